// What the tests read from the page, many things at once: each page of a test has these functions.

const NAMES_OF_FIELDS = ["theta", "phi_dot", "psi_dot"];

/** The pixels of a picture or canvas: its width and height, and four numbers for each pixel. */
const readPixels = (picture) => {
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width: picture.width, height: picture.height });
  const context = canvas.getContext("2d");
  context.drawImage(picture, 0, 0);
  return context.getImageData(0, 0, canvas.width, canvas.height);
};

/** Hue in degrees, saturation and value of a pixel. */
const findHue = (r, g, b) => {
  const [most, least] = [Math.max(r, g, b), Math.min(r, g, b)];
  const width = most - least || 1;
  const turned = [(g - b) / width, 2 + (b - r) / width, 4 + (r - g) / width];
  const hue = 60 * turned[[r, g, b].indexOf(most)];
  return [(hue + 360) % 360, (most - least) / (most || 1), most / 255];
};

/** What a colour is of, as one names it: light and shadow change its value. */
const NAMED = {
  enamel: ([hue, saturation, value]) => hue > 342 && saturation > 0.55 && value < 0.75,
  brass: ([hue, saturation]) => hue > 32 && hue < 48 && saturation > 0.3 && saturation < 0.8,
  ball: ([hue, saturation, value]) => hue > 28 && hue < 42 && saturation > 0.9 && value > 0.4,
  torque: ([hue, saturation]) => hue < 12 && saturation > 0.7,
  L: ([hue, saturation]) => hue > 212 && hue < 230 && saturation > 0.7,
  omega: ([hue, saturation]) => hue > 155 && hue < 172 && saturation > 0.7,
};

window.looks = {
  /** The time, fields, buttons of regular rates and rows of constants as texts. */
  readNumbers() {
    const texts = (elements) => [...elements].map((each) => each.textContent);
    const roots = [...document.querySelectorAll("#roots button")];
    const values = NAMES_OF_FIELDS.map((name) => document.getElementById(`field-${name}`).value);
    return {
      time: document.body.dataset.time,
      fields: Object.fromEntries(NAMES_OF_FIELDS.map((name, k) => [name, values[k]])),
      roots: texts(roots.filter((each) => !each.hidden)),
      rows: Object.fromEntries(
        [...document.querySelectorAll("#constants tr")].map((row) => texts(row.children)),
      ),
    };
  },

  /** The place of the ball, by its colour, in the middle of the scene's canvas. */
  findBall() {
    const canvas = document.querySelector("#picture");
    const { data, width } = readPixels(canvas);
    let [x, y, count] = [0, 0, 0];
    for (let k = 0; k < data.length; k += 4) {
      const [r, g, b] = [data[k], data[k + 1], data[k + 2]];
      const isOrange = r > 190 && g > 95 && g < 160 && b < 50;
      if (!isOrange || data[k + 3] < 255) continue;
      x += (k / 4) % width;
      y += Math.floor(k / 4 / width);
      count += 1;
    }
    const box = canvas.getBoundingClientRect();
    const size = box.width / width;
    return [box.left + (x / count) * size, box.top + (y / count) * size];
  },

  /** How many pixels of the scene have each named colour, and which are near to some places (px). */
  nameColors({ places, radius }) {
    const canvas = document.querySelector("#picture");
    const { data, width, height } = readPixels(canvas);
    const ratio = width / canvas.getBoundingClientRect().width;
    const counts = Object.fromEntries(Object.keys(NAMED).map((name) => [name, 0]));
    const near = Object.fromEntries(Object.keys(places).map((name) => [name, new Set()]));
    for (let k = 0; k < width * height; k += 1) {
      if (data[4 * k + 3] < 255) continue;
      const seen = findHue(data[4 * k], data[4 * k + 1], data[4 * k + 2]);
      const name = Object.keys(NAMED).find((each) => NAMED[each](seen));
      if (!name) continue;
      counts[name] += 1;
      const [x, y] = [k % width, Math.floor(k / width)].map((each) => each / ratio);
      for (const [of, [px, py]] of Object.entries(places))
        if (Math.hypot(px - x, py - y) < radius) near[of].add(name);
    }
    const lists = Object.entries(near).map(([of, names]) => [of, [...names]]);
    return { counts, near: Object.fromEntries(lists) };
  },

  /** How many colours the scene has: one if nothing is drawn. */
  countColors() {
    const gl = document.querySelector("#picture").getContext("webgl2");
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return new Set(new Uint32Array(pixels.buffer)).size;
  },

  /** The height of a saved picture, and how many of its pixels have a colour, as #rrggbb. */
  async countPixels([text, color]) {
    const picture = new Image();
    picture.src = `data:image/png;base64,${text}`;
    await picture.decode();
    const { data } = readPixels(picture);
    const context = document.createElement("canvas").getContext("2d");
    context.fillStyle = color;
    context.fillRect(0, 0, 1, 1);
    const wanted = [...context.getImageData(0, 0, 1, 1).data].slice(0, 3);
    let count = 0;
    for (let k = 0; k < data.length; k += 4)
      count += wanted.every((each, n) => data[k + n] === each);
    return [picture.height, count];
  },

  /** The heights of the level of the energy and of the place on it, the angles, and the curve. */
  readWell() {
    const level = document.querySelector("#well path[stroke='var(--gold)']").getAttribute("d");
    const place = document.querySelector("#well circle").getAttribute("cy");
    const curve = document.querySelector("#potential").getAttribute("d");
    const names = document.querySelectorAll("#well text.tick[text-anchor=middle]");
    const angles = [...names].map((each) => each.textContent);
    return [Number(level.match(/M44 ([\d.]+)H/)[1]), Number(place), angles, curve];
  },

  /** Whether nothing covers the middle of a part. */
  isOnTop(name) {
    const part = document.getElementById(name);
    const { left, top, width, height } = part.getBoundingClientRect();
    return part.contains(document.elementFromPoint(left + width / 2, top + height / 2));
  },

  /** What is wider or higher than its place, and what another element of its row covers. */
  findCut() {
    const isSeen = (element) => element.checkVisibility() && element.getClientRects().length;
    const name = (element) => `${element.id || element.className} "${element.textContent}"`;
    const places = "#strip, #bar, button, summary, label, th, td, p, h2, #legend li, #entries";
    const isCut = (each) =>
      (each.scrollWidth > each.clientWidth + 1 && getComputedStyle(each).display !== "inline") ||
      (each.id === "strip" && each.scrollHeight > each.clientHeight + 1);
    const cut = [...document.querySelectorAll(places)].filter(
      (each) => isSeen(each) && isCut(each),
    );
    const beyond = [...document.querySelectorAll("svg[role=img] text")].filter((text) => {
      const svg = text.closest("svg[role=img]");
      const [own, all] = [text, svg].map((each) => each.getBoundingClientRect());
      return all.width && (own.left < all.left - 1 || own.right > all.right + 1);
    });
    const isWide = document.documentElement.scrollWidth > innerWidth;
    return [...(isWide ? ["the page is too wide"] : []), ...cut.map(name), ...beyond.map(name)];
  },

  /** Wait until a chart is out of sight, as the page is told that it is. */
  waitUntilHidden(chart) {
    return new Promise((done) => {
      const look = ([found]) => found.isIntersecting || done();
      new IntersectionObserver(look).observe(document.querySelector(chart));
    });
  },
};

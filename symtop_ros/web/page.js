// The page around the 3D scene: controls and charts of a running top, or charts of a saved run.
(() => {
  "use strict";
  const find = (id) => document.getElementById(id);
  const make = (name, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(name), properties);
    element.append(...children);
    return element;
  };
  const saved = window.SAVED_RUN; // of a file that a run was saved to
  const content = window.TOP_CONTENT; // of the page as one file, whose top lives in it
  let top = null; // that top, once its kernel is loaded
  const frame = document.querySelector("iframe");
  const page = Array.from(crypto.getRandomValues(new Uint32Array(4)), (n) => n.toString(36)).join("");
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  let facts = null; // what holds for a whole motion
  let rows = []; // time, theta, phi', psi', theta of the ghost
  let socket = null;
  const boxes = {}; // of the layers of the scene, by their names
  let lesson = null; // once the server has sent its steps

  // Words and numbers

  const inDegrees = () => find("unit").value === "deg";
  const angle = (value) => (inDegrees() ? (value * 180) / Math.PI : value);
  const angleUnit = () => (inDegrees() ? "\u00b0" : "rad");
  const short = (value, digits = 4) => (value === null || value === undefined || Number.isNaN(value) ? "" : String(Number(value.toPrecision(digits))));
  const fixed = (value) => (Math.abs(value) >= 1e5 ? value.toPrecision(4) : (Math.round(value * 1e4) / 1e4).toFixed(inDegrees() ? 1 : 3));

  // Fields: a value is taken over on Enter or when the field is left, never while it is typed

  const FIELDS = {
    factor: { label: "factor of phi'", low: 1.05, high: 3, step: 0.05 },
    theta: { label: "tilt theta", unit: "rad", low: 0, high: Math.PI, step: 0.01 },
    psi_dot: { label: "spin psi' (rad/s)", low: -400, high: 400, step: 1 },
    phi_dot: { label: "precession phi' (rad/s)", low: -12, high: 12, step: 0.1 },
    "top.Ix": { label: "Ix, across the axis (kg m\u00b2)" },
    "top.Iz": { label: "Iz, about the axis (kg m\u00b2)" },
    "top.Mgl": { label: "Mgl, gravity moment (J)" },
    "friction.axial": { label: "friction, axial (N m s)" },
    "friction.transverse": { label: "friction, transverse (N m s)" },
  };
  const values = { factor: 1.4 };
  let typed = null; // the field that was typed into, and not yet taken over
  let asked = null; // the field whose value was sent last
  let dragged = null;

  // A number with the unit that may follow it: 0.5, 1e-3, pi/4, 30\u00b0, 0.6 rad. An angle without a
  // unit is in that of the page; a multiple of pi is in rad.
  const parse = (text, name) => {
    const plain = text.trim().toLowerCase().replace("\u2212", "-").replace(",", ".").replace("\u03c0", "pi");
    const [, number, unit] = plain.match(/^(.*?)\s*(\u00b0|deg|degrees|rad)?$/);
    const [, sign, size, pi, part] = number.match(/^([+-]?)(\d+\.?\d*(?:e[+-]?\d+)?|\.\d+(?:e[+-]?\d+)?)?\s*\*?\s*(pi)?(?:\s*\/\s*(\d+\.?\d*))?$/) ?? [];
    if (sign === undefined || (!size && !pi)) return NaN;
    const value = (Number(size ?? 1) * (pi ? Math.PI : 1) * (sign === "-" ? -1 : 1)) / Number(part ?? 1);
    if (unit && name !== "theta") return NaN;
    const isDegrees = unit ? unit !== "rad" : name === "theta" && inDegrees() && !pi;
    return isDegrees ? (value * Math.PI) / 180 : value;
  };
  const scale = (name) => (name === "theta" && inDegrees() ? 180 / Math.PI : 1);
  const write = (name) => {
    const { text, slider } = FIELDS[name];
    if (values[name] === undefined) return;
    const shown = short(values[name] * scale(name), 6);
    if (document.activeElement !== text) {
      text.value = shown;
      text.removeAttribute("aria-invalid");
    }
    if (slider && dragged !== slider) {
      slider.value = values[name];
      slider.setAttribute("aria-valuetext", shown);
    }
  };
  const commit = (name) => {
    const { text, label } = FIELDS[name];
    if (typed !== name) return;
    typed = null;
    const value = parse(text.value, name);
    if (!Number.isFinite(value)) {
      text.setAttribute("aria-invalid", "true");
      refuse(`${label} must be a number, got ${text.value.trim() || "nothing"}`);
      return;
    }
    asked = name;
    text.removeAttribute("aria-invalid");
    if (name === "theta" && !(value >= 0 && value <= Math.PI)) {
      refuse(`tilt theta must be 0 to ${inDegrees() ? "180\u00b0" : "pi rad"}, got ${text.value.trim()}`);
      return;
    }
    change(name, value);
  };
  const change = (name, value) => {
    if (name === "factor") {
      if (value > 0) values.factor = value;
      else refuse(`factor of phi' must be positive, got ${value}`);
      write(name);
    } else if (name.includes(".")) send({ act: "set", name, value });
    else startWith(name, value);
  };
  const startWith = (name, value) => {
    const { theta, phi_dot, psi_dot } = { ...values, [name]: value };
    send({ act: "start", theta, phi_dot, psi_dot });
  };
  // Of the moves of a slider the last one in a tenth of a second is sent.
  let moved = null;
  const later = (act) => {
    if (!moved) setTimeout(() => { const last = moved; moved = null; last(); }, 100);
    moved = act;
  };
  const addField = (place) => {
    const name = place.dataset.field;
    const field = FIELDS[name];
    const id = "field-" + name;
    field.name = make("label", { htmlFor: id, textContent: field.label });
    field.text = make("input", { id, type: "text", inputMode: "text", autocomplete: "off" });
    field.text.addEventListener("keydown", (event) => {
      if (event.key === "Enter") commit(name);
      if (event.key === "Escape") { typed = null; refuse(""); field.text.blur(); }
    });
    field.text.addEventListener("input", () => { typed = name; });
    field.text.addEventListener("blur", () => {
      commit(name);
      setTimeout(() => write(name), 1000); // what holds, if the value was refused
    });
    place.append(field.name, field.text);
    if (field.low === undefined) return;
    const { low: min, high: max, step } = field;
    field.slider = make("input", { type: "range", min, max, step: "any" });
    field.slider.setAttribute("aria-label", field.label);
    field.slider.addEventListener("keydown", (event) => {
      const signs = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };
      const sign = signs[event.key];
      if (!sign) return;
      event.preventDefault();
      const { min, max } = field.slider;
      change(name, Math.min(Math.max(Number((values[name] + sign * step).toPrecision(12)), Number(min)), Number(max)));
    });
    field.slider.addEventListener("input", () => {
      dragged = field.slider;
      const value = Math.min(Number(Number(field.slider.value).toFixed(step < 0.1 ? 3 : 1)), Number(field.slider.max));
      field.text.value = short(value * scale(name), 6);
      later(() => change(name, value));
    });
    for (const end of ["change", "pointerup", "blur"]) {
      field.slider.addEventListener(end, () => { dragged = null; });
    }
    place.append(field.slider);
  };
  const showValues = () => {
    const { start, top } = facts;
    Object.assign(values, start, top);
    const widest = (name, least, more = []) => {
      const high = Math.ceil(1.15 * Math.max(least, ...[values[name], ...more].map(Math.abs)));
      Object.assign(FIELDS[name].slider, { min: -high, max: high });
    };
    widest("psi_dot", 340);
    widest("phi_dot", 10, facts.roots.filter((rate) => Math.abs(rate) < 1e4));
    Object.keys(FIELDS).forEach(write);
  };

  // What the page says

  const refuse = (text) => {
    find("refusal").textContent = text;
    find("refusal").hidden = !text;
    if (text && asked) FIELDS[asked].text.setAttribute("aria-invalid", "true");
  };
  const say = (id, text) => { if (find(id).textContent !== text) find(id).textContent = text; };
  const showFacts = () => {
    const sentences = inDegrees() ? facts.degrees : facts;
    say("headline", sentences.headline);
    say("why", sentences.why);
    if (saved) return;
    say("pause", facts.running ? "Pause" : "Run");
    if (!content) say("record", facts.recording ? "End the recording" : "Record (MCAP)");
    say("pace", facts.running ? "" : "paused");
    const speed = find("speed");
    if (![...speed.options].some((option) => Number(option.value) === facts.factor)) {
      speed.append(make("option", { value: facts.factor, textContent: `${short(facts.factor, 3)} of real time` }));
    }
    if (document.activeElement !== speed) speed.value = facts.factor;
    find("link").value = content ? `${location.href.split("#")[0]}#${facts.link}` : `${location.origin}/?${facts.link}`;
    find("roots").replaceChildren(
      ...(facts.roots.length ? ["steady at"] : ["no steady precession at this tilt and spin"]),
      ...facts.roots.map((rate, k) => {
        const name = facts.roots.length === 2 ? ["slow", "fast"][k] : "slow";
        const button = make("button", { textContent: `${facts.roots.length === 2 ? name : "the"} root ${short(rate, 4)} rad/s` });
        button.onclick = () =>
          send({ act: "start", theta: values.theta, psi_dot: values.psi_dot, precession: name });
        return button;
      }),
    );
    find("entries").replaceChildren(
      ...facts.history.map(([entry, text]) =>
        Object.assign(make("button", { textContent: text }), { onclick: () => send({ act: "restart", entry }) }),
      ),
    );
    showValues();
  };

  // Charts

  const SVG = "http://www.w3.org/2000/svg";
  const WIDE = 300;
  const LEFT = 44;
  const draw = (id, height, label, content) => {
    const place = find(id);
    if (!place.firstChild) {
      const svg = document.createElementNS(SVG, "svg");
      svg.setAttribute("viewBox", `0 0 ${WIDE} ${height}`);
      svg.setAttribute("role", "img");
      svg.setAttribute("aria-label", label);
      place.append(svg);
    }
    place.firstChild.innerHTML = content;
  };
  const ticks = (low, high, count) => {
    const rough = (high - low) / count;
    const size = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((k) => k * size).find((each) => each >= rough * 0.999);
    const found = [];
    for (let k = Math.ceil(low / step); k * step <= high; k += 1) found.push(Number((k * step).toPrecision(10)));
    return found;
  };
  // A box with axes: `low` and `high` are the values at its lower and upper edge, in this order.
  const box = (height, [left, right], [low, high], marks = 4, shown = (value) => value) => {
    const bottom = height - 18;
    const x = (value) => LEFT + ((value - left) / (right - left)) * (WIDE - LEFT - 6);
    const y = (value) => bottom - ((value - low) / (high - low)) * (bottom - 8);
    const lines = ticks(shown(Math.min(low, high)), shown(Math.max(low, high)), marks).map((value) => {
      const place = y((value / (shown(1) || 1)));
      return `<path class="axis" d="M${LEFT} ${place.toFixed(1)}H${WIDE - 6}"/>
        <text class="tick" x="${LEFT - 4}" y="${(place + 3).toFixed(1)}" text-anchor="end">${short(value, 5)}</text>`;
    });
    return { x, y, bottom, axes: lines.join("") };
  };
  const below = (frame, values, shown = (value) => short(value, 5)) =>
    values.map((value) => `<text class="tick" x="${frame.x(value).toFixed(1)}" y="${frame.bottom + 12}" text-anchor="middle">${shown(value)}</text>`).join("");
  const path = (points, style) => {
    let text = "";
    let pen = "M";
    for (const [x, y] of points) {
      if (Number.isFinite(y)) { text += `${pen}${x.toFixed(1)} ${y.toFixed(1)}`; pen = "L"; } else pen = "M";
    }
    return `<path d="${text}" fill="none" ${style}/>`;
  };
  const spread = (numbers, least) => {
    let low = Infinity;
    let high = -Infinity;
    for (const value of numbers) if (Number.isFinite(value)) { low = Math.min(low, value); high = Math.max(high, value); }
    if (low > high) return [0, 1];
    const more = Math.max(0.06 * (high - low), (least - (high - low)) / 2, 1e-9);
    return [low - more, high + more];
  };

  const drawWell = (row) => {
    const { left, right, bottom, top, theta, height, energy, angles, before } = facts.potential;
    const frame = box(150, [left, right], [bottom, top]);
    const cut = (value) => (value <= top ? value : NaN);
    const curve = (tilts, heights) => tilts.map((tilt, k) => [frame.x(tilt), frame.y(cut(heights[k]))]);
    const [low, high] = angles.map(frame.x);
    const dot = frame.x(row[1]);
    const names = angles[1] - angles[0] < 0.1 * (right - left) ? [(angles[0] + angles[1]) / 2] : angles;
    draw("well", 150, "Effective potential over the tilt",
      `<rect x="${low.toFixed(1)}" y="8" width="${Math.max(high - low, 1).toFixed(1)}" height="${frame.bottom - 8}" fill="var(--band)"/>
      ${frame.axes}${before ? path(curve(before.theta, before.height), 'stroke="var(--grey)" stroke-dasharray="4 3" id="before"') : ""}
      <path d="M${LEFT} ${frame.y(energy).toFixed(1)}H${WIDE - 6}" stroke="var(--gold)" stroke-width="2"/>
      <text x="${WIDE - 8}" y="${(frame.y(energy) - 4).toFixed(1)}" text-anchor="end">E'</text>
      ${path(curve(theta, height), 'stroke="var(--phi)" stroke-width="2" id="potential"')}
      <text x="${LEFT + 2}" y="18">U in J</text>
      <circle cx="${dot.toFixed(1)}" cy="${frame.y(energy).toFixed(1)}" r="5" fill="var(--theta)"/>
      ${below(frame, names, (value) => `${fixed(angle(value))} ${angleUnit()}`)}`);
  };

  // theta'' = sin(theta)/Ix (a phi'^2 - b phi' + Mgl) with psi' held, as in physics/precession.py
  const acceleration = (theta, spin) => {
    const { "top.Ix": Ix, "top.Iz": Iz, "top.Mgl": Mgl } = facts.top;
    const a = (Ix - Iz) * Math.cos(theta);
    return { a, b: Iz * spin, c: Mgl, at: (rate) => (Math.sin(theta) / Ix) * ((a * rate - Iz * spin) * rate + Mgl) };
  };
  const drawRule = (row) => {
    const [, theta, rate, spin] = row;
    const { a, b, c, at } = acceleration(theta, spin);
    const inner = Math.sqrt(b * b - 4 * a * c);
    const far = Math.abs(b) + inner; // without cancellation: one root is the quotient of the other
    const sign = b < 0 ? -1 : 1;
    const roots = (Number.isFinite(inner) ? [sign * far / (2 * a), (2 * c) / (sign * far)] : []).filter((root) => Math.abs(root) < 1e4);
    const hurried = rate * values.factor;
    const range = spread([0, ...roots, ...facts.roots.filter((each) => Math.abs(each) < 1e4), facts.start.phi_dot, rate, hurried], 1);
    const rates = Array.from({ length: 81 }, (_, k) => range[0] + (k / 80) * (range[1] - range[0]));
    const [low, high] = spread([0, at(rate), at(hurried), ...rates.map(at)], 1);
    const frame = box(150, range, [high, low], 4); // the axis points down: up is a rise
    const dot = (value, style) => `<circle cx="${frame.x(value).toFixed(1)}" cy="${frame.y(at(value)).toFixed(1)}" r="5" ${style}/>`;
    draw("rule", 150, "Acceleration of the tilt over the precession rate",
      `${frame.axes}<path d="M${LEFT} ${frame.y(0).toFixed(1)}H${WIDE - 6}" stroke="var(--grey)"/>
      ${path(rates.map((each) => [frame.x(each), frame.y(at(each))]), 'stroke="var(--phi)" stroke-width="2"')}
      ${roots.map((root) => `<path class="root" d="M${frame.x(root).toFixed(1)} ${(frame.y(0) - 6).toFixed(1)}v12" stroke="var(--text)" stroke-width="2"/>`).join("")}
      ${Math.abs(rate) > 1e-9 ? dot(hurried, 'fill="none" stroke="var(--theta)" stroke-width="2" id="hurried"') : ""}
      ${dot(rate, 'fill="var(--theta)" id="now"')}
      <text x="${LEFT + 2}" y="18">rises \u2191 (theta'' &lt; 0, rad/s\u00b2)</text>
      <text x="${WIDE - 8}" y="${frame.bottom - 4}" text-anchor="end">falls \u2193</text>
      ${below(frame, ticks(range[0], range[1], 4), (value) => `${short(value)}`)}
      <text class="tick" x="4" y="${frame.bottom + 12}">rad/s</text>`);
  };

  const SERIES = { theta: [1, "var(--theta)", 0.01], phi_dot: [2, "var(--phi)", 0.1], psi_dot: [3, "var(--psi)", 0.1] };
  const drawSeries = (shown) => {
    const now = shown[shown.length - 1][0];
    const begin = Math.max(now - facts.window, shown[0][0]);
    const range = [begin, Math.max(now, begin + facts.window / 20)];
    for (const [id, [column, color, least]] of Object.entries(SERIES)) {
      const isTilt = id === "theta";
      const all = isTilt ? [...shown.map((row) => row[1]), ...shown.map((row) => row[4] ?? NaN)] : shown.map((row) => row[column]);
      const [low, high] = spread(all, Math.max(least, isTilt ? 0 : 0.02 * Math.abs(shown[0][column])));
      const frame = box(96, range, isTilt ? [high, low] : [low, high], 3, isTilt ? angle : (value) => value);
      const line = (k, style) => path(shown.map((row) => [frame.x(row[0]), row[k] === null ? NaN : frame.y(row[k])]), style);
      const marks = facts.marks.filter((time) => time >= begin && time <= now)
        .map((time) => `<path class="kick" d="M${frame.x(time).toFixed(1)} 8V${frame.bottom}" stroke="var(--gold)" stroke-width="1.5"/>`);
      draw(id, 96, `${id} over time`, `${frame.axes}${marks.join("")}
        ${isTilt ? line(4, 'stroke="var(--grey)" stroke-width="1.5" stroke-dasharray="4 3" class="ghost"') : ""}
        ${line(column, `stroke="${color}" stroke-width="1.8"`)}
        <text x="${LEFT + 2}" y="17">${isTilt ? `${angleUnit()}; up is higher` : "rad/s"}</text>
        ${below(frame, ticks(range[0], range[1], 4))}`);
    }
  };
  const EXPLAINED = { energy: "energy E", L_z: "L_z, about the axis of the top", "L_z'": "L_z', about the vertical" };
  const drawConstants = (now) => {
    const cell = (text) => `<td>${text}</td>`;
    const lines = facts.table.map(([name, text]) => `<tr><th scope="row">${name}</th>${cell(text)}</tr>`);
    for (const [name, [value, change, unit]] of Object.entries(now ?? {})) {
      const drift = Math.abs(change) < 1e-12 * Math.abs(value) || change === 0 ? "constant" : `changed by ${short(change, 2)}`;
      lines.push(`<tr><th scope="row">${EXPLAINED[name]}</th>${cell(`${short(value, 6)} ${unit}, ${drift}`)}</tr>`);
    }
    find("constants").tBodies[0].innerHTML = lines.join("");
  };
  const drawCharts = (shown, now) => {
    if (!facts || !shown.length) return;
    const row = shown[shown.length - 1];
    document.body.dataset.theta = row[1];
    document.body.dataset.time = row[0];
    drawWell(row);
    drawRule(row);
    drawSeries(shown);
    if (now !== undefined) drawConstants(now);
  };

  // Look

  const TORQUES = "fictitious torques";
  const LEGEND = [["#0a46be", "L, angular momentum"], ["#009e73", "omega"], ["#d53c0a", "torque"], ["#e69600", "trace"], ["#c9ced6", "pale: ghost, not kicked"],
    ["#d53c0a", "gravity", TORQUES], ["#1e96f0", "Coriolis", TORQUES], ["#690fff", "centrifugal", TORQUES], ["#d23ca5", "sum, Ix theta''", TORQUES]];
  const addLegend = () =>
    find("legend").append(
      ...LEGEND.map(([color, text, layer]) => {
        const mark = make("i");
        mark.style.background = color;
        const entry = make("li", { hidden: Boolean(layer) }, mark, text);
        if (layer) entry.dataset.layer = layer;
        return entry;
      }),
    );
  const showLayer = (layer, shown) => {
    boxes[layer].checked = shown;
    for (const entry of document.querySelectorAll(`#legend [data-layer="${layer}"]`)) entry.hidden = !shown;
    send({ act: "show", layer, shown });
  };
  const setTheme = () => {
    const choice = saved ? "" : find("theme").value;
    const isDark = choice ? choice === "dark" : dark.matches;
    if (document.documentElement.dataset.theme === (isDark ? "dark" : "light")) return;
    document.documentElement.dataset.theme = isDark ? "dark" : "light";
    showScene(isDark);
  };
  const showScene = (isDark) => {
    if (content) return;
    if (saved) {
      frame.srcdoc = saved.scene.replace("{darkMode:false}", `{darkMode:${isDark}}`);
    } else {
      const address = `ws://${location.host}/scene/${page}`;
      frame.src = `/scene?${isDark ? "darkMode&" : ""}websocket=${encodeURIComponent(address)}`;
    }
  };

  // A running top

  const send = (message) => {
    refuse("");
    if (content) {
      if (top) top.take(message);
      return;
    }
    if (socket && socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
    else refuse("the page is not connected: is top_panel still running?");
  };
  const act = (name) => {
    if (name === "hurry") send({ act: "kick", factor: values.factor });
    else if (name === "delay") send({ act: "kick", factor: 1 / values.factor });
    else send({ act: name });
  };
  const receive = (message) => {
    if (message.hello) greet(message.hello);
    if (message.facts) {
      if (facts && message.facts.since !== facts.since) rows = [];
      facts = message.facts;
      showFacts();
    }
    if (message.rows) {
      rows.push(...message.rows);
      const begin = rows[rows.length - 1][0] - facts.window;
      const old = rows.findIndex((row) => row[0] >= begin);
      if (old > 0) rows = rows.slice(old);
    }
    if (message.series) {
      rows = message.series;
      drawCharts(rows, message.constants);
      showTime(message.time);
    }
    if (message.now) {
      const last = rows[rows.length - 1];
      drawCharts(last && last[0] >= message.now[0] ? rows : [...rows, message.now], message.constants);
    }
    if (message.refused) refuse(message.refused);
    if (message.granted) asked = null;
    if (message.said) refuse(message.said);
    if (message.file) make("a", { href: message.file, download: "" }).click();
  };
  const greet = ({ scenes, layers, lesson: steps }) => {
    if (find("scenes").options.length) return;
    find("scenes").append(
      make("option", { value: "", textContent: "choose ..." }),
      ...scenes.map(({ name, title }) => make("option", { value: name, textContent: title })),
    );
    find("scenes").addEventListener("change", () => {
      const chosen = scenes.find(({ name }) => name === find("scenes").value);
      find("story").textContent = chosen ? chosen.story : "";
      if (chosen) send({ act: "scene", name: chosen.name });
    });
    find("layers").append(
      ...Object.entries(layers).map(([layer, checked]) => {
        const box = make("input", { type: "checkbox", checked });
        boxes[layer] = box;
        box.addEventListener("change", () => showLayer(layer, box.checked));
        return make("div", {}, make("label", {}, box, " " + layer));
      }),
    );
    // Of the layers that are hidden at first a step of the lesson shows those that it names.
    const chooseLayers = (named) => {
      for (const [layer, shown] of Object.entries(layers)) {
        if (!shown && boxes[layer].checked !== named.includes(layer)) showLayer(layer, !boxes[layer].checked);
      }
    };
    lesson = makeLesson({ find, make, send, chooseLayers }, steps);
    if (calm.matches || (content && content.run)) send({ act: "rest" });
    if (content) { followFragment(); return; }
    followLink(location.search + "&" + location.hash.slice(1), document.documentElement.dataset.trusted === "yes");
  };
  // The page as one file: nobody else can reach its top, so that a link starts without a question.
  const followFragment = () => {
    const text = location.hash.slice(1);
    if (/^run=|^$/.test(text)) return;
    const { lesson: step, ...link } = Object.fromEntries(new URLSearchParams(text));
    if (step !== undefined) { find("tab-lesson").click(); lesson.show(Number(step)); }
    if (Object.keys(link).length) send({ act: "link", link });
  };
  const showTime = ([time, end]) => {
    const line = find("timeline");
    if (dragged !== line) Object.assign(line, { max: end, value: time });
    line.setAttribute("aria-valuetext", `${time.toFixed(3)} s of ${end.toFixed(3)} s`);
  };
  const addTimeline = () => {
    const line = make("input", { id: "timeline", type: "range", min: 0, max: 0, step: "any" });
    line.setAttribute("aria-label", "time of the run");
    line.addEventListener("input", () => { dragged = line; send({ act: "seek", time: Number(line.value) }); });
    for (const end of ["change", "pointerup", "blur"]) line.addEventListener(end, () => { dragged = null; });
    find("acts").append(make("div", { className: "row" }, line));
  };
  const keepFile = (name, type, text) => {
    const url = URL.createObjectURL(new Blob([text], { type }));
    make("a", { href: url, download: name }).click();
    setTimeout(() => URL.revokeObjectURL(url), 10_000);
  };
  const addSaving = () => {
    const offer = (text, save) => make("button", { textContent: text, className: "button", onclick: save });
    const run = () => JSON.stringify(top.run.json);
    // The page as it was opened, with the events of the run in it; no end of a script is among them.
    const page = () => window.TOP_SOURCE.replace("/*RUN*/", () => `window.TOP_CONTENT.run = ${run().replaceAll("<", "\\u003c")};`);
    find("save").replaceChildren(
      offer("This run as a page (HTML, opens anywhere)", () => keepFile("top.html", "text/html", page())),
      offer("This run (JSON)", () => keepFile("run.json", "application/json", run())),
      offer("Series (CSV)", () => keepFile("top.csv", "text/csv", top.csv)),
      offer("Picture (PNG)", () => make("a", { href: document.querySelector("canvas").toDataURL("image/png"), download: "top.png" }).click()),
      find("link").labels[0], find("link"),
      make("p", { className: "dim", textContent: "A run.json or a saved page that is dropped onto this page is opened." }),
    );
  };
  const openFile = async (file) => {
    const text = await file.text();
    const found = text.match(/window\.TOP_CONTENT\.run = (\{.*\});/);
    try {
      send({ act: "load", run: JSON.parse(found ? found[1] : text) });
    } catch {
      refuse(`${file.name} must be a run.json or a saved page`);
    }
  };
  const openTop = async () => {
    try {
      top = await window.startTop(content, find("scene"), receive);
    } catch (error) {
      refuse(`the top cannot be shown: ${error.message}`);
      return;
    }
    addTimeline();
    addSaving();
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      const [file] = event.dataTransfer.files;
      if (file) openFile(file);
    });
    top.open();
  };
  const connect = () => {
    if (content) { openTop(); return; }
    socket = new WebSocket(`ws://${location.host}/controls/${page}`);
    socket.onmessage = (event) => receive(JSON.parse(event.data));
    socket.onclose = () => {
      refuse("the connection is lost: is top_panel still running?");
      setTimeout(connect, 1000);
    };
    socket.onopen = () => refuse("");
  };

  // A link such as /?theta=0.5&psi_dot=200 holds a start. The page of another site may have led here:
  // only a link that the user has typed or chosen in the browser starts without a question.
  const followLink = (text, isTrusted) => {
    const { lesson: step, ...link } = Object.fromEntries(new URLSearchParams(text));
    if (step !== undefined) { find("tab-lesson").click(); lesson.show(Number(step)); }
    if (!Object.keys(link).length) return;
    history.replaceState(null, "", "/");
    const start = () => send({ act: "link", link });
    if (isTrusted) { start(); return; }
    find("offered").textContent =
      "A link asks for this start: " + Object.entries(link).map((pair) => pair.join(" = ")).join(", ").slice(0, 300) + ".";
    find("follow").onclick = () => { find("offer").hidden = true; start(); };
    find("ignore").onclick = () => { find("offer").hidden = true; };
    find("offer").hidden = false;
  };

  const KEYS = { h: "hurry", d: "delay", " ": "pause", s: "step", r: "reset" };
  const PUSHES = { ArrowUp: "up", ArrowDown: "down", ArrowRight: "along", ArrowLeft: "back" };
  const onKey = (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target.closest ? event.target : document.body;
    if (target.closest("input[type=text], select, textarea")) return;
    const isPush = event.key in PUSHES;
    if (isPush && target.closest("input, [role=tab]")) return;
    if (event.key === " " && target.closest("button, a, input, summary")) return;
    const key = event.key.toLowerCase(); // Caps Lock changes nothing
    if (!isPush && !(key in KEYS)) return;
    event.preventDefault();
    event.stopImmediatePropagation(); // viser moves the camera with some of these keys
    if (event.repeat && !isPush) return;
    if (isPush) send({ act: "push", way: PUSHES[event.key] });
    else act(KEYS[key]);
  };
  const hold = (button) => {
    let timer = null;
    const push = () => send({ act: "torque", sign: Number(button.dataset.hold) });
    const begin = () => { end(); push(); timer = setInterval(push, 50); };
    const end = () => { clearInterval(timer); timer = null; };
    button.addEventListener("pointerdown", begin);
    for (const name of ["pointerup", "pointerleave", "pointercancel", "blur", "keyup"]) button.addEventListener(name, end);
    button.addEventListener("keydown", (event) => { if (event.key === "Enter" && !event.repeat) begin(); });
  };
  const addTabs = () => {
    const list = document.querySelector("[role=tablist]");
    const panels = [...document.querySelectorAll(".tab")];
    const choose = (panel) => {
      for (const each of panels) {
        each.hidden = each !== panel;
        const tab = find("tab-" + each.id);
        tab.setAttribute("aria-selected", String(each === panel));
        tab.tabIndex = each === panel ? 0 : -1;
      }
      document.body.classList.toggle("in-lesson", panel.id === "lesson");
    };
    for (const panel of panels) {
      panel.setAttribute("role", "tabpanel");
      panel.setAttribute("aria-labelledby", "tab-" + panel.id);
      const tab = make("button", { id: "tab-" + panel.id, textContent: panel.dataset.name });
      tab.setAttribute("role", "tab");
      tab.setAttribute("aria-controls", panel.id);
      tab.onclick = () => choose(panel);
      if (panel.id === "lesson") tab.addEventListener("click", () => { if (lesson) lesson.open(); });
      tab.onkeydown = (event) => {
        const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (!step) return;
        const next = panels[(panels.indexOf(panel) + step + panels.length) % panels.length];
        choose(next);
        find("tab-" + next.id).focus();
      };
      list.append(tab);
    }
    choose(panels[0]);
  };
  const live = () => {
    document.querySelectorAll("[data-field]").forEach(addField);
    write("factor");
    addTabs();
    for (const [value, text] of [[1, "real time"], ...[2, 5, 10, 20, 50, 100].map((n) => [1 / n, `1/${n} of real time`])]) {
      find("speed").append(make("option", { value, textContent: text }));
    }
    find("speed").addEventListener("change", () => send({ act: "speed", factor: Number(find("speed").value) }));
    document.querySelectorAll("[data-act]").forEach((button) => { button.onclick = () => act(button.dataset.act); });
    document.querySelectorAll("[data-push]").forEach((button) => { button.onclick = () => send({ act: "push", way: button.dataset.push }); });
    document.querySelectorAll("[data-hold]").forEach(hold);
    find("picture").href = `/picture.png?page=${page}`;
    for (const id of ["theme", "unit"]) {
      find(id).value = readChoice(id) ?? find(id).value;
      find(id).addEventListener("change", () => keepChoice(id, find(id).value));
    }
    find("theme").addEventListener("change", setTheme);
    find("unit").addEventListener("change", () => { if (facts) { setUnit(); showFacts(); } });
    // A button that the mouse has pressed gives the space key back to the page.
    document.addEventListener("click", (event) => { if (event.detail && event.target.closest("button")) event.target.closest("button").blur(); });
    document.addEventListener("keydown", onKey, true);
    if (frame) frame.addEventListener("load", () => frame.contentWindow.addEventListener("keydown", onKey, true));
    addEventListener("hashchange", () => (content ? followFragment() : followLink(location.hash.slice(1), window.isSecureContext)));
    connect();
  };
  // Choices are kept by the browser, where it keeps anything: a frame or a file may have no store.
  const readChoice = (id) => { try { return localStorage.getItem(`symtop.${id}`); } catch { return null; } };
  const keepChoice = (id, value) => { try { localStorage.setItem(`symtop.${id}`, value); } catch { /* not kept */ } };
  const setUnit = () => {
    const { slider, name } = FIELDS.theta;
    name.textContent = `tilt theta (${angleUnit()})`;
    slider.setAttribute("aria-label", `tilt theta (${angleUnit()})`);
  };

  // A saved run: charts follow the slider of viser's player

  const play = () => {
    document.body.classList.add("saved");
    const { rows, facts: all } = saved;
    const locate = (list, column, time) => {
      let [low, high] = [0, list.length];
      while (high - low > 1) { const k = (low + high) >> 1; if (list[k][column] <= time) low = k; else high = k; }
      return low;
    };
    let before = null;
    const follow = () => {
      const slider = frame.contentDocument && frame.contentDocument.querySelector("[role=slider]");
      const played = slider ? Number(slider.getAttribute("aria-valuenow")) : 0;
      if (played !== before) {
        const last = locate(rows, 5, played);
        const [, chosen, first, constants] = all[locate(all, 0, played)];
        const isNew = facts !== chosen;
        if (isNew) { facts = chosen; showFacts(); }
        const begin = locate(rows, 0, rows[last][0] - facts.window);
        drawCharts(rows.slice(Math.min(Math.max(first, begin), last), last + 1), isNew ? constants : undefined);
        before = played;
      }
      requestAnimationFrame(follow);
    };
    follow();
  };

  addLegend();
  dark.addEventListener("change", setTheme);
  if (saved) play();
  else { live(); setUnit(); }
  setTheme();
})();

// Texts of the page that are cut off or covered: their boxes, against those of what clips and covers them.

const NEAR = 1.5; // px that a box may reach beyond another: letters have room around them
const INSIDE = 0.3; // of a line, from its edges: there its letters are
const [APART, HIGH] = [3, 0.35]; // px, and of a line, by which texts of a chart overlap
const ROWS = "#doing, #strip, #controls, #rest, #charts"; // what is scrolled sideways, or would be
// Lists of which the whole text stands below: the title of a step, the names of what a chart or a question has.
const SAID = ["steps", "free-x", "free-y", "questions"];
const ROOM = 26; // px of the arrow and the edges of a list

/** Whether an element and all around it are shown. */
const isShown = (element) =>
  element.checkVisibility({ checkVisibilityCSS: true, opacityProperty: true });

/** Lines of text that are shown, with their element. */
const listLines = () => {
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const lines = [];
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement;
    if (!node.data.trim() || element.closest("script, style, select, textarea, option")) continue;
    if (!isShown(element) || isHiddenOnPurpose(element)) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    lines.push({ node, element, range, text: node.data.trim() });
  }
  return lines;
};

/** What only a screen reader reads. */
const isHiddenOnPurpose = (element) => {
  for (let each = element; each; each = each.parentElement)
    if (getComputedStyle(each).clipPath.startsWith("inset(50%")) return true;
  return false;
};

const listBoxes = (range) =>
  [...range.getClientRects()].filter((box) => box.width > 1 && box.height > 1);

/** How an element treats what reaches beyond it, along an axis. */
const findFlow = (element, axis) =>
  getComputedStyle(element)[axis === "x" ? "overflowX" : "overflowY"];

/** What cuts a box off, if anything does; what is scrolled does not. */
const findCut = (element, box) => {
  for (const [axis, low, high] of [
    ["x", "left", "right"],
    ["y", "top", "bottom"],
  ]) {
    let isScrolled = false;
    for (let each = element; each && each !== document.documentElement; each = each.parentElement) {
      const flow = each === document.body ? "visible" : findFlow(each, axis);
      if (flow === "auto" || flow === "scroll") isScrolled = axis === "y" || each.matches(ROWS);
      if (isScrolled) break;
      if (flow === "visible") continue;
      const around = each.getBoundingClientRect();
      if (box[low] < around[low] - NEAR || box[high] > around[high] + NEAR) return each;
    }
    const far = axis === "x" ? innerWidth : innerHeight;
    const isPage = findFlow(document.body, axis) !== "hidden";
    if (!isScrolled && !isPage && (box[low] < -NEAR || box[high] > far + NEAR))
      return document.body;
  }
  return null;
};

/** Whether a place is outside the window, or outside what is scrolled. */
const isScrolledOut = (element, x, y) => {
  if (x < 0 || y < 0 || x >= innerWidth || y >= innerHeight) return true;
  for (let each = element; each; each = each.parentElement) {
    if (!/auto|scroll/.test(getComputedStyle(each).overflow)) continue;
    const { left, right, top, bottom } = each.getBoundingClientRect();
    if (x < left + 1 || x > right - 1 || y < top + 1 || y > bottom - 1) return true;
  }
  return false;
};

const isPart = (one, other) => one.contains(other) || other.contains(one);

/** What covers a box at one of some places along its middle, if anything does. */
const findCover = (element, box) => {
  for (const part of [0.1, 0.5, 0.9]) {
    for (const up of [INSIDE, 0.5, 1 - INSIDE]) {
      const [x, y] = [box.left + part * box.width, box.top + up * box.height];
      if (isScrolledOut(element, x, y)) continue;
      const found = document.elementFromPoint(x, y);
      if (found && !isPart(found, element) && !isFormula(found)) return found;
    }
  }
  return null;
};

/** The boxes of formulas are higher than their signs: they reach into the lines above and below. */
const isFormula = (element) => element.closest("math, .formula") !== null;

const name = (element) => {
  const owner = element.closest("[id]");
  return `${element.tagName.toLowerCase()}${element.id ? `#${element.id}` : ""} in ${owner?.id ?? "?"}`;
};

/** Texts of a drawing that lie on each other. */
const listCollisions = () =>
  [...document.querySelectorAll("svg")].filter(isShown).flatMap((svg) => {
    const texts = [...svg.querySelectorAll("text")].filter(
      (each) => isShown(each) && each.textContent.trim(),
    );
    const boxes = texts.map((each) => each.getBoundingClientRect());
    return texts.flatMap((text, k) =>
      texts.slice(0, k).flatMap((other, n) => {
        const [a, b] = [boxes[k], boxes[n]];
        const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const high = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        if (across < APART || high < HIGH * Math.min(a.height, b.height)) return [];
        return [`on each other: ${other.textContent} | ${text.textContent} (${name(svg)})`];
      }),
    );
  });

/** Lists and fields whose text is wider than they are. */
const listNarrow = () => {
  const context = document.createElement("canvas").getContext("2d");
  return [...document.querySelectorAll("select, input[type=text]")].flatMap((each) => {
    if (!isShown(each) || each.readOnly || SAID.includes(each.id)) return [];
    const text =
      each.tagName === "SELECT" ? (each.selectedOptions[0]?.textContent ?? "") : each.value;
    const style = getComputedStyle(each);
    context.font = `${style.fontWeight} ${style.fontSize} ${style.fontFamily}`;
    const edges =
      each.tagName === "SELECT"
        ? ROOM
        : parseFloat(style.paddingLeft) + parseFloat(style.paddingRight);
    if (context.measureText(text).width <= each.clientWidth - edges + NEAR) return [];
    return [`cut in ${name(each)}: ${text}`];
  });
};

/** All faults of the page as it is; each text is brought into sight first. */
const list = () => {
  const all = new CSSStyleSheet();
  all.replaceSync("* { pointer-events: auto !important; }");
  document.adoptedStyleSheets = [all];
  const faults = new Set([...listCollisions(), ...listNarrow()]);
  for (const { element, range, text } of listLines()) {
    if (element.closest("#controls, #charts, #strip, #rest, #doing"))
      element.scrollIntoView({ block: "nearest", inline: "nearest" });
    for (const box of listBoxes(range)) {
      const cut = findCut(element, box);
      if (cut) faults.add(`cut by ${name(cut)}: ${text}`);
      const cover = cut ? null : findCover(element, box);
      if (cover) faults.add(`covered by ${name(cover)}: ${text}`);
    }
  }
  document.adoptedStyleSheets = [];
  return faults;
};

const wait = async (frames) => {
  for (let k = 0; k < frames; k += 1) await new Promise(requestAnimationFrame);
};

const openAll = (selector) => {
  for (const each of document.querySelectorAll(selector)) each.open = true;
};

/** Go on with the motion by parts of a nutation, at rest. */
const step = async (times) => {
  for (let k = 0; k < times; k += 1) document.querySelector("[data-act=step]").click();
  await wait(4); // charts are drawn when they are due
  await new Promise((done) => setTimeout(done, 80));
  await wait(2);
};

window.cuts = {
  /** Look at the answer to a kick, its reason, all charts, panels and steps: each fault with where it was first. */
  async walk() {
    const found = {};
    const look = async (where) => {
      await wait(3);
      for (const fault of list()) found[fault] ??= where;
    };
    const get = (id) => document.getElementById(id);
    get("hurry").click();
    await step(14);
    await look("kick");
    openAll("#reason");
    await look("why");
    openAll("#numbers");
    await look("numbers");
    get("reason").open = false;
    openAll("#charts > details");
    await step(0);
    await look("charts");
    for (const tab of document.querySelectorAll("[role=tab]")) {
      if (tab.ariaSelected !== "true") tab.click();
      openAll("#controls details");
      await look(tab.id);
    }
    const steps = get("steps");
    for (let k = 0; k < steps.options.length; k += 1) {
      steps.selectedIndex = k;
      steps.dispatchEvent(new Event("change"));
      for (const button of document.querySelectorAll("#lesson-acts button")) {
        if (!button.disabled) button.click();
        await step(8);
      }
      openAll("#controls details, #charts > .looked");
      await look(`step ${k + 1}`);
    }
    document.body.dataset.film = "beside";
    get("film").hidden = false;
    await look("film");
    return found;
  },
};

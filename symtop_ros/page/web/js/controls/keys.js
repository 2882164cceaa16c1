// Keys of the page: they act where nothing is typed, and where the browser does not use them. With
// Shift the arrows turn the view instead of the top. Buttons that act while they are held.

/** @type {{[key: string]: string}} */
const ACTS = {
  h: "hurry",
  d: "delay",
  c: "clamp",
  " ": "pause",
  s: "step",
  r: "reset",
  p: "projector",
};
/** @type {{[key: string]: string}} */
const PUSHES = { ArrowUp: "up", ArrowDown: "down", ArrowRight: "along", ArrowLeft: "back" };
const TURN = 20; // px of a drag
/** @type {{[key: string]: [right: number, down: number]}} */
const TURNS = {
  ArrowUp: [0, -TURN],
  ArrowDown: [0, TURN],
  ArrowRight: [TURN, 0],
  ArrowLeft: [-TURN, 0],
};
/** @type {{[key: string]: number}} */
const DISTANCES = { "+": 1 / 1.1, "-": 1.1 };
const ENDS = ["pointerup", "pointercancel", "lostpointercapture", "blur", "keyup"];

/**
 * The element that has the focus, or null if it or the browser uses all keys itself.
 * @param {KeyboardEvent} event
 */
const findTarget = (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return null;
  const target = event.target instanceof Element ? event.target : document.body;
  return target.closest("input[type=text], select, textarea, #film-picture") ? null : target;
};

/**
 * The act or the push of a key; null if the element that has the focus uses the key itself.
 * @param {KeyboardEvent} event
 */
const read = (event) => {
  const target = findTarget(event);
  if (!target) return null;
  const way = PUSHES[event.key];
  if (way && event.shiftKey) return null;
  if (way) return target.closest("input, [role=tab]") ? null : { way };
  if (event.key === " " && target.closest("button, a, input, summary")) return null;
  const name = ACTS[event.key.toLowerCase()]; // Caps Lock changes nothing
  return name ? { name } : null;
};

/** @param {(name: string) => void} act @param {(way: string) => void} push */
export const listenToKeys = (act, push) => {
  document.addEventListener(
    "keydown",
    (event) => {
      const found = read(event);
      if (!found) return;
      event.preventDefault();
      if (found.way) push(found.way);
      else if (found.name && !event.repeat) act(found.name);
    },
    true,
  );
  // A button that the mouse has pressed gives the space key back to the page.
  document.addEventListener("click", (event) => {
    const button = event.target instanceof Element ? event.target.closest("button") : null;
    if (event.detail && button) button.blur();
  });
};

/** The view is turned, and moved nearer and away. @param {import("../scene/camera.js").Camera} camera */
export const turnByKeys = (camera) => {
  document.addEventListener("keydown", (event) => {
    if (!findTarget(event)) return;
    const turn = event.shiftKey ? TURNS[event.key] : undefined;
    const factor = DISTANCES[event.key];
    if (turn) camera.turn(...turn);
    else if (factor) camera.approach(factor);
    else return;
    event.preventDefault();
  });
};

/**
 * One hold of a button is one act: it begins when the button is pressed, and ends with the end of that, not
 * with a silence, which a slow page has too.
 * @param {HTMLButtonElement} button @param {() => void} begin @param {() => void} end
 */
export const actWhileHeld = (button, begin, end) => {
  let isHeld = false;
  const stop = () => {
    if (isHeld) end();
    isHeld = false;
  };
  const start = () => {
    stop();
    isHeld = true;
    begin();
  };
  button.addEventListener("pointerdown", ({ isTrusted, button: which, pointerId }) => {
    if (which || isHeld) return; // another button of the mouse, or a second finger
    // It is let go wherever that happens, outside the window too; an event that a script has made is of
    // no pointer which could be captured.
    if (isTrusted) button.setPointerCapture(pointerId);
    start();
  });
  button.addEventListener("keydown", (event) => {
    if ((event.key === "Enter" || event.key === " ") && !event.repeat) start();
  });
  for (const name of ENDS) button.addEventListener(name, stop);
  for (const name of ["blur", "pagehide"]) addEventListener(name, stop);
  document.addEventListener("visibilitychange", () => {
    if (document.hidden) stop();
  });
  // A disabled button hears of no end.
  new MutationObserver(() => {
    if (button.disabled) stop();
  }).observe(button, { attributeFilter: ["disabled"] });
};

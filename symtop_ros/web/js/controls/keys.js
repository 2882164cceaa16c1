// Keys of the page: they act where nothing is typed, and where the browser does not use them.

/** @type {{[key: string]: string}} */
const ACTS = { h: "hurry", d: "delay", " ": "pause", s: "step", r: "reset" };
/** @type {{[key: string]: string}} */
const PUSHES = { ArrowUp: "up", ArrowDown: "down", ArrowRight: "along", ArrowLeft: "back" };

/**
 * The act or the push of a key; null if the element that has the focus uses the key itself.
 * @param {KeyboardEvent} event
 */
const read = (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return null;
  const target = event.target instanceof Element ? event.target : document.body;
  if (target.closest("input[type=text], select, textarea")) return null;
  const way = PUSHES[event.key];
  if (way) return target.closest("input, [role=tab]") ? null : { way };
  if (event.key === " " && target.closest("button, a, input, summary")) return null;
  const name = ACTS[event.key.toLowerCase()]; // Caps Lock changes nothing
  return name ? { name } : null;
};

/**
 * @param {(name: string) => void} act
 * @param {(way: string) => void} push
 */
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

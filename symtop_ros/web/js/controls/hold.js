// Buttons that act while they are held.

const PERIOD = 50; // ms between two messages
const ENDS = ["pointerup", "pointerleave", "pointercancel", "blur", "keyup"];

/** @param {HTMLElement} button @param {() => void} act */
export const actWhileHeld = (button, act) => {
  let timer = 0;
  const end = () => clearInterval(timer);
  const begin = () => {
    end();
    act();
    timer = window.setInterval(act, PERIOD);
  };
  button.addEventListener("pointerdown", begin);
  for (const name of ENDS) button.addEventListener(name, end);
  button.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && !event.repeat) begin();
  });
};

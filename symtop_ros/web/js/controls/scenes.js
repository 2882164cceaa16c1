// The list of scenes, and the story of the one that is chosen.

import { find, make, say } from "./document.js";
import { phrase } from "../words/wording.js";

/**
 * A scene is started when it is picked with the pointer, or by its button or Enter: keys that move
 * through the list start nothing.
 * @param {{name: string}[]} scenes @param {(name: string) => void} start
 */
export const offerScenes = (scenes, start) => {
  const list = find("scenes", HTMLSelectElement);
  const button = find("start-scene", HTMLButtonElement);
  let isPicked = false; // with the pointer
  list.append(
    make("option", { value: "", textContent: phrase("scene.choose") }),
    ...scenes.map(({ name }) =>
      make("option", { value: name, textContent: phrase(`scene.${name}.title`) }),
    ),
  );
  const startChosen = () => {
    button.hidden = true;
    if (list.value) start(list.value);
  };
  list.addEventListener("pointerdown", () => {
    isPicked = true;
  });
  list.addEventListener("keydown", (event) => {
    isPicked = false;
    if (event.key !== "Enter") return;
    event.preventDefault(); // it would open the list
    startChosen();
  });
  list.addEventListener("change", () => {
    say("story", list.value && phrase(`scene.${list.value}.story`));
    button.hidden = !list.value;
    if (isPicked) startChosen();
  });
  button.addEventListener("click", startChosen);
};

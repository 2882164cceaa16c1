// The list of scenes, and the story of the one that is chosen.

import { find, make, say } from "./document.js";
import { phrase } from "../words/wording.js";

/**
 * A scene is started when it is picked with the pointer, or by its button or Enter: keys that move
 * through the list start nothing. Returns what tells the story of one that was started elsewhere.
 * @param {{name: string}[]} scenes @param {(name: string) => void} start
 * @returns {(name: string) => void}
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
  const tellStory = () => say("story", list.value && phrase(`scene.${list.value}.story`));
  list.addEventListener("change", () => {
    tellStory();
    button.hidden = !list.value;
    if (isPicked) startChosen();
  });
  button.addEventListener("click", startChosen);
  return (name) => {
    list.value = name; // nothing is chosen by a name that is no scene's
    button.hidden = true;
    tellStory();
  };
};

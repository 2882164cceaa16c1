// The list of scenes, and the story of the one that was chosen.

import { find, make, say } from "./document.js";

/**
 * @param {{name: string, title: string, story: string}[]} scenes
 * @param {(name: string) => void} choose
 */
export const offerScenes = (scenes, choose) => {
  const list = find("scenes", HTMLSelectElement);
  list.append(
    make("option", { value: "", textContent: "choose ..." }),
    ...scenes.map(({ name, title }) => make("option", { value: name, textContent: title })),
  );
  list.addEventListener("change", () => {
    const chosen = scenes.find(({ name }) => name === list.value);
    say("story", chosen?.story ?? "");
    if (chosen) choose(chosen.name);
  });
};

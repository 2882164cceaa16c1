// The end of the page's address: #scene=looping, #theta=0.5&psi_dot=200 or #lesson=3.

/**
 * Follow it now, and whenever it changes.
 * @param {string} opening what a file opens whose address has no such end
 * @param {boolean} isReloaded the run that the address has started is there already
 * @param {(step: number) => void} openLesson
 * @param {(link: {[name: string]: string}) => void} start
 */
export const followAddress = (opening, isReloaded, openLesson, start) => {
  const follow = (isNew = true) => {
    const text = location.hash.slice(1) || opening;
    // A plus is that of 1e+20, and no space, as it would be in a form.
    const pairs = new URLSearchParams(text.replaceAll("+", "%2B"));
    pairs.delete("lang");
    const { lesson, ...link } = Object.fromEntries(pairs);
    if (lesson !== undefined) openLesson(Number(lesson));
    if (isNew && Object.keys(link).length) start(link);
  };
  addEventListener("hashchange", () => follow());
  follow(!isReloaded);
};

// The end of the page's address: #scene=looping, #theta=0.5&psi_dot=200 or #lesson=3.

/**
 * Follow it now, and whenever it changes.
 * @param {(step: number) => void} openLesson
 * @param {(link: {[name: string]: string}) => void} start
 */
export const followAddress = (openLesson, start) => {
  const follow = () => {
    const { lesson, ...link } = Object.fromEntries(new URLSearchParams(location.hash.slice(1)));
    if (lesson !== undefined) openLesson(Number(lesson));
    if (Object.keys(link).length) start(link);
  };
  addEventListener("hashchange", follow);
  follow();
};

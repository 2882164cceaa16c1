// Changes of a browser before the page begins: a test has those that it asks for.

window.patches = {
  /** Let a frame have a stamp that is older than the clock when its script runs. */
  ageStamps() {
    window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now() - 300), 50);
  },

  /** Let `asleep(ms)` hide the page for so long by its clocks: meanwhile it gets no frame. */
  letSleep() {
    const requestFrame = window.requestAnimationFrame.bind(window);
    const clocks = [
      [performance, performance.now.bind(performance)],
      [Date, Date.now.bind(Date)],
    ];
    let [passed, isHidden] = [0, false];
    let waiting = [];
    const draw = (each) => requestFrame((now) => each(now + passed));
    window.requestAnimationFrame = (each) => (isHidden ? waiting.push(each) : draw(each));
    for (const [owner, read] of clocks) owner.now = () => read() + passed;
    Object.defineProperty(document, "hidden", { get: () => isHidden });
    const tell = () => document.dispatchEvent(new Event("visibilitychange"));
    window.asleep = (milliseconds) => {
      isHidden = true;
      tell();
      passed += milliseconds;
      isHidden = false;
      for (const each of waiting) draw(each);
      waiting = [];
      tell();
    };
  },

  /** Count the frames, of which there are fewer than the browser would draw. */
  countFrames() {
    const requestFrame = window.requestAnimationFrame.bind(window);
    window.framesDone = 0;
    const step = (draw) => (now) => {
      window.framesDone += 1;
      draw(now);
    };
    window.requestAnimationFrame = (draw) => setTimeout(() => requestFrame(step(draw)), 40);
  },

  /** Keep the heights of two circles of 96 pieces, of six corners with eight numbers each. */
  keepCircles() {
    const load = WebGL2RenderingContext.prototype.bufferData;
    window.circles = [];
    const pieces = [...Array(96).keys()];
    WebGL2RenderingContext.prototype.bufferData = function (target, numbers, ...rest) {
      if (numbers.length === 2 * 96 * 6 * 8) {
        const circles = [0, 1].map((n) => pieces.map((k) => numbers[(n * 96 + k) * 48 + 2]));
        const areLevel = circles.every((all) => all.every((each) => each === all[0]));
        if (areLevel) window.circles = circles.map((all) => all[0]); // and no trace
      }
      load.call(this, target, numbers, ...rest);
    };
  },

  /** Count the calls of the kernel, and the steps of its integrations in hundreds. */
  countWork() {
    const HUNDRED = 100;
    const MORE_STEPS = 11;
    const instantiate = WebAssembly.instantiate;
    window.work = { calls: 0, hundreds: 0 };
    const count =
      (call) =>
      (...given) => {
        window.work.calls += 1;
        return call(...given);
      };
    const reachBySteps = (reach) => (handle, t, steps, place) => {
      for (let left = steps; ; left -= HUNDRED) {
        const status = reach(handle, t, Math.min(left, HUNDRED), place);
        if (status !== MORE_STEPS || left <= HUNDRED) return status;
        window.work.hundreds += 1;
      }
    };
    WebAssembly.instantiate = async (...given) => {
      const { instance } = await instantiate.apply(WebAssembly, given);
      const { symtop_reach, ...others } = instance.exports;
      const exports = { ...others, symtop_reach: reachBySteps(symtop_reach) };
      for (const [name, each] of Object.entries(exports))
        if (name.startsWith("symtop_")) exports[name] = count(each);
      return { instance: { exports } };
    };
  },
};

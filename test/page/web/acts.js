// What the tests do on the page, many things at once: each page of a test has these functions.

window.acts = {
  /** Wait until the page has drawn so often. */
  async waitForFrames(count) {
    for (let k = 0; k < count; k += 1) await new Promise(requestAnimationFrame);
  },

  /** Wait until the run is longer than some seconds; false if it is not for a while. */
  async waitForTime([seconds, patience]) {
    const end = performance.now() + 1000 * patience;
    while (!(Number(document.getElementById("timeline").max) > seconds)) {
      if (performance.now() > end) return false;
      await new Promise((done) => setTimeout(done, 20));
    }
    return true;
  },

  /** Let nothing run for a time in which the clock runs: the ends of the run before and after. */
  async sleep() {
    const before = window.symtop.run().end;
    const end = performance.now() + 900;
    while (performance.now() < end) {}
    await window.acts.waitForFrames(3);
    return [before, window.symtop.run().end];
  },

  /** Drop a file of this text. */
  drop([name, text]) {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([text], name));
    document.dispatchEvent(new DragEvent("drop", { dataTransfer, cancelable: true }));
  },

  /** Press a key while no field has the focus. */
  press(key) {
    document.dispatchEvent(new KeyboardEvent("keydown", { key }));
  },

  /** Open charts, or all of them if none is named. */
  openCharts(names) {
    for (const place of document.querySelectorAll("[data-chart]"))
      if (!names.length || names.includes(place.dataset.chart))
        place.closest("details").open = true;
  },

  /** Give a slider or a list another value, as its user does. */
  change([name, value]) {
    const element = document.getElementById(name);
    element.value = value;
    element.dispatchEvent(new Event("input"));
    element.dispatchEvent(new Event("change"));
  },

  losePicture() {
    const gl = document.querySelector("#picture").getContext("webgl2");
    window.lost = gl.getExtension("WEBGL_lose_context");
    window.lost.loseContext();
  },

  /** Follow an address, and wait until what it starts is shown. */
  open(hash) {
    return new Promise((done) => {
      const wait = () => requestAnimationFrame(() => requestAnimationFrame(done));
      addEventListener("hashchange", wait, { once: true });
      location.hash = hash;
    });
  },

  /** Follow addresses; how many events each of them, and then a key, has added. */
  async follow(addresses) {
    const count = () => window.symtop.run().events.length;
    const answers = [];
    for (const address of addresses) {
      const before = count();
      const isNew = location.hash !== new URL(address, location.href).hash;
      const followed = new Promise((done) => addEventListener("hashchange", done, { once: true }));
      location.hash = address;
      if (isNew) await followed;
      const after = count();
      window.acts.press("r");
      answers.push([after - before, count() - after]);
    }
    return answers;
  },

  /** Drop runs; each refusal, whether the events stayed, and how many a key has added. */
  async refuse(runs) {
    const read = () => window.symtop.run().events;
    const refusal = document.getElementById("refusal");
    const answers = [];
    for (const text of runs) {
      const before = JSON.stringify(read());
      const count = read().length;
      window.acts.drop(["run.json", text]);
      while (refusal.hidden) await new Promise((done) => setTimeout(done, 1));
      const answer = [refusal.dataset.text, JSON.stringify(read()) === before];
      window.acts.press("r");
      answers.push([...answer, read().length - count]);
    }
    return answers;
  },

  /** Try what a page may not do: what it has done nevertheless, and what was forbidden. */
  async attack(own) {
    const done = [];
    const forbidden = new Set();
    addEventListener("securitypolicyviolation", (event) => forbidden.add(event.effectiveDirective));
    const add = (name, values) =>
      document.body.append(Object.assign(document.createElement(name), values));
    add("script", { textContent: "window.pwned = 1" });
    add("div", { innerHTML: "<img src='data:,' onerror='window.pwned = 1'>" });
    add("div", { innerHTML: "<p style='color: red'></p>" });
    add("style", { textContent: "p { color: red }" });
    add("iframe", { src: "data:text/html,x" });
    add("img", { src: "http://elsewhere.test/x.png" });
    add("video", { src: "http://elsewhere.test/x.mp4" });
    setTimeout("window.pwned = 1");
    for (const address of ["http://elsewhere.test/", own]) {
      try {
        await fetch(address);
        done.push(address);
      } catch {}
    }
    for (let k = 0; k < 1200 && forbidden.size < 9; k += 1)
      await new Promise((wait) => setTimeout(wait, 50));
    if (window.pwned) done.push("script");
    return { done, forbidden: [...forbidden].sort() };
  },
};

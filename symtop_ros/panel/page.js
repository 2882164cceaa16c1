// Sent with the page, before viser's own code runs.
(() => {
  // A link such as /?theta=0.5&psi_dot=200 holds the start of an experiment; the fragment serves as
  // well. It is passed on once, and the address is cleared, so that a reload does not start again.
  const OPTIONS = ["darkMode", "fixedDpr", "showStats"];
  const values = new URLSearchParams(location.search + "&" + location.hash.slice(1));
  const start = new URLSearchParams(
    [...values].filter(([name]) => !OPTIONS.includes(name) && !name.startsWith("initialCamera")),
  );
  if ([...start].length) {
    [...start.keys()].forEach((name) => values.delete(name));
    history.replaceState(null, "", values.size ? "/?" + values : "/");
    fetch("/start?" + start, { headers: { "X-Top-Panel": "start" } }).then((answer) =>
      answer.text(),
    );
  }

  // The keys of the page. Viser moves the camera with some of them, by a listener of the document.
  const KEYS = ["KeyH", "KeyD", "Space", "KeyR"];
  const ARROWS = ["ArrowUp", "ArrowDown", "ArrowLeft", "ArrowRight"];
  const isOurs = (event) =>
    [...KEYS, ...ARROWS].includes(event.code) && !(event.ctrlKey || event.metaKey || event.altKey);
  document.documentElement.addEventListener("keydown", (event) => {
    if (isOurs(event)) event.stopPropagation();
  });
  addEventListener("DOMContentLoaded", () => {
    const style = document.createElement("style");
    // The first button after the verdict is the one that the page is about.
    style.textContent = `
      div:has(> .panel-box) + * button { height: 3rem !important; font-size: 1.1rem !important; }
      .panel-box { padding: 2px 10px 0; font-size: 12.5px; line-height: 1.4; height: 146px;
        overflow-y: auto; }
      .panel-message { color: #d53640; padding-top: 4px; }
      .panel-table { width: 100%; font-size: 12px; line-height: 1.55; padding: 2px 10px; }
      .panel-table td { padding: 0 6px 0 0; }
      .panel-dim { opacity: 0.65; }`;
    document.head.append(style);
    // A slider or a list that has the focus keeps its arrows; the page's own keys are handled later.
    document.body.addEventListener("keydown", (event) => {
      const keeps = event.target.closest("[role=slider], [role=tab], [role=option]");
      if (keeps && ARROWS.includes(event.code)) event.stopPropagation();
    });
    // The space key pauses; it does not press the button that was clicked last.
    document.body.addEventListener("keyup", (event) => {
      if (event.code === "Space" && event.target.closest("button")) event.preventDefault();
    });
    document.body.addEventListener("pointerup", () => {
      const focused = document.activeElement;
      if (focused && focused.closest("button, [role=slider]")) focused.blur();
    });
  });
})();

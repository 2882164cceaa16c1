// The lesson: a step at a time, with a prediction, buttons that make its motions, and its charts.
"use strict";
const makeLesson = ({ find, make, send, chooseLayers }, steps) => {
  const select = find("steps");
  let shown = null; // number of the step
  const field = find("prediction");
  const current = () => select.selectedIndex + 1;
  // What was written is kept by the browser for this tab, and survives a reload. A step is an entry of
  // its history: Back is the step before. A frame of another site may not have one.
  const predictions = { ...history.state };
  const keep = (number, text, isNew = false) => {
    predictions[number] = text;
    const change = isNew ? "pushState" : "replaceState";
    try { history[change](predictions, "", `#lesson=${number}`); } catch { /* not kept */ }
  };
  const written = (number) => predictions[number] ?? "";

  const addActs = ({ acts, scene }) => {
    const hurries = [];
    const begin = (start) => {
      send({ act: "link", link: { scene, ...start } });
      send({ act: "run" });
      for (const button of hurries) button.disabled = false;
    };
    const buttons = acts.map(({ button: textContent, start, hurry, hold }) => {
      const button = make("button", { textContent, disabled: !start });
      if (!start) hurries.push(button);
      // A second hurry would not be that of the step: the motion has to be started again before it.
      button.onclick = () => {
        if (start) begin(start);
        else {
          send({ act: "kick", factor: hurry, hold });
          for (const each of hurries) each.disabled = true;
        }
      };
      return button;
    });
    find("lesson-acts").replaceChildren(...buttons);
  };
  const show = (number, isBack = false) => {
    const isNew = shown !== null && shown !== number && !isBack;
    shown = number;
    const step = steps[number - 1];
    select.selectedIndex = number - 1;
    for (const name of ["predict", "compute", "look", "seen", "question", "answer"]) {
      find("lesson-" + name).textContent = step[name] ?? "";
    }
    for (const details of document.querySelectorAll("#lesson details")) details.open = false;
    for (const chart of document.querySelectorAll("[data-chart]")) {
      chart.classList.toggle("looked", step.charts.includes(chart.dataset.chart));
    }
    find("charts").scrollTop = 0;
    chooseLayers(step.layers);
    field.value = written(number);
    find("step-back").disabled = number === 1;
    find("step-next").disabled = number === steps.length;
    addActs(step);
    keep(number, field.value, isNew);
    send({ act: "rest" }); // nothing moves before the prediction
  };
  const go = (by) => (event) => {
    show(current() + by);
    if (event.detail) select.scrollIntoView();
    else select.focus();
  };
  select.append(...steps.map(({ title }, k) => make("option", { textContent: `${k + 1}. ${title}` })));
  select.addEventListener("change", () => show(current()));
  addEventListener("popstate", () => {
    const [, number] = location.hash.match(/^#lesson=(\d+)$/) ?? [];
    if (number && Number(number) !== shown) show(Number(number), true);
  });
  field.addEventListener("input", () => keep(current(), field.value));
  find("step-back").onclick = go(-1);
  find("step-next").onclick = go(1);
  return {
    show: (number) => show(Math.min(Math.max(Math.round(number) || 1, 1), steps.length)),
    open: () => { if (!location.hash.startsWith("#lesson=")) show(current()); },
  };
};

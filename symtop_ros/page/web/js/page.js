// The page around the scene: what it asks of the top, and what it shows of the answers.

import { Charts } from "./charts/charts.js";
import { choose, followLooks, keepChoice, read } from "./controls/choices.js";
import { find, findAll, make, say, write, writeTexts } from "./controls/document.js";
import { Fields } from "./controls/fields.js";
import { showFittedUnit } from "./controls/fitted.js";
import { offerFiles, openDropped, save } from "./run/files.js";
import { actWhileHeld, listenToKeys } from "./controls/keys.js";
import { Layers } from "./controls/layers.js";
import { Lesson, writePredictions } from "./controls/lesson.js";
import { splitLink } from "./run/links.js";
import { FULL, recall } from "./run/memory.js";
import { Measure } from "./controls/measure.js";
import { Moments } from "./controls/moments.js";
import { offerCopy, offerFullScreen, showLink } from "./controls/window.js";
import { dismissRefusals, guard, refuse, showLoss } from "./controls/notices.js";
import { drawKinds } from "./charts/kinds_chart.js";
import { drawLedger } from "./charts/ledger_chart.js";
import { NANO } from "./physics/course.js";
import { inDegrees } from "./words/quantities.js";
import { Opening } from "./controls/opening.js";
import { Question, readAnswer } from "./controls/question.js";
import { Parts } from "./controls/parts.js";
import { Roots } from "./controls/roots.js";
import { offerScenes } from "./controls/scenes.js";
import { drawScene } from "./scene/picture.js";
import { Seen } from "./controls/seen.js";
import { SpeedList } from "./controls/speed.js";
import { offerTabs } from "./controls/tabs.js";
import { Timeline } from "./controls/timeline.js";
import { writePoints } from "./words/points.js";
import { typesetSymbols } from "./words/typeset.js";
import { phrase } from "./words/wording.js";

/** @import { Facts, MotionFacts, Now } from "./words/facts.js" */
/** @import { Hold } from "./physics/kernel.js" */
/** @import { Fitting } from "./fit/client.js" */
/** @import { Held, Message } from "./run/acts.js" */
/** @import { LocalTop } from "./run/local.js" */
/** @import { Frame, Hello, News } from "./run/telling.js" */

/**
 * Kicks of buttons and keys. A push on the axle has no torque about it: it holds p_psi. What holds psi', as
 * the article compares, has a name of its own.
 * @type {{[act: string]: (factor: number) => {factor: number, hold: Hold}}}
 */
const KICKS = {
  hurry: (factor) => ({ factor, hold: "spin_momentum" }),
  delay: (factor) => ({ factor: 1 / factor, hold: "spin_momentum" }),
  hurry_held: (factor) => ({ factor, hold: "spin_rate" }),
  delay_held: (factor) => ({ factor: 1 / factor, hold: "spin_rate" }),
};

const showLedger = guard("ledger", drawLedger);
const showKinds = guard("kinds", drawKinds);

export class Page {
  /** @param {import("./start.js").Content} content of the file */
  constructor(content) {
    this.content = content;
    /** @type {LocalTop | null} */
    this.top = null; // while the kernel is loaded
    /** What holds after the last act, and for the motion. @type {Facts | null} */
    this.facts = null;
    const send = this.send.bind(this);
    writeTexts();
    dismissRefusals();
    offerTabs();
    offerFullScreen();
    offerCopy();
    this.fields = new Fields(send);
    this.roots = new Roots(send);
    this.seen = new Seen(send);
    /** @type {Parts | null} */
    this.parts = null; // until the top has sent the bodies of the classroom
    this.speeds = new SpeedList((factor) => send({ act: "speed", factor }));
    this.timeline = new Timeline((time) => send({ act: "seek", time }));
    this.layers = new Layers(send);
    this.moments = new Moments(send);
    this.measure = new Measure(send, this.load.bind(this));
    /** @type {Lesson | null} */
    this.lesson = null; // until the top has sent its steps
    /** @type {((name: string) => void) | null} */
    this.tellStory = null; // until it has sent its scenes
    this.charts = new Charts((kept) => send({ act: "keep", kept }));
    this.question = new Question(
      () => {
        this.act("hurry");
        this.send({ act: "run" });
      },
      (name) => this.send({ act: "scene", name }),
      new Opening(
        (layers, shown) => this.layers.force(layers, shown),
        (most) => this.send({ act: "limit", most }),
      ),
    );
    addEventListener("beforeprint", () => {
      if (!find("picture").hidden) find("printed").replaceChildren(drawScene());
    });
    addEventListener(FULL, () => refuse(phrase("page.full")), { once: true });
    followLooks();
    keepChoice("unit", () => this.showUnit());
    this.listen();
  }

  listen() {
    const act = (/** @type {string} */ name) => this.act(name);
    const push = (/** @type {string} */ way) => this.send({ act: "push", way });
    for (const button of findAll("[data-act]"))
      button.addEventListener("click", () => act(button.dataset.act ?? ""));
    for (const button of findAll("[data-push]"))
      button.addEventListener("click", () => push(button.dataset.push ?? ""));
    for (const button of /** @type {HTMLButtonElement[]} */ (findAll("[data-hold]"))) {
      const hold = /** @type {Held} */ (button.dataset.hold);
      const message = /** @type {Message} */ ({ act: hold, sign: Number(button.dataset.sign) });
      const begin = () => this.send(message);
      // what was refused at the beginning stays to be read
      actWhileHeld(button, begin, () => this.top?.take({ act: "let_go", hold }));
    }
    listenToKeys(act, push);
    find("reason").addEventListener("toggle", () => this.showNamed());
  }

  /**
   * Show a top from now on.
   * @param {LocalTop} top @param {Element} source the page as it was opened @param {Fitting} fitting
   */
  connect(top, source, fitting) {
    this.top = top;
    // A node has the time of its machine, and records there.
    find("time").hidden = Boolean(this.content.node);
    find("record").hidden = !this.content.node;
    this.charts.marks = top.marks;
    for (const name of /** @type {const} */ (["pointermove", "pointerdown"])) // also a finger's
      document.addEventListener(name, (event) => top.marks.follow(event), { capture: true });
    offerFiles(top, source);
    this.measure.connect(fitting);
    const { node } = this.content;
    find("tab-measure").hidden = Boolean(node); // it has its own motion
    openDropped(this.load.bind(this), node ? null : (file) => this.measure.open(file));
  }

  /** Open a run. @param {any} run of run.json */
  load(run) {
    this.question.leave(); // a run of one start is no new act that would end it
    this.send({ act: "load", run });
  }

  /** @param {Message} message */
  send(message) {
    refuse("");
    this.top?.take(message);
  }

  /** @param {string} name */
  act(name) {
    const { factor } = this.fields.values;
    if (name === "projector") choose("size", find("size", HTMLSelectElement).value ? "" : name);
    else if (name in KICKS) this.send({ act: "kick", ...KICKS[name](factor) });
    else this.send(/** @type {Message} */ ({ act: name })); // an act of a button needs no more
  }

  /** Show what the top tells. @param {News} news */
  receive(news) {
    if ("hello" in news) this.greet(news.hello);
    else if ("facts" in news) this.showFacts(news.facts);
    else if ("motion" in news) this.followMotion(news.motion);
    else if ("now" in news) this.showNow(news.now);
    else if ("samples" in news) this.showFrame(news);
    else if ("solved" in news) this.seen.show(news.solved);
    else if ("refused" in news) refuse(this.fields.markRefused(news.refused), news.isOfData);
    else if ("granted" in news) this.fields.grant();
    else if ("said" in news) refuse(news.said);
    else showLoss(news.lost);
  }

  /** @param {Hello} hello */
  greet({ scenes, layers, lesson: steps, bodies }) {
    this.parts = new Parts(this.send.bind(this), bodies);
    if (this.facts) this.showParts(this.facts);
    this.tellStory = offerScenes(scenes, (name) => this.send({ act: "scene", name }));
    this.layers.offer(layers);
    this.lesson = new Lesson(steps, this.send.bind(this), (step) => this.prepare(step.layers));
    find("save-predictions").addEventListener("click", () => {
      save("predictions.txt", "text/plain", writePredictions(steps, readAnswer()));
    });
    const isCalm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const { node, run, opening } = this.content;
    const isReloaded = !node && Boolean(recall().run);
    if (!node && (isCalm || (run && !isReloaded))) this.top?.take({ act: "rest" });
    const isPlain = /^(#(lang=[^&]*)?)?$/.test(location.hash); // a language starts nothing
    if (isReloaded && this.facts) this.question.resume(this.facts);
    else if (!node && !run && isPlain && !opening) this.question.ask();
    addEventListener("hashchange", () => {
      refuse("");
      this.followAddress(true);
    });
    this.followAddress(!isReloaded);
  }

  /**
   * Follow the end of the address: #scene=looping, #theta=0.5&psi_dot=200 or #lesson=3.
   * @param {boolean} isNew the run that it starts is not there already
   */
  followAddress(isNew) {
    const text = location.hash.slice(1) || (this.content.opening ?? "");
    const { lesson: step, lang, ...link } = splitLink(text);
    if (step !== undefined) this.lesson?.open(Number(step));
    if (isNew && Object.keys(link).length) this.followLink(link);
  }

  /**
   * A step of the lesson has its own question and arrows, and angles in rad unless others were chosen.
   * @param {string[]} layers
   */
  prepare(layers) {
    this.question.leave();
    this.layers.choose(layers);
    if (read("unit") !== null) return;
    find("unit", HTMLSelectElement).value = "rad";
    this.showUnit();
  }

  /**
   * Start what the address asks for. Any page may have led here: others watch a node, so that its
   * user is asked.
   * @param {{[name: string]: string}} link
   */
  followLink(link) {
    const fields = Object.entries(link).map((pair) => pair.join(" = "));
    const question = phrase("page.link_asks", {
      node: this.content.node,
      start: fields.join(", "),
    });
    if (this.content.node && !confirm(question)) return;
    this.top?.take({ act: "link", link }); // a refusal of the run that was to be opened stays
    if (link.scene !== undefined) this.tellStory?.(link.scene);
  }

  /** @param {Facts} facts */
  showFacts(facts) {
    this.showMotion(facts, true);
    say("pause", phrase(facts.running ? "page.pause" : "page.run"));
    say("record", phrase(facts.recording ? "page.end_record" : "page.record"));
    Object.assign(this.timeline, { acts: facts.acts, since: facts.since });
    this.speeds.show(facts.factor);
    showLink(`${location.href.split("#")[0]}#${facts.link}`);
    this.showHistory(facts.histories[inDegrees() ? "degrees" : "radians"]);
    this.fields.show(facts);
    this.showParts(facts);
    this.lesson?.follow(facts);
    say("impulses-title", facts.impulses);
    for (const [name, text] of Object.entries(facts.outlooks)) say(`outlook-${name}`, text);
    showLedger(facts.ledger, facts.energies);
    find("hand-chart").hidden = !facts.hasHand;
  }

  /** @param {Facts} facts */
  showParts(facts) {
    if (!this.parts || !this.top) return;
    const { kernel } = this.top;
    this.parts.show(facts, (parts) => kernel.findBody(parts, facts.weighed.gravity));
    this.charts.mass = this.parts.mass;
  }

  /** What friction and torques have changed. @param {MotionFacts} motion */
  followMotion(motion) {
    if (this.facts) this.showMotion({ ...this.facts, ...motion }, false);
  }

  /** Show what follows the motion. @param {Facts} facts @param {boolean} isAct that is announced */
  showMotion(facts, isAct) {
    this.facts = facts;
    const { headline, because, measured, why } = facts.texts[inDegrees() ? "degrees" : "radians"];
    find("said").ariaLive = isAct ? "polite" : "off"; // a screen reader would never end
    say("headline", headline);
    say("because", because);
    say("measured", measured);
    say("why", why);
    if (!because) find("numbers", HTMLDetailsElement).open = true; // there is nothing else
    say("rule-apart", facts.apart);
    // Impulses are those of gravity alone, and of a precession that is free.
    find("impulses-chart").hidden = facts.isHeld || facts.apart !== "";
    if (isAct) this.question.follow(facts);
    showKinds(facts.body, facts.turning);
  }

  /** Show the arrows that the reason names, if it is read, for a moment. */
  showNamed() {
    if (!find("reason", HTMLDetailsElement).open) return;
    this.layers.flash(findAll("#because .word").map(({ dataset }) => dataset.layer ?? ""));
  }

  /** Show the tilt and the rates of now. @param {Now} now */
  showNow(now) {
    this.fields.follow(now);
    this.roots.show(
      this.fields.isEdited && this.facts ? { ...this.facts.start, ...this.facts } : now,
    );
  }

  /** @param {[entry: number, text: string][]} history */
  showHistory(history) {
    find("entries").replaceChildren(
      ...history.map(([entry, text]) => {
        const button = make("button");
        write(button, text, typesetSymbols); // no buttons in it: another page may have written it
        button.addEventListener("click", () => this.send({ act: "restart", entry }));
        return button;
      }),
    );
  }

  /** @param {Frame} frame */
  showFrame({ samples, marks, points, stretches, present, isSlow, end }) {
    if (!this.facts) return;
    say("instant", present);
    say("stretch-act", stretches.act);
    say("stretch-turns", stretches.turns || phrase("page.no_turns"));
    const sample = samples[samples.length - 1];
    const { time: now, state } = sample;
    this.moments.follow(sample);
    const time = now / NANO;
    Object.assign(document.body.dataset, { time, theta: state.angles.theta });
    this.charts.draw(this.facts, samples, this.fields.values.factor, marks);
    say("points", writePoints(points));
    this.timeline.show(time, end);
    this.question.show(time);
    if (this.top) this.measure.follow(this.top);
    const kind = !this.facts.running ? "paused" : isSlow ? "slow" : null;
    say("pace", kind ? phrase("watched", { kind }) : "");
  }

  showUnit() {
    this.fields.showUnit();
    this.seen.showUnit();
    this.lesson?.showUnit();
    showFittedUnit();
    if (this.facts) this.showFacts(this.facts);
  }
}

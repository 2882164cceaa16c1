// What the page's modules say of cases, without the page: `kernel` and `phrase` are kept first.

/** A record as JSON has it, with null for NaN; but a zero keeps its sign. */
const toRecord = (value) => {
  if (typeof value === "number") return Number.isFinite(value) ? value : null;
  if (value === null || typeof value !== "object") return value;
  if (ArrayBuffer.isView(value)) return toRecord(Array.from(value));
  if (Array.isArray(value)) return value.map((each) => toRecord(each) ?? null);
  const known = Object.entries(value).filter(([, each]) => each !== undefined);
  return Object.fromEntries(known.map(([name, each]) => [name, toRecord(each)]));
};

/** What functions of a module give: each of some names, with a list of arguments. */
window.callAll = async ([module, calls]) => {
  const found = await import(`/${module}.js`);
  return calls.map(([name, ...given]) => toRecord(found[name](...given)));
};

/** Keep the kernel of these bytes, in base 64, and the texts of a language. */
window.loadKernel = async ([module, templates, language]) => {
  const { Kernel } = await import("/physics/kernel.js");
  const { phrase, setTemplates } = await import("/words/wording.js");
  const decode = (text) => Uint8Array.from(atob(text), (each) => each.charCodeAt(0));
  window.kernel = await Kernel.load(decode(module));
  setTemplates(templates, language);
  window.phrase = phrase;
};

/** The state after a kick, records, and their text. */
window.judgeCases = async (cases) => {
  const { Course } = await import("/physics/course.js");
  const { State } = await import("/physics/state.js");
  const { judge, judgeKick } = await import("/words/verdict.js");
  const { findConstants, findFrameTorques, findPivotForce, findPotential } = await import(
    "/physics/formulas.js"
  );
  return cases.map(({ top, angles, rates, kick }) => {
    const state = State.fromEuler(kernel, angles, rates);
    const course = new Course(kernel, top, state);
    const { kind, value, hold } = kick;
    const after = state.kick(top, kind, [value].flat(), hold);
    const verdict = judge(course, 1.4, hold);
    const record = judgeKick(new Course(kernel, top, after), state, hold ?? null);
    const [theta, phi, psi] = [state.angles.theta, state.rates.phi, state.rates.psi];
    const potential = findPotential(top, state);
    return toRecord({
      start: [...state.orientation, ...state.omega],
      after: [...after.orientation, ...after.omega],
      angles: state.angles,
      rates: state.rates,
      verdict,
      record,
      texts: ["radians", "degrees"].flatMap((variant) => [
        phrase("verdict", verdict, variant),
        phrase("kick", record, variant),
      ]),
      regular: kernel.findRegularRates(top, angles.theta, rates.psi),
      drawn: {
        world: state.toWorld(state.omega),
        torques: Object.values(findFrameTorques(top, theta, phi, psi)),
        constants: Object.values(findConstants(top, state)),
        pivot: Object.values(findPivotForce(top, state, 2.0, 9.75)),
        potential: [...[0.3, 1.0, 2.5].map((tilt) => potential.at(tilt)), potential.energy],
      },
    });
  });
};

/** What the page keeps of states that are given by their doubles. */
window.takeStates = async (states) => {
  const { State } = await import("/physics/state.js");
  return states.map(([orientation, omega]) => {
    const state = new State(kernel, orientation, omega);
    const { angles, rates } = state;
    return toRecord([state.given, state.orientation, state.omega, angles, rates]);
  });
};

/** Headline, reason and kind of motion of starts. */
window.sayStarts = async (starts) => {
  const { Course } = await import("/physics/course.js");
  const { State } = await import("/physics/state.js");
  const { findOutcome } = await import("/words/headline.js");
  return starts.map(({ top, theta, phi_dot, theta_dot = 0, psi_dot }) => {
    const rates = { phi: phi_dot, theta: theta_dot, psi: psi_dot };
    const course = new Course(kernel, top, State.fromEuler(kernel, { theta }, rates));
    const moment = { kind: "start", asked: {}, course };
    const { headline, name, outcome } = findOutcome(moment, course);
    return [phrase("headline", headline), phrase(name, outcome), course.motion.kind];
  });
};

/**
 * What the page says of kicks, in both units, and the levels that its scene marks in the end; with the
 * doubles before and after.
 */
window.sayKicks = async (cases) => {
  const { Course } = await import("/physics/course.js");
  const { State } = await import("/physics/state.js");
  const { findOutcome } = await import("/words/headline.js");
  const { findPush, listReached } = await import("/scene/push.js");
  return cases.map(({ top, angles, rates, kick: { kind, value, hold } }) => {
    const before = State.fromEuler(kernel, angles, rates);
    const course = new Course(kernel, top, before.kick(top, kind, [value].flat(), hold));
    const moment = { kind: "kick", time: 0, asked: { hold }, course, before };
    const { headline } = findOutcome(moment, course);
    const levels = listReached(findPush(moment), Infinity, []);
    const write = (variant) => phrase("headline", headline, variant);
    return {
      states: [before, course.start].map((each) => [[...each.orientation], [...each.omega]]),
      texts: { radians: write("radians"), degrees: write("degrees") },
      labels: levels.map((each) => [each.from, each.to, phrase("moved", each)]),
      happened: phrase("guess", { kind: "right", seen: headline.seen }),
    };
  });
};

/** All sentences that the page shows together of kicks. */
window.sayAll = async (cases) => {
  const { Course } = await import("/physics/course.js");
  const { State } = await import("/physics/state.js");
  const { findOutcome } = await import("/words/headline.js");
  return cases.map(({ top, angles, rates, kick: { kind, value, hold } }) => {
    const before = State.fromEuler(kernel, angles, rates);
    const course = new Course(kernel, top, before.kick(top, kind, [value].flat(), hold));
    const moment = { kind: "kick", time: 0, asked: { hold }, course, before };
    const { headline, name, outcome, because } = findOutcome(moment, course);
    const said = [phrase("headline", headline), phrase(name, outcome)];
    return because ? [...said, phrase("because", because), phrase("in_numbers", because)] : said;
  });
};

/** The impulses of starts since them: at times, and the texts that the page shows at half a nutation. */
window.findImpulses = async (cases) => {
  const { Course } = await import("/physics/course.js");
  const { State } = await import("/physics/state.js");
  const { findImpulses } = await import("/charts/impulses.js");
  const { writeImpulses } = await import("/charts/impulses_chart.js");
  return cases.map(([top, theta, phi, rate, psi]) => {
    const rates = { phi, theta: rate, psi };
    const course = new Course(kernel, top, State.fromEuler(kernel, { theta }, rates));
    const half = course.motion.nutation_period / 2;
    const found = [0.3, 0.9, 1].map((share) => {
      const passed = share * half;
      const numbers = course.motion.at(passed); // at the double, which no nanosecond rounds
      const state = new State(kernel, numbers.slice(0, 4), numbers.slice(4));
      return findImpulses(course, state, passed);
    });
    return toRecord([half, found, writeImpulses(course, half)]);
  });
};

/** The course of a case that is given by its doubles. */
const followCase = async ({ top, orientation, omega, friction, torque, clamped }) => {
  const { Course } = await import("/physics/course.js");
  const { State } = await import("/physics/state.js");
  const start = new State(kernel, orientation, omega);
  return new Course(kernel, top, start, friction, torque, null, clamped);
};

/** What was exchanged from the start of each case to a time in ns: the record, and its text. */
window.findExchanges = async (cases) => {
  const { findStretch, nameExchange } = await import("/words/stretch.js");
  const answers = cases.map(async (each) => {
    const course = await followCase(each);
    const [first, last] = [0, each.end].map((passed) => course.at(passed));
    const record = nameExchange(findStretch(course, first, last, each.end / 1e9));
    return toRecord([record, phrase("exchange", record)]);
  });
  return Promise.all(answers);
};

/** The last two turning points of each case up to a time in ns. */
window.findTurns = async (cases) => {
  const { findLastTurns } = await import("/words/stretch.js");
  const answers = cases.map(async (each) => findLastTurns(await followCase(each), each.end));
  return Promise.all(answers);
};

/** Whether each start makes loops, and the spins at which the kinds of its motions change. */
window.decideKinds = async (cases) => {
  const { makesLoops, findBoundaries } = await import("/physics/kinds.js");
  return cases.map(([top, theta, phi, psi]) => [
    makesLoops(top, theta, phi, psi),
    findBoundaries(top, theta, phi),
  ]);
};

/** Texts as the page sets them: of each its prose, and of each formula its source, MathML and words. */
window.setTexts = async (texts) => {
  const { findFormulas } = await import("/words/formula.js");
  const { typesetSymbols } = await import("/words/typeset.js");
  return texts.map((text) => {
    const parts = typesetSymbols(text);
    const sources = findFormulas(text).filter(({ terms }) => terms);
    const isFormula = (part) => part.className?.startsWith("formula");
    const formulas = parts.filter(isFormula).map((each, k) => ({
      source: sources[k].text,
      tree: JSON.stringify(sources[k].terms),
      pieces: [...each.querySelectorAll("math")].map(({ outerHTML }) => outerHTML),
      words: each.ariaLabel,
      name: each.className,
    }));
    return { prose: parts.filter((part) => typeof part === "string"), formulas };
  });
};

/** Why the axle moves so at an instant, in each language that is loaded. */
window.sayPresents = async (cases) => {
  const { Course } = await import("/physics/course.js");
  const { State } = await import("/physics/state.js");
  const { describePresent } = await import("/words/present.js");
  return cases.map(({ top, orientation, omega }) => {
    const state = new State(kernel, orientation, omega);
    return describePresent(new Course(kernel, top, state), state);
  });
};

/** By how much L changes from the start of each case on, in which span in ns, and the way of the axle. */
window.findChanges = async (cases) => {
  const { chooseSpan, findChange, findWay } = await import("/scene/change.js");
  const answers = cases.map(async (each) => {
    const course = await followCase(each);
    const span = chooseSpan(course, course.start);
    const run = { find: () => ({ course }), at: (time) => course.at(time) };
    return { span, change: findChange(run, 0, span), way: findWay(course.start) };
  });
  return Promise.all(answers);
};

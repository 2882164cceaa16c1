// What the page's modules say of cases: the state after a kick, records, and their text.

const toRecord = (value) =>
  JSON.parse(JSON.stringify(value, (_, each) => (Object.is(each, -0) ? 0 : each)));

window.judgeCases = async (cases) => {
  const { Course } = await import("/physics/course.js");
  const { State } = await import("/physics/state.js");
  const { judge, judgeKick } = await import("/words/verdict.js");
  const { findConstants, findFrameTorques, findPotential } = await import("/charts/formulas.js");
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
        potential: [...[0.3, 1.0, 2.5].map((tilt) => potential.at(tilt)), potential.energy],
      },
    });
  });
};

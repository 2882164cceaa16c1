// What the page's modules say of cases: the state after a kick, records, and their text.

const toRecord = (value) =>
  JSON.parse(JSON.stringify(value, (_, each) => (Object.is(each, -0) ? 0 : each)));

window.judgeCases = async (cases) => {
  const { State } = await import("/physics/state.js");
  const kicks = await import("/physics/kicks.js");
  const { judge, judgeKick } = await import("/physics/verdict.js");
  const precession = await import("/physics/precession.js");
  const { EffectivePotential, findConstants } = await import("/physics/potential.js");
  const solve = (top, start, driven = {}) => ({
    top,
    start,
    isDriven: Boolean(driven.friction),
    motion: kernel.motion({ ...top, orientation: start.given, angular_velocity: start.omega }),
  });
  const makeKick = (top, state, { kind, value, hold }) => {
    if (kind === "impulse") return kicks.applyImpulse(top, state, value);
    if (kind === "factor") return kicks.hurry(state, value, hold);
    return kicks.setPrecessionRate(state, value, hold);
  };
  return cases.map(({ top, angles, rates, kick }) => {
    const state = State.fromEuler(angles, rates);
    const before = solve(top, state);
    const verdict = judge(before, 1.4, kick.hold ?? "spin_rate");
    const after = makeKick(top, state, kick);
    const course = solve(top, after);
    const record = judgeKick(course, state, before.motion.turning_angles, kick.hold ?? null);
    const [theta, phi, psi] = [state.angles.theta, state.rates.phi, state.rates.psi];
    const potential = new EffectivePotential(top, state);
    return toRecord({
      start: [...state.orientation, ...state.omega],
      after: [...after.orientation, ...after.omega],
      angles: state.angles,
      rates: state.rates,
      world: state.toWorld(state.omega),
      verdict,
      record,
      texts: ["radians", "degrees"].flatMap((variant) => [
        writer.write("verdict", verdict, variant),
        writer.write("kick", record, variant),
      ]),
      regular: precession.findRegularRates(top, angles.theta, rates.psi),
      torques: precession.findFrameTorques(top, theta, phi, psi),
      acceleration: precession.findTiltAcceleration(top, theta, phi, psi),
      constants: findConstants(top, state),
      potential: [0.3, 1.0, 2.5].map((tilt) => potential.at(tilt)),
      energy: potential.energy,
    });
  });
};

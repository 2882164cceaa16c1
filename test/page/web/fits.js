// What the page's fit finds, and its parts, for tests: `kernel` is kept first.

const toNumbers = (rows) => Array.from(rows, Number);

/** Open the modules of the fit, with a kernel. */
const openFit = async () => {
  const names = ["answer", "fitting", "lasting", "linear", "many", "model", "projection", "record"];
  const more = ["refine", "statistics", "twins"];
  const found = await Promise.all([...names, ...more].map((name) => import(`/fit/${name}.js`)));
  const modules = Object.assign({}, ...found);
  return { ...modules, many: new modules.Many(kernel) };
};

/** The model of a record about an attitude: what is shown, its derivatives, and sizes. */
window.showModel = async ([given, reference, named]) => {
  const { Model, many, makeRecord } = await openFit();
  const model = new Model(many, makeRecord(given), reference);
  const x = model.fill(named);
  const slopes = [false, true].map((central) => model.findJacobian(x, central).map(toNumbers));
  return {
    names: model.names,
    residuals: toNumbers(model.findResiduals(x)),
    slopes,
    scales: model.findScales(x),
  };
};

/** A fit from parameters, without a search. */
window.refineFit = async ([given, reference, named]) => {
  const { Model, many, makeRecord, refine, describeFit } = await openFit();
  const model = new Model(many, makeRecord(given), reference);
  return describeFit(refine(model, model.fill(named)), { Ix: 1, Iz: 0.25, Mgl: 1 });
};

/** The fit of a record, or why there is none. */
window.fitRecord = async (given) => {
  const { fitMotion, describeFit, makeRecord, many } = await openFit();
  try {
    const fit = fitMotion(many, makeRecord(given), () => {});
    return describeFit(fit, { Ix: 0.000228, Iz: 0.0000572, Mgl: 0.068 });
  } catch (error) {
    if (error instanceof RangeError) return error.message;
    throw error;
  }
};

/** Eigenvalues and vectors of a matrix, and the solutions of systems with it. */
window.solveSystem = async ([matrix, rights]) => {
  const { findEigen, solve } = await openFit();
  return { ...findEigen(matrix), solutions: solve(matrix, rights) };
};

/** What noise is like, by columns. */
window.measureNoise = async ([columns, parameters]) => {
  const { countIndependent, isWhite, sumInfluences, findSpread } = await openFit();
  const independent = countIndependent(columns);
  return {
    independent,
    isWhite: isWhite(columns),
    variance: sumInfluences(columns[0], parameters, independent),
    spread: findSpread(columns[0]),
  };
};

/** Noise that lasts, by columns. */
window.findLasting = async ([given, good, follows, parameters]) => {
  const { findLasting, measureNoise, whitenColumns } = await openFit();
  const [columns, rows] = [
    given.map((each) => Float64Array.from(each)),
    { good, follows, parameters },
  ];
  const noise = measureNoise(columns, rows, findLasting(columns, rows));
  return { ...noise, white: whitenColumns(noise, columns).map(toNumbers) };
};

/** Points that a motion and its twins show, and those of their cameras. */
window.showTwins = async ([motion, camera, times]) => {
  const { many, mirrorView, turnCamera, seeFromAbove, project } = await openFit();
  const above = { ...camera, elevation: Math.PI / 2 };
  const all = [
    { motion, camera },
    mirrorView(motion, camera),
    turnCamera(motion, camera),
    { motion, camera: above },
    { motion: seeFromAbove(motion), camera: above },
  ];
  return all.map((each) => {
    const [axes] = many.findAxes([each.motion], Float64Array.from(times));
    return toNumbers(project(axes, each.camera, new Float64Array(2 * times.length)));
  });
};

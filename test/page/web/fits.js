// What the page's fit finds, and its parts, for tests: `kernel` is kept first.

const toNumbers = (rows) => Array.from(rows, Number);

/** Open the modules of the fit, with a kernel. */
const openFit = async () => {
  const names = [
    "answer",
    "fitting",
    "linear",
    "many",
    "model",
    "projection",
    "record",
    "whitening",
  ];
  const more = ["refine", "statistics", "twins", "noise", "search", "starts", "least_squares"];
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
window.findPacf = async ([given, good, follows, parameters]) => {
  const { findPacf, measureNoise, whitenColumns } = await openFit();
  const [columns, rows] = [
    given.map((each) => Float64Array.from(each)),
    { good, follows, parameters },
  ];
  const noise = measureNoise(columns, rows, findPacf(columns, rows));
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

/** Points of a near camera, those of the twin of its mirrored picture, and the twin's p_psi. */
window.mirrorFilm = async ([motion, camera, times]) => {
  const { many, mirrorPicture, project } = await openFit();
  const twin = mirrorPicture(motion, camera);
  const [own, other] = [{ motion, camera }, twin].map((each) => {
    const [axes] = many.findAxes([each.motion], Float64Array.from(times));
    return toNumbers(project(axes, each.camera, new Float64Array(2 * times.length)));
  });
  return [own, other, twin.motion.omega[2]];
};

/** Points of axes as a camera that looks elsewhere sees them, and turned to the pivot. */
window.rectifyPoints = async ([axes, camera]) => {
  const { project, rectify } = await openFit();
  const seen = project(axes, camera, new Float64Array((2 * axes.length) / 3));
  return axes
    .slice(0, axes.length / 3)
    .map((_, k) => rectify([seen[2 * k], seen[2 * k + 1]], camera));
};

/** The least squares of a linear problem with this matrix and these right sides, and limits. */
window.minimiseLinear = async ([rows, rights, start, isSoft, [low, high]]) => {
  const { minimise } = await openFit();
  const problem = {
    find: (x) =>
      Float64Array.from(rows, (row, k) => row.reduce((a, b, j) => a + b * x[j], -rights[k])),
    derive: () => start.map((_, j) => Float64Array.from(rows, (row) => row[j])),
    clip: (x) => x.map((each) => Math.min(Math.max(each, low), high)),
    isSoft,
  };
  return minimise(problem, start, 100, 1e-15);
};

/** What a record keeps of what it was given. */
window.describeRecord = async (given) => {
  const record = (await openFit()).makeRecord(given);
  const { times, values, hasLength, width, count, step, seconds, follows, spreads } = record;
  const { rounding, fixed, smooth } = record;
  const cut = record.cut(13).count;
  const more = { rounding, fixed, smooth: smooth.values, cut, times: toNumbers(times) };
  return { values, hasLength, width, count, step, seconds, follows, spreads, ...more };
};

/** The noise of rows that a model leaves, if its record has this rounding; and the rows in deviations. */
window.findNoise = async ([rows, { rounding, fixed, follows, values }, lasts]) => {
  const { findNoise, whiten } = await openFit();
  const flat = Float64Array.from(rows.flat());
  const record = { width: rows[0].length, flat: values.flat(), rounding, fixed, follows };
  const noise = findNoise({ record, findResiduals: () => flat }, [1, 2, 3], lasts);
  return { kept: noise.kept, sigma: noise.sigma, white: toNumbers(whiten(noise, flat)) };
};

/** The frequencies that starts are looked for at; and which shapes are taken that have some costs. */
window.askStarts = async ([given, costs]) => {
  const { Starts, many, makeRecord } = await openFit();
  const starts = new Starts(many);
  const compareAll = (all) => all.map((_, k) => (k in costs ? { cost: costs[k] } : null));
  const shapes = starts.choose({ compareAll }, 7).map((y) => y);
  const rates = [];
  starts.choose = (_, rate) => {
    rates.push(rate);
    return [];
  };
  const parts = [];
  starts.list(makeRecord(given), (part) => parts.push(part));
  const all = starts.shapes.map(({ y, own }) => [y, own]);
  return { rates, parts, shapes, all };
};

/** The parameters of motions that are shown by linear maps, and what they leave of a record. */
window.fillStarts = async (cases) => {
  const { Starts, many, makeRecord } = await openFit();
  const starts = new Starts(many);
  return cases.map(([given, y, maps]) => {
    const { model, x } = starts.fill(makeRecord(given), y, maps);
    return { left: toNumbers(model.findResiduals(x)), x, names: model.names };
  });
};

/** The motions that a search finds from some starts, and the parts for which they are asked. */
window.searchFrom = async ([given, reference, all, effort]) => {
  const { Model, makeRecord, many, search } = await openFit();
  const parts = [];
  const found = search(makeRecord(given), effort, (part) => {
    parts.push(part.count);
    const model = new Model(many, part, reference);
    return all.map((named) => ({ model, x: model.fill(named) }));
  });
  return {
    parts,
    found: found.map(({ model, x, cost }) => ({ rows: model.record.count, x, cost })),
  };
};

/** Whether what a motion with these rates leaves of a record swings with it; `rates` is null for none. */
window.trySwing = async ([times, columns, rates]) => {
  const { isSwinging } = await import("/fit/lines.js");
  const width = columns.length;
  const model = {
    record: { times, width, rounding: new Array(width).fill(0) },
    read: () => null,
    many: { findRates: () => rates },
  };
  const kept = times.map((_, row) => row);
  const residuals = kept.flatMap((row) => columns.map((each) => each[row]));
  return isSwinging({ model, x: [], residuals, noise: { kept, sigma: columns.map(() => 1) } });
};

// Small matrices as rows of numbers: the solution of a system, and eigenvectors.

/** @typedef {number[][]} Matrix rows */

const SWEEPS = 60; // of Jacobi's rotations; six suffice for most matrices
const NEGLIGIBLE = 1e-300;

/** @param {number} size @param {number} other @returns {Matrix} */
export const zeros = (size, other = size) =>
  Array.from({ length: size }, () => new Array(other).fill(0));

/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b */
export const dot = (a, b) => {
  let sum = 0;
  for (let k = 0; k < a.length; k += 1) sum += a[k] * b[k];
  return sum;
};

/** A matrix times a vector. @param {Matrix} matrix @param {ArrayLike<number>} vector */
export const apply = (matrix, vector) => matrix.map((row) => dot(row, vector));

/** @param {Matrix} matrix @returns {Matrix} */
export const transpose = (matrix) => matrix[0].map((_, k) => matrix.map((row) => row[k]));

/** The products of columns with each other. @param {ArrayLike<number>[]} columns @returns {Matrix} */
export const multiplyPairs = (columns) => {
  const normal = zeros(columns.length);
  for (let j = 0; j < columns.length; j += 1)
    for (let k = 0; k <= j; k += 1) normal[j][k] = normal[k][j] = dot(columns[j], columns[k]);
  return normal;
};

/**
 * The lower triangle of Cholesky; null if the matrix is not positive definite.
 * @param {Matrix} matrix
 */
const decompose = (matrix) => {
  const low = zeros(matrix.length);
  for (let j = 0; j < matrix.length; j += 1)
    for (let k = 0; k <= j; k += 1) {
      const left = matrix[j][k] - dot(low[j].slice(0, k), low[k].slice(0, k));
      if (k < j) low[j][k] = left / low[k][k];
      else if (left > 0) low[j][j] = Math.sqrt(left);
      else return null;
    }
  return low;
};

/**
 * The solutions of a symmetric positive system, one for each right side; null if it has none.
 * @param {Matrix} matrix @param {ArrayLike<number>[]} rights
 */
export const solve = (matrix, rights) => {
  const low = decompose(matrix);
  return low && rights.map((right) => substitute(low, right));
};

/** @param {Matrix} low @param {ArrayLike<number>} right @returns {number[]} */
const substitute = (low, right) => {
  const found = Array.from(right);
  for (let j = 0; j < found.length; j += 1)
    found[j] = (found[j] - dot(low[j].slice(0, j), found)) / low[j][j];
  for (let j = found.length - 1; j >= 0; j -= 1) {
    for (let k = j + 1; k < found.length; k += 1) found[j] -= low[k][j] * found[k];
    found[j] /= low[j][j];
  }
  return found;
};

/**
 * Eigenvalues, growing, and the eigenvectors, a row for each: Jacobi's rotations (Golub and Van Loan,
 * Matrix Computations, 8.5), which find small eigenvalues of a scaled matrix to many digits.
 * @param {Matrix} matrix symmetric
 */
export const findEigen = (matrix) => {
  const a = matrix.map((row) => [...row]);
  const vectors = matrix.map((row, k) => row.map((_, j) => Number(j === k)));
  for (let sweep = 0; sweep < SWEEPS && rotateAll(a, vectors); sweep += 1);
  const order = a.map((_, k) => k).sort((j, k) => a[j][j] - a[k][k]);
  return { values: order.map((k) => a[k][k]), vectors: order.map((k) => vectors[k]) };
};

/** Make all elements beside the diagonal zero, one by one; false if they are. @param {Matrix} a @param {Matrix} vectors */
const rotateAll = (a, vectors) => {
  let done = false;
  for (let j = 1; j < a.length; j += 1)
    for (let k = 0; k < j; k += 1) {
      const small = Number.EPSILON * Math.sqrt(Math.abs(a[j][j] * a[k][k]));
      if (Math.abs(a[j][k]) <= small + NEGLIGIBLE) continue;
      rotate(a, vectors, j, k);
      done = true;
    }
  return done;
};

/** @param {Matrix} a @param {Matrix} vectors @param {number} j @param {number} k */
const rotate = (a, vectors, j, k) => {
  const half = (a[k][k] - a[j][j]) / (2 * a[j][k]);
  const tan = (half < 0 ? -1 : 1) / (Math.abs(half) + Math.hypot(half, 1));
  const cos = 1 / Math.hypot(tan, 1);
  const sin = tan * cos;
  for (const row of a)
    [row[j], row[k]] = [cos * row[j] - sin * row[k], sin * row[j] + cos * row[k]];
  for (const rows of [a, vectors]) {
    const [first, second] = [rows[j], rows[k]];
    rows[j] = first.map((each, i) => cos * each - sin * second[i]);
    rows[k] = first.map((each, i) => sin * each + cos * second[i]);
  }
};

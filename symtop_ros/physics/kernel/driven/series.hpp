// The top with friction and an applied torque: Taylor series in time, step after step.
//
// The derivatives are polynomials of degree 2 of the variables (equations.hpp), so coefficient k + 1
// of all variables follows from the products of coefficients 0 to k with those from k to 0: with
// x = sum x_k t^k and x' = c a b, Cauchy's product gives
//
//   (k + 1) x_(k+1) = c (a_0 b_k + a_1 b_(k-1) + ... + a_k b_0),
//
// and with x' = c a it is (k + 1) x_(k+1) = c a_k. The spin is no factor of any product: S' = omega_z
// gives (k + 1) S_(k+1) = omega_z,k. The length
// of a step follows from the last two coefficients (A. Jorba and M. Zou, A software package for the
// numerical integration of ODEs, Experimental Mathematics 14 (2005) 99).
#pragma once

#include "equations.hpp"

namespace symtop {

// A frame that turns by at most 2 rad in a step has terms that fall so fast that the first eight
// alone need sums of two doubles. Longer steps want twelve, which take half of the time. See
// design/extended_terms.py.
const int DRIVEN_TERMS = 30, EXTENDED_TERMS = 8;
// Size of the last terms of a step, for variables of size 1. It is far below EPS, because what is left
// out has the same sign in many steps, while rounding has not.
const double LAST = 1e-19;
// The terms of an axis near the vertical may be larger than this by a factor, compared with its tilt:
// so that steps do not become shorter at ordinary tilts.
const double CLOSER = 8.0;
const double LONGEST = 16.0;  // in units of about 1/rate; so the powers of a step stay in range
// rad by which the frame turns in a step. Further on the terms of a sine would exceed their sum, and
// rounding with them.
const double LARGEST_TURN = 2.0;
const double LARGEST_ANGULAR_VELOCITY = 1e100;
const int LENGTH_BITS = 10;  // a length has so few bits that the sum of lengths, the time, is exact
const double LARGEST_SPIN = 1e15;  // rad of half the spin angle; far beyond, no digit of it is left

// 1/n: its double, and the rest that this leaves, rounded.
const Double2 INVERSES[EXTENDED_TERMS + 1] = {
    {0.0, 0.0}, {1.0, 0.0}, {1.0 / 2, 0.0}, {1.0 / 3, 0x1.5555555555555p-56}, {1.0 / 4, 0.0},
    {1.0 / 5, -0x1.999999999999ap-57}, {1.0 / 6, 0x1.5555555555555p-57},
    {1.0 / 7, 0x1.2492492492492p-57}, {1.0 / 8, 0.0}};

typedef double Four __attribute__((vector_size(32), may_alias));

struct Knot {
  double t;
  Double2 values[VARIABLES];
};

struct Piece {
  Knot start, following;
  double end, unit;
  Double2 low[EXTENDED_TERMS + 1][VARIABLES];  // coefficients of the first powers
  double high[DRIVEN_TERMS + 1][VARIABLES];    // and of the others

  // Variables at start.t + u unit: the smallest terms first.
  void evaluate(Double2 u, Double2 values[VARIABLES]) const {
    double tail[VARIABLES] = {};
    for (int n = DRIVEN_TERMS; n > EXTENDED_TERMS; n--)
      for (int k = 0; k < VARIABLES; k++) tail[k] = (tail[k] + high[n][k]) * u.high;
    for (int k = 0; k < VARIABLES; k++) {
      Double2 sum = {tail[k], 0.0};
      for (int n = EXTENDED_TERMS; n > 0; n--) sum = (sum + low[n][k]) * u;
      if (k >= OMEGA_X && k <= OMEGA_Z) sum = scale(sum, 1 / unit);
      values[k] = sum + start.values[k];
    }
  }

  // A time is given as the sum of two doubles.
  Double2 locate(double t, double rest) const {
    return scale(sum_of(t, -start.t) + Double2{rest, 0.0}, 1 / unit);
  }

  // The state at the end, of norm 1: one step of Newton's for 1/sqrt(norm), which was 1 to rounding.
  void find_end() {
    following.t = end;
    evaluate(locate(end, 0.0), following.values);
    Double2 norm = {0.0, 0.0};
    for (int k = W; k <= Z; k++) norm = norm + following.values[k] * following.values[k];
    const Double2 factor = Double2{1.5, 0.0} - scale(norm, 0.5);
    for (int k = W; k <= Z; k++) following.values[k] = following.values[k] * factor;
  }
};

class Stepper {
 public:
  DrivenEquations equations;

  void step(const Knot& knot, int direction, Piece& piece) {
    piece.start = knot;
    const double rate = equations.estimate_rate(knot.values);
    if (!(rate < LARGEST_ANGULAR_VELOCITY)) return stop(piece, knot.t);
    int exponent = 0;
    if (rate) std::frexp(1 / rate, &exponent);
    set_unit(std::ldexp(1.0, exponent));
    for (int k = 0; k < FACTORS; k++)
      low_[0][k] = k >= OMEGA_X && k <= OMEGA_Z ? scale(knot.values[k], unit_) : knot.values[k];
    compute_series();
    bool is_moving = false;
    for (int k = 0; k < FACTORS; k++) is_moving |= low_[1][k].high != 0;
    if (!is_moving) return stop(piece, direction * INFINITY);
    piece.unit = unit_;
    copy_series(piece);
    double length = direction * find_length() * unit_;
    piece.end = knot.t + length;
    piece.find_end();
    while (std::fabs(piece.following.values[SPIN].high * equations.half_rest) > LARGEST_SPIN) {
      length /= 2;
      piece.end = knot.t + length;
      piece.find_end();
    }
  }

 private:
  double unit_ = 0.0;
  Double2 constants_[MOST_TERMS];
  Double2 low_[EXTENDED_TERMS + 1][FACTORS];
  double series_[DRIVEN_TERMS + 1][FACTORS];
  // The factors of all products, by order: so the loops over products are over neighbours.
  alignas(32) double left_[DRIVEN_TERMS + 1][MOST_PAIRS] = {};
  alignas(32) double right_[DRIVEN_TERMS + 1][MOST_PAIRS] = {};
  alignas(32) double left_rest_[EXTENDED_TERMS + 1][MOST_PAIRS] = {};
  alignas(32) double right_rest_[EXTENDED_TERMS + 1][MOST_PAIRS] = {};

  // A piece whose state does not change: nothing moves, or it is too fast to go on.
  static void stop(Piece& piece, double end) {
    piece.end = end;
    piece.unit = INFINITY;
    std::memset(piece.low, 0, sizeof piece.low);
    std::memset(piece.high, 0, sizeof piece.high);
  }

  void set_unit(double unit) {
    if (unit == unit_) return;
    unit_ = unit;
    for (int n = 0; n < equations.term_count; n++) {
      const Double2 driving = scale(equations.parts[2][n], unit) + equations.parts[1][n];
      constants_[n] = scale(driving, unit) + equations.parts[0][n];
    }
  }

  void compute_series() {
    put_low(0);
    for (int n = 0; n < EXTENDED_TERMS; n++) compute_low_order(n);
    for (int n = EXTENDED_TERMS; n < DRIVEN_TERMS; n++) compute_high_order(n);
  }

  void put_low(int order) {
    for (int k = 0; k < FACTORS; k++) series_[order][k] = low_[order][k].high;
    for (int p = 0; p < equations.pair_count; p++) {
      const Double2 a = low_[order][equations.left[p]], b = low_[order][equations.right[p]];
      left_[order][p] = a.high, left_rest_[order][p] = a.low;
      right_[order][p] = b.high, right_rest_[order][p] = b.low;
    }
  }

  // Add the products of two orders to sums of two doubles.
  SYMTOP_CLONES static void add_extended(const double* a, const double* a_rest, const double* b,
                                         const double* b_rest, int count, double* sum,
                                         double* rest) {
    for (int p = 0; p < count; p++) {
      const double product = a[p] * b[p], lost = __builtin_fma(a[p], b[p], -product);
      const double total = sum[p] + product, part = total - sum[p];
      const double error = (sum[p] - (total - part)) + (product - part);
      rest[p] += error + (lost + (a[p] * b_rest[p] + a_rest[p] * b[p]));
      sum[p] = total;
    }
  }

  // The sums over m of a[m] b[order - m], for the first 4 VECTORS products.
  template <int VECTORS>
  static SYMTOP_INLINE void add_vectors(const double a[][MOST_PAIRS], const double b[][MOST_PAIRS],
                                        int order, double* sum) {
    Four sums[VECTORS] = {};
    for (int m = 0; m <= order; m++) {
      const Four* x = reinterpret_cast<const Four*>(a[m]);
      const Four* y = reinterpret_cast<const Four*>(b[order - m]);
#pragma GCC unroll 7
      for (int v = 0; v < VECTORS; v++) sums[v] += x[v] * y[v];
    }
    std::memcpy(sum, sums, sizeof sums);
  }

  // Without an applied torque there are 18 products, with one up to 24.
  SYMTOP_CLONES static void add_products(const double a[][MOST_PAIRS], const double b[][MOST_PAIRS],
                                         int order, int count, double* sum) {
    if (count <= 20)
      add_vectors<5>(a, b, order, sum);
    else
      add_vectors<7>(a, b, order, sum);
  }

  SYMTOP_CLONES void compute_low_order(int order) {
    double sum[MOST_PAIRS] = {}, rest[MOST_PAIRS] = {};
    const int count = equations.product_count;
    for (int m = 0; m <= order; m++)
      add_extended(left_[m], left_rest_[m], right_[order - m], right_rest_[order - m], count, sum,
                   rest);
    Double2 products[MOST_PAIRS];
    for (int p = 0; p < count; p++) products[p] = sum_of(sum[p], rest[p]);
    for (int p = count; p < equations.pair_count; p++)
      products[p] = low_[order][equations.left[p]];
    for (int row = 0; row < FACTORS; row++) {
      double total = 0.0, lost = 0.0;
      for (int n = equations.first_terms[row]; n < equations.first_terms[row + 1]; n++) {
        const Double2 c = constants_[n], x = products[equations.pairs[n]];
        const double term = c.high * x.high, below = __builtin_fma(c.high, x.high, -term);
        const Double2 next = sum_of(total, term);
        total = next.high;
        lost += next.low + (below + (c.high * x.low + c.low * x.high));
      }
      low_[order + 1][row] = sum_of(total, lost) * INVERSES[order + 1];
    }
    put_low(order + 1);
  }

  void compute_high_order(int order) {
    double sum[MOST_PAIRS];
    add_products(left_, right_, order, equations.product_count, sum);
    for (int p = equations.product_count; p < equations.pair_count; p++)
      sum[p] = series_[order][equations.left[p]];
    for (int row = 0; row < FACTORS; row++) {
      double total = 0.0;
      for (int n = equations.first_terms[row]; n < equations.first_terms[row + 1]; n++) {
        const double product = sum[equations.pairs[n]];
        total += constants_[n].high * product + constants_[n].low * product;
      }
      series_[order + 1][row] = total / (order + 1);
    }
    for (int p = 0; p < equations.pair_count; p++) {
      left_[order + 1][p] = series_[order + 1][equations.left[p]];
      right_[order + 1][p] = series_[order + 1][equations.right[p]];
    }
  }

  void copy_series(Piece& piece) const {
    for (int n = 1; n <= EXTENDED_TERMS; n++) {
      for (int k = 0; k < FACTORS; k++) piece.low[n][k] = low_[n][k];
      piece.low[n][SPIN] = low_[n - 1][OMEGA_Z] * INVERSES[n];
    }
    for (int n = EXTENDED_TERMS + 1; n <= DRIVEN_TERMS; n++) {
      for (int k = 0; k < FACTORS; k++) piece.high[n][k] = series_[n][k];
      piece.high[n][SPIN] = series_[n - 1][OMEGA_Z] / n;
    }
  }

  double find_length() const {
    const double* q = series_[0];
    const double spin = equations.ratio * q[OMEGA_Z];
    const double turn =
        std::sqrt(q[OMEGA_X] * q[OMEGA_X] + q[OMEGA_Y] * q[OMEGA_Y] + spin * spin);
    double length = LARGEST_TURN / std::fmax(turn, LARGEST_TURN / LONGEST);
    const double axial = std::fmax(1.0, std::fabs(q[OMEGA_Z]));
    const double upper = q[W] * q[W] + q[Z] * q[Z], lower = q[X] * q[X] + q[Y] * q[Y];
    // cos^2 and sin^2 of half the tilt. Near the vertical the axis is given by what is small of q:
    // x and y above, where tan(theta/2)^2 = lower/upper, and w and z below; and by omega across.
    const bool swings = CLOSER * CLOSER * std::fmin(upper, lower) < 1;
    const int swing[] = {OMEGA_X, OMEGA_Y, upper > lower ? X : W, upper > lower ? Y : Z};
    const double size = swings ? measure_swing(swing) : 1.0;
    for (int order = DRIVEN_TERMS - 1; order <= DRIVEN_TERMS; order++) {
      double largest = std::fabs(series_[order][OMEGA_Z]) / axial;
      for (int k = W; k < OMEGA_Z; k++) largest = std::fmax(largest, std::fabs(series_[order][k]));
      if (swings) largest = std::fmax(largest, find_largest(series_[order], swing) / size);
      if (largest) length = std::fmin(length, std::pow(LAST / largest, 1.0 / order));
    }
    int exponent;
    const double fraction = std::frexp(length, &exponent);
    return std::ldexp(std::floor(std::ldexp(fraction, LENGTH_BITS)), exponent - LENGTH_BITS);
  }

  static double find_largest(const double* row, const int swing[4]) {
    double largest = 0.0;
    for (int i = 0; i < 4; i++) largest = std::fmax(largest, std::fabs(row[swing[i]]));
    return largest;
  }

  // How far the axis swings from the vertical in a step: its terms count by this size.
  double measure_swing(const int swing[4]) const {
    double size = 0.0;
    for (int order = 0; order < 4; order++)
      size = std::fmax(size, CLOSER * find_largest(series_[order], swing));
    return size > 1.0 || size == 0 ? 1.0 : size;
  }
};

}  // namespace symtop

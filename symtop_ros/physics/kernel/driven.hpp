// The driven top of symtop_ros/physics/driven: equations.py, series.py and trail.py, which say why
// everything is as it is. What has extended precision there is a sum of two doubles here (32 digits),
// so that states have the same bits on every machine. They are not the bits of Python, whose
// extended precision is that of the processor.
#pragma once

#include <cstdlib>

#include "numbers.hpp"

namespace symtop {

// ---- Sums of two doubles ------------------------------------------------------------------------

struct Double2 {
  double high, low;
  double to_double() const { return high; }
};

inline Double2 sum_of(double a, double b) {  // Knuth's two-sum
  const double s = a + b, part = s - a;
  return {s, (a - (s - part)) + (b - part)};
}

inline Double2 fast_sum_of(double a, double b) {  // for |a| >= |b|
  const double s = a + b;
  return {s, b - (s - a)};
}

inline Double2 operator-(Double2 a) { return {-a.high, -a.low}; }

inline Double2 operator+(Double2 a, Double2 b) {
  Double2 s = sum_of(a.high, b.high);
  const Double2 t = sum_of(a.low, b.low);
  s = fast_sum_of(s.high, s.low + t.high);
  return fast_sum_of(s.high, s.low + t.low);
}

inline Double2 operator-(Double2 a, Double2 b) { return a + -b; }

inline Double2 operator*(Double2 a, Double2 b) {
  const double p = a.high * b.high, rest = __builtin_fma(a.high, b.high, -p);
  return fast_sum_of(p, rest + (a.high * b.low + a.low * b.high));
}

inline Double2 operator*(Double2 a, double b) {
  const double p = a.high * b, rest = __builtin_fma(a.high, b, -p);
  return fast_sum_of(p, rest + a.low * b);
}

inline Double2 operator/(Double2 a, Double2 b) {
  const double q = a.high / b.high;
  Double2 rest = a - b * q;
  const double r = rest.high / b.high;
  rest = rest - b * r;
  return fast_sum_of(q, r) + Double2{rest.high / b.high, 0.0};
}

inline Double2 scale(Double2 a, double power_of_two) {
  return {a.high * power_of_two, a.low * power_of_two};
}

inline Double2 root(Double2 a) {
  if (a.high <= 0) return {0.0, 0.0};
  const double x = std::sqrt(a.high);
  const Double2 rest = a - Double2{x, 0.0} * x;
  return fast_sum_of(x, rest.high / (2 * x));
}

// ---- equations.py -------------------------------------------------------------------------------

enum { W, X, Y, Z, OMEGA_X, OMEGA_Y, OMEGA_Z, ONE, SPIN, VARIABLES };
const int FACTORS = 8;

const int MOST_PAIRS = 28;  // 27 are possible; a multiple of 4
const int MOST_TERMS = 64;
const int PARTS = 3;  // of the free top, of friction, and of the torques

struct DrivenArguments {
  double Ix, Iz, Mgl, axial, transverse, torque[3], orientation[4], omega[3];
};

struct DrivenEquations {
  int pair_count = 0, term_count = 0;
  int left[MOST_PAIRS] = {}, right[MOST_PAIRS] = {};  // the two factors of a product
  int rows[MOST_TERMS], pairs[MOST_TERMS];            // of a term: its variable, and its product
  Double2 parts[PARTS][MOST_TERMS];
  int first_terms[FACTORS + 1];
  double ratio, half_rest, swing, decay;

  int find_pair(int i, int j) {
    if (i > j) return find_pair(j, i);
    for (int p = 0; p < pair_count; p++)
      if (left[p] == i && right[p] == j) return p;
    left[pair_count] = i, right[pair_count] = j;
    return pair_count++;
  }

  void add_term(int part, int row, int i, int j, Double2 size) {
    const int pair = find_pair(i, j);
    int place = 0;
    while (place < term_count && (rows[place] != row || pairs[place] != pair)) place++;
    if (place == term_count) {
      rows[place] = row, pairs[place] = pair;
      for (auto& each : parts) each[place] = {0.0, 0.0};
      term_count++;
    }
    parts[part][place] = parts[part][place] + size;
  }

  // _add_torque: component `component` of axis `axis`, a quadratic form of the quaternion
  void add_torque(int row, int axis, int component, Double2 size) {
    static const int AXES[3][3][4][3] = {
        {{{W, W, 1}, {X, X, 1}, {Y, Y, -1}, {Z, Z, -1}}, {{X, Y, 2}, {W, Z, -2}},
         {{X, Z, 2}, {W, Y, 2}}},
        {{{X, Y, 2}, {W, Z, 2}}, {{W, W, 1}, {Y, Y, 1}, {X, X, -1}, {Z, Z, -1}},
         {{Y, Z, 2}, {W, X, -2}}},
        {{{X, Z, 2}, {W, Y, -2}}, {{Y, Z, 2}, {W, X, 2}},
         {{W, W, 1}, {Z, Z, 1}, {X, X, -1}, {Y, Y, -1}}}};
    for (const auto& term : AXES[axis][component])
      if (size.high && term[2]) add_term(2, row, term[0], term[1], size * double(term[2]));
  }

  void prepare(const DrivenArguments& top) {
    const Double2 Ix = {top.Ix, 0.0}, Iz = {top.Iz, 0.0}, Mgl = {top.Mgl, 0.0};
    const Double2 exact_ratio = Iz / Ix;
    ratio = exact_ratio.high;
    const double share = round_to_integer(ratio * 0x1p26) / 0x1p26;
    half_rest = (1 - share) / 2;
    static const int TURNING[12][4] = {
        {W, X, OMEGA_X, -1}, {W, Y, OMEGA_Y, -1}, {W, Z, OMEGA_Z, -1}, {X, W, OMEGA_X, 1},
        {X, Y, OMEGA_Z, 1},  {X, Z, OMEGA_Y, -1}, {Y, W, OMEGA_Y, 1},  {Y, Z, OMEGA_X, 1},
        {Y, X, OMEGA_Z, -1}, {Z, W, OMEGA_Z, 1},  {Z, X, OMEGA_Y, 1},  {Z, Y, OMEGA_X, -1}};
    for (const auto& t : TURNING)
      add_term(0, t[0], t[1], t[2], {t[3] * (t[2] == OMEGA_Z ? share : 1.0) / 2, 0.0});
    const Double2 remaining = Double2{share, 0.0} - exact_ratio;
    add_term(0, OMEGA_X, OMEGA_Z, OMEGA_Y, remaining);
    add_term(0, OMEGA_Y, OMEGA_Z, OMEGA_X, -remaining);
    const Double2 across = Double2{top.transverse, 0.0} / Ix, along = Double2{top.axial, 0.0} / Iz;
    add_term(1, OMEGA_X, ONE, OMEGA_X, -across);
    add_term(1, OMEGA_Y, ONE, OMEGA_Y, -across);
    add_term(1, OMEGA_Z, ONE, OMEGA_Z, -along);
    add_torque(OMEGA_X, 2, 1, Mgl / Ix);
    add_torque(OMEGA_Y, 2, 0, -(Mgl / Ix));
    for (int axis = 0; axis < 3; axis++) {
      const Double2 torque = {top.torque[axis], 0.0};
      add_torque(OMEGA_X, axis, 0, torque / Ix);
      add_torque(OMEGA_Y, axis, 1, torque / Ix);
      add_torque(OMEGA_Z, axis, 2, torque / Iz);
    }
    const double* f = top.torque;
    const double size = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    swing = std::sqrt((std::fabs(top.Mgl) + size) / top.Ix);
    decay = std::fmax(across.high, along.high);
    sort_terms();
  }

  void sort_terms() {
    for (int a = 0; a < term_count; a++)
      for (int b = a; b > 0 && rows[b - 1] > rows[b]; b--) {
        swap(rows[b - 1], rows[b]);
        swap(pairs[b - 1], pairs[b]);
        for (auto& each : parts) swap(each[b - 1], each[b]);
      }
    for (int row = 0, n = 0; row <= FACTORS; row++) {
      while (n < term_count && rows[n] < row) n++;
      first_terms[row] = n;
    }
  }

  template <class T>
  static void swap(T& a, T& b) {
    const T kept = a;
    a = b, b = kept;
  }

  double estimate_rate(const Double2 values[]) const {
    const double x = values[OMEGA_X].high, y = values[OMEGA_Y].high,
                 z = ratio * values[OMEGA_Z].high;
    return std::sqrt(x * x + y * y + z * z) + swing + decay;
  }
};

// ---- series.py ----------------------------------------------------------------------------------

const int DRIVEN_TERMS = 30, EXTENDED_TERMS = 12;  // twice as many as in Python: they cost little
const double LAST = 1e-19, CLOSER = 8.0, LONGEST = 16.0, LARGEST_TURN = 3.5;
const double LARGEST_ANGULAR_VELOCITY = 1e100;
const int LENGTH_BITS = 10;

// 1/n
const Double2 INVERSES[EXTENDED_TERMS + 1] = {
    {0.0, 0.0}, {1.0, 0.0}, {1.0 / 2, 0.0}, {1.0 / 3, 0x1.5555555555555p-56}, {1.0 / 4, 0.0},
    {1.0 / 5, -0x1.999999999999ap-57}, {1.0 / 6, 0x1.5555555555555p-57},
    {1.0 / 7, 0x1.2492492492492p-57}, {1.0 / 8, 0.0}, {1.0 / 9, 0x1.c71c71c71c71cp-58},
    {1.0 / 10, -0x1.999999999999ap-58}, {1.0 / 11, -0x1.745d1745d1746p-59},
    {1.0 / 12, 0x1.5555555555555p-58}};

typedef double Four __attribute__((vector_size(32), may_alias));

struct Knot {
  double t;
  Double2 values[VARIABLES];
};

struct Piece {
  Knot start;
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

  Knot find_end() const {
    Knot knot;
    knot.t = end;
    evaluate(locate(end, 0.0), knot.values);
    Double2 norm = {0.0, 0.0};
    for (int k = W; k <= Z; k++) norm = norm + knot.values[k] * knot.values[k];
    const Double2 factor = Double2{1.5, 0.0} - scale(norm, 0.5);
    for (int k = W; k <= Z; k++) knot.values[k] = knot.values[k] * factor;
    return knot;
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
    piece.end = knot.t + direction * find_length() * unit_;
    piece.unit = unit_;
    copy_series(piece);
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

  static void stop(Piece& piece, double end) {  // _stop
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
                                         const double* b_rest, double* sum, double* rest) {
    for (int p = 0; p < MOST_PAIRS; p++) {
      const double product = a[p] * b[p], lost = __builtin_fma(a[p], b[p], -product);
      const double total = sum[p] + product, part = total - sum[p];
      const double error = (sum[p] - (total - part)) + (product - part);
      rest[p] += error + (lost + (a[p] * b_rest[p] + a_rest[p] * b[p]));
      sum[p] = total;
    }
  }

  // The sums over m of a[m] b[order - m], for all products.
  SYMTOP_CLONES static void add_products(const double a[][MOST_PAIRS], const double b[][MOST_PAIRS],
                                         int order, double* sum) {
    const int VECTORS = MOST_PAIRS / 4;
    Four sums[VECTORS] = {};
    for (int m = 0; m <= order; m++) {
      const Four* x = reinterpret_cast<const Four*>(a[m]);
      const Four* y = reinterpret_cast<const Four*>(b[order - m]);
#pragma GCC unroll 7
      for (int v = 0; v < VECTORS; v++) sums[v] += x[v] * y[v];
    }
    std::memcpy(sum, sums, sizeof sums);
  }

  SYMTOP_CLONES void compute_low_order(int order) {
    double sum[MOST_PAIRS] = {}, rest[MOST_PAIRS] = {};
    for (int m = 0; m <= order; m++)
      add_extended(left_[m], left_rest_[m], right_[order - m], right_rest_[order - m], sum, rest);
    Double2 products[MOST_PAIRS];
    for (int p = 0; p < MOST_PAIRS; p++) products[p] = sum_of(sum[p], rest[p]);
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
    add_products(left_, right_, order, sum);
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

  // _measure_swing
  double measure_swing(const int swing[4]) const {
    double size = 0.0;
    for (int order = 0; order < 4; order++)
      size = std::fmax(size, CLOSER * find_largest(series_[order], swing));
    return size > 1.0 || size == 0 ? 1.0 : size;
  }
};

// ---- trail.py -----------------------------------------------------------------------------------

const int KEPT = 1024, RECENT = 64;

class Trail {
 public:
  // False if there is no memory.
  bool prepare(const DrivenArguments& top, int direction) {
    kept_ = static_cast<Knot*>(std::malloc((KEPT + 1) * sizeof(Knot)));
    recent_ = static_cast<Piece*>(std::malloc(RECENT * sizeof(Piece)));
    if (!kept_ || !recent_) return false;
    direction_ = direction;
    stepper_.equations.prepare(top);
    kept_[0] = start(top);
    kept_count_ = spacing_ = 1;
    return true;
  }
  Trail() = default;
  Trail(const Trail&) = delete;
  Trail& operator=(const Trail&) = delete;
  ~Trail() {
    std::free(kept_);
    std::free(recent_);
  }

  // Trail.reach; *is_stuck is set if the motion is too fast to go on.
  double reach(double t, double steps, bool* is_stuck) {
    go_back(t);
    *is_stuck = false;
    while (steps > 0 && std::fabs(present().end) < std::fabs(t)) {
      if (present().end == present().start.t) {
        *is_stuck = true;
        break;
      }
      step();
      steps -= 1;
    }
    return std::fabs(t) <= std::fabs(present().end) ? t : present().end;
  }

  // Write the state at t + rest; the time has been reached.
  void read(double t, double rest, double orientation[4], double omega[3]) const {
    Double2 v[VARIABLES];
    const Piece& piece = present();
    piece.evaluate(piece.locate(t, rest), v);
    Double2 c, s;
    find_unit(v[SPIN] * stepper_.equations.half_rest, c, s);
    const Double2 q[4] = {v[W] * c - v[Z] * s, v[X] * c + v[Y] * s, v[Y] * c - v[X] * s,
                          v[Z] * c + v[W] * s};
    const Double2 c2 = c * c - s * s, s2 = scale(c * s, 2.0);
    for (int k = 0; k < 4; k++) orientation[k] = q[k].high;
    omega[0] = (v[OMEGA_X] * c2 + v[OMEGA_Y] * s2).high;
    omega[1] = (v[OMEGA_Y] * c2 - v[OMEGA_X] * s2).high;
    omega[2] = v[OMEGA_Z].high;
  }

  double decay() const { return stepper_.equations.decay; }

 private:
  Stepper stepper_;
  int direction_ = 1;
  Knot* kept_ = nullptr;  // knots over the whole integration, with `spacing_` pieces between two
  long kept_count_ = 0, spacing_ = 1;
  Piece* recent_ = nullptr;  // a ring: the last pieces up to the present one
  int recent_count_ = 0, last_ = 0;
  long count_ = 0;  // pieces before the present one

  const Piece& present() const { return recent_[last_]; }

  // DrivenEquations.start
  static Knot start(const DrivenArguments& top) {
    Knot knot = {};
    Double2 norm = {0.0, 0.0};
    for (double q : top.orientation) norm = norm + Double2{q, 0.0} * q;
    norm = root(norm);
    for (int k = 0; k < 4; k++) knot.values[W + k] = Double2{top.orientation[k], 0.0} / norm;
    for (int k = 0; k < 3; k++) knot.values[OMEGA_X + k] = {top.omega[k], 0.0};
    knot.values[ONE] = {1.0, 0.0};
    return knot;
  }

  // Cosine and sine of an angle, to some digits more than doubles have.
  static void find_unit(Double2 angle, Double2& c, Double2& s) {
    const Double2 QUARTER = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
    const double quarters = round_to_integer(angle.high * QUARTERS);
    const Double2 near = angle - QUARTER * quarters;
    const double x = near.high, square = x * x;
    static const double SINE[] = {1.0 / 355687428096000, -1.0 / 1307674368000, 1.0 / 6227020800,
                                  -1.0 / 39916800, 1.0 / 362880, -1.0 / 5040, 1.0 / 120};
    static const double VERSINE[] = {-1.0 / 20922789888000, 1.0 / 87178291200, -1.0 / 479001600,
                                     1.0 / 3628800, -1.0 / 40320, 1.0 / 720, -1.0 / 24};
    double of_sine = 0.0, of_versine = 0.0;
    for (double each : SINE) of_sine = (of_sine + each) * square;
    for (double each : VERSINE) of_versine = (of_versine + each) * square;
    // The largest terms, x - x^3/6 and 1 - x^2/2, as sums of two doubles.
    const Double2 near_2 = near * near, sixth = INVERSES[6];
    const Double2 sine = near - near * near_2 * sixth + Double2{x * (square * of_sine), 0.0};
    const Double2 cosine = Double2{1.0, 0.0} - scale(near_2, 0.5) -
                           Double2{square * of_versine, 0.0};
    const int64_t turns = static_cast<int64_t>(quarters);
    c = turns & 1 ? sine : cosine, s = turns & 1 ? cosine : sine;
    if ((turns + 1) & 2) c = -c;
    if (turns & 2) s = -s;
  }

  void append(const Knot& knot) {
    last_ = (last_ + 1) % RECENT;
    if (recent_count_ < RECENT) recent_count_++;
    stepper_.step(knot, direction_, recent_[last_]);
  }

  void step() {
    const Knot knot = present().find_end();
    count_++;
    if (count_ == kept_count_ * spacing_) kept_[kept_count_++] = knot;
    if (kept_count_ > KEPT) {
      kept_count_ = (kept_count_ + 1) / 2;
      for (long n = 0; n < kept_count_; n++) kept_[n] = kept_[2 * n];
      spacing_ *= 2;
    }
    append(knot);
  }

  void go_back(double t) {
    while (recent_count_ && std::fabs(present().start.t) >= std::fabs(t) && count_) {
      last_ = (last_ + RECENT - 1) % RECENT;
      recent_count_--;
      count_--;
    }
    if (recent_count_) return;
    long place = 0;
    while (place + 1 < kept_count_ && std::fabs(kept_[place + 1].t) < std::fabs(t)) place++;
    count_ = place * spacing_;
    append(kept_[place]);
  }
};

}  // namespace symtop

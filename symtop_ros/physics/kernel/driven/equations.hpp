// The equations of motion of a driven top, with quadratic derivatives, and double-double numbers.
//
// The spin about the axis is split off. It is counted as an angle, and the rest is integrated in a
// frame that turns about the axis at about Iz/Ix omega_z instead of omega_z. There friction and weight
// have the same form as in the body, and the angular velocity of a free top is constant. Steps have to
// resolve the nutation only, however fast a slender body spins.
//
// Let omega be the angular velocity of the body in the axes of this frame, whose own one is
// Omega = (omega_x, omega_y, s omega_z), and S the angle of spin, with S' = omega_z. The body is turned
// in the frame by (1 - s) S about the axis. The axis is one of symmetry: L = (Ix omega_x, Ix omega_y,
// Iz omega_z) in the frame, too. Every derivative is then a polynomial of degree 2:
//
// - of the quaternion q of the frame: q' = q (0, Omega)/2,
// - of omega, by Euler's equations in the turning frame, L' + Omega x L = N:
//     omega_x' = (s - Iz/Ix) omega_y omega_z + N_x/Ix
//     omega_y' = -(s - Iz/Ix) omega_z omega_x + N_y/Ix
//     omega_z' = N_z/Iz
//   The directions in N are quadratic in q, and friction is linear in omega.
//
// With s = Iz/Ix the first two of a free top would vanish. s is Iz/Ix with 26 binary places, so that s/2
// and (1 - s)/2 are doubles without rounding; the rest, s - Iz/Ix, is a term with 32 digits.
//
// An error of the angular velocity grows with time, therefore rounding must not accumulate in it. The
// state between two steps, the largest terms of the series and the constants have 32 digits, as sums
// of two doubles, with the same bits on every machine.
#pragma once

#include "../elementary.hpp"

namespace symtop {

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

// The length of a vector. Its components are scaled by a power of two, which rounds nothing: the
// squares of a weak torque or a slow rate would be zero, and steps then far too long.
inline double find_length(double x, double y, double z) {
  const double largest = std::fmax(std::fmax(std::fabs(x), std::fabs(y)), std::fabs(z));
  if (!(largest > 0 && largest < INFINITY)) return largest;
  int exponent;
  std::frexp(largest, &exponent);
  x = std::ldexp(x, -exponent), y = std::ldexp(y, -exponent), z = std::ldexp(z, -exponent);
  return std::ldexp(std::sqrt(x * x + y * y + z * z), exponent);
}

enum { W, X, Y, Z, OMEGA_X, OMEGA_Y, OMEGA_Z, ONE, SPIN, VARIABLES };
const int FACTORS = 8;

// Products are found once and used by several terms. There are 12 of a component of q with one of
// omega, omega_z omega_x and omega_z omega_y, 4 of two components of q for the weight (X Z, W Y, Y Z,
// W X), the other 6 for a torque in any direction, and 3 of omega with 1 for friction: 27 in all.
const int MOST_PAIRS = 28;  // a multiple of 4
// 12 of q', 2 of Euler's equations, 3 of friction, and in each of 3 rows 8 of the torques: 41 in all.
const int MOST_TERMS = 64;
// Coefficients of the free top, of friction and of the torques, by their powers of a unit of time u.
// In this unit the variables are q and u omega: d(u omega) = u^2 omega' for d(t/u), in which a product
// of two rates has the factor 1, friction u and a torque u^2; q' has the factor 1.
const int PARTS = 3;

struct DrivenArguments {
  double Ix, Iz, Mgl, axial, transverse, torque[3], orientation[4], omega[3];
};

struct DrivenEquations {
  // Products with the number 1 stand last: they are no sums over orders.
  int pair_count = 0, product_count = 0, term_count = 0;
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

  // A torque along the axis `axis` of the world: its component `component` in the frame. This is the
  // entry of the matrix of q in row `axis` and column `component`, of which q v q* gives
  //
  //   w^2 + x^2 - y^2 - z^2   2 (x y - w z)           2 (x z + w y)
  //   2 (x y + w z)           w^2 + y^2 - x^2 - z^2   2 (y z - w x)
  //   2 (x z - w y)           2 (y z + w x)           w^2 + z^2 - x^2 - y^2
  //
  // A row has the components of a world axis in the frame. Of each entry: the two factors of a
  // product, and its coefficient; 0 where there are less than four.
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
    half_rest = (1 - share) / 2;  // of S: half the angle of the body in the frame
    // The product q (0, Omega)/2. Of each term: its row, its two factors, and its sign; with omega_z
    // there is the factor s.
    //
    //   2 w' = -x Omega_x - y Omega_y - z Omega_z
    //   2 x' =  w Omega_x + y Omega_z - z Omega_y
    //   2 y' =  w Omega_y + z Omega_x - x Omega_z
    //   2 z' =  w Omega_z + x Omega_y - y Omega_x
    static const int TURNING[12][4] = {
        {W, X, OMEGA_X, -1}, {W, Y, OMEGA_Y, -1}, {W, Z, OMEGA_Z, -1}, {X, W, OMEGA_X, 1},
        {X, Y, OMEGA_Z, 1},  {X, Z, OMEGA_Y, -1}, {Y, W, OMEGA_Y, 1},  {Y, Z, OMEGA_X, 1},
        {Y, X, OMEGA_Z, -1}, {Z, W, OMEGA_Z, 1},  {Z, X, OMEGA_Y, 1},  {Z, Y, OMEGA_X, -1}};
    for (const auto& t : TURNING)
      add_term(0, t[0], t[1], t[2], {t[3] * (t[2] == OMEGA_Z ? share : 1.0) / 2, 0.0});
    const Double2 remaining = Double2{share, 0.0} - exact_ratio;  // Omega x L
    add_term(0, OMEGA_X, OMEGA_Z, OMEGA_Y, remaining);
    add_term(0, OMEGA_Y, OMEGA_Z, OMEGA_X, -remaining);
    const Double2 across = Double2{top.transverse, 0.0} / Ix, along = Double2{top.axial, 0.0} / Iz;
    add_term(1, OMEGA_X, ONE, OMEGA_X, -across);
    add_term(1, OMEGA_Y, ONE, OMEGA_Y, -across);
    add_term(1, OMEGA_Z, ONE, OMEGA_Z, -along);
    // The weight acts at l on the axis e: -Mgl e x Z = Mgl (Z_y, -Z_x, 0), with the vertical Z in the
    // frame. Its component along the axis is zero.
    add_torque(OMEGA_X, 2, 1, Mgl / Ix);
    add_torque(OMEGA_Y, 2, 0, -(Mgl / Ix));
    for (int axis = 0; axis < 3; axis++) {
      const Double2 torque = {top.torque[axis], 0.0};
      add_torque(OMEGA_X, axis, 0, torque / Ix);
      add_torque(OMEGA_Y, axis, 1, torque / Ix);
      add_torque(OMEGA_Z, axis, 2, torque / Iz);
    }
    const double size = find_length(top.torque[0], top.torque[1], top.torque[2]);
    swing = std::sqrt((std::fabs(top.Mgl) + size) / top.Ix);
    decay = std::fmax(across.high, along.high);
    sort_pairs();
    sort_terms();
  }

  // Products of two variables first, then those with 1; the terms keep their products.
  void sort_pairs() {
    int places[MOST_PAIRS], sorted[2][MOST_PAIRS];
    for (int linear = 0, count = 0; linear < 2; linear++) {
      for (int p = 0; p < pair_count; p++)
        if ((right[p] == ONE) == linear) {
          sorted[0][count] = left[p], sorted[1][count] = right[p];
          places[p] = count++;
        }
      if (!linear) product_count = count;
    }
    std::memcpy(left, sorted[0], sizeof sorted[0]);
    std::memcpy(right, sorted[1], sizeof sorted[1]);
    for (int n = 0; n < term_count; n++) pairs[n] = places[pairs[n]];
  }

  // Terms by rows: those of a row are from first_terms[row] to before first_terms[row + 1].
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
    return find_length(values[OMEGA_X].high, values[OMEGA_Y].high, ratio * values[OMEGA_Z].high) +
           swing + decay;
  }
};

}  // namespace symtop

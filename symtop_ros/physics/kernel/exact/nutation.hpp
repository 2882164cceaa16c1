// The cubic of the nutation, (du/dt)^2 = f(u) for u = cos(theta), and its roots (derivation.md,
// section 2).
//
// Goldstein (Classical Mechanics, section 5.7) writes
//
//   (du/dt)^2 = (1 - u^2)(alpha - beta u) - (b - a u)^2.
//
// Expanded in powers of u, as there, the coefficients cancel: for a small tilt the roots are near
// 1, and their distances from 1, on which everything depends, keep no digit. So the height is
// measured from the start, s = u - u0. Each coefficient is then a sum of products of the given
// numbers:
//
//   name                 textbook            in terms of the start
//   a                    a = p_psi/Ix        (Iz/Ix) omega_z, in rad/s
//   beta                 beta = 2 Mgl/Ix     in rad^2/s^2
//   one_minus_u          1 - u0              2 |B|^2, with Cayley-Klein parameters A and B
//   one_plus_u           1 + u0              2 |A|^2
//   b_minus_au           b - a u0            sin^2(theta) phi', in rad/s
//   u_dot                du/dt               -sin(theta) theta', in rad/s
//   omega_xy_squared     alpha - beta u0     theta'^2 + sin^2(theta) phi'^2, in rad^2/s^2
//   u_dot_dot            d2u/dt2             half of f'(u) at u0, in rad/s^2
//   b_minus_a            b - a               (p_phi - p_psi)/Ix, in rad/s
//   b_plus_a             b + a               (p_phi + p_psi)/Ix, in rad/s
//   b_minus_au_highest   b - a alpha/beta    b - a u with all energy potential; 0 without weight
//   alpha_minus_beta     alpha - beta        kinetic energy left upright, in rad^2/s^2
//
// On the separatrix b = a and alpha = beta: the axis has just the energy to come to rest upright.
// Near it these two numbers decide on everything, and all digits of their terms may cancel. A sum
// that is zero decides on the kind of the motion: regular precession, a cusp, a way through a pole.
// Of a zero 57 digits leave some 1e-57, another number in each order of operations. In both cases
// the sums are formed again without any rounding (`sum_exactly`).
#pragma once

#include "../elementary.hpp"

namespace symtop {

struct Start {  // what a motion starts from; Mgl > 0 and the orientation as it was given
  double Ix, Iz, Mgl;
  double w, x, y, z;
  double wx, wy, wz;
  bool is_clamped = false;  // phi' is held at 0: see `clamp`
  // What the doubles of a state that is carried on leave over; a push across the axle leaves wz as
  // it is.
  struct {
    double w, x, y, z, wx, wy;
  } rest = {};
};

// The numbers of a start with what their doubles leave over.
template <class T>
struct WholeStart {
  T w, x, y, z, wx, wy;

  explicit WholeStart(const Start& s)
      : w(sum(s.w, s.rest.w)),
        x(sum(s.x, s.rest.x)),
        y(sum(s.y, s.rest.y)),
        z(sum(s.z, s.rest.z)),
        wx(sum(s.wx, s.rest.wx)),
        wy(sum(s.wy, s.rest.wy)) {}

 private:
  static T sum(double high, double low) { return low == 0 ? T(high) : T(high) + T(low); }
};

// The start of a motion whose precession is held (derivation.md, section 11). The hand takes up
// what p_psi asks for, so that the axis moves as that of a body without axial momentum, Iz = 0, and
// the body turns about it by omega_z: the turning rate c of Iz = 0.
inline Start clamp(Start s) {
  s.Iz = 0.0;
  s.is_clamped = true;
  return s;
}

constexpr double EPS = 0x1p-52;
// Normalising a norm this close to 1 would only add rounding
constexpr double NORM_ROUNDING = 4 * EPS;
// A sum of products of a start's doubles can be wrong by some tens of EPS of its largest term. A
// sum below this share of its terms is treated as zero.
constexpr double START_ROUNDING = 64 * EPS;

inline void turn_over(double& w, double& x, double& y, double& z) {
  const double w_before = w, y_before = y;
  w = -x;
  x = w_before;
  y = -z;
  z = y_before;
}

// The closed form wants Mgl > 0: a world turned by pi about x' has it. Returns true if it was
// turned.
inline bool turn_over(Start& s) {
  if (!(s.Mgl < 0)) return false;
  turn_over(s.w, s.x, s.y, s.z);
  turn_over(s.rest.w, s.rest.x, s.rest.y, s.rest.z);
  s.Mgl = -s.Mgl;
  return true;
}

// A quaternion that has norm 1 to rounding stays as it is, bit for bit.
inline Start normalize(Start s) {
  const double norm = std::sqrt((s.w * s.w + s.z * s.z) + (s.x * s.x + s.y * s.y));
  if (std::fabs(norm - 1.0) <= NORM_ROUNDING) return s;
  s.w = s.w / norm;
  s.x = s.x / norm;
  s.y = s.y / norm;
  s.z = s.z / norm;
  return s;
}

// c = wz (Ix - Iz)/Ix, by which the body turns about its axis in addition to the means of a
// nutation (section 1). As p_psi (1/Iz - 1/Ix) it would cancel for a body that is nearly a sphere.
// It may exceed the means by all their digits, so it is kept apart.
template <int N>
inline Float<N> find_turning_rate(const Start& s) {
  const Float<N> Ix(s.Ix);
  return Float<N>(s.wz) * (Ix - Float<N>(s.Iz)) / Ix;
}

template <int N>
struct NutationOf {
  Float<N> a, beta, one_minus_u, one_plus_u, b_minus_au, u_dot, omega_xy_squared, u_dot_dot,
      b_minus_a, b_plus_a, b_minus_au_highest, alpha_minus_beta;

  Float<N> u() const { return (one_plus_u - one_minus_u).scale(-1); }
  Float<N> b_minus_au_at(const Float<N>& s) const { return b_minus_au - a * s; }
};
typedef NutationOf<3> Nutation;

// The sums again, in integers: each times its denominators, so that nothing is divided before the
// end. With beta = 2 Mgl/Ix and a = Iz wz/Ix.
template <int N>
SYMTOP_SET_UP inline void sum_exactly(const Start& start, NutationOf<N>& nutation) {
  typedef Float<N> Rounded;
  const Exact Ix(start.Ix), Iz(start.Iz), Mgl(start.Mgl), wz(start.wz);
  const WholeStart<Exact> all(start);
  const Exact &w = all.w, &x = all.x, &y = all.y, &z = all.z, &wx = all.wx, &wy = all.wy;
  const Exact upper = w * w + z * z, lower = x * x + y * y, norm = upper + lower;
  const Exact gx = x * z - w * y, gy = y * z + w * x;
  const Exact along = wx * gx + wy * gy, spin = Iz * wz, squared = wx * wx + wy * wy;
  const Exact rise = Ix * ((upper - lower) * norm) * squared,
              weight = (Mgl * upper * lower).scale(2);
  const Exact highest = (Mgl * along).scale(2) - spin * squared * norm;
  const Rounded length(norm), product = Rounded(Ix) * length;
  nutation.b_minus_au = Rounded(along).scale(1) / length;
  nutation.u_dot = Rounded(wy * gx - wx * gy).scale(1) / length;
  nutation.u_dot_dot = Rounded((spin * along * norm).scale(1) - rise - weight) / (product * length);
  nutation.b_minus_a = Rounded(Ix * along - spin * lower).scale(1) / product;
  nutation.b_plus_a = Rounded(Ix * along + spin * upper).scale(1) / product;
  if (Mgl.sign) nutation.b_minus_au_highest = Rounded(highest) / (Rounded(Mgl).scale(1) * length);
  nutation.alpha_minus_beta = Rounded(squared * Ix * norm - (Mgl * lower).scale(2)) / product;
}

// A sum below 1e-10 of its terms has lost 10 of its digits: it is formed exactly instead.
const double PER_CANCELLED = 1e10;

template <int N>
inline bool is_cancelled(const Float<N>& sum, const Float<N>& terms) {
  return sum * Float<N>(PER_CANCELLED) <= terms;
}

// Bits, 40 decimal digits, after which a sum has none of its terms' digits, and may be zero.
const int LOST_BITS = 133;

// True if a sum is so small, compared with one of its terms, that it may be zero. `power` is that
// of the sum in `value`: its digits are lost as often.
template <int N>
inline bool is_lost(const Float<N>& value, const Float<N>& term, int power = 1) {
  return value.sign && term.sign && value.exponent < term.exponent - power * LOST_BITS;
}

// The same of a motion in a vertical plane, p_phi = p_psi = 0: of the angular velocity across the
// axis the part along the line of nodes counts alone, theta' = turn/(|A| |B|), with the norm of the
// quaternion taken out. All sums are formed without any rounding, then each is divided once.
template <int N>
SYMTOP_SET_UP inline NutationOf<N> find_plane_nutation(const Start& start) {
  typedef Float<N> Rounded;
  const Exact Ix(start.Ix), Mgl(start.Mgl), w(start.w), x(start.x), y(start.y), z(start.z);
  const Exact upper = w * w + z * z, lower = x * x + y * y, norm = upper + lower;
  const Exact turn = Exact(start.wy) * (x * z - w * y) - Exact(start.wx) * (y * z + w * x);
  const Exact squared = turn * turn, both = upper * lower;
  const Exact weight = (Mgl * both).scale(2);
  const Rounded per_norm = invert(Rounded(norm)), per_both = invert(Rounded(both));
  const Rounded per_all = per_norm * per_both / Rounded(start.Ix);
  NutationOf<N> n;
  n.beta = Rounded(start.Mgl).scale(1) / Rounded(start.Ix);
  n.one_minus_u = Rounded(lower).scale(1) * per_norm;
  n.one_plus_u = Rounded(upper).scale(1) * per_norm;
  n.u_dot = Rounded(turn).scale(1) * per_norm;
  n.omega_xy_squared = Rounded(squared) * per_both;
  n.u_dot_dot =
      -Rounded((upper - lower) * norm * Ix * squared + weight * both) * per_all * per_norm;
  n.alpha_minus_beta = Rounded(squared * Ix * norm - weight * lower) * per_all;
  return n;
}

// The angular velocity across the axis without the part that a clamp takes: theta' along the line
// of nodes. From the products of the plane, -u'/(1 - u^2) (gy, -gx), as sin(theta) is not 0.
// Returns |theta'|.
SYMTOP_SET_UP inline Float<3> drop_precession(const Nutation& n, Start& start) {
  typedef Float<3> P;
  const P w(start.w), x(start.x), y(start.y), z(start.z);
  const P share = n.u_dot / (n.one_plus_u * n.one_minus_u);
  const P scale = share.scale(1) / (w * w + z * z + (x * x + y * y));
  start.wx = (-(scale * (y * z + w * x))).to_double();
  start.wy = (scale * (x * z - w * y)).to_double();
  return root(n.omega_xy_squared);
}

// The numbers of the table above.
template <int N>
inline NutationOf<N> find_nutation(const Start& start) {
  if (start.is_clamped) return find_plane_nutation<N>(start);
  typedef Float<N> P;
  const P Ix(start.Ix), Iz(start.Iz), Mgl(start.Mgl), wz(start.wz);
  const WholeStart<P> all(start);
  const P &w = all.w, &x = all.x, &y = all.y, &z = all.z, &wx = all.wx, &wy = all.wy;
  const P upper = w * w + z * z, lower = x * x + y * y;
  // The doubles of a quaternion have norm 1 to rounding only. With this factor 1 - u0 and 1 + u0
  // have the sum 2 exactly, as the cubic assumes.
  const P twice = P(2.0) / (upper + lower), per_Ix = invert(Ix);
  const P gx = twice * (x * z - w * y), gy = twice * (y * z + w * x);
  const P along_x = wx * gx, along_y = wy * gy;
  NutationOf<N> n;
  n.a = wz * Iz * per_Ix;
  n.beta = Mgl.scale(1) * per_Ix;
  n.one_minus_u = twice * lower;
  n.one_plus_u = twice * upper;
  n.b_minus_au = along_x + along_y;
  n.u_dot = wy * gx - wx * gy;
  n.omega_xy_squared = wx * wx + wy * wy;
  const P of_spin = n.a * n.b_minus_au, of_rise = n.u() * n.omega_xy_squared;
  const P of_weight = (n.beta * n.one_plus_u * n.one_minus_u).scale(-1);
  n.u_dot_dot = of_spin - of_rise - of_weight;
  n.b_minus_a = n.b_minus_au - n.a * n.one_minus_u;
  n.b_plus_a = n.b_minus_au + n.a * n.one_plus_u;
  if (n.beta.sign) n.b_minus_au_highest = n.b_minus_au - n.a * n.omega_xy_squared / n.beta;
  n.alpha_minus_beta = n.omega_xy_squared - n.beta * n.one_minus_u;
  if (is_cancelled(size(n.b_minus_a), size(along_x) + size(along_y)) ||
      is_cancelled(size(n.alpha_minus_beta), n.omega_xy_squared) ||
      is_lost(n.u_dot * n.u_dot, n.omega_xy_squared, 2) ||
      is_lost(n.b_minus_au * n.b_minus_au, n.omega_xy_squared, 2) ||
      is_lost(n.b_plus_a, n.b_minus_au) || is_lost(n.b_minus_au_highest, n.b_minus_au) ||
      is_lost(n.u_dot_dot, of_spin) || is_lost(n.u_dot_dot, of_rise))
    sum_exactly(start, n);
  return n;
}

// Roots s1 <= 0 <= s2 <= s3 of f, measured from the start. s21 and s32 are their differences s2 -
// s1 and s3 - s2; below_pole and above_pole are the distances 1 - u2 and u3 - 1 from the upper
// pole. They are stored because subtraction would lose their digits where roots nearly meet.
template <int N>
struct RootsOf {
  Float<N> s1, s2, s3, s21, s32, below_pole, above_pole;
  Float<N> s31() const { return s21 + s32; }
};
typedef RootsOf<3> Roots;

template <int N>
struct Cubic {
  Float<N> a2, a1, a0;
  Float<N> at(const Float<N>& s) const { return ((s + a2) * s + a1) * s + a0; }
};

const int MOST_STEPS = 60;  // of Newton's method in doubles; from the bound some 5 are usual

// A number just above the largest root, found in doubles from an upper bound. In doubles that are
// too coarse or too small the number is wrong; the caller tests it.
template <int N>
inline Float<N> estimate_largest_root(const Cubic<N>& cubic, double s) {
  const double a2 = cubic.a2.to_double(), a1 = cubic.a1.to_double(), a0 = cubic.a0.to_double();
  for (int step = 0; step < MOST_STEPS; step++) {
    const double value = ((s + a2) * s + a1) * s + a0, slope = (3 * s + 2 * a2) * s + a1;
    if (!(value > 0 && slope > 0) || value < 4 * EPS * slope * s) break;
    s -= value / slope;
  }
  return std::isfinite(s) ? Float<N>(s * (1 + 32 * EPS)) : Float<N>();
}

// The largest root, by Newton's method from an upper bound. The iterates decrease until rounding
// stops them, or until the next step would be lost in it: the root is apart from the others, so
// that each step is about the square of the one before. A start at the turning point is the root 0,
// which relative steps would approach for ever.
template <int N>
inline Float<N> find_largest_root(const Cubic<N>& cubic, Float<N> s) {
  const Float<N> converged = half_of_digits<N>(9);
  if (!cubic.a0.sign && cubic.a1.sign > 0 && cubic.a2.sign > 0) return Float<N>();
  const Float<N> three(3.0), estimate = estimate_largest_root(cubic, s.to_double());
  // It is taken if it lies above the root as well.
  if (three * estimate > -cubic.a2 && cubic.at(estimate).sign > 0) s = estimate;
  for (;;) {
    const Float<N> value = cubic.at(s), slope = (three * s + cubic.a2.scale(1)) * s + cubic.a1;
    if (value.sign <= 0 || slope.sign <= 0) return s;
    const Float<N> step = value / slope;
    if (step < converged * s) return s - step;
    s = s - step;
  }
}

// 1 - u2 and u3 - 1, which decide how near the separatrix is. In terms of v = 1 - u the cubic is
//
//   f/beta = -v^3 + ... + 2 (alpha - beta - a (b - a)) v/beta - (b - a)^2/beta
//
// so that v2 + v3 and v2 v3 follow from two numbers that are known to all digits, and from the root
// v1 = 1 - u1 that is apart. v2 >= 0 >= v3 makes their difference free of cancellation. From the
// coefficients of powers of s, gaps below 1e-19 would have no digit left.
template <int N>
inline void find_distances_from_pole(const NutationOf<N>& n, const Float<N>& v1,
                                     RootsOf<N>& roots) {
  const Float<N> scale = n.beta * v1, per_scale = invert(scale);
  const Float<N> product = n.b_minus_a * n.b_minus_a * per_scale;
  const Float<N> excess = n.alpha_minus_beta - n.a * n.b_minus_a;
  const Float<N> half_sum = (product / v1).scale(-1) - excess * per_scale;
  const Float<N> half_gap = root(half_sum * half_sum + product);
  if (half_sum.sign > 0) {
    roots.below_pole = half_sum + half_gap;
    roots.above_pole = product / roots.below_pole;
  } else {
    roots.above_pole = half_gap - half_sum;
    roots.below_pole = roots.above_pole.sign ? product / roots.above_pole : Float<N>();
  }
}

// s1 is apart: it is the largest root of the reflected cubic, and u1 >= -1 bounds it.
template <int N>
inline RootsOf<N> find_roots_from_lowest(const NutationOf<N>& n, const Cubic<N>& cubic) {
  RootsOf<N> roots;
  const Cubic<N> reflected = {-cubic.a2, cubic.a1, -cubic.a0};
  roots.s1 = -find_largest_root(reflected, n.one_plus_u);
  if (roots.s1.sign > 0) roots.s1 = Float<N>();
  const Float<N> total = -(cubic.a2 + roots.s1);
  // If s2 and s3 are both small compared with s1, their sum has lost its digits, and the product
  // comes from a0. From a start at the upper turning point, a0 = 0, it is exactly zero, as s2 is.
  const bool has_digits = total >= -roots.s1 && (cubic.a0.sign || !roots.s1.sign);
  const Float<N> product = has_digits ? cubic.a1 - roots.s1 * total : -cubic.a0 / roots.s1;
  find_distances_from_pole(n, n.one_minus_u - roots.s1, roots);
  roots.s3 = n.one_minus_u + roots.above_pole;
  roots.s2 = product / roots.s3;  // one_minus_u - below_pole would cancel
  roots.s21 = roots.s2 - roots.s1;
  roots.s32 = roots.below_pole + roots.above_pole;
  return roots;
}

// s3 is apart. Lagrange's bound on the largest root (a0 >= 0 adds nothing to it); u3 >= 1 is
// another.
template <int N>
inline RootsOf<N> find_roots_from_highest(const NutationOf<N>& n, const Cubic<N>& cubic) {
  RootsOf<N> roots;
  const Float<N> zero;
  Float<N> bound =
      (cubic.a2.sign < 0 ? -cubic.a2 : zero) + root(cubic.a1.sign < 0 ? -cubic.a1 : zero);
  if (bound < n.one_minus_u) bound = n.one_minus_u;
  roots.s3 = find_largest_root(cubic, bound);
  const Float<N> per_s3 = invert(roots.s3), product = cubic.a0 * per_s3;
  // Not as -(a2 + s3)/2, which would cancel: s3 may be huge.
  const Float<N> half_sum = ((cubic.a1 + product) * per_s3).scale(-1);
  const Float<N> half_gap = root(half_sum * half_sum + product);
  // Of half_sum + half_gap and half_sum - half_gap one cancels; it comes from the product.
  roots.s2 = half_sum.sign >= 0 ? half_sum + half_gap : product / (half_gap - half_sum);
  if (half_sum.sign < 0)
    roots.s1 = half_sum - half_gap;
  else if (roots.s2.sign)
    roots.s1 = -product / roots.s2;
  roots.below_pole = n.one_minus_u - roots.s2;
  roots.above_pole = roots.s3 - n.one_minus_u;
  roots.s21 = half_gap.scale(1);
  roots.s32 = roots.s3 - roots.s2;
  return roots;
}

// The roots of f(s)/beta = s^3 + a2 s^2 + a1 s + a0, with a0 = (du/dt)^2/beta and a1 = 2
// (d2u/dt2)/beta at the start. One root is well apart from the other two, on one side of their mean
// -a2/3. Newton's method finds it from outside, where the cubic is convex and the iteration
// monotone: it cannot jump to another root. The other two follow from their sum and their product
// (Vieta). Viete's trigonometric solution would give all three to the absolute error of the
// largest, which leaves no digit of a small s2.
template <int N>
inline RootsOf<N> find_roots(const NutationOf<N>& n) {
  const Float<N> per_beta = invert(n.beta);
  const Cubic<N> cubic = {n.u().scale(1) - (n.omega_xy_squared + n.a * n.a) * per_beta,
                          n.u_dot_dot.scale(1) * per_beta, n.u_dot * n.u_dot * per_beta};
  if (!cubic.a1.sign && !cubic.a0.sign) {
    // Regular precession: the start is a double root, and f(1) = -(b - a)^2 is the product of the
    // distances from the pole.
    const Float<N> share = n.b_minus_a / n.one_minus_u;
    RootsOf<N> roots;
    roots.below_pole = n.one_minus_u;
    roots.above_pole = share * share * per_beta;
    roots.s3 = roots.s32 = roots.below_pole + roots.above_pole;
    return roots;
  }
  const Float<N> mean = -cubic.a2 / Float<N>(3.0);
  return cubic.at(mean).sign > 0 ? find_roots_from_lowest(n, cubic)
                                 : find_roots_from_highest(n, cubic);
}

}  // namespace symtop

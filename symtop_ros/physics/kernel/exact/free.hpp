// The motion without a torque that turns the axis (derivation.md, section 8): Mgl is 0, or the axis
// rests on the vertical. The body turns about L by |L| t/Ix, and about its axis by c t.
#pragma once

#include <initializer_list>

#include "kind.hpp"

namespace symtop {

// Below this share of the kinetic energy the weight changes no digit of any phase, and the largest
// root of the cubic, of the order of 1/Mgl, would leave the range of doubles.
const double WEIGHTLESS = 1e-200;

// True if no torque turns the axis: for circular functions instead of elliptic ones. It is not
// omega_z that counts, but Iz/Ix omega_z: a rod may spin fast.
inline bool is_free(const Start& s) {
  const bool is_vertical = (s.w == 0 && s.z == 0) || (s.x == 0 && s.y == 0);
  if (s.wx == 0 && s.wy == 0 && is_vertical) return true;
  const double weight = std::fabs(s.Mgl) / s.Ix;
  for (double rate : {s.wx, s.wy, s.Iz / s.Ix * s.wz})
    if (weight <= WEIGHTLESS * rate * rate) return true;
  return false;
}

// The same start without its weight.
inline Start drop_weight(Start s) {
  s.Mgl = 0.0;
  return s;
}

// Roots of f = -|R|^2 (u - u1)(u - u2), which is quadratic without weight, |R| = |L|/Ix: measured
// from the start, as in nutation.hpp. Their product is negative, so that the root of the
// discriminant does not cancel; of the two roots one does, and comes from the product.
inline Roots find_free_roots(const Nutation& n, const Precise& square) {
  Roots roots;  // the third one is infinite
  const Precise &middle = n.u_dot_dot, rise = n.u_dot * n.u_dot;
  const Precise half_gap = root(middle * middle + square * rise);
  if (!half_gap.sign) return roots;  // regular: both are where the start is
  const Precise per_square = invert(square);
  roots.s2 = middle.sign >= 0 ? (middle + half_gap) * per_square : rise / (half_gap - middle);
  roots.s1 = middle.sign <= 0 ? (middle - half_gap) * per_square : -rise / (half_gap + middle);
  return roots;
}

// The distances of the turning points from the poles, of which none is a difference: those that may
// be small come from f(1) = -(b - a)^2 and f(-1) = -(b + a)^2, but for a start that is the turning
// point.
inline void find_free_zeros(const Nutation& n, const Roots& roots, const Precise& square,
                            Zero zeros[]) {
  const Precise &below = n.b_plus_a, &above = n.b_minus_a;
  const Precise to_lower = n.one_plus_u + roots.s2, to_upper = n.one_minus_u - roots.s1;
  zeros[OF_A] = {true, below, n.one_plus_u, to_lower, {}};
  zeros[OF_B] = {false, above, to_upper, n.one_minus_u, {}};
  if (roots.s1.sign) zeros[OF_A].from_u1 = below * below / (square * to_lower);
  if (roots.s2.sign) zeros[OF_B].from_u2 = above * above / (square * to_upper);
}

struct FreeMotion {
  Start start;  // with norm 1
  bool is_turned_over;
  Nutation nutation;
  Roots roots;
  Zero zeros[OF_OMEGA_XY];  // of A and B
  Precise nutation_rate, turning_rate;
  Steps steps;
  double direction[3];  // of L, in the body
  Kind kind;

  void solve(const Start& given, bool turned_over) {
    is_turned_over = turned_over;
    start = normalize(given);
    nutation = find_nutation<3>(drop_weight(given));
    // Of a clamped motion the rounded parts of omega would give another rate.
    const Precise dropped = given.is_clamped ? drop_precession(nutation, start) : Precise();
    const Precise square = nutation.omega_xy_squared + nutation.a * nutation.a;
    nutation_rate = given.is_clamped ? dropped : root(square);
    turning_rate = find_turning_rate<3>(given);
    const Precise rates[] = {nutation_rate.scale(-1), turning_rate.scale(-1), -turning_rate};
    steps = find_steps(rates, 3);
    find_direction();
    roots = find_free_roots(nutation, square);
    find_free_zeros(nutation, roots, square, zeros);
    const bool is_vertical = !nutation.one_minus_u.sign || !nutation.one_plus_u.sign;
    kind = start.wx == 0 && start.wy == 0 && is_vertical ? SLEEPING : classify_free(*this);
  }

  // Of a body at rest L has no direction, and no turn about it.
  void find_direction() {
    const WholeStart<Precise> all(start);
    const Precise L[] = {all.wx, all.wy, nutation.a};
    for (int i = 0; i < 3; i++)
      direction[i] = nutation_rate.sign ? (L[i] / nutation_rate).to_double() : i == 2 ? 1.0 : 0.0;
  }

  // |omega_xy| is constant.
  Precise find_largest_rate_across() const { return root(nutation.omega_xy_squared); }

  bool is_far(double t) const { return std::fabs(t) >= steps.farthest; }

  // For a time that is not far.
  Attitude at(double t) const {
    Phase phases[FUNCTIONS];
    find_phases(steps, FUNCTIONS, t, phases);
    return at_phases(phases);
  }

  Attitude at_phases(const Phase phases[]) const {
    const Pair half = find_unit(phases[0]), turn = find_unit(phases[1]);
    const double lx = direction[0], ly = direction[1], lz = direction[2];
    const Pair A = {start.w, start.z}, B = {start.x, start.y};
    const Pair along = {half.x, lz * half.y}, over = {lx * half.y, ly * half.y};
    const Pair a = multiply(A, along), b = multiply(B, conjugate(over));
    const Pair d = multiply(A, over), e = multiply(B, conjugate(along));
    Pair values[FUNCTIONS];
    values[OF_A] = multiply(Pair{a.x - b.x, a.y - b.y}, turn);
    values[OF_B] = multiply(Pair{d.x + e.x, d.y + e.y}, conjugate(turn));
    values[OF_OMEGA_XY] = multiply(Pair{start.wx, start.wy}, find_unit(phases[2]));
    return complete_attitude(values, is_turned_over);
  }

  // u is a cosine in time about the middle of its turning points, (b/|R|) (a/|R|).
  double find_mean_cosine() const {
    const Precise whole = nutation_rate * nutation_rate;
    const Precise b = nutation.b_minus_au + nutation.a * nutation.u();
    if (!whole.sign) return nutation.u().to_double();
    return is_lost(b, nutation.b_minus_au) ? 0.0 : (nutation.a * b / whole).to_double();
  }

  // Half turns of arg A and arg B in a turn about L: whether the circle encloses a pole.
  int upper_turns() const { return zeros[OF_A].is_negative() ? -1 : 1; }
  int lower_turns() const { return zeros[OF_B].is_negative() ? -1 : 1; }
};

}  // namespace symtop

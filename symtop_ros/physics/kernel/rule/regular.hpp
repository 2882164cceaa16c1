// The quadratic of regular precession: Ix theta''/sin(theta) = a p^2 - b p + Mgl of the precession
// rate p = phi', for any theta' (the article's first displayed equation; derivation.md, "Perry's
// rule at the two roots").
//
//   held              a                       b
//   spin rate psi'    (Ix - Iz) cos(theta)    Iz psi'
//   spin momentum     Ix cos(theta)           Iz omega_z
#pragma once

#include "../symtop.h"
#include "attitude.hpp"

namespace symtop {

// The discriminant of doubles, b^2/4 - a c, is exact with 134 decimal digits, unless the moments
// differ by 80 decades: so is the number of its roots, where roots merge.
typedef Float<7> Long;

inline bool is_finite(double x) { return std::isfinite(x); }

// The real roots of a p^2 - b p + c, the one of smaller size first; returns how many are finite.
// (b - sqrt(b^2 - 4 a c))/(2 a) cancels in the slow root of a fast top, which is the smaller one by
// far. Here b/2 and the root of the discriminant are added with equal signs, q = b/2 + sign(b)
// sqrt(b^2/4 - a c); the roots are then c/q and q/a (Press et al., Numerical Recipes, section 5.6).
inline int solve_quadratic(const Long& a, const Long& b, const Long& c, double roots[2]) {
  int count = 0;
  const auto keep = [&](const Long& root) {
    const double rate = root.to_double();
    if (is_finite(rate)) roots[count++] = rate;
  };
  if (!a.sign) {  // a horizontal axis, or a sphere: the centrifugal torque is zero at every rate
    if (b.sign) keep(c / b);
    return count;
  }
  const Long half = b.scale(-1), discriminant = half * half - a * c;
  if (discriminant.sign < 0) return 0;  // too slow a spin: gravity wins at every rate
  const Long square_root = root(discriminant),
             q = half.sign < 0 ? half - square_root : half + square_root;
  if (!q.sign) {  // b = 0 and Mgl = 0: only a top that does not precess is regular
    roots[0] = roots[1] = 0.0;
    return 2;
  }
  keep(c / q);
  keep(q / a);
  if (count == 2 && std::fabs(roots[1]) < std::fabs(roots[0])) {
    const double slow = roots[1];
    roots[1] = roots[0];
    roots[0] = slow;
  }
  return count;
}

// Fills up what there is not.
inline void write_roots(const Long& a, const Long& b, const Long& c, double roots[2]) {
  for (int count = solve_quadratic(a, b, c, roots); count < 2; count++) roots[count] = NAN;
}

// cos(x) from n = 0 on, or sin(x)/x from n = 1 on, by the series, to 47 digits of 1. Horner's rule
// for last! times it, of which all coefficients are whole: one division, at the end.
inline Long sum_circular_series(const Long& x, int first) {
  const Long square = -(x * x);
  int last = first;
  for (double term = 1.0; term > 1e-52; term *= -square.to_double() / (last * (last - 1)))
    last += 2;
  Long coefficient(1.0), total(1.0);
  for (int n = last; n > first; n -= 2) {
    coefficient = coefficient * Long(double(n * (n - 1)));
    total = total * square + coefficient;
  }
  return total / coefficient;
}

// The cosine of a double. Zero if it is no more than EPS: no double is exactly pi/2, and the axis
// was meant to be horizontal.
inline Long find_long_cosine(double theta) {
  const Long total = sum_circular_series(Long(take_turns_off(theta)), 0);
  return size(total) <= Long(EPS) ? Long() : total;
}

// The sine of a number from 0 to pi, to 47 digits of itself: from the nearer end.
inline Long find_long_sine(const Long& x) {
  const Long rest = Long(find_long_turn().scale(-1)) - x, &nearer = rest < x ? rest : x;
  return nearer * sum_circular_series(nearer, 1);
}

// Regular rates phi' at a tilt, given psi' or omega_z.
inline void find_regular_rates(const symtop_top& top, double theta, double spin, symtop_hold hold,
                               double rates[2]) {
  const Long Ix(top.Ix), Iz(top.Iz);
  const Long transverse = hold == SYMTOP_SPIN_RATE ? Ix - Iz : Ix;
  write_roots(transverse * find_long_cosine(theta), Iz * Long(spin), Long(top.Mgl), rates);
}

struct TiltQuadratic {
  Precise a, b, Mgl;
  Precise a_terms, b_terms;  // sizes of the terms whose rounding a and b have

  // Of the cosine and the spin of a state or of an angle, and of the sizes of the terms that they
  // are sums of. Precise numbers: phi' of an axis next to the vertical has a square beyond all
  // doubles, and at a root the terms cancel.
  TiltQuadratic(const symtop_top& top, Pair cosine_of_terms, Pair spin_of_terms, symtop_hold hold)
      : Mgl(top.Mgl) {
    const double cosine = std::fabs(cosine_of_terms.x) <= EPS ? 0.0 : cosine_of_terms.x;
    const Precise moment(hold == SYMTOP_SPIN_MOMENTUM ? top.Ix : top.Ix - top.Iz), Iz(top.Iz);
    a = moment * Precise(cosine);
    a_terms = size(moment) * Precise(cosine_of_terms.y);
    b = Iz * Precise(spin_of_terms.x);
    b_terms = Iz * Precise(spin_of_terms.y);
  }

  Precise at(double rate) const {
    const Precise p(rate);
    return (a * p - b) * p + Mgl;
  }

  // at(after) - at(before), of which the sign decides Perry's rule. The difference of two values
  // would lose all digits for a small change of the rate, and Mgl would hide what is smaller than
  // its rounding. As a product it is right to rounding, and zero if its second factor is no more.
  Precise change(double before, double after) const {
    const Precise p(before), q(after), slope = a * (p + q) - b;
    const Precise largest = a_terms * (size(p) + size(q)) + b_terms;
    return size(slope) <= Precise(START_ROUNDING) * largest ? Precise() : (q - p) * slope;
  }

  // True if it vanishes at every rate: without weight and spin, where a is zero as well.
  bool is_nothing() const { return !a.sign && !b.sign && !Mgl.sign; }

  // True if the quadratic vanishes at a rate, up to rounding of its terms.
  bool is_balanced(double rate) const {
    const Precise p(std::fabs(rate)), terms = (a_terms * p + b_terms) * p + size(Mgl);
    return size(at(rate)) <= Precise(START_ROUNDING) * terms;
  }

  // Of the nearest doubles to a and b, as a state has no more digits.
  void find_roots(double roots[2]) const {
    write_roots(Long(a.to_double()), Long(b.to_double()), Long(Mgl), roots);
  }
};

// The parts of Ix theta''/sin(theta) for an observer who precesses with the top, in N m: gravity,
// and the Coriolis and the centrifugal torque about the line of nodes; and sin(theta), which they
// all have as a factor, and which is zero on the vertical.
inline void find_tilt_torques(const symtop_top& top, double theta, double phi_dot, double psi_dot,
                              double torques[4]) {
  const Pair tilt = find_tilt(theta, false);
  torques[0] = top.Mgl;
  torques[1] = -top.Iz * psi_dot * phi_dot;
  torques[2] = (top.Ix - top.Iz) * tilt.x * phi_dot * phi_dot;
  torques[3] = tilt.y;
}

}  // namespace symtop

// Tops with theta' = 0, compared with the same tops hurried: the points of a map of Perry's rule.
//
// With theta' = 0 the tilt is one turning angle. The cubic f(u) of (du/dt)^2 = f(u), u =
// cos(theta), then has the factor s = u - u0, and the other turning angle is a root of the
// quadratic that remains (derivation.md, "Perry's rule at the two roots"). So a point of a map
// needs neither elliptic functions nor the roots of a cubic.
#pragma once

#include "verdict.hpp"

namespace symtop {

// The one of two roots that is nearest to 0 on the side of a sign; 0 if neither is there.
inline double choose_root(double first, double second, double side) {
  double nearest = INFINITY;
  for (double root : {first, second})
    if (is_finite(root) && (side > 0 ? root > 0 : root < 0))
      nearest = std::fmin(nearest, std::fabs(root));
  return is_finite(nearest) ? std::copysign(nearest, side) : 0.0;
}

// The angle at which theta' vanishes again. f = s (f1 + f2 s + f3 s^2) is positive on the side of
// the sign of f1, up to the nearest root there. The roots are q/f3 and f1/q (Press et al.,
// Numerical Recipes, section 5.6): neither is a difference that cancels.
inline double find_other_turning_angle(const symtop_top& top, double theta, double phi_dot,
                                       double psi_dot) {
  const Pair tilt = find_tilt(theta, false), half = find_tilt(theta, true);
  const double fastest = std::fmax(std::fmax(std::fabs(phi_dot), std::fabs(psi_dot)),
                                   std::sqrt(std::fabs(top.Mgl) / top.Ix));
  // In this unit of time, a power of two, no product of rates overflows.
  const double unit = fastest > 0 ? std::ldexp(1.0, -std::ilogb(fastest) - 1) : 1.0;
  phi_dot *= unit;
  psi_dot *= unit;
  const double u = tilt.x, a = top.Iz / top.Ix * (psi_dot + phi_dot * u);  // Goldstein's a
  const double beta = 2 * (top.Mgl / top.Ix * unit) * unit;
  const double across = tilt.y * tilt.y;
  const double f1 = -across * (beta + 2 * phi_dot * (u * phi_dot - a));
  const double f2 = 2 * beta * u - across * phi_dot * phi_dot - a * a;
  const double root = std::sqrt(std::fmax(f2 * f2 - 4 * beta * f1, 0.0));
  const double q = -(f2 + std::copysign(root, f2)) / 2;
  const double s = f1 == 0 ? 0.0 : choose_root(f1 / q, q / beta, f1);
  // 1 - u and 1 + u of the other angle: the arc cosine of u would lose half the digits at a pole.
  const double below = std::fmax(2 * half.y * half.y - s, 0.0);
  const double above = std::fmax(2 * half.x * half.x + s, 0.0);
  return 2 * arc_tangent(std::sqrt(below), std::sqrt(above));
}

// Both other angles, and Perry's rule.
inline symtop_rule compare_hurried(const symtop_top& top, double theta, double phi_dot,
                                   double psi_dot, double factor, symtop_hold hold,
                                   double angles[2]) {
  const Pair tilt = find_tilt(theta, false);
  const bool holds_momentum = hold == SYMTOP_SPIN_MOMENTUM;
  const double spin = holds_momentum ? psi_dot + phi_dot * tilt.x : psi_dot;
  const double kicked = holds_momentum ? psi_dot - (factor - 1) * phi_dot * tilt.x : psi_dot;
  const double after = factor * phi_dot;
  angles[0] = find_other_turning_angle(top, theta, phi_dot, psi_dot);
  angles[1] = find_other_turning_angle(top, theta, after, kicked);
  if (tilt.y == 0) return SYMTOP_RULE_SAYS_NOTHING;  // on the vertical, where phi' is undefined
  const TiltQuadratic quadratic(top, {tilt.x, std::fabs(tilt.x)}, {spin, std::fabs(spin)}, hold);
  const int change = quadratic.change(phi_dot, after).sign;
  return judge_change({phi_dot, after, factor, false, top.Mgl != 0}, change);
}

}  // namespace symtop

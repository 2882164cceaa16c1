// The kind of a motion, by the sign of phi' at the two turning angles of theta (derivation.md,
// sections 8 and 14).
//
// Numbers that differ by rounding of the start alone count as equal: a start that is computed to
// lie on a root of regular precession is regular, although its doubles miss the root. A `Motion`
// here is one with weight (`ClosedForm`) or one without (`FreeMotion`): both have the numbers of
// nutation.hpp, and the same words.
#pragma once

#include "closed_form.hpp"

namespace symtop {

enum Kind {
  REGULAR,
  UNIDIRECTIONAL,
  CUSPS,
  LOOPING,
  THROUGH_THE_POLE,
  ASYMPTOTIC,
  SLEEPING,
  DRIVEN,
  CLAMPED
};

// The largest sin^2(theta) of a nutation: 1 if the axis becomes horizontal.
inline Precise find_largest_sine_squared(const Zero zeros[]) {
  const Zero &A = zeros[OF_A], &B = zeros[OF_B];
  const Precise one(1.0), below = A.from_u1 * B.from_u1, above = A.from_u2 * B.from_u2;
  if (A.from_u1 < one && one < A.from_u2) return one;
  return below > above ? below : above;
}

// A bound on the terms of b - a u = sin^2(theta) phi' during a nutation, in rad/s. A state of the
// motion is known to rounding of these, not to rounding of the terms at the start: they may all be
// small there, near a cusp.
template <class Motion>
inline Precise find_largest_precession(const Motion& motion) {
  const Precise sine_squared = find_largest_sine_squared(motion.zeros);
  return motion.find_largest_rate_across() * root(sine_squared) +
         size(motion.nutation.a) * sine_squared;
}

// True if theta' = theta'' = 0 at the start. The centrifugal term of theta'' is u |omega_xy|^2.
// Near the horizontal u is small, but its rounding is not: it is that of |A|^2 - |B|^2, some EPS of
// 1.
inline bool is_regular(const Nutation& n) {
  const Precise rounding(START_ROUNDING), sine_squared = n.one_plus_u * n.one_minus_u;
  const Precise& centrifugal = n.omega_xy_squared;
  const Precise gravity = (n.beta * sine_squared).scale(-1), spin = n.a * n.b_minus_au;
  const bool is_still =
      n.u_dot * n.u_dot <= rounding * rounding * n.omega_xy_squared * sine_squared;
  return is_still && size(n.u_dot_dot) <= rounding * (size(spin) + centrifugal + gravity);
}

// True if the axis passes the upper pole: b = a up to rounding, and the root next to the pole,
// which (1 - u2)(u3 - 1) = (b - a)^2/(beta (1 - u1)) has, is u2. Next to the separatrix both are,
// and rounding alone decides which is nearer: a state of an asymptotic motion is never quite on it.
inline bool passes_upper_pole(const ClosedForm& motion, const Precise& rounding) {
  const Zero& B = motion.zeros[OF_B];
  if (size(B.d) > rounding) return false;
  const Precise square = motion.nutation.beta * B.from_u1 * B.from_u2 * B.from_u2;
  return B.from_u2 <= B.from_u3 || square <= rounding * rounding;
}

// Of a motion whose axis moves under gravity.
inline Kind classify(const ClosedForm& motion) {
  const Nutation& n = motion.nutation;
  if (!motion.roots.s32.sign) return ASYMPTOTIC;
  if (is_regular(n)) return REGULAR;
  const Precise rounding = Precise(START_ROUNDING) * find_largest_precession(motion);
  if (size(motion.zeros[OF_A].d) <= rounding || passes_upper_pole(motion, rounding))
    return THROUGH_THE_POLE;
  const Precise lower = n.b_minus_au_at(motion.roots.s1), upper = n.b_minus_au_at(motion.roots.s2);
  if (size(lower) <= rounding || size(upper) <= rounding) return CUSPS;
  return (lower.sign > 0) == (upper.sign > 0) ? UNIDIRECTIONAL : LOOPING;
}

// Of a motion without a torque, whose axis moves on a circle about L at a constant |omega_xy|. phi'
// vanishes at no single turning angle, as there |b - a u| = sin(theta) |omega_xy|: there are no
// cusps. If both are rounding, omega_xy is that of an axis at rest. Else the circle encloses one
// pole, or L and no pole, or both: (b - a u1)(b - a u2) has the sign of (b - a)(b + a).
template <class Motion>
inline Kind classify_free(const Motion& motion) {
  const Nutation& n = motion.nutation;
  if (is_regular(n)) return REGULAR;
  const Precise rounding = Precise(START_ROUNDING) * find_largest_precession(motion);
  if (size(n.b_plus_a) <= rounding || size(n.b_minus_a) <= rounding) return THROUGH_THE_POLE;
  const Precise lower = n.b_minus_au_at(motion.roots.s1), upper = n.b_minus_au_at(motion.roots.s2);
  if (size(lower) <= rounding && size(upper) <= rounding) return REGULAR;
  return n.b_plus_a.sign == n.b_minus_a.sign ? UNIDIRECTIONAL : LOOPING;
}

}  // namespace symtop

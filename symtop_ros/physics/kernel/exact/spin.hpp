// Whether psi' takes both signs in a nutation, decided without sampling.
//
// With Goldstein's a and b (nutation.hpp) and the constant omega_z
//
//   sin^2(theta) psi' = h(u) = omega_z (1 - u^2) - u (b - a u),        u = cos(theta),
//
// which is quadratic in u. Its largest and smallest values between the turning points lie at the
// turning points, or at its vertex if that is between them. A psi' that differs from zero by
// rounding of the start alone has no sign: a top that is started with psi' = 0 at a turning point
// does not reverse there (derivation.md, section 14).
#pragma once

#include "kind.hpp"

namespace symtop {

// The least and the largest of some values: whether they have both signs, beyond rounding.
struct Range {
  Precise least, largest;

  explicit Range(const Precise& first) : least(first), largest(first) {}

  void add(const Precise& value) {
    if (value < least) least = value;
    if (largest < value) largest = value;
  }
  bool has_both_signs(const Precise& rounding) const {
    return least < -rounding && rounding < largest;
  }
};

// The value of h at its vertex, if that lies between the turning points. Next to the vertical h is
// as small as sin^2(theta), so the vertex is found by w = 1 - |u|, the height from the nearer pole:
//
//   h = -d + w (2 omega_z - a + d) - w^2 (omega_z - a),        d = b - a, or -(b + a) about u = -1.
//
// Nothing there is larger than its sum, but 2 omega_z - a, and that is formed as a product.
template <class Motion>
inline void add_vertex(const Motion& motion, Range& values) {
  const Start& s = motion.start;
  const Zero &A = motion.zeros[OF_A], &B = motion.zeros[OF_B];
  const Precise bend = find_turning_rate<3>(s), Ix(s.Ix);
  if (!bend.sign) return;  // a sphere, or no spin: h has no vertex
  const bool is_upper = B.from_u1 * B.from_u2 < A.from_u1 * A.from_u2;
  const Precise d = is_upper ? motion.nutation.b_minus_a : -motion.nutation.b_plus_a;
  const Precise slope = Precise(s.wz) * (Ix.scale(1) - Precise(s.Iz)) / Ix + d;
  const Precise w = (slope / bend).scale(-1);
  const Precise &low = is_upper ? B.from_u2 : A.from_u1, &high = is_upper ? B.from_u1 : A.from_u2;
  if (low < w && w < high) values.add((slope * w).scale(-1) - d);
}

template <class Motion>
inline bool spin_reverses(const Motion& motion) {
  const Nutation& n = motion.nutation;
  const Zero &A = motion.zeros[OF_A], &B = motion.zeros[OF_B];
  const Precise spin(motion.start.wz);
  const auto at = [&](const Precise& sine_squared, const Precise& s) {
    return spin * sine_squared - (n.u() + s) * n.b_minus_au_at(s);
  };
  Range values(at(A.from_u1 * B.from_u1, motion.roots.s1));
  values.add(at(A.from_u2 * B.from_u2, motion.roots.s2));
  add_vertex(motion, values);
  const Precise largest =
      size(spin) * find_largest_sine_squared(motion.zeros) + find_largest_precession(motion);
  return values.has_both_signs(Precise(START_ROUNDING) * largest);
}

}  // namespace symtop

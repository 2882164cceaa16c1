// Whether psi' takes both signs in a nutation, decided without sampling.
//
// With Goldstein's a and b (nutation.hpp) and the constant omega_z
//
//   sin^2(theta) psi' = h(u) = omega_z (1 - u^2) - u (b - a u),        u = cos(theta),
//
// which is quadratic in u. Its largest and smallest values between the turning points lie at the
// turning points, or at its vertex if that is between them. A psi' that differs from zero by rounding
// of the start alone has no sign: a top that is started with psi' = 0 at a turning point does not
// reverse there.
#pragma once

#include "kind.hpp"

namespace symtop {

// The least and the largest of some values: whether they have both signs, beyond rounding.
template <class T>
struct Range {
  T least, largest;

  explicit Range(const T& first) : least(first), largest(first) {}

  void add(const T& value) {
    if (value < least) least = value;
    if (largest < value) largest = value;
  }
  bool has_both_signs(const T& rounding) const { return least < -rounding && rounding < largest; }

  // The value at the vertex b/bend, if that lies between two heights.
  void add_vertex(const T& spin, const T& a, const T& b, const T& low, const T& high) {
    const T bend = (a - spin) + (a - spin);
    if (!(bend < T(0.0)) && !(T(0.0) < bend)) return;
    const T vertex = b / bend;
    if (low < vertex && vertex < high) add(spin - b * b / (bend + bend));
  }
};

inline bool spin_reverses(const ClosedForm& motion) {
  const Nutation& n = motion.nutation;
  const Roots& roots = motion.roots;
  const Zero &A = motion.zeros[OF_A], &B = motion.zeros[OF_B];
  const Precise spin(motion.start.wz), low = n.u() + roots.s1, high = n.u() + roots.s2;
  Range<Precise> values(spin * A.from_u1 * B.from_u1 - low * n.b_minus_au_at(roots.s1));
  values.add(spin * A.from_u2 * B.from_u2 - high * n.b_minus_au_at(roots.s2));
  values.add_vertex(spin, n.a, n.b_minus_au + n.a * n.u(), low, high);
  const Precise largest =
      size(spin) * find_largest_sine_squared(motion.zeros) + find_largest_precession(motion);
  return values.has_both_signs(Precise(START_ROUNDING) * largest);
}

// Without a torque the axis moves on a circle about L, at an angle `cone` from it. Next to the vertical
// h is as small as sin^2(theta), so the vertex is found by w = 1 - |u|, the height below that pole:
//
//   h = -d + w (2 omega_z - a + d) + w^2 (a - omega_z),        d = +-b - a, a product of sines.
inline bool spin_reverses_free(double tilt_of_momentum, double cone, double rate, double omega_z) {
  const double least = tilt_of_momentum - cone, most = tilt_of_momentum + cone;
  const Pair low = cosine_and_sine(least), far = cosine_and_sine(most);
  const Pair half_low = cosine_and_sine(least / 2), half_far = cosine_and_sine(most / 2);
  const Pair opening = cosine_and_sine(cone);
  const double across = rate * opening.y, a = rate * opening.x;
  Range<double> values(omega_z * (far.y * far.y) - far.x * across * far.y);
  values.add(omega_z * (low.y * low.y) + low.x * across * low.y);
  const bool is_upper = std::fabs(half_low.y * half_far.y) < std::fabs(half_low.x * half_far.x);
  const double first = is_upper ? half_low.y : half_low.x, last = is_upper ? half_far.y : half_far.x;
  const double d = -2 * rate * first * last;
  const double slope = (omega_z - a) + (omega_z + d), bend = 2 * (a - omega_z);
  const double w = -slope / bend, w_low = 2 * first * first, w_far = 2 * last * last;
  if (std::fmin(w_low, w_far) < w && w < std::fmax(w_low, w_far)) values.add(slope * w / 2 - d);
  const bool crosses = low.x * far.x <= 0;  // the horizontal, where sin(theta) is 1
  const double sine = crosses ? 1.0 : std::fmax(std::fabs(low.y), std::fabs(far.y));
  return values.has_both_signs(START_ROUNDING * sine *
                               (std::fabs(omega_z) * sine + std::fabs(across)));
}

}  // namespace symtop

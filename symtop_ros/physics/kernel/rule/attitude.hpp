// States of Euler angles z-x-z and their rates, and back.
//
// Only what a person gives or reads goes through angles: no state is computed by way of them, as
// phi and psi have no value where the axis is vertical.
#pragma once

#include "../exact/nutation.hpp"

namespace symtop {

// Beyond this many rad the rounding of x times 2/pi could miss the quarter turn: it has 26 bits.
const double LARGEST_ANGLE = 0x1p15;
// Between these limits, products of two moments, of a moment and the square of a rate, and their
// quotients are doubles; the square of anything smaller would underflow.
const double SMALLEST = 1e-100, LARGEST = 1e100;

// 2 pi with 1280 bits: those before the point of the largest double, and 256 after it.
typedef Float<20> Turns;
inline Turns find_long_turn() {
  static const uint64_t LIMBS[] = {
      0x9ed529077096966d, 0x1c62f356208552bb, 0x83655d23dca3ad96, 0x69163fa8fd24cf5f,
      0x98da48361c55d39a, 0xc2007cb8a163bf05, 0x49286651ece45b3d, 0xae9f24117c4b1fe6,
      0xee386bfb5a899fa5, 0x0bff5cb6f406b7ed, 0xf44c42e9a637ed6b, 0xe485b576625e7ec6,
      0x4fe1356d6d51c245, 0x302b0a6df25f1437, 0xef9519b3cd3a431b, 0x514a08798e3404dd,
      0x020bbea63b139b22, 0x29024e088a67cc74, 0xc4c6628b80dc1cd1, 0xc90fdaa22168c234};
  Turns turn;
  turn.sign = 1;
  turn.exponent = 3;
  std::memcpy(turn.limbs, LIMBS, sizeof LIMBS);
  return turn;
}

// The nearest whole number, away from zero from two: no multiple of an irrational number is a half.
template <int N>
Float<N> round_to_whole(const Float<N>& x) {
  Float<N> whole = size(x) + Float<N>(0.5);
  const int below = 64 * N - whole.exponent;  // bits after the point
  for (int i = 0; i < N && 64 * i < below; i++)
    whole.limbs[i] = below - 64 * i >= 64 ? 0 : whole.limbs[i] >> (below % 64) << (below % 64);
  if (whole.exponent <= 0) return Float<N>();
  whole.sign = x.sign;
  return whole;
}

// The angle without its whole turns, from -pi to pi, as right as the length of the result allows.
inline Turns take_turns_off(double angle) {
  const Turns x(angle), turn = find_long_turn();
  return x - round_to_whole(x / turn) * turn;
}

// Cosine and sine of an angle of any size: the library of the system has other last bits elsewhere.
inline Pair find_cosine_and_sine(double angle) {
  const bool is_large = std::fabs(angle) > LARGEST_ANGLE;
  return cosine_and_sine(is_large ? take_turns_off(angle).to_double() : angle);
}

// Cosine and sine of (a + b)/2. The halves are added, which no angle makes overflow. Knuth's
// two-sum finds what the sum has lost, up to half an EPS of it, and another rotation makes it good:
// below LARGEST_ANGLE its cosine is 1 to rounding.
inline Pair turn_by_half_sum(double a, double b) {
  const double x = a / 2, y = b / 2, total = x + y, part = total - x;
  const double lost = (x - (total - part)) + (y - part);
  const bool is_large = std::fabs(total) > LARGEST_ANGLE / 2;
  return multiply(find_cosine_and_sine(total),
                  is_large ? find_cosine_and_sine(lost) : Pair{1, lost});
}

// Cosine and sine of a tilt, or of half a tilt. A multiple of the double next to pi is the vertical
// itself: with the 1.2e-16 rad that are missing, a top that hangs at rest would be one that swings.
inline Pair find_tilt(double theta, bool is_half) {
  const double half_turns = round_to_integer(theta / PI);
  if (std::fabs(theta) > LARGEST_ANGLE || half_turns * PI != theta)
    return find_cosine_and_sine(is_half ? theta / 2 : theta);
  const int quarters = static_cast<int>(half_turns) * (is_half ? 1 : 2) & 3;
  const double COSINES[] = {1, 0, -1, 0};
  return {COSINES[quarters], COSINES[(quarters + 3) & 3]};
}

inline void flush_tiny(double* numbers, int count) {
  for (int i = 0; i < count; i++)
    if (std::fabs(numbers[i]) < SMALLEST) numbers[i] = 0.0;
}

// A = cos(theta/2) exp(i(phi + psi)/2) and B = sin(theta/2) exp(i(phi - psi)/2), and the angular
// velocity phi' z' + theta' (line of nodes) + psi' z in the body frame (derivation.md, section 1).
inline void find_state(const double angles[3], const double rates[3], double q[4],
                       double omega[3]) {
  const double phi = angles[0], theta = angles[1], psi = angles[2];
  const Pair sum = turn_by_half_sum(phi, psi), difference = turn_by_half_sum(phi, -psi);
  const Pair half = find_tilt(theta, true);
  q[0] = half.x * sum.x;
  q[1] = half.y * difference.x;
  q[2] = half.y * difference.y;
  q[3] = half.x * sum.y;
  const Pair tilt = find_tilt(theta, false), spin = find_cosine_and_sine(psi);
  omega[0] = rates[0] * tilt.y * spin.y + rates[1] * spin.x;
  omega[1] = rates[0] * tilt.y * spin.x - rates[1] * spin.y;
  omega[2] = rates[0] * tilt.x + rates[2];
  flush_tiny(q, 4);
  flush_tiny(omega, 3);
}

inline double wrap_angle(double angle) {
  return angle - 2 * PI * round_to_integer(angle / (2 * PI));
}

// phi, theta and psi of a unit quaternion, 0 <= theta <= pi; on the vertical phi counts as 0.
inline void find_angles(const double q[4], double angles[3]) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  // Of the two moduli, and not of cos(theta): an arc cosine loses half the digits of a small tilt.
  const double theta = 2 * arc_tangent(find_modulus({x, y}), find_modulus({w, z}));
  // (phi + psi)/2, (phi - psi)/2
  const double upper = arc_tangent(z, w), lower = arc_tangent(y, x);
  const bool is_upright = theta == 0, is_hanging = theta == PI;
  const double psi = is_upright ? 2 * upper : is_hanging ? -2 * lower : upper - lower;
  angles[0] = is_upright || is_hanging ? 0.0 : wrap_angle(upper + lower);
  angles[1] = theta;
  angles[2] = wrap_angle(psi);
}

// World z' in the body frame, of products of the quaternion: a small tilt keeps its digits.
struct Vertical {
  double x, y, z;

  explicit Vertical(const double q[4])
      : x(2 * (q[1] * q[3] - q[0] * q[2])),
        y(2 * (q[2] * q[3] + q[0] * q[1])),
        z((q[0] * q[0] + q[3] * q[3]) - (q[1] * q[1] + q[2] * q[2])) {}

  bool is_of_vertical_axis() const { return x == 0 && y == 0; }
  double find_sine() const { return find_modulus({x, y}); }
};

// phi' of an axis that is not vertical. Divided twice: the square of a sine below 1e-154 would
// underflow.
inline double find_precession_rate(const Vertical& g, const double omega[3]) {
  const double sine = g.find_sine();
  return (omega[0] * g.x + omega[1] * g.y) / sine / sine;
}

// phi', theta' and psi'. On the vertical phi' counts as 0, and theta' is the rate of the axis.
inline void find_angle_rates(const double q[4], const double omega[3], double rates[3]) {
  const Vertical g(q);
  const double sine = g.find_sine();
  if (sine > 0) {
    rates[0] = find_precession_rate(g, omega);
    rates[1] = (omega[0] * g.y - omega[1] * g.x) / sine;
  } else {
    rates[0] = 0.0;
    rates[1] = find_modulus({omega[0], omega[1]});
  }
  rates[2] = omega[2] - rates[0] * g.z;
}

}  // namespace symtop

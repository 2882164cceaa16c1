// Numbers of 57 decimal digits, for the constants of a motion, and how they enter doubles.
//
// A motion is set up once and evaluated often. Its constants are those of exactly the doubles that
// were given: no error grows with time, and exponents have no limit. So many digits serve phases of
// 1e15 turns next to the separatrix (design/digits.py).
#pragma once

#include "newton.hpp"

namespace symtop {

typedef Float<3> Precise;
typedef Float<37> Longest;  // 700 digits: see exact/mean_rates.hpp
typedef Float<24> Exact;    // sums of products of five doubles, without rounding: a Fraction

// A share below which the square is lost in rounding, but for some bits.
template <int N>
Float<N> half_of_digits(int spare) {
  return Float<N>(1.0).scale(spare - 32 * N);
}

constexpr Precise precise(uint64_t high, uint64_t middle, uint64_t low, int exponent) {
  Precise result;
  result.sign = 1;
  result.exponent = exponent;
  result.limbs[2] = high;
  result.limbs[1] = middle;
  result.limbs[0] = low;
  return result;
}

// 2 pi, 1/(2 pi) and ln(2).
constexpr Precise TWO_PI = precise(0xc90fdaa22168c234, 0xc4c6628b80dc1cd1, 0x29024e088a67cc74, 3);
constexpr Precise PER_TURN =
    precise(0xa2f9836e4e441529, 0xfc2757d1f534ddc0, 0xdb6295993c439041, -2);
constexpr Precise LN2 = precise(0xb17217f7d1cf79ab, 0xc9e3b39803f2f6af, 0x40f343267298b62d, 0);
// The same numbers as sums of two doubles, the first of 26 bits.
const double QUARTER_HIGH = 0x1.921fb50000000p+0;
const double QUARTER_LOW = 0x1.110b4611a6263p-26;
const double QUARTERS = 0x1.45f306dc9c883p-1;
const double LN2_HIGH = 0x1.62e42f8000000p-1;
const double LN2_LOW = 0x1.be8e7bcd5e4f2p-27;
const double DOUBLINGS = 0x1.71547652b82fep+0;

inline double rest_of(const Precise& x, double high) { return (x - Precise(high)).to_double(); }

// A number as a double of 26 bits and the rest: 24 digits together.
inline void split_short(const Precise& x, double& high, double& low) {
  int exponent;
  const double fraction = std::frexp(x.to_double(), &exponent);
  high = std::ldexp(std::floor(std::ldexp(fraction, 26)), exponent - 26);
  low = rest_of(x, high);
}

// exp(x) of a number x <= 0, as a double.
inline double exponential(const Precise& x) {
  const double doublings = round_to_integer(x.to_double() / 0.6931471805599453);
  if (doublings < -1000) return 0.0;
  const int HALVINGS = 16;
  const Precise y = (x - Precise(doublings) * LN2).scale(-HALVINGS);
  Precise term(1.0), sum(1.0);
  for (int n = 1; n < 16; n++) {
    term = term * y / Precise(double(n));
    sum = sum + term;
  }
  for (int n = 0; n < HALVINGS; n++) sum = sum * sum;
  return sum.scale(static_cast<int>(doublings)).to_double();
}

// Carlson's symmetric integral R_F(x, y, 1) to 34 digits. Each step of the duplication makes the
// arguments differ by a quarter of what they did (B. C. Carlson, Numer. Algorithms 10 (1995) 13,
// algorithm for R_F). The error of the last series is of the order of their sixth power.
inline Precise integrate_rf(Precise x, Precise y) {
  const Precise one(1.0), third = one / Precise(3.0);
  Precise z = one, mean, dx, dy;
  for (;;) {
    mean = (x + y + z) * third;
    const Precise inverse = invert(mean);
    dx = one - x * inverse;
    dy = one - y * inverse;
    const double largest =
        std::fmax(std::fmax(std::fabs(dx.to_double()), std::fabs(dy.to_double())),
                  std::fabs((dx + dy).to_double()));
    if (largest < 2e-6) break;
    const Precise rx = root(x), ry = root(y), rz = root(z);
    const Precise shift = rx * ry + rx * rz + ry * rz;
    x = (x + shift).scale(-2);
    y = (y + shift).scale(-2);
    z = (z + shift).scale(-2);
  }
  const Precise dz = -(dx + dy), e2 = dx * dy - dz * dz, e3 = dx * dy * dz;
  const Precise sum = one - e2 / Precise(10.0) + e3 / Precise(14.0) + e2 * e2 / Precise(24.0) -
                      Precise(3.0) * e2 * e3 / Precise(44.0);
  return sum / root(mean);
}

}  // namespace symtop

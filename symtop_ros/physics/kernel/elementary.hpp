// Elementary functions of doubles, the same to the last bit on every machine.
//
// Sums, products, quotients and square roots of doubles round in the same way on every machine if a
// compiler does not fuse them (-ffp-contract=off, arithmetic.hpp). The elementary functions of the
// C library do not: their last bit depends on the version and on the processor. Those here are made
// of sums, products and quotients alone. For the same reason complex numbers are pairs of reals.
#pragma once

#include "precise.hpp"

namespace symtop {

const double PI = 3.141592653589793;
const double PI_HIGH = 0x1.921fb54442d18p+1, PI_LOW = 0x1.1a62633145c07p-53;

template <class R>
struct PairOf {  // real and imaginary part, or a sum of two doubles
  R x, y;
};
typedef PairOf<double> Pair;

template <class R, class Q>
SYMTOP_INLINE auto multiply(PairOf<R> a, PairOf<Q> b) -> PairOf<decltype(a.x * b.x)> {
  return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
}

template <class R, class Q>
SYMTOP_INLINE auto multiply_by_conjugate(PairOf<R> a, PairOf<Q> b) -> PairOf<decltype(a.x * b.x)> {
  return {a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y};
}

inline Pair conjugate(Pair a) { return {a.x, -a.y}; }

// R. L. Smith, Comm. ACM 5 (1962) 435: no square of a component overflows.
inline Pair divide(Pair a, Pair b) {
  if (std::fabs(b.x) >= std::fabs(b.y)) {
    const double ratio = b.y / b.x, size = b.x + b.y * ratio;
    return {(a.x + a.y * ratio) / size, (a.y - a.x * ratio) / size};
  }
  const double ratio = b.x / b.y, size = b.x * ratio + b.y;
  return {(a.x * ratio + a.y) / size, (a.y * ratio - a.x) / size};
}

// Not the hypot of the C library, whose last bit depends on the version.
inline double find_modulus(Pair a) {
  const double x = std::fabs(a.x), y = std::fabs(a.y);
  const double large = x > y ? x : y, small = x > y ? y : x;
  if (large == 0) return 0.0;
  const double ratio = small / large;
  return large * std::sqrt(1.0 + ratio * ratio);
}

template <class R>
SYMTOP_INLINE PairOf<R> cosine_and_sine_near_0(R x, R rest) {
  static const double SINE[] = {
      1.0 / 355687428096000, -1.0 / 1307674368000, 1.0 / 6227020800, -1.0 / 39916800,
      1.0 / 362880,          -1.0 / 5040,          1.0 / 120,        -1.0 / 6};
  static const double VERSINE[] = {
      -1.0 / 20922789888000, 1.0 / 87178291200, -1.0 / 479001600, 1.0 / 3628800,
      -1.0 / 40320,          1.0 / 720,         -1.0 / 24,        1.0 / 2};
  const R square = x * x;
  R versine = VERSINE[0] * square, series = SINE[0] * square;
  for (int n = 1; n < 8; n++) {
    versine = (versine + VERSINE[n]) * square;
    series = (series + SINE[n]) * square;
  }
  return {1.0 - (versine + x * rest), x + (x * series + rest)};
}

// For |x| up to some thousand turns: quarter turns are subtracted in two parts, of which the
// product with the first is exact.
template <class R>
SYMTOP_INLINE PairOf<R> cosine_and_sine(R x) {
  const R quarters = round_to_integer(x * QUARTERS);
  const R part = x - quarters * QUARTER_HIGH, low = quarters * QUARTER_LOW;
  const R near = part - low;
  const PairOf<R> unit = cosine_and_sine_near_0<R>(near, (part - near) - low);
  const Integer<R> turns = count_of(quarters);
  const auto is_odd = (turns & 1) != 0;
  const R c = choose(is_odd, unit.y, unit.x), s = choose(is_odd, unit.x, unit.y);
  return {choose(((turns + 1) & 2) != 0, -c, c), choose((turns & 2) != 0, -s, s)};
}

const double LEAST_EXPONENT = -708.0;  // below, exp(x) is no normal double; it counts as zero

// A power of two, and p with exp(x) = power (1 + p): exp(x) - 1 needs both apart.
template <class R>
SYMTOP_INLINE PairOf<R> expand_exponential(R x) {
  static const double SERIES[] = {1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800,
                                  1.0 / 362880,     1.0 / 40320,     1.0 / 5040,     1.0 / 720,
                                  1.0 / 120,        1.0 / 24,        1.0 / 6,        1.0 / 2};
  const R bounded = choose(x > LEAST_EXPONENT, x, repeat<R>(LEAST_EXPONENT));
  const R doublings = round_to_integer(bounded * DOUBLINGS);
  const R y = (bounded - doublings * LN2_HIGH) - doublings * LN2_LOW;
  R series = SERIES[0] * y;
  for (int n = 1; n < 12; n++) series = (series + SERIES[n]) * y;
  const R power = read_bits_as<R>((count_of(doublings) + 1023) << 52);
  return {choose(x < LEAST_EXPONENT, R{}, power), y + y * series};
}

template <class R>
SYMTOP_INLINE R exponential(R x) {
  const PairOf<R> e = expand_exponential(x);
  return e.x + e.x * e.y;
}

template <class R>
SYMTOP_INLINE R exponential_minus_1(R x) {
  const PairOf<R> e = expand_exponential(x);
  return (e.x - 1.0) + e.x * e.y;
}

// Arc tangents of 0 to 8 eighths, as sums of two doubles.
const double EIGHTHS_OF_TANGENT[9][2] = {
    {0.0, 0.0},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
};
const double HALF_PI_HIGH = 0x1.921fb54442d18p+0, HALF_PI_LOW = 0x1.1a62633145c07p-54;

// The angle of the point (x, y) in rad, from -pi to pi, right to 1 EPS of itself. The ratio of the
// smaller coordinate to the larger one is turned back by the nearest of nine angles, of which the
// tangents are eighths; the Taylor series of what is left has the sixteenth part of the argument at
// most (DLMF 4.24.3). Signs of zero are those of atan2.
inline double arc_tangent(double y, double x) {
  static const double SERIES[] = {-1.0 / 15, 1.0 / 13, -1.0 / 11, 1.0 / 9,
                                  -1.0 / 7,  1.0 / 5,  -1.0 / 3};
  const double height = std::fabs(y), width = std::fabs(x);
  const double large = height > width ? height : width, small = height > width ? width : height;
  const double ratio = large > 0 ? small / large : 0.0, place = round_to_integer(8.0 * ratio);
  const double nearest = place * 0.125, z = (ratio - nearest) / (1.0 + ratio * nearest);
  const double square = z * z;
  double series = SERIES[0] * square;
  for (int n = 1; n < 7; n++) series = (series + SERIES[n]) * square;
  const double* eighth = EIGHTHS_OF_TANGENT[static_cast<int>(place)];
  double angle = eighth[0] + ((z + z * series) + eighth[1]);
  if (height > width)
    angle = (HALF_PI_HIGH - std::copysign(angle, x)) + HALF_PI_LOW;
  else if (std::signbit(x))
    angle = (PI - angle) + PI_LOW;
  return std::copysign(angle, y);
}

// R_F(x, y, 1) in doubles; infinite for x = y = 0, when both have underflowed. The series is that
// of DLMF 19.36.1 up to the seventh power.
inline double integrate_rf_in_doubles(double x, double y) {
  if (x == 0 && y == 0) return INFINITY;
  double z = 1.0, mean, dx, dy;
  for (;;) {
    mean = (x + y + z) / 3;
    dx = (mean - x) / mean;
    dy = (mean - y) / mean;
    if (std::fmax(std::fmax(std::fabs(dx), std::fabs(dy)), std::fabs(dx + dy)) < 0.006) break;
    const double rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z);
    const double shift = rx * ry + rx * rz + ry * rz;
    x = (x + shift) / 4;
    y = (y + shift) / 4;
    z = (z + shift) / 4;
  }
  const double dz = -(dx + dy), e2 = dx * dy - dz * dz, e3 = dx * dy * dz;
  const double square = e2 * e2, cube = e3 * e3;
  const double high = square / 24 - 3 * e2 * e3 / 44 - 5 * square * e2 / 208 + 3 * cube / 104;
  return (1 + (-e2 / 10 + e3 / 14 + (high + square * e3 / 16))) / std::sqrt(mean);
}

// The complete elliptic integral K from the complementary modulus sqrt(1 - m): pi/2 divided by the
// arithmetic-geometric mean of 1 and it (DLMF 19.8.5). In terms of m it would lose its digits
// towards m = 1. Convergence is quadratic: after a gap of 1e-8 the next mean is right to rounding.
inline double quarter_period(double modulus) {
  if (modulus == 0) return INFINITY;
  double a = 1.0, b = modulus;
  while (a - b > 1e-8 * a) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return PI / (a + b);
}

}  // namespace symtop

// Numbers of the kernel: floats of many bits, double-double, and elementary functions of doubles.
//
// Sums, products, quotients and square roots of doubles round in the same way on every machine if a
// compiler does not fuse them (-ffp-contract=off). Everything here is made of those, in the same
// order as in Python: symtop_ros/physics/exact/elementary.py and precise.py.
#pragma once

#include "lanes.hpp"

namespace symtop {

typedef unsigned __int128 Wide;

// ---- Floats of N limbs of 64 bits ---------------------------------------------------------------
//
// The value is sign * 0.mantissa * 2^exponent. Results are truncated. Three limbs have 57 decimal
// digits, which is more than the 50 of the context PRECISE of precise.py.

template <int N>
struct Float {
  int sign = 0;
  int exponent = 0;
  uint64_t limbs[N] = {};  // the lowest one first; the highest bit is set unless the sign is 0

  Float() = default;

  Float(double x) {
    if (x == 0) return;
    sign = x < 0 ? -1 : 1;
    uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    const int stored = (bits >> 52) & 0x7ff;
    if (stored && stored != 0x7ff) {
      exponent = stored - 1022;
      limbs[N - 1] = (bits & 0xfffffffffffff) << 11 | uint64_t(1) << 63;
    } else {  // below the normal doubles
      const double fraction = std::frexp(std::fabs(x), &exponent);
      limbs[N - 1] = static_cast<uint64_t>(std::ldexp(fraction, 53)) << 11;
    }
  }

  // The same number with another length: truncated, or filled with zeros.
  template <int M>
  explicit Float(const Float<M>& x) : sign(x.sign), exponent(x.exponent) {
    for (int i = 0; i < N; i++) limbs[i] = M - N + i >= 0 ? x.limbs[M - N + i] : 0;
  }

  // The nearest double; the even one of two.
  double to_double() const {
    if (!sign) return 0.0;
    bool is_more = false;
    for (int i = 0; i < N - 1; i++) is_more |= limbs[i] != 0;
    const uint64_t top = limbs[N - 1], below = top & 2047;
    uint64_t mantissa = top >> 11;
    if (below > 1024 || (below == 1024 && (is_more || (mantissa & 1)))) mantissa++;
    const double size = sign * static_cast<double>(mantissa);
    if (exponent < -900 || exponent > 1000) return std::ldexp(size, exponent - 53);
    const uint64_t bits = static_cast<uint64_t>(exponent - 53 + 1023) << 52;
    double power;
    std::memcpy(&power, &bits, sizeof power);
    return size * power;
  }

  // This times 2^power.
  Float scale(int power) const {
    Float result = *this;
    result.exponent += power;
    return result;
  }

  Float operator-() const {
    Float result = *this;
    result.sign = -sign;
    return result;
  }
};

template <int N>
int compare_sizes(const Float<N>& a, const Float<N>& b) {
  if (!a.sign || !b.sign) return (a.sign != 0) - (b.sign != 0);
  if (a.exponent != b.exponent) return a.exponent < b.exponent ? -1 : 1;
  for (int i = N - 1; i >= 0; i--)
    if (a.limbs[i] != b.limbs[i]) return a.limbs[i] < b.limbs[i] ? -1 : 1;
  return 0;
}

template <int N>
int compare(const Float<N>& a, const Float<N>& b) {
  return a.sign != b.sign ? (a.sign < b.sign ? -1 : 1) : a.sign * compare_sizes(a, b);
}

template <int N>
Float<N> operator*(const Float<N>& a, const Float<N>& b) {
  Float<N> result;
  result.sign = a.sign * b.sign;
  if (!result.sign) return result;
  uint64_t product[2 * N] = {};
  for (int i = 0; i < N; i++) {
    if (!a.limbs[i]) continue;  // doubles have many limbs of zero
    uint64_t carry = 0;
    for (int j = 0; j < N; j++) {
      const Wide sum = static_cast<Wide>(a.limbs[i]) * b.limbs[j] + product[i + j] + carry;
      product[i + j] = static_cast<uint64_t>(sum);
      carry = static_cast<uint64_t>(sum >> 64);
    }
    product[i + N] = carry;
  }
  result.exponent = a.exponent + b.exponent;
  const bool is_full = product[2 * N - 1] >> 63;
  for (int i = 0; i < N; i++)
    result.limbs[i] =
        is_full ? product[N + i] : product[N + i] << 1 | product[N + i - 1] >> 63;
  if (!is_full) result.exponent--;
  return result;
}

// The same for three limbs, from six of the nine products: those left out are below the last bit.
inline Float<3> operator*(const Float<3>& a, const Float<3>& b) {
  Float<3> result;
  result.sign = a.sign * b.sign;
  if (!result.sign) return result;
  const Wide a0b2 = static_cast<Wide>(a.limbs[0]) * b.limbs[2];
  const Wide a1b1 = static_cast<Wide>(a.limbs[1]) * b.limbs[1];
  const Wide a2b0 = static_cast<Wide>(a.limbs[2]) * b.limbs[0];
  const Wide a1b2 = static_cast<Wide>(a.limbs[1]) * b.limbs[2];
  const Wide a2b1 = static_cast<Wide>(a.limbs[2]) * b.limbs[1];
  const Wide a2b2 = static_cast<Wide>(a.limbs[2]) * b.limbs[2];
  const auto low = [](Wide x) { return static_cast<Wide>(static_cast<uint64_t>(x)); };
  const Wide second = low(a0b2) + low(a1b1) + low(a2b0);
  const Wide third = (second >> 64) + (a0b2 >> 64) + (a1b1 >> 64) + (a2b0 >> 64) + low(a1b2) +
                     low(a2b1);
  const Wide fourth = (third >> 64) + (a1b2 >> 64) + (a2b1 >> 64) + low(a2b2);
  const uint64_t p2 = static_cast<uint64_t>(second), p3 = static_cast<uint64_t>(third);
  const uint64_t p4 = static_cast<uint64_t>(fourth);
  const uint64_t p5 = static_cast<uint64_t>((fourth >> 64) + (a2b2 >> 64));
  result.exponent = a.exponent + b.exponent;
  if (p5 >> 63) {
    result.limbs[0] = p3, result.limbs[1] = p4, result.limbs[2] = p5;
  } else {
    result.limbs[0] = p3 << 1 | p2 >> 63, result.limbs[1] = p4 << 1 | p3 >> 63;
    result.limbs[2] = p5 << 1 | p4 >> 63;
    result.exponent--;
  }
  return result;
}

// Shift the N + 1 limbs of a sum or a difference until the highest bit is set.
template <int N>
void normalize(uint64_t* limbs, Float<N>& result) {
  int top = N;
  while (top >= 0 && !limbs[top]) top--;
  if (top < 0) {
    result.sign = result.exponent = 0;
    return;
  }
  const int places = N - top, bits = __builtin_clzll(limbs[top]);
  for (int i = N; i >= 0; i--) {
    const uint64_t upper = i >= places ? limbs[i - places] : 0;
    const uint64_t lower = i >= places + 1 ? limbs[i - places - 1] : 0;
    limbs[i] = bits ? upper << bits | lower >> (64 - bits) : upper;
  }
  result.exponent -= 64 * places + bits;
  std::memcpy(result.limbs, limbs + 1, sizeof result.limbs);
}

template <int N>
Float<N> operator+(const Float<N>& x, const Float<N>& y) {
  if (!x.sign) return y;
  if (!y.sign) return x;
  const bool is_first = compare_sizes(x, y) >= 0;
  const Float<N>&a = is_first ? x : y, &b = is_first ? y : x;
  const int distance = a.exponent - b.exponent;
  if (distance >= 64 * N + 2) return a;
  // One more limb below, so that a bit that is lost in the shift is no bit of the result. The smaller
  // number lies between limbs of zero, of which the shift is a choice.
  uint64_t large[N + 1] = {}, small[N + 1], between[2 * N + 3] = {};
  std::memcpy(large + 1, a.limbs, sizeof a.limbs);
  std::memcpy(between + 1, b.limbs, sizeof b.limbs);
  const int places = distance / 64, bits = distance % 64;
  for (int i = 0; i <= N; i++) {
    const Wide both = static_cast<Wide>(between[i + places + 1]) << 64 | between[i + places];
    small[i] = static_cast<uint64_t>(both >> bits);
  }
  Float<N> result;
  result.sign = a.sign;
  result.exponent = a.exponent;
  if (a.sign == b.sign) {
    uint64_t carry = 0;
    for (int i = 0; i <= N; i++) {
      const Wide sum = static_cast<Wide>(large[i]) + small[i] + carry;
      large[i] = static_cast<uint64_t>(sum);
      carry = static_cast<uint64_t>(sum >> 64);
    }
    if (carry) {
      for (int i = 0; i < N; i++) large[i] = large[i] >> 1 | large[i + 1] << 63;
      large[N] = large[N] >> 1 | uint64_t(1) << 63;
      result.exponent++;
    }
    std::memcpy(result.limbs, large + 1, sizeof result.limbs);
    return result;
  } else {
    uint64_t borrow = 0;
    for (int i = 0; i <= N; i++) {
      const Wide difference = static_cast<Wide>(large[i]) - small[i] - borrow;
      large[i] = static_cast<uint64_t>(difference);
      borrow = (difference >> 64) != 0;
    }
  }
  normalize(large, result);
  return result;
}

// The same for three limbs, in two halves of 128 bits, of which the lowest 64 are the guard limb.
inline Float<3> operator+(const Float<3>& x, const Float<3>& y) {
  if (!x.sign) return y;
  if (!y.sign) return x;
  const auto upper = [](const Float<3>& f) { return static_cast<Wide>(f.limbs[2]) << 64 | f.limbs[1]; };
  const auto lower = [](const Float<3>& f) { return static_cast<Wide>(f.limbs[0]) << 64; };
  const Wide upper_x = upper(x), upper_y = upper(y);
  const bool is_first =
      x.exponent != y.exponent
          ? x.exponent > y.exponent
          : upper_x != upper_y ? upper_x > upper_y : x.limbs[0] >= y.limbs[0];
  const Float<3>&a = is_first ? x : y, &b = is_first ? y : x;
  const int distance = a.exponent - b.exponent;
  if (distance >= 194) return a;
  Wide high = is_first ? upper_x : upper_y, low = lower(a);
  Wide small_high = is_first ? upper_y : upper_x, small_low = lower(b);
  if (distance >= 128) {
    small_low = small_high >> (distance - 128);
    small_high = 0;
  } else if (distance) {
    small_low = small_low >> distance | small_high << (128 - distance);
    small_high >>= distance;
  }
  Float<3> result;
  result.sign = a.sign;
  result.exponent = a.exponent;
  if (a.sign == b.sign) {
    low += small_low;
    const Wide carry = low < small_low, total = high + small_high, sum = total + carry;
    if (total < high || sum < total) {
      low = low >> 1 | sum << 127;
      high = sum >> 1 | static_cast<Wide>(1) << 127;
      result.exponent++;
    } else {
      high = sum;
    }
  } else {
    const Wide borrow = low < small_low;
    low -= small_low;
    high = high - small_high - borrow;
    if (!high) {
      if (!low) return Float<3>();
      high = low, low = 0;
      result.exponent -= 128;
    }
    const uint64_t top = static_cast<uint64_t>(high >> 64);
    const int bits = top ? __builtin_clzll(top)
                         : 64 + __builtin_clzll(static_cast<uint64_t>(high));
    if (bits) {
      high = high << bits | low >> (128 - bits);
      low <<= bits;
      result.exponent -= bits;
    }
  }
  result.limbs[2] = static_cast<uint64_t>(high >> 64);
  result.limbs[1] = static_cast<uint64_t>(high);
  result.limbs[0] = static_cast<uint64_t>(low >> 64);
  return result;
}

template <int N>
Float<N> operator-(const Float<N>& a, const Float<N>& b) {
  return a + -b;
}

// The first 106 bits of a mantissa, as a sum of two doubles.
inline void split_mantissa(const Float<3>& a, double& high, double& low) {
  const uint64_t top = a.limbs[2];
  high = static_cast<double>(top >> 11) * 0x1p-53;
  low = static_cast<double>((top & 2047) << 42 | a.limbs[1] >> 22) * 0x1p-106;
}

// The reciprocal by Newton's method, from a double; each step doubles the digits. The first step is
// made in doubles: what is left of 1 is formed without rounding.
inline Float<3> invert(const Float<3>& a) {
  Float<3> mantissa = a;
  mantissa.exponent = 0;
  mantissa.sign = 1;
  double high, low;
  split_mantissa(a, high, low);
  const double estimate = 1.0 / high;
  const double rest = __builtin_fma(-high, estimate, 1.0) - low * estimate;
  const Float<3> first = Float<3>(estimate) + Float<3>(estimate * rest);
  const Float<2> error(Float<3>(1.0) - mantissa * first);
  Float<3> result = first + Float<3>(Float<2>(first) * error);
  result.exponent -= a.exponent;
  result.sign = a.sign;
  return result;
}

inline Float<3> operator/(const Float<3>& a, const Float<3>& b) { return a * invert(b); }

// The square root, from the reciprocal of the root, as above.
inline Float<3> root(const Float<3>& a) {
  if (a.sign <= 0) return Float<3>();
  Float<3> mantissa = a;
  const int odd = a.exponent & 1;
  mantissa.exponent = odd;
  double high, low;
  split_mantissa(a, high, low);
  if (odd) high *= 2, low *= 2;
  const double inverse = 1.0 / std::sqrt(high);
  const double square = inverse * inverse, below = __builtin_fma(inverse, inverse, -square);
  const double product = high * square, lost = __builtin_fma(high, square, -product);
  const double rest = (1.0 - product) - lost - high * below - low * square;
  const Float<3> first = Float<3>(inverse) + Float<3>(inverse * (0.5 * rest));
  // The root itself is corrected, by half of what its square lacks.
  const Float<3> estimate = mantissa * first;
  const Float<2> lacking(mantissa - estimate * estimate);
  const Float<3> result = estimate + Float<3>((lacking * Float<2>(first)).scale(-1));
  return result.scale((a.exponent - odd) / 2);
}

template <int N>
Float<N> size(const Float<N>& a) {
  return a.sign < 0 ? -a : a;
}

template <int N>
bool operator<(const Float<N>& a, const Float<N>& b) { return compare(a, b) < 0; }
template <int N>
bool operator<=(const Float<N>& a, const Float<N>& b) { return compare(a, b) <= 0; }
template <int N>
bool operator>(const Float<N>& a, const Float<N>& b) { return compare(a, b) > 0; }
template <int N>
bool operator>=(const Float<N>& a, const Float<N>& b) { return compare(a, b) >= 0; }

typedef Float<3> Precise;  // a Decimal of precise.py
typedef Float<24> Exact;   // sums of products of five doubles, without rounding: a Fraction

inline Precise precise(uint64_t high, uint64_t middle, uint64_t low, int exponent) {
  Precise result;
  result.sign = 1;
  result.exponent = exponent;
  result.limbs[2] = high, result.limbs[1] = middle, result.limbs[0] = low;
  return result;
}

// TWO_PI, PER_TURN of phases.py, and ln(2); a test compares them with those of Python.
const Precise TWO_PI = precise(0xc90fdaa22168c234, 0xc4c6628b80dc1cd1, 0x29024e088a67cc74, 3);
const Precise PER_TURN = precise(0xa2f9836e4e441529, 0xfc2757d1f534ddc0, 0xdb6295993c439041, -2);
const Precise LN2 = precise(0xb17217f7d1cf79ab, 0xc9e3b39803f2f6af, 0x40f343267298b62d, 0);
// The same numbers as sums of two doubles, the first of 26 bits.
const double QUARTER_HIGH = 0x1.921fb50000000p+0;
const double QUARTER_LOW = 0x1.110b4611a6263p-26;
const double QUARTERS = 0x1.45f306dc9c883p-1;
const double LN2_HIGH = 0x1.62e42f8000000p-1;
const double LN2_LOW = 0x1.be8e7bcd5e4f2p-27;
const double DOUBLINGS = 0x1.71547652b82fep+0;

inline double rest_of(const Precise& x, double high) { return (x - Precise(high)).to_double(); }

// split_short
inline void split_short(const Precise& x, double& high, double& low) {
  int exponent;
  const double fraction = std::frexp(x.to_double(), &exponent);
  high = std::ldexp(std::floor(std::ldexp(fraction, 26)), exponent - 26);
  low = rest_of(x, high);
}

// exp(x) of a number x <= 0, as a double: Decimal.exp()
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

// integrate_rf
inline Precise integrate_rf(Precise x, Precise y) {
  const Precise one(1.0), third = one / Precise(3.0);
  Precise z = one, mean, dx, dy;
  for (;;) {
    mean = (x + y + z) * third;
    const Precise inverse = invert(mean);
    dx = one - x * inverse, dy = one - y * inverse;
    const double largest = std::fmax(std::fmax(std::fabs(dx.to_double()), std::fabs(dy.to_double())),
                                     std::fabs((dx + dy).to_double()));
    if (largest < 2e-6) break;
    const Precise rx = root(x), ry = root(y), rz = root(z);
    const Precise shift = rx * ry + rx * rz + ry * rz;
    x = (x + shift).scale(-2), y = (y + shift).scale(-2), z = (z + shift).scale(-2);
  }
  const Precise dz = -(dx + dy), e2 = dx * dy - dz * dz, e3 = dx * dy * dz;
  const Precise sum = one - e2 / Precise(10.0) + e3 / Precise(14.0) + e2 * e2 / Precise(24.0) -
                      Precise(3.0) * e2 * e3 / Precise(44.0);
  return sum / root(mean);
}

// ---- Elementary functions of doubles: elementary.py ---------------------------------------------

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

inline Pair divide(Pair a, Pair b) {
  if (std::fabs(b.x) >= std::fabs(b.y)) {
    const double ratio = b.y / b.x, size = b.x + b.y * ratio;
    return {(a.x + a.y * ratio) / size, (a.y - a.x * ratio) / size};
  }
  const double ratio = b.x / b.y, size = b.x * ratio + b.y;
  return {(a.x * ratio + a.y) / size, (a.y * ratio - a.x) / size};
}

inline double find_modulus(Pair a) {
  const double x = std::fabs(a.x), y = std::fabs(a.y);
  const double large = x > y ? x : y, small = x > y ? y : x;
  if (large == 0) return 0.0;
  const double ratio = small / large;
  return large * std::sqrt(1.0 + ratio * ratio);
}

template <class R>
SYMTOP_INLINE PairOf<R> cosine_and_sine_near_0(R x, R rest) {
  static const double SINE[] = {1.0 / 355687428096000, -1.0 / 1307674368000, 1.0 / 6227020800,
                                -1.0 / 39916800, 1.0 / 362880, -1.0 / 5040, 1.0 / 120, -1.0 / 6};
  static const double VERSINE[] = {-1.0 / 20922789888000, 1.0 / 87178291200, -1.0 / 479001600,
                                   1.0 / 3628800, -1.0 / 40320, 1.0 / 720, -1.0 / 24, 1.0 / 2};
  const R square = x * x;
  R versine = VERSINE[0] * square, series = SINE[0] * square;
  for (int n = 1; n < 8; n++) {
    versine = (versine + VERSINE[n]) * square;
    series = (series + SINE[n]) * square;
  }
  return {1.0 - (versine + x * rest), x + (x * series + rest)};
}

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

const double LEAST_EXPONENT = -708.0;

// expand_exponential: a power of two, and p with exp(x) = power (1 + p)
template <class R>
SYMTOP_INLINE PairOf<R> expand_exponential(R x) {
  static const double SERIES[] = {1.0 / 6227020800, 1.0 / 479001600, 1.0 / 39916800, 1.0 / 3628800,
                                  1.0 / 362880, 1.0 / 40320, 1.0 / 5040, 1.0 / 720, 1.0 / 120,
                                  1.0 / 24, 1.0 / 6, 1.0 / 2};
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

inline double integrate_rf_in_doubles(double x, double y) {
  if (x == 0 && y == 0) return INFINITY;
  double z = 1.0, mean, dx, dy;
  for (;;) {
    mean = (x + y + z) / 3;
    dx = (mean - x) / mean, dy = (mean - y) / mean;
    if (std::fmax(std::fmax(std::fabs(dx), std::fabs(dy)), std::fabs(dx + dy)) < 0.006) break;
    const double rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z);
    const double shift = rx * ry + rx * rz + ry * rz;
    x = (x + shift) / 4, y = (y + shift) / 4, z = (z + shift) / 4;
  }
  const double dz = -(dx + dy), e2 = dx * dy - dz * dz, e3 = dx * dy * dz;
  const double square = e2 * e2, cube = e3 * e3;
  const double high = square / 24 - 3 * e2 * e3 / 44 - 5 * square * e2 / 208 + 3 * cube / 104;
  return (1 + (-e2 / 10 + e3 / 14 + (high + square * e3 / 16))) / std::sqrt(mean);
}

// quarter_period of nutation_phase.py
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

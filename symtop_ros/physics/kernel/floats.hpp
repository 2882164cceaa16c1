// Floats of N limbs of 64 bits.
//
// The value is sign * 0.mantissa * 2^exponent. Results are truncated.
#pragma once

#include "lanes.hpp"

// Sums and products are calls in WebAssembly: inlined they would make a module twice as large. The
// compiler of a graphics processor would inline and unroll all of a set-up, and never come to an
// end.
#if defined(__wasm__) || defined(__CUDACC__)
#define SYMTOP_CALL __attribute__((noinline))
#else
#define SYMTOP_CALL
#endif
#ifdef __CUDACC__
#define SYMTOP_SET_UP __attribute__((noinline))
#define SYMTOP_ROLLED _Pragma("unroll 1")
#else
#define SYMTOP_SET_UP
#define SYMTOP_ROLLED
#endif

namespace symtop {

typedef unsigned __int128 Wide;

template <int N>
struct Float {
  int sign = 0;
  int exponent = 0;
  uint64_t limbs[N] = {};  // the lowest one first; the highest bit is set unless the sign is 0

  Float() = default;

  SYMTOP_CALL Float(double x) {
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
  SYMTOP_CALL double to_double() const {
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
SYMTOP_CALL int compare(const Float<N>& a, const Float<N>& b) {
  return a.sign != b.sign ? (a.sign < b.sign ? -1 : 1) : a.sign * compare_sizes(a, b);
}

template <int N>
SYMTOP_SET_UP Float<N> operator*(const Float<N>& a, const Float<N>& b) {
  Float<N> result;
  result.sign = a.sign * b.sign;
  if (!result.sign) return result;
  uint64_t product[2 * N] = {};
  SYMTOP_ROLLED
  for (int i = 0; i < N; i++) {
    if (!a.limbs[i]) continue;  // doubles have many limbs of zero
    uint64_t carry = 0;
    SYMTOP_ROLLED
    for (int j = 0; j < N; j++) {
      const Wide sum = static_cast<Wide>(a.limbs[i]) * b.limbs[j] + product[i + j] + carry;
      product[i + j] = static_cast<uint64_t>(sum);
      carry = static_cast<uint64_t>(sum >> 64);
    }
    product[i + N] = carry;
  }
  result.exponent = a.exponent + b.exponent;
  const bool is_full = product[2 * N - 1] >> 63;
  SYMTOP_ROLLED
  for (int i = 0; i < N; i++)
    result.limbs[i] = is_full ? product[N + i] : product[N + i] << 1 | product[N + i - 1] >> 63;
  if (!is_full) result.exponent--;
  return result;
}

// The same for three limbs, from six of the nine products. Two of those left out reach a last bit
// each, or two of a product that is shifted.
SYMTOP_CALL inline Float<3> operator*(const Float<3>& a, const Float<3>& b) {
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
  const Wide third =
      (second >> 64) + (a0b2 >> 64) + (a1b1 >> 64) + (a2b0 >> 64) + low(a1b2) + low(a2b1);
  const Wide fourth = (third >> 64) + (a1b2 >> 64) + (a2b1 >> 64) + low(a2b2);
  const uint64_t p2 = static_cast<uint64_t>(second), p3 = static_cast<uint64_t>(third);
  const uint64_t p4 = static_cast<uint64_t>(fourth);
  const uint64_t p5 = static_cast<uint64_t>((fourth >> 64) + (a2b2 >> 64));
  result.exponent = a.exponent + b.exponent;
  if (p5 >> 63) {
    result.limbs[0] = p3;
    result.limbs[1] = p4;
    result.limbs[2] = p5;
  } else {
    result.limbs[0] = p3 << 1 | p2 >> 63;
    result.limbs[1] = p4 << 1 | p3 >> 63;
    result.limbs[2] = p5 << 1 | p4 >> 63;
    result.exponent--;
  }
  return result;
}

// Shift the N + 1 limbs of a sum or a difference until the highest bit is set.
template <int N>
SYMTOP_SET_UP void normalize(uint64_t* limbs, Float<N>& result) {
  int top = N;
  while (top >= 0 && !limbs[top]) top--;
  if (top < 0) {
    result.sign = result.exponent = 0;
    return;
  }
  const int places = N - top, bits = __builtin_clzll(limbs[top]);
  SYMTOP_ROLLED
  for (int i = N; i > 0; i--) {  // the lowest is no part of the result
    const uint64_t upper = i >= places ? limbs[i - places] : 0;
    const uint64_t lower = i >= places + 1 ? limbs[i - places - 1] : 0;
    limbs[i] = bits ? upper << bits | lower >> (64 - bits) : upper;
  }
  result.exponent -= 64 * places + bits;
  std::memcpy(result.limbs, limbs + 1, sizeof result.limbs);
}

template <int N>
SYMTOP_SET_UP Float<N> operator+(const Float<N>& x, const Float<N>& y) {
  if (!x.sign) return y;
  if (!y.sign) return x;
  const bool is_first = compare_sizes(x, y) >= 0;
  const Float<N>&a = is_first ? x : y, &b = is_first ? y : x;
  const int distance = a.exponent - b.exponent;
  if (distance >= 64 * N + 2) return a;
  // One more limb below, so that a bit that is lost in the shift is no bit of the result. The
  // smaller number lies between limbs of zero, of which the shift is a choice.
  uint64_t large[N + 1] = {}, small[N + 1], between[2 * N + 3] = {};
  std::memcpy(large + 1, a.limbs, sizeof a.limbs);
  std::memcpy(between + 1, b.limbs, sizeof b.limbs);
  const int places = distance / 64, bits = distance % 64;
  SYMTOP_ROLLED
  for (int i = 0; i <= N; i++) {
    const Wide both = static_cast<Wide>(between[i + places + 1]) << 64 | between[i + places];
    small[i] = static_cast<uint64_t>(both >> bits);
  }
  Float<N> result;
  result.sign = a.sign;
  result.exponent = a.exponent;
  if (a.sign == b.sign) {
    uint64_t carry = 0;
    SYMTOP_ROLLED
    for (int i = 0; i <= N; i++) {
      const Wide sum = static_cast<Wide>(large[i]) + small[i] + carry;
      large[i] = static_cast<uint64_t>(sum);
      carry = static_cast<uint64_t>(sum >> 64);
    }
    if (carry) {
      SYMTOP_ROLLED
      for (int i = 0; i < N; i++) large[i] = large[i] >> 1 | large[i + 1] << 63;
      large[N] = large[N] >> 1 | uint64_t(1) << 63;
      result.exponent++;
    }
    std::memcpy(result.limbs, large + 1, sizeof result.limbs);
    return result;
  } else {
    uint64_t borrow = 0;
    SYMTOP_ROLLED
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
SYMTOP_CALL inline Float<3> operator+(const Float<3>& x, const Float<3>& y) {
  if (!x.sign) return y;
  if (!y.sign) return x;
  const auto upper = [](const Float<3>& f) {
    return static_cast<Wide>(f.limbs[2]) << 64 | f.limbs[1];
  };
  const auto lower = [](const Float<3>& f) { return static_cast<Wide>(f.limbs[0]) << 64; };
  const Wide upper_x = upper(x), upper_y = upper(y);
  const bool is_first = x.exponent != y.exponent ? x.exponent > y.exponent
                        : upper_x != upper_y     ? upper_x > upper_y
                                                 : x.limbs[0] >= y.limbs[0];
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
      high = low;
      low = 0;
      result.exponent -= 128;
    }
    const uint64_t top = static_cast<uint64_t>(high >> 64);
    const int bits = top ? __builtin_clzll(top) : 64 + __builtin_clzll(static_cast<uint64_t>(high));
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
SYMTOP_CALL Float<N> operator-(const Float<N>& a, const Float<N>& b) {
  return a + -b;
}

template <int N>
Float<N> size(const Float<N>& a) {
  return a.sign < 0 ? -a : a;
}

template <int N>
bool operator<(const Float<N>& a, const Float<N>& b) {
  return compare(a, b) < 0;
}
template <int N>
bool operator<=(const Float<N>& a, const Float<N>& b) {
  return compare(a, b) <= 0;
}
template <int N>
bool operator>(const Float<N>& a, const Float<N>& b) {
  return compare(a, b) > 0;
}
template <int N>
bool operator>=(const Float<N>& a, const Float<N>& b) {
  return compare(a, b) >= 0;
}

}  // namespace symtop

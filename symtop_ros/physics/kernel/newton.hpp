// Reciprocals, quotients and square roots of floats, by Newton's method.
#pragma once

#include "floats.hpp"

namespace symtop {

// The first 106 bits of a mantissa, as a sum of two doubles.
inline void split_mantissa(const Float<3>& a, double& high, double& low) {
  const uint64_t top = a.limbs[2];
  high = static_cast<double>(top >> 11) * 0x1p-53;
  low = static_cast<double>((top & 2047) << 42 | a.limbs[1] >> 22) * 0x1p-106;
}

// The reciprocal, from a double; each step doubles the digits. The first step is
// made in doubles: what is left of 1 is formed without rounding.
SYMTOP_SET_UP inline Float<3> invert(const Float<3>& a) {
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

// The square root, from the reciprocal of the root, as above.
SYMTOP_SET_UP inline Float<3> root(const Float<3>& a) {
  if (a.sign <= 0) return Float<3>();
  Float<3> mantissa = a;
  const int odd = a.exponent & 1;
  mantissa.exponent = odd;
  double high, low;
  split_mantissa(a, high, low);
  if (odd) {
    high *= 2;
    low *= 2;
  }
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

// The same with N limbs, from three: each step doubles the digits.
template <int N>
SYMTOP_SET_UP inline Float<N> invert(const Float<N>& a) {
  Float<N> result(invert(Float<3>(a)));
  const Float<N> one(1.0);
  for (int limbs = 3; limbs < N; limbs *= 2) result = result + result * (one - a * result);
  return result;
}

template <int N>
SYMTOP_SET_UP inline Float<N> root(const Float<N>& a) {
  if (a.sign <= 0) return Float<N>();
  Float<N> inverse(invert(root(Float<3>(a))));
  const Float<N> one(1.0);
  for (int limbs = 3; limbs < N; limbs *= 2)
    inverse = inverse + (inverse * (one - a * inverse * inverse)).scale(-1);
  const Float<N> result = a * inverse;
  return result + ((a - result * result) * inverse).scale(-1);
}

template <int N>
SYMTOP_CALL Float<N> operator/(const Float<N>& a, const Float<N>& b) {
  return a * invert(b);
}

}  // namespace symtop

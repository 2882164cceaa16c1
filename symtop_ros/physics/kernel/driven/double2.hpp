// Sums of two doubles, which have 32 digits: of one number, or of as many as there are lanes.
//
// Their products need what the product of two doubles loses in rounding. One operation gives it
// where the processor has fused products. Elsewhere that is a function of the library, and 16 sums
// and products of halves are faster. What is lost is a double, so both give the same one.
#pragma once

#include "../elementary.hpp"

namespace symtop {

// Of x86-64 some processors have fused products, and a library for all of them asks.
#if defined(__FP_FAST_FMA) || defined(__FMA__) || defined(__aarch64__)
constexpr bool fuses_products() { return true; }
#elif defined(SYMTOP_HAS_CLONES)
inline bool fuses_products() {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}
#else
constexpr bool fuses_products() { return false; }
#endif

// What a product of two doubles loses.
struct Fused {
  static SYMTOP_INLINE double find_lost(double a, double b, double product) {
    return __builtin_fma(a, b, -product);
  }
  static SYMTOP_INLINE Lanes find_lost(Lanes a, Lanes b, Lanes product) {
    Lanes lost;
    for (int i = 0; i < LANES; i++) lost[i] = __builtin_fma(a[i], b[i], -product[i]);
    return lost;
  }
  static bool can_take(const Lanes*, int) { return true; }
};

// By halves, of which products are exact (T. J. Dekker, Numer. Math. 18 (1971) 224).
struct Split {
  template <class R>
  static SYMTOP_INLINE R find_lost(R a, R b, R product) {
    const R x = halve(a), x_rest = a - x, y = halve(b), y_rest = b - y;
    return ((x * y - product) + (x * y_rest + x_rest * y)) + x_rest * y_rest;
  }

  // True if all of the numbers are 0, or so far inside of the range of doubles that no part of a
  // product of them leaves it: nor of a product of one with a sum of products, which is 0 or above
  // 2^-452.
  static bool can_take(const Lanes* numbers, int count) {
    bool all = true;
    for (int n = 0; n < count; n++)
      for (int i = 0; i < LANES; i++) all &= is_plain(numbers[n][i]);
    return all;
  }

  static bool is_plain(double a) {
    const double size = std::fabs(a);
    return (size > 0x1p-200 && size < 0x1p200) || size == 0;
  }

 private:
  // The first 26 digits; what they leave has 26 digits and a sign.
  template <class R>
  static SYMTOP_INLINE R halve(R a) {
    const R many = a * 0x1.0000002p27;
    return many - (many - a);
  }
};

template <class R>
struct SumOf {
  R high, low;
};
typedef SumOf<double> Double2;

template <class R>
SYMTOP_INLINE SumOf<R> sum_of(R a, R b) {  // Knuth's two-sum
  const R s = a + b, part = s - a;
  return {s, (a - (s - part)) + (b - part)};
}

template <class R>
SYMTOP_INLINE SumOf<R> fast_sum_of(R a, R b) {  // for |a| >= |b|
  const R s = a + b;
  return {s, b - (s - a)};
}

template <class R>
SYMTOP_INLINE SumOf<R> operator-(SumOf<R> a) {
  return {-a.high, -a.low};
}

template <class R>
SYMTOP_INLINE SumOf<R> operator+(SumOf<R> a, SumOf<R> b) {
  SumOf<R> s = sum_of(a.high, b.high);
  const SumOf<R> t = sum_of(a.low, b.low);
  s = fast_sum_of(s.high, s.low + t.high);
  return fast_sum_of(s.high, s.low + t.low);
}

template <class R>
SYMTOP_INLINE SumOf<R> operator-(SumOf<R> a, SumOf<R> b) {
  return a + -b;
}

template <class Product, class R>
SYMTOP_INLINE SumOf<R> multiply(SumOf<R> a, SumOf<R> b) {
  const R p = a.high * b.high, rest = Product::find_lost(a.high, b.high, p);
  return fast_sum_of(p, rest + (a.high * b.low + a.low * b.high));
}

template <class R>
SYMTOP_INLINE SumOf<R> scale(SumOf<R> a, R power_of_two) {
  return {a.high * power_of_two, a.low * power_of_two};
}

// Where sums are many, a last bit of their lower parts is left: it need not be below the last digit
// of the higher part.
template <class R>
SYMTOP_INLINE void add(SumOf<R>& sum, SumOf<R> term) {
  const SumOf<R> s = sum_of(sum.high, term.high);
  sum = {s.high, sum.low + (s.low + term.low)};
}

template <class Product, class R>
SYMTOP_INLINE void add_product(SumOf<R>& sum, SumOf<R> a, SumOf<R> b) {
  const R product = a.high * b.high, lost = Product::find_lost(a.high, b.high, product);
  const SumOf<R> s = sum_of(sum.high, product);
  sum = {s.high, sum.low + (s.low + (lost + (a.high * b.low + a.low * b.high)))};
}

// ---- Of one number ----

inline Double2 operator*(Double2 a, Double2 b) {
#ifndef SYMTOP_HAS_CLONES  // where the function of the library asks the processor, too
  if (!fuses_products() && Split::is_plain(a.high) && Split::is_plain(b.high))
    return multiply<Split>(a, b);
#endif
  return multiply<Fused>(a, b);
}

inline Double2 operator*(Double2 a, double b) { return a * Double2{b, 0.0}; }

inline Double2 operator/(Double2 a, Double2 b) {
  const double q = a.high / b.high;
  Double2 rest = a - b * q;
  const double r = rest.high / b.high;
  rest = rest - b * r;
  return fast_sum_of(q, r) + Double2{rest.high / b.high, 0.0};
}

inline Double2 root(Double2 a) {
  if (a.high <= 0) return {0.0, 0.0};
  const double x = std::sqrt(a.high);
  const Double2 rest = a - Double2{x, 0.0} * x;
  return fast_sum_of(x, rest.high / (2 * x));
}

// ---- Of four ----

SYMTOP_INLINE SumOf<Lanes> repeat(Double2 a) {
  return {symtop::repeat<Lanes>(a.high), symtop::repeat<Lanes>(a.low)};
}

SYMTOP_INLINE Double2 pick(SumOf<Lanes> a, int lane) { return {a.high[lane], a.low[lane]}; }

}  // namespace symtop

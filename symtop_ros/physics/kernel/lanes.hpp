// Several doubles at a time, with the operators of one: a template that is written for a number R
// computes one state for R = double, and LANES states for R = Lanes. Each lane has the bits that a
// double alone has, because every operation rounds the lanes separately.
#pragma once

#include "arithmetic.hpp"

// Two variants are compiled where the processor may have wider registers. They differ in speed
// only: nothing is fused, and sums keep their order. A template is inlined into both. A program
// that is for AVX-512 needs no second variant, and GCC 12 fails with an internal error over it. One
// that is watched for races would choose the variant before its watcher has started, and crash.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && __GNUC__ >= 12 && \
    !defined(__AVX512F__) && !defined(__SANITIZE_THREAD__)
#define SYMTOP_CLONES __attribute__((target_clones("arch=x86-64-v3", "default")))
#define SYMTOP_HAS_CLONES
#else
#define SYMTOP_CLONES
#endif
#define SYMTOP_INLINE inline __attribute__((always_inline))
// Before a loop over a few vectors, whose sums then stay in registers. WebAssembly has none here.
#ifdef __wasm__
#define SYMTOP_UNROLL
#else
#define SYMTOP_UNROLL _Pragma("GCC unroll 10")
#endif

namespace symtop {

const int LANES = 4;
// A graphics processor has threads instead, and its compiler no vectors.
#if !defined(__CUDACC__) && !defined(SYMTOP_NO_LANES)
#define SYMTOP_LANES
typedef double Lanes __attribute__((vector_size(8 * LANES)));
typedef uint64_t IntegerLanes __attribute__((vector_size(8 * LANES)));
typedef decltype(Lanes{} < Lanes{}) Truths;
#endif

template <class R>
struct IntegerOf {
  typedef uint64_t Type;
};
#ifdef SYMTOP_LANES
template <>
struct IntegerOf<Lanes> {
  typedef IntegerLanes Type;
};
#endif
template <class R>
using Integer = typename IntegerOf<R>::Type;  // as many integers as numbers, modulo 2^64

template <class To, class From>
SYMTOP_INLINE To read_bits_as(const From& from) {
  static_assert(sizeof(To) == sizeof(From), "the same bits");
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

#ifdef SYMTOP_LANES
// The lanes of a in another order. Written lane by lane GCC 12 takes each of them out and puts it
// back.
#if defined(__clang__) || __GNUC__ >= 12
#define SYMTOP_ORDER(a, b, i, j, k, l) __builtin_shufflevector(a, b, i, j, k, l)
#else
#define SYMTOP_ORDER(a, b, i, j, k, l) __builtin_shuffle(a, b, IntegerLanes{i, j, k, l})
#endif
template <int I, int J, int K, int L>
SYMTOP_INLINE Lanes order(Lanes a) {
  return SYMTOP_ORDER(a, a, I, J, K, L);
}

template <int I>
SYMTOP_INLINE Lanes spread(Lanes a) {
  return SYMTOP_ORDER(a, a, I, I, I, I);
}

// Lanes with the other sign where `signs` has one.
SYMTOP_INLINE Lanes negate(Lanes a, Lanes signs) {
  return read_bits_as<Lanes>(read_bits_as<IntegerLanes>(a) ^ read_bits_as<IntegerLanes>(signs));
}
#endif

// ---- What is written for a double and for lanes ----

const uint64_t SIGN = uint64_t(1) << 63;

SYMTOP_INLINE double choose(bool condition, double a, double b) { return condition ? a : b; }

SYMTOP_INLINE double find_size(double x) { return std::fabs(x); }

SYMTOP_INLINE double copy_sign(double size, double x) { return std::copysign(size, x); }

// The nearest double of an integer with sign. The lanes add two parts whose digits are placed
// behind a 1, which is taken off again: few processors convert lanes of 64 bits.
SYMTOP_INLINE double to_double(uint64_t n) { return static_cast<double>(static_cast<int64_t>(n)); }

// Entry k of rows of four numbers, for every lane.
SYMTOP_INLINE void read_row(const double (*rows)[4], uint64_t k, double entries[4]) {
  for (int i = 0; i < 4; i++) entries[i] = rows[k][i];
}

#ifdef SYMTOP_LANES
SYMTOP_INLINE Lanes choose(Truths condition, Lanes a, Lanes b) { return condition ? a : b; }

SYMTOP_INLINE Lanes find_size(Lanes x) {
  return read_bits_as<Lanes>(read_bits_as<IntegerLanes>(x) & ~SIGN);
}

SYMTOP_INLINE Lanes find_larger(Lanes a, Lanes b) { return a > b ? a : b; }

SYMTOP_INLINE double find_largest_lane(Lanes a) {
  const Lanes pairs = find_larger(a, order<2, 3, 2, 3>(a));
  return pairs[0] > pairs[1] ? pairs[0] : pairs[1];
}

SYMTOP_INLINE Lanes copy_sign(Lanes size, Lanes x) {
  const IntegerLanes sign = read_bits_as<IntegerLanes>(x) & SIGN;
  return read_bits_as<Lanes>(read_bits_as<IntegerLanes>(find_size(size)) | sign);
}

SYMTOP_INLINE Lanes to_double(IntegerLanes n) {
  const Lanes lower = read_bits_as<Lanes>((n & 0xffffffff) | read_bits_as<uint64_t>(0x1p52));
  const Lanes upper = read_bits_as<Lanes>((n >> 32) ^ read_bits_as<uint64_t>(0x1p84 + 0x1p63));
  return (upper - (0x1p84 + 0x1p63 + 0x1p52)) + lower;
}

SYMTOP_INLINE void read_row(const double (*rows)[4], IntegerLanes k, Lanes entries[4]) {
  for (int i = 0; i < 4; i++)
    for (int lane = 0; lane < LANES; lane++) entries[i][lane] = rows[k[lane]][i];
}
#endif

// ---- What follows for both ----

// A constant in every lane. Subtracting 0 keeps the sign of a zero.
template <class R>
SYMTOP_INLINE R repeat(double x) {
  return x - R{};
}

template <class R>
SYMTOP_INLINE R find_sign(R x) {
  return copy_sign(repeat<R>(1.0), x);
}

// The nearest integer; the even one of two. Without a call of the library, which takes longer.
template <class R>
SYMTOP_INLINE R round_to_integer(R x) {
  const R size = find_size(x);
  return choose(size < 0x1p52, copy_sign((size + 0x1p52) - 0x1p52, x), x);
}

// The integer of a whole number below 2^51 in size: its digits after a larger number is added.
template <class R>
SYMTOP_INLINE Integer<R> count_of(R whole) {
  const double LARGE = 0x1.8p52;
  return read_bits_as<Integer<R>>(whole + LARGE) - read_bits_as<uint64_t>(LARGE);
}

}  // namespace symtop

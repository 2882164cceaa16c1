// Numbers as a coarse and a fine part, of which sums of products take no more than three products.
//
// The coarse part is a multiple of 2^-23 and at most 8 in size, so it has 26 digits: products of
// two coarse parts are exact, and so are their sums up to 128, whatever their order and with or
// without fused products. The fine part is a double below 2^-23 or so, whose products are rounded
// at 2^-77: 23 digits of a number of size 1, where a sum of two doubles has 32 and takes 14
// operations for a product. In units of a step's length all terms are of size 1 or less
// (derivation.md, section 15).
#pragma once

#include "double2.hpp"

namespace symtop {

const double COARSEST = 0x1.8p29;        // added and taken off, it leaves multiples of 2^-23
const double COARSEST_POWER = 0x1.8p27;  // and of 2^-25 of powers, which are at most 2

template <class R>
struct PartsOf {
  R coarse, fine;

  R whole() const { return coarse + fine; }
};

template <class R>
SYMTOP_INLINE PartsOf<R> split(SumOf<R> a, double coarsest = COARSEST) {
  const R coarse = (a.high + coarsest) - coarsest;
  return {coarse, (a.high - coarse) + a.low};
}

// A sum of products: the exact part of it, and the rest.
template <class R>
SYMTOP_INLINE void add_product(PartsOf<R>& sum, R coarse, R fine, R other_coarse, R other_fine,
                               R other_whole) {
  sum.coarse += coarse * other_coarse;
  sum.fine += coarse * other_fine + fine * other_whole;
}

template <class R>
SYMTOP_INLINE void add(PartsOf<R>& sum, PartsOf<R> other) {
  sum.coarse += other.coarse;
  sum.fine += other.fine;
}

// An exact sum and its rest as parts of a number again.
template <class R>
SYMTOP_INLINE PartsOf<R> collect(PartsOf<R> sum) {
  return split(SumOf<R>{sum.coarse, sum.fine});
}

// A sum by an integer up to 64: what the coarse quotient leaves is exact.
template <class R>
SYMTOP_INLINE PartsOf<R> divide(PartsOf<R> sum, double n, double inverse) {
  const R coarse = (sum.coarse * inverse + COARSEST) - COARSEST;
  return {coarse, ((sum.coarse - coarse * n) + sum.fine) * inverse};
}

}  // namespace symtop

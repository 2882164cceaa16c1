// A step of a driven motion: its Taylor series in time, and states within it.
#pragma once

#include "equations.hpp"

namespace symtop {

// A frame that turns by at most 2 rad in a step has terms that fall so fast that the first ten alone
// need sums of two doubles. Longer steps want more of them, and take longer. See
// design/extended_terms.py.
const int DRIVEN_TERMS = 30, EXTENDED_TERMS = 10;

struct Knot {
  double t;
  Variables now;
};

// The sum of a series, for four variables: `terms` has those of eight, by powers, and the first
// `rests` of them are lower parts. The smallest terms come first. Powers of u have 32 digits and each
// product with them is added without loss: Horner's rule would wait for each of its roundings.
template <class Product>
SYMTOP_INLINE SumOf<Lanes> sum_series(const Lanes terms[][2], const Lanes rests[][2], int half,
                                      const Double2* powers) {
  static_assert(DRIVEN_TERMS % 2 == 0 && EXTENDED_TERMS % 2 == 0, "the tail has pairs of terms");
  // The tail, as two series of the square that do not wait for each other.
  Lanes even = terms[DRIVEN_TERMS][half], odd = terms[DRIVEN_TERMS - 1][half];
  for (int n = DRIVEN_TERMS - 2; n > EXTENDED_TERMS; n -= 2) {
    even = even * powers[2].high + terms[n][half];
    odd = odd * powers[2].high + terms[n - 1][half];
  }
  SumOf<Lanes> sum = {(even * powers[1].high + odd) * powers[EXTENDED_TERMS + 1].high, Lanes{}};
  for (int n = EXTENDED_TERMS; n > 0; n--)
    add_product<Product>(sum, {terms[n][half], rests[n][half]}, repeat(powers[n]));
  return sum;
}

template <class Product>
SYMTOP_CLONES void sum_both(const Lanes terms[][2], const Lanes rests[][2], const Double2* powers,
                            SumOf<Lanes> sums[2]) {
  for (int half = 0; half < 2; half++)
    sums[half] = sum_series<Product>(terms, rests, half, powers);
}

struct Piece {
  Knot start, following;
  double end, unit;
  // Coefficients by powers of (t - start.t)/unit, of q and of the rates times the unit, with the spin:
  // terms + rests.
  Lanes terms[DRIVEN_TERMS + 1][2], rests[EXTENDED_TERMS + 1][2];
  bool is_split;  // products by halves may be taken of them

  // The variables at start.t + u unit.
  Variables evaluate(Double2 u) const {
    Double2 powers[EXTENDED_TERMS + 2] = {{1.0, 0.0}, u};
    for (int n = 2; n <= EXTENDED_TERMS + 1; n++) powers[n] = powers[n / 2] * powers[n - n / 2];
    SumOf<Lanes> sums[2];
    if (is_split && std::fabs(u.high) > 0x1p-15)  // of which the tenth power is no tiny number
      sum_both<Split>(terms, rests, powers, sums);
    else
      sum_both<Fused>(terms, rests, powers, sums);
    const Lanes rates = {1 / unit, 1 / unit, 1 / unit, 1.0};
    return {fast_sum_of(sums[0].high, sums[0].low) + start.now.q,
            scale(fast_sum_of(sums[1].high, sums[1].low), rates) + start.now.rates};
  }

  // A time is given as the sum of two doubles.
  Double2 locate(double t, double rest) const {
    return scale(sum_of(t, -start.t) + Double2{rest, 0.0}, 1 / unit);
  }

  // The state at the end, of norm 1. The norm was 1 to rounding, so that its root is as far from 1 as
  // half of its square.
  void find_end() {
    following.t = end;
    following.now = evaluate(locate(end, 0.0));
    Double2 excess = {-1.0, 0.0};
    SumOf<Lanes>& q = following.now.q;
    for (int k = W; k <= Z; k++) add(excess, pick(q, k) * pick(q, k));
    q = fast_sum_of(q.high, q.low - q.high * (0.5 * (excess.high + excess.low)));
  }

  // A state that does not change any more.
  void rest_until(double time) {
    end = time;
    unit = INFINITY;
    is_split = false;
    std::memset(terms, 0, sizeof terms);
    std::memset(rests, 0, sizeof rests);
  }
};

}  // namespace symtop

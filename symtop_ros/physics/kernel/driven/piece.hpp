// A step of a driven motion: its Taylor series in time, and states within it.
#pragma once

#include "equations.hpp"
#include "parts.hpp"

namespace symtop {

// A frame that turns by at most 2 rad in a step has terms that fall so fast that the first ten
// alone need more digits than a double. Longer steps want more of them, and take longer. See
// design/extended_terms.py; of 20 to 38 terms 34 take the least time (design/driven_steps.py).
const int DRIVEN_TERMS = 34, EXTENDED_TERMS = 10;
// In a coarse motion all terms are doubles. Of 16 to 24 these take the least time for a local error
// of 1e-10 to 1e-12.
const int COARSE_TERMS = 22;

// How a piece keeps its first terms: in parts, as sums of two doubles (of some, products by halves
// may be taken), or as doubles.
enum Digits { IN_PARTS, IN_SPLIT_SUMS, IN_SUMS, IN_DOUBLES };

struct Knot {
  double t;
  Variables now;
  double unit = 0.0;  // of the time of the step that follows, about its length; 0 if not known
};

// The terms in doubles that follow the first `EXACT`, divided by u^(EXACT + 1): as two series of
// the square of u that do not wait for each other.
template <int EXACT, int LAST>
SYMTOP_INLINE Lanes sum_tail(const Lanes terms[][2], int half, double u, double square) {
  static_assert(LAST % 2 == 0 && EXACT % 2 == 0, "the tail has pairs of terms");
  Lanes even = terms[LAST][half], odd = terms[LAST - 1][half];
  for (int n = LAST - 2; n > EXACT; n -= 2) {
    even = even * square + terms[n][half];
    odd = odd * square + terms[n - 1][half];
  }
  return even * u + odd;
}

// The sum of a series, for four variables: `terms` has those of eight, by powers, and the first
// `rests` of them are lower parts. The smallest terms come first. Powers of u have 32 digits and
// each product with them is added without loss: Horner's rule would wait for each of its roundings.
template <class Product>
SYMTOP_INLINE SumOf<Lanes> sum_series(const Lanes terms[][2], const Lanes rests[][2], int half,
                                      const Double2* powers) {
  const Lanes tail =
      sum_tail<EXTENDED_TERMS, DRIVEN_TERMS>(terms, half, powers[1].high, powers[2].high);
  SumOf<Lanes> sum = {tail * powers[EXTENDED_TERMS + 1].high, Lanes{}};
  for (int n = EXTENDED_TERMS; n > 0; n--)
    add_product<Product>(sum, {terms[n][half], rests[n][half]}, repeat(powers[n]));
  return sum;
}

template <class Product>
SYMTOP_CLONES void sum_both(const Lanes terms[][2], const Lanes rests[][2], const Double2* powers,
                            SumOf<Lanes> sums[2]) {
  for (int half = 0; half < 2; half++) sums[half] = sum_series<Product>(terms, rests, half, powers);
}

struct Piece {
  Knot start, following;
  double end, unit;
  // Coefficients by powers of (t - start.t)/unit, of q and of the rates times the unit, with the
  // spin: terms + rests.
  Lanes terms[DRIVEN_TERMS + 1][2], rests[EXTENDED_TERMS + 1][2];
  // In parts, the first terms are sums of coarse and rests instead, up to rounding.
  Lanes coarse[EXTENDED_TERMS + 1][2];
  Digits digits;

  // The terms of order 0, as sums of two doubles.
  void put_first() {
    const SumOf<Lanes> rates = scale(start.now.rates, Lanes{unit, unit, unit, 1.0});
    terms[0][0] = start.now.q.high;
    rests[0][0] = start.now.q.low;
    terms[0][1] = rates.high;
    rests[0][1] = rates.low;
  }

  // The variables at start.t + u unit.
  Variables evaluate(Double2 u) const {
    if (digits == IN_DOUBLES) return evaluate_doubles(u.high);
    return digits == IN_PARTS ? evaluate_parts(u) : evaluate_sums(u);
  }

 private:
  Variables evaluate_parts(Double2 u) const {
    PartsOf<double> powers[EXTENDED_TERMS + 2];
    powers[1] = split(u, COARSEST_POWER);
    for (int n = 2; n <= EXTENDED_TERMS + 1; n++) {
      const PartsOf<double> a = powers[n / 2], b = powers[n - n / 2];
      PartsOf<double> product = {};
      add_product(product, a.coarse, a.fine, b.coarse, b.fine, b.whole());
      powers[n] = split(Double2{product.coarse, product.fine}, COARSEST_POWER);
    }
    SumOf<Lanes> sums[2];
    sum_parts(powers, sums);
    return add_to_start(sums);
  }

  SYMTOP_CLONES void sum_parts(const PartsOf<double>* powers, SumOf<Lanes> sums[2]) const {
    const double square = powers[2].whole(), first = powers[1].whole();
    const double highest = powers[EXTENDED_TERMS + 1].whole();
    SYMTOP_UNROLL
    for (int half = 0; half < 2; half++) {
      const Lanes tail =
          sum_tail<EXTENDED_TERMS, DRIVEN_TERMS>(terms, half, first, square) * highest;
      PartsOf<Lanes> sum = {Lanes{}, tail};
      SYMTOP_UNROLL
      for (int n = EXTENDED_TERMS; n > 0; n--)
        add_product(sum, coarse[n][half], rests[n][half], repeat<Lanes>(powers[n].coarse),
                    repeat<Lanes>(powers[n].fine), repeat<Lanes>(powers[n].whole()));
      sums[half] = fast_sum_of(sum.coarse, sum.fine);
    }
  }

  Variables evaluate_sums(Double2 u) const {
    Double2 powers[EXTENDED_TERMS + 2] = {{1.0, 0.0}, u};
    for (int n = 2; n <= EXTENDED_TERMS + 1; n++) powers[n] = powers[n / 2] * powers[n - n / 2];
    SumOf<Lanes> sums[2];
    if (digits == IN_SPLIT_SUMS &&
        std::fabs(u.high) > 0x1p-15)  // of which the tenth power is no tiny number
      sum_both<Split>(terms, rests, powers, sums);
    else
      sum_both<Fused>(terms, rests, powers, sums);
    for (SumOf<Lanes>& each : sums) each = fast_sum_of(each.high, each.low);
    return add_to_start(sums);
  }

  Variables evaluate_doubles(double u) const {
    SumOf<Lanes> sums[2];
    sum_doubles(u, sums);
    return add_to_start(sums);
  }

  SYMTOP_CLONES void sum_doubles(double u, SumOf<Lanes> sums[2]) const {
    for (int half = 0; half < 2; half++)
      sums[half] = {sum_tail<0, COARSE_TERMS>(terms, half, u, u * u) * u, Lanes{}};
  }

  Variables add_to_start(const SumOf<Lanes> sums[2]) const {
    const Lanes rates = {1 / unit, 1 / unit, 1 / unit, 1.0};
    return {sums[0] + start.now.q, scale(sums[1], rates) + start.now.rates};
  }

 public:
  // A time is given as the sum of two doubles.
  Double2 locate(double t, double rest) const {
    return scale(sum_of(t, -start.t) + Double2{rest, 0.0}, 1 / unit);
  }

  // The state at the end, of norm 1. The norm was 1 to rounding, so that its root is as far from 1
  // as half of its square.
  void find_end() {
    following.t = end;
    following.now = evaluate(locate(end, 0.0));
    SumOf<Lanes>& q = following.now.q;
    const PartsOf<Lanes> parts = split(q);
    const Lanes squares = parts.coarse * parts.coarse;
    const Lanes rests = parts.fine * (parts.coarse + q.high);
    const double excess = (((squares[W] + squares[X]) + (squares[Y] + squares[Z])) - 1.0) +
                          ((rests[W] + rests[X]) + (rests[Y] + rests[Z]));
    q = fast_sum_of(q.high, q.low - q.high * (0.5 * excess));
  }

  // A state that does not change any more.
  void rest_until(double time) {
    end = time;
    unit = INFINITY;
    digits = IN_SUMS;
    std::memset(terms, 0, sizeof terms);
    std::memset(rests, 0, sizeof rests);
  }
};

}  // namespace symtop

// Mean phi' and psi' of a nutation, with as many digits as their terms lose (derivation.md, section
// 7).
//
// They are sum and difference of the mean rates of arg A and arg B. Under weak gravity these may
// cancel: a sphere that hardly feels its weight turns about L, and the mean psi' is as small as the
// weight. Then the constants of the motion are computed again, with 700 digits. No double is so
// small that more could be lost: what is left is zero.
#pragma once

#include "closed_form.hpp"

namespace symtop {

// 10^-30 and 10^-680: shares of the largest term below which a sum keeps no KEPT = 20 of 50 and of
// 700 digits.
inline Precise find_lost_share() { return invert(Precise(1e15) * Precise(1e15)); }
inline Longest find_last_lost_share() {
  const Longest e17(1e17), e34 = e17 * e17, e68 = e34 * e34, e136 = e68 * e68;
  return invert(e136 * e136 * e136 * e136 * e136);
}

template <int N>
struct MeanSums {
  Float<N> precession, spin, largest;

  // Of the means of arg A and arg B, and the turning rate c.
  MeanSums(const Float<N>& a, const Float<N>& b, const Float<N>& c)
      : precession(a + b), spin(a - b + c), largest(size(a)) {
    for (const Float<N>& each : {size(b), size(c)})
      if (largest < each) largest = each;
  }
};

// The same with all the digits that may be needed.
inline MeanSums<37> compute_long_means(const Start& start) {
  const NutationOf<37> n = find_nutation<37>(start);
  const RootsOf<37> roots = find_roots(n);
  ZeroOf<37> zeros[FUNCTIONS];
  find_zeros(n, roots, zeros);
  Longest means[FUNCTIONS];
  compute_mean_rates(n, zeros, root(roots.s32 / roots.s31()), means);
  return {means[OF_A], means[OF_B], find_turning_rate<37>(start)};
}

struct MeanRates {
  Precise precession, spin;
};

// A sum below its share of the largest term is rounding: it is formed again.
inline MeanRates find_mean_rates(const ClosedForm& motion) {
  const MeanSums<3> sums(motion.means[OF_A], motion.means[OF_B], motion.half_c.scale(1));
  const Precise lost = sums.largest * find_lost_share();
  const bool has_precession = size(sums.precession) >= lost, has_spin = size(sums.spin) >= lost;
  if (has_precession && has_spin) return {sums.precession, sums.spin};
  const MeanSums<37> longer = compute_long_means(motion.start);
  const Longest last = longer.largest * find_last_lost_share();
  const auto keep = [&last](const Longest& sum) {
    return size(sum) >= last ? Precise(sum) : Precise();
  };
  return {keep(longer.precession), keep(longer.spin)};
}

}  // namespace symtop

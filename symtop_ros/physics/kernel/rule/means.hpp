// What a change of phi' does in the mean: its sense compared with the mean precession, and the mean
// height (docs/article.md, "In the mean").
//
// Perry's rule compares theta'' at an instant with the sense of phi' at that instant. In the
// backward part of a loop that is the opposite of the precession that is seen. So the sense of the
// change is compared with the mean of phi' as well, and the mean of cos(theta) says what the height
// does.
#pragma once

#include "../gravity.hpp"
#include "tilt.hpp"

namespace symtop {

inline symtop_means leave_means() {
  return {SYMTOP_SENSE_UNSAID, SYMTOP_AS_HIGH, {NAN, NAN}, {NAN, NAN}};
}

// The means have an error of some EPS; the doubles of the starts are rounded as well, and the kick
// has rounded once more. A mean of that size has no sign, and a change of that size is none.
inline symtop_lift_kind find_change_of_height(const double cosines[2]) {
  const double change = cosines[1] - cosines[0];
  if (std::fabs(change) <= START_ROUNDING) return SYMTOP_AS_HIGH;
  return change > 0 ? SYMTOP_HIGHER : SYMTOP_LOWER;
}

// `change` is that of phi'; 0 for a kick that is no change of phi' alone. A mean that is undefined
// is NaN, of which no comparison is true.
inline symtop_sense find_sense(double change, const double rates[2], const double scales[2]) {
  for (int k = 0; k < 2; k++)
    if (!(std::fabs(rates[k]) > START_ROUNDING * scales[k])) return SYMTOP_SENSE_UNSAID;
  const bool is_forward = rates[0] > 0;
  if (change == 0 || is_forward != (rates[1] > 0)) return SYMTOP_SENSE_UNSAID;
  return is_forward == (change > 0) ? SYMTOP_SENSE_ALONG : SYMTOP_SENSE_AGAINST;
}

// An axis that approaches a pole for ever has that height in no time that ends.
inline bool has_means(GravityMotion& motion) { return motion.find_kind() != ASYMPTOTIC; }

inline symtop_means compare_means(double change, const Instant& before, const Instant& after,
                                  GravityMotion& without, GravityMotion& with) {
  if (!has_means(without) || !has_means(with)) return leave_means();
  const Rates was = without.find_rates(), now = with.find_rates();
  const double scales[] = {before.find_largest_rate(), after.find_largest_rate()};
  symtop_means means = {SYMTOP_SENSE_UNSAID,
                        SYMTOP_AS_HIGH,
                        {was.mean_precession_rate, now.mean_precession_rate},
                        {was.mean_cosine, now.mean_cosine}};
  means.height = find_change_of_height(means.cosines);
  if (before.top.Mgl != 0) means.sense = find_sense(change, means.rates, scales);
  return means;
}

}  // namespace symtop

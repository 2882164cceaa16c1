// The mean of u = cos(theta) over a nutation (derivation.md, section 7).
//
// With u = u1 + (u2 - u1) sn^2 the mean is u3 - (u3 - u1) E/K, which cancels: u3 is huge for a fast
// top. By Gauss's means, E/K = 1 - (c0^2/2 + c1^2 + 2 c2^2 + 4 c3^2 ...) with c0^2 = m = (u2 -
// u1)/(u3 - u1) (DLMF 19.8.6). The first term gives the middle of the turning heights; the others
// are products, and say by how much the axis stays longer at its upper turning point than at its
// lower one.
#pragma once

#include "closed_form.hpp"

namespace symtop {

// Below this share of a the next c, which is smaller by its square, changes no digit.
const double DONE = 1e-9;

inline double find_mean_cosine(const ClosedForm& motion) {
  const Roots& roots = motion.roots;
  // It comes to rest at the upper root, and is there for all but some time.
  if (!roots.s32.sign) return (motion.nutation.u() + roots.s2).to_double();
  const double whole = roots.s31().to_double();
  const double m = (roots.s21 / roots.s31()).to_double();
  double a = 1.0, b = root(roots.s32 / roots.s31()).to_double(), sum = 0.0;
  // c as c^2/(2 (a + b)) of the one before, not as (a - b)/2, which would cancel.
  double c = m / (2 * (1 + b)), weight = 1.0;
  for (bool is_done = false; !is_done; weight *= 2) {
    sum += weight * (whole * c) * c;
    is_done = c <= DONE * a;
    const double half_sum = (a + b) / 2;
    b = std::sqrt(a * b);
    a = half_sum;
    c = c * c / (2 * (a + b));
  }
  const Precise middle = motion.nutation.u() + (roots.s1 + roots.s2).scale(-1);
  return middle.to_double() + sum;
}

}  // namespace symtop

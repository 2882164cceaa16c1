// Twin of physics/exact/quotients.py: the quotients of theta functions, and the mean rates.
#pragma once

#include "nutation.hpp"

namespace symtop {

enum { OF_A, OF_B, OF_OMEGA_XY, FUNCTIONS };

struct Zero {
  bool is_below;
  Precise d, from_u1, from_u2, from_u3;
  bool is_negative() const { return d.sign < 0; }
};

// _zero_below
inline Zero find_zero_below(const Nutation& n, const Roots& roots) {
  const Precise& d = n.b_plus_a;
  const Precise from_u2 = n.one_plus_u + roots.s2, from_u3 = n.one_plus_u + roots.s3;
  return {true, d, d * d / (n.beta * from_u2 * from_u3), from_u2, from_u3};
}

// _zero_above
inline Zero find_zero_above(const Nutation& n, const Precise& d, const Precise& from_u1,
                            Precise from_u2, Precise from_u3) {
  const Precise product = d * d / (n.beta * from_u1);
  if (!(from_u2 + from_u3).sign)
    from_u2 = from_u3 = Precise();
  else if (from_u2 <= from_u3)
    from_u2 = product / from_u3;
  else
    from_u3 = product / from_u2;
  return {false, d, from_u1, from_u2, from_u3};
}

inline void find_zeros(const Nutation& n, const Roots& roots, Zero zeros[FUNCTIONS]) {
  const Precise above = n.omega_xy_squared / n.beta;
  Precise d = n.b_minus_au_highest, from_u2 = above - roots.s2, from_u3 = roots.s3 - above;
  if (roots.s32 < cancelled() * n.one_minus_u) {
    const Precise lift = n.alpha_minus_beta / n.beta;
    d = n.b_minus_a - n.a * lift;
    from_u2 = roots.below_pole + lift, from_u3 = roots.above_pole - lift;
  }
  zeros[OF_A] = find_zero_below(n, roots);
  zeros[OF_B] = find_zero_above(n, n.b_minus_a, n.one_minus_u - roots.s1, roots.below_pole,
                                roots.above_pole);
  zeros[OF_OMEGA_XY] = find_zero_above(n, d, above - roots.s1, from_u2, from_u3);
}

// _iterate_mean
inline Precise iterate_mean(const Precise& k, Precise* products, int& count) {
  static const Precise CONVERGED = Precise(1e-24);
  Precise a(1.0), b = k;
  count = 0;
  while (a - b > CONVERGED * a) {
    const Precise mean = (a + b).scale(-1);
    b = root(a * b);
    a = mean;
    count++;
    if (products) products[count - 1] = (a * b).scale(2 * count);
  }
  return (a + b).scale(-1);
}

// _third_kind
inline Precise integrate_third_kind(const Zero& zero, const Precise& root_near, const Precise& k,
                                    const Precise& mean, const Precise* products, int count) {
  const Precise near = root_near * root_near, one(1.0);
  Precise c = one + near, d = (one + k).scale(1), p = zero.is_below ? one + k * near : k + near;
  for (int n = 0; n < count; n++) {
    const Precise per_p = invert(p), e = products[n] * per_p, next = near * d * per_p + c;
    d = (c * e + d).scale(1), c = next, p = near * e + p;
  }
  const Precise m = mean.scale(count + 1);
  return (c * m + root_near * d) / (m * (root_near * m + p));
}

const int MOST_MEANS = 64;

// compute_mean_rates
inline Precise compute_mean_rates(const Nutation& n, const Zero zeros[], const Precise& k,
                                  Precise means[FUNCTIONS]) {
  if (!k.sign) {
    for (int i = 0; i < FUNCTIONS; i++)
      means[i] = zeros[i].is_below ? zeros[i].d / zeros[i].from_u2.scale(1) : Precise();
    return Precise();
  }
  Precise products[MOST_MEANS];
  int count;
  const Precise mean = iterate_mean(k, products, count);
  for (int i = 0; i < FUNCTIONS; i++) {
    const Zero& zero = zeros[i];
    const Precise rate = root(n.beta * zero.from_u3);
    const Precise& near = zero.is_below ? zero.from_u2 : zero.from_u1;
    const Precise nearness = zero.is_below ? zero.from_u1 / near : zero.from_u2 / near;
    const Precise root_near = rate.sign ? size(zero.d) / (rate * near) : root(nearness);
    means[i] = (mean * rate *
                integrate_third_kind(zero, root_near, k, mean, products, count)).scale(-1);
    if (zero.is_negative()) means[i] = -means[i];
  }
  return mean;
}

// _compute_shift_complement
inline double compute_shift_complement(const Zero& zero, const Roots& roots) {
  const Precise &g1 = zero.from_u1, &g2 = zero.from_u2, &g3 = zero.from_u3, s31 = roots.s31();
  if (zero.is_below) {
    const double share = (roots.s21 / g2).to_double();
    return std::sqrt((g1 / g2).to_double()) *
           integrate_rf_in_doubles(share, share * (g3 / s31).to_double());
  }
  if (!roots.s32.sign) return 0.0;
  const double share = (roots.s21 / g1).to_double();
  const double scale = std::sqrt((g2 / roots.s32 * s31 / g1).to_double());
  return scale * integrate_rf_in_doubles(share * (g3 / roots.s32).to_double(), share);
}

}  // namespace symtop

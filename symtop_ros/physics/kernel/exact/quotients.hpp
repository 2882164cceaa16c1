// The three functions of time that make up the motion, quotients of theta functions, and their mean
// rates (derivation.md, sections 3, 4 and 7).
//
// A, B and conj(omega_xy), that is the Cayley-Klein parameters and the angular velocity omega_xy =
// omega_x + i omega_y across the axis, all have the form
//
//   C  th_k(v + i shift)/th4(v)  exp(i rate t),        v = v0 + Omega t
//
// (Klein & Sommerfeld, The Theory of the Top, chapter VI; Whittaker, Analytical Dynamics, chapter
// VI; the argument holds for the third function as well). Each vanishes at one height u_P of the
// axis: A at the lower pole u = -1, B at the upper pole u = 1, omega_xy at u = alpha/beta, where
// the whole energy would be potential. There f(u_P) = -d^2 with d = b - a u_P (Goldstein's a and b,
// see nutation.hpp). Shift and rate follow from d and from the distances of u_P to the three roots
// of f, in the same way for all three.
#pragma once

#include "nutation.hpp"

namespace symtop {

enum { OF_A, OF_B, OF_OMEGA_XY, FUNCTIONS };

// The height u_P at which one of the three functions vanishes.
template <int N>
struct ZeroOf {
  bool is_below;                          // true for A, whose zero lies below the motion
  Float<N> d, from_u1, from_u2, from_u3;  // b - a u_P in rad/s; distances from the roots, all >= 0
  bool is_negative() const { return d.sign < 0; }
};
typedef ZeroOf<3> Zero;

// The zero at u = -1. Near the pole u1 + 1 would be the difference of nearly equal numbers. It
// comes from the product beta (u_P - u1)(u_P - u2)(u_P - u3) = f(u_P) = -d^2, whose other factors
// are not small.
template <int N>
inline ZeroOf<N> find_zero_below(const NutationOf<N>& n, const RootsOf<N>& roots) {
  const Float<N>& d = n.b_plus_a;
  const Float<N> from_u2 = n.one_plus_u + roots.s2, from_u3 = n.one_plus_u + roots.s3;
  return {true, d, d * d / (n.beta * from_u2 * from_u3), from_u2, from_u3};
}

// A zero that lies between u2 and u3. The smaller of the distances from these comes from the
// product, as above.
template <int N>
inline ZeroOf<N> find_zero_above(const NutationOf<N>& n, const Float<N>& d, const Float<N>& from_u1,
                                 Float<N> from_u2, Float<N> from_u3) {
  const Float<N> product = d * d / (n.beta * from_u1);
  if (!(from_u2 + from_u3).sign)
    from_u2 = from_u3 = Float<N>();
  else if (from_u2 <= from_u3)
    from_u2 = product / from_u3;
  else
    from_u3 = product / from_u2;
  return {false, d, from_u1, from_u2, from_u3};
}

template <int N>
inline void find_zeros(const NutationOf<N>& n, const RootsOf<N>& roots,
                       ZeroOf<N> zeros[FUNCTIONS]) {
  const Float<N> above = n.omega_xy_squared / n.beta;
  Float<N> d = n.b_minus_au_highest, from_u2 = above - roots.s2, from_u3 = roots.s3 - above;
  if (roots.s32 * Float<N>(PER_CANCELLED) < n.one_minus_u) {
    // All three heights are so near the pole that from the start no digit would be left. The lift
    // is alpha/beta - 1.
    const Float<N> lift = n.alpha_minus_beta / n.beta;
    d = n.b_minus_a - n.a * lift;
    from_u2 = roots.below_pole + lift;
    from_u3 = roots.above_pole - lift;
  }
  zeros[OF_A] = find_zero_below(n, roots);
  zeros[OF_B] =
      find_zero_above(n, n.b_minus_a, n.one_minus_u - roots.s1, roots.below_pole, roots.above_pole);
  zeros[OF_OMEGA_XY] = find_zero_above(n, d, above - roots.s1, from_u2, from_u3);
}

// The arithmetic-geometric mean of 1 and k, and 4^n a_n b_n of its steps n >= 1. Convergence is
// quadratic: a relative gap of 16 bits less than half of the digits leaves all but 32 of them.
template <int N>
inline Float<N> iterate_agm(const Float<N>& k, Float<N>* products, int& count) {
  const Float<N> converged = half_of_digits<N>(16);
  Float<N> a(1.0), b = k;
  count = 0;
  while (a - b > converged * a) {
    const Float<N> half_sum = (a + b).scale(-1);
    b = root(a * b);
    a = half_sum;
    count++;
    if (products) products[count - 1] = (a * b).scale(2 * count);
  }
  return (a + b).scale(-1);
}

// The complete integral of the third kind, times 2/pi sqrt(from_u1 from_u2); root_near is the
// square root of the distance of u_P from the near turning point divided by that from the far one.
// Computed as in R. Bulirsch, Numer. Math. 13 (1969) 305, procedure cel. Its first step divides by
// that nearness, which is zero for a pole that the axis passes; here this step is done by hand, and
// the nearness cancels. Letters are those of section 7, which are Bulirsch's a, b/root and p root
// after that step as x, y and p, and root_near as the square root of rho.
template <int N>
inline Float<N> integrate_third_kind(const ZeroOf<N>& zero, const Float<N>& root_near,
                                     const Float<N>& k, const Float<N>& agm,
                                     const Float<N>* products, int count) {
  const Float<N> near = root_near * root_near, one(1.0);
  Float<N> x = one + near, y = (one + k).scale(1), p = zero.is_below ? one + k * near : k + near;
  for (int n = 0; n < count; n++) {
    const Float<N> per_p = invert(p), e = products[n] * per_p, next = near * y * per_p + x;
    y = (x * e + y).scale(1);
    x = next;
    p = near * e + p;
  }
  const Float<N> h = agm.scale(count + 1);
  return (x * h + root_near * y) / (h * (root_near * h + p));
}

const int MOST_AGM_STEPS = 64;

// The arithmetic-geometric mean of 1 and k = sqrt(1 - m), and the mean rates of the three
// functions: the mean of d/(2 |u - u_P|) over a nutation (section 7).
template <int N>
inline Float<N> compute_mean_rates(const NutationOf<N>& n, const ZeroOf<N> zeros[],
                                   const Float<N>& k, Float<N> means[FUNCTIONS]) {
  if (!k.sign) {  // the separatrix: the axis spends all its time at u2 = u3, but for an instant
    for (int i = 0; i < FUNCTIONS; i++)
      means[i] = zeros[i].is_below ? zeros[i].d / zeros[i].from_u2.scale(1) : Float<N>();
    return Float<N>();
  }
  Float<N> products[MOST_AGM_STEPS];
  int count;
  const Float<N> agm = iterate_agm(k, products, count);
  for (int i = 0; i < FUNCTIONS; i++) {
    const ZeroOf<N>& zero = zeros[i];
    const Float<N> rate = root(n.beta * zero.from_u3);
    const Float<N>& near = zero.is_below ? zero.from_u2 : zero.from_u1;
    const Float<N> nearness = zero.is_below ? zero.from_u1 / near : zero.from_u2 / near;
    // By the product of the three distances: a root of so many digits is slow.
    const Float<N> root_near = rate.sign ? size(zero.d) / (rate * near) : root(nearness);
    means[i] =
        (agm * rate * integrate_third_kind(zero, root_near, k, agm, products, count)).scale(-1);
    if (zero.is_negative()) means[i] = -means[i];
  }
  return agm;
}

// K' - |shift|, right to rounding however close to K' the shift is. The textbooks give the shift
// itself as an incomplete elliptic integral of the first kind. When the axis passes near a pole it
// is close to K', and all depends on the difference, which a subtraction would lose. The difference
// is again such an integral, from the other limit: one Carlson R_F (DLMF 19.25.5). R_F is
// homogeneous, so its arguments are scaled to be near 1.
inline double compute_shift_complement(const Zero& zero, const Roots& roots) {
  const Precise &g1 = zero.from_u1, &g2 = zero.from_u2, &g3 = zero.from_u3, s31 = roots.s31();
  if (zero.is_below) {
    const double share = (roots.s21 / g2).to_double();
    return std::sqrt((g1 / g2).to_double()) *
           integrate_rf_in_doubles(share, share * (g3 / s31).to_double());
  }
  if (!roots.s32.sign) return 0.0;  // u2 = u3 is the pole itself, which is never reached
  const double share = (roots.s21 / g1).to_double();
  const double scale = std::sqrt((g2 / roots.s32 * s31 / g1).to_double());
  return scale * integrate_rf_in_doubles(share * (g3 / roots.s32).to_double(), share);
}

}  // namespace symtop

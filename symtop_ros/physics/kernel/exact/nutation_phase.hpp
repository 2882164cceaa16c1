// The place in the nutation: the phase x = pi v/K since a turning point, with v = v0 + Omega t, and
// the distances from both turning points (derivation.md, sections 3 and 5).
#pragma once

#include "phases.hpp"

namespace symtop {

// From this ratio K/K' on phases are computed with all digits: they are then stretched.
const double STRETCHED = 1.5;
// From this share of |A|^2 or |B|^2 at the far turning point left at the near one, the rounding of
// a phase counts: theta changes fast compared with itself. It is 1/100.
const double PER_NEAR_POLE = 100;
// On the separatrix y grows for ever. Here exp(-y/2) is zero, and the axis is upright to any digit.
const double FARTHEST = 1e6;

// A phase, and its distances from the turning points, which are multiplied by K/K' for the
// complementary series. Each is right to rounding of itself, which x alone cannot give.
template <class R>
struct LocationOf {
  R x;             // in [-pi, pi]; 0 is the lower turning point
  R below, above;  // the distance from the lower one, with the sign of x, and from the upper one
  R low;           // what is missing in the distance from the nearer one
};
typedef LocationOf<double> Location;

struct NutationPhase {
  double Omega, K, Kc;  // K and K' (DLMF 19.2.8); u(t) has sn(v0 + Omega t)
  bool is_stretched, is_separatrix, from_top;
  Pair origin;  // the phase at t = 0, as a sum of two doubles
  // K/K', also as a sum of two doubles, of which the first has 26 bits; exp(-pi K/(2 K'))
  double ratio, ratio_high, ratio_low, root_of_nome;
  Location start;

  bool is_direct() const { return Kc >= K; }
  // Time in s in which the functions of the motion change where they change fastest.
  double shortest_change() const { return 0.5 / PI * (K < Kc ? K : Kc) / Omega; }
  Location lower_turning_point() const {
    return {0.0, 0.0, PI * (1.0 > K / Kc ? 1.0 : K / Kc), 0.0};
  }
  Location upper_turning_point() const {
    return {PI, PI * (1.0 > K / Kc ? 1.0 : K / Kc), 0.0, 0.0};
  }

  // The location at a time, from the phase since t = 0 as the sum of two doubles. It is kept as two
  // doubles until its distance from the nearer turning point is known: near the separatrix this
  // distance is stretched by K/K', and so would be its rounding.
  template <class R>
  SYMTOP_INLINE LocationOf<R> locate(R t, R high, R low) const {
    if (is_separatrix) {  // no period: the phase is the hyperbolic argument itself
      // Further away both series are at their limits; infinity times zero would be no number.
      const R longest = repeat<R>(FARTHEST / Omega);
      R seconds = choose(t < longest, t, longest);
      seconds = choose(seconds < -longest, -longest, seconds);
      const R y = origin.x + 2 * Omega * seconds;
      return {0.0 * y, y, repeat<R>(INFINITY), R{}};
    }
    // Knuth's two-sum, and the whole turns taken off in two parts: x is right to rounding of
    // itself.
    R total = high + origin.x;
    const R part = total - high;
    R error = (high - (total - part)) + (origin.x - part) + (low + origin.y);
    const R turns = round_to_integer(total / (2 * PI));
    total = total - turns * (2 * PI_HIGH);
    error = error - turns * (2 * PI_LOW);
    // The distance from the one turning point is that from the other taken off pi, in two parts:
    // each keeps its digits where it is small.
    const R sign = find_sign(total), distance = find_size(total);
    const PairOf<R> near = {distance, sign * error}, far = {PI_HIGH - distance, PI_LOW - near.y};
    const PairOf<R> below = from_top ? far : near, above = from_top ? near : far;
    const R x = (below.x + below.y) * (from_top ? -sign : sign);
    if (is_direct()) return {x, x, above.x + above.y, R{}};
    return stretch(x, below, above);
  }

  // The location for the complementary series, from |x| and pi - |x| as two doubles. A quotient is
  // as small as exp(-y/2) of itself elsewhere, y being the smaller one of the two distances times
  // K/K'. The rounding of y, half an ulp of up to pi/2 K/K', would be the largest error of a small
  // tilt.
  template <class R>
  SYMTOP_INLINE LocationOf<R> stretch(R x, PairOf<R> below, PairOf<R> above) const {
    const R y = x * ratio, rise = (above.x + above.y) * ratio;
    if (!is_stretched) return {x, y, rise, R{}};
    // Only the nearer turning point needs the rest of its product: the other's terms are small.
    const auto is_upper = rise < find_size(y);
    const R high = choose(is_upper, above.x, -below.x), low = choose(is_upper, above.y, -below.y);
    // The rounding of the product, by Dekker's halves of 26 bits (T. J. Dekker, Numer. Math. 18
    // (1971) 224): the first part of the ratio has as many, so that products with the halves are
    // exact.
    const R product = (high + low) * ratio, shifted = 134217729.0 * high;
    const R upper = shifted - (shifted - high), lower = high - upper;
    const R rest = ((upper * ratio_high - product) + lower * ratio_high) +
                   (high * ratio_low + low * ratio_high);
    return {x, y, rise, rest};
  }
};

// v at t = 0 from the nearer turning point, and which one that is. It is an incomplete elliptic
// integral (DLMF 19.25.5). From the farther turning point it would be nearly complete, and the
// small distance from the nearer one would be lost in it. Halfway, at v = K/2, s2/s1 is sqrt(1 -
// m).
inline Precise find_starting_phase(const Nutation& n, const Roots& roots, bool is_precise,
                                   bool& from_top) {
  const Precise s1 = -roots.s1, &s2 = roots.s2, &s3 = roots.s3;
  const Precise &s21 = roots.s21, s31 = roots.s31(), &s32 = roots.s32;
  const auto integrate = [is_precise](const Precise& x, const Precise& y) {
    return is_precise ? integrate_rf(x, y)
                      : Precise(integrate_rf_in_doubles(x.to_double(), y.to_double()));
  };
  from_top = false;
  if (!s21.sign) return Precise();  // regular precession: the phase does not matter
  // From the turning point that is nearer: the integral of the other would be a difference from K.
  if (s2 * s2 * s31 >= s1 * s1 * s32) {
    const Precise v = root(s1 / s21) * integrate(s2 / s21, s3 / s31);
    return n.u_dot.sign < 0 ? -v : v;
  }
  from_top = true;
  const Precise per_product = invert(s21 * s3);
  const Precise v = root(s2 * s31 * per_product) * integrate(s32 * s1 * per_product, s32 / s3);
  return n.u_dot.sign < 0 ? v : -v;
}

// True if the axis passes so near a pole that the rounding of phases matters.
inline bool comes_near_a_pole(const Zero zeros[]) {
  const Precise times(PER_NEAR_POLE);
  return zeros[OF_A].from_u1 * times < zeros[OF_A].from_u2 ||
         zeros[OF_B].from_u2 * times < zeros[OF_B].from_u1;
}

// `agm` is the arithmetic-geometric mean of 1 and sqrt(1 - m), and 0 at the separatrix: there K is
// infinite, and y = x K/K' takes the place of x.
inline NutationPhase find_nutation_phase(const Nutation& n, const Roots& roots, const Zero zeros[],
                                         const Precise& agm, const Precise& frequency) {
  NutationPhase phase;
  phase.Omega = frequency.to_double() / 2;
  phase.is_separatrix = !agm.sign;
  phase.K = agm.sign ? PI / (2 * agm.to_double()) : INFINITY;
  const Precise modulus = root(roots.s21 / roots.s31());  // sqrt(m): K' from 1 - m would lose it
  phase.Kc = quarter_period(modulus.to_double());
  phase.is_stretched = STRETCHED * phase.Kc < phase.K;
  // All digits where the phase is stretched, or where a pole magnifies its error.
  const Precise v =
      find_starting_phase(n, roots, phase.is_stretched || comes_near_a_pole(zeros), phase.from_top);
  const Precise origin = ((agm.sign ? agm : Precise(1.0)) * v).scale(1);
  phase.origin.x = origin.to_double();
  phase.origin.y = rest_of(origin, phase.origin.x);
  if (phase.is_stretched && agm.sign) {
    int count;
    const Precise ratio = iterate_agm<3>(modulus, nullptr, count) / agm;
    phase.ratio = ratio.to_double();
    split_short(ratio, phase.ratio_high, phase.ratio_low);
    phase.root_of_nome = exponential(-(TWO_PI * ratio).scale(-2));
  } else {
    phase.ratio = phase.K / phase.Kc;
    phase.ratio_high = phase.ratio_low = 0.0;
    phase.root_of_nome = exponential(-PI / 2 * phase.K / phase.Kc);
  }
  phase.start = phase.locate(0.0, 0.0, 0.0);
  return phase;
}

}  // namespace symtop

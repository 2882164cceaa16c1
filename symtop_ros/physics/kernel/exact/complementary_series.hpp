// The theta quotients summed in the nome q', for m > 1/2, after Jacobi's imaginary transformation
// (DLMF 20.7.30 to 20.7.33; derivation.md, section 5).
//
// The transformation turns cos(n x) into cosh(n y) with y = x K/K', which overflows near the
// separatrix. The common factor exp(|y|) and its powers are therefore divided out, and the basis is
// 1, h^n, E^n with E = exp(-|y|) and h = exp(|y| - pi K/K'). All of them are at most 1. At the
// separatrix (K infinite, h = q' = 0) only the first terms remain, the hyperbolic functions.
//
// Each numerator is the sum over all integers n of (-1)^n q'^(n^2 - n) w^n, up to a phase, with w =
// E exp(i phi) for A and w = h exp(-i phi) for the other two, phi = pi (K' - shift)/K'. Its terms n
// and 1 - n have the common factor 1 - w. It vanishes if the axis passes the pole, and is written
// with expm1; what remains of the sum is called the cofactor here. So the digits of a quotient are
// relative to its own size there.
#pragma once

#include "direct_series.hpp"

namespace symtop {

struct Exponentials {
  double rising[5], falling[4];

  template <class R>
  SYMTOP_INLINE R sum(R h, R E) const {
    const double *c = rising, *d = falling;
    return c[0] + (h * (c[1] + h * (c[2] + h * (c[3] + h * c[4]))) +
                   E * (d[0] + E * (d[1] + E * (d[2] + E * d[3]))));
  }

  double slope(double h, double E) const {
    const double *c = rising, *d = falling;
    const double up = h * (c[1] + h * (2 * c[2] + h * (3 * c[3] + h * (4 * c[4]))));
    return up - E * (d[0] + E * (2 * d[1] + E * (3 * d[2] + E * (4 * d[3]))));
  }
};

template <class R>
struct BasisOf {
  R sign, decay, h, E, rising_gap, falling_gap, divisor;
};

struct ComplementarySeries {
  double K, Kc, root;
  int winding;
  Exponentials real[FUNCTIONS], imaginary[FUNCTIONS], theta_4;
  double angle[FUNCTIONS], versine[FUNCTIONS], sine[FUNCTIONS];

  static bool is_below(int k) { return k == OF_A; }
  int winding_of(int k) const { return k == OF_OMEGA_XY ? winding : 0; }

  // The coefficients of a numerator divided by 1 - w: of 1 and h^n, and of E^n. The cofactor is the
  // sum over k of (-1)^k q^(k^2 + k) (1 + w + 1/w + ... + w^k + 1/w^k). With h E = q, 1/w is h
  // exp(-i phi)/q for A and E exp(i phi)/q for the others. The q in this denominator is divided out
  // of q^(k^2 + k) first: h and q may both be zero.
  void expand(int k, const double powers[5], const double inverses[5], const Shift& shift) {
    const double phi = shift.sign * PI * shift.complement / Kc;
    const double *of_h = is_below(k) ? inverses : powers, *of_E = is_below(k) ? powers : inverses;
    for (int n = 0; n < 5; n++) {
      const Pair turn = cosine_and_sine(phi * n);
      real[k].rising[n] = of_h[n] * turn.x;
      imaginary[k].rising[n] = -of_h[n] * turn.y;
      if (n) real[k].falling[n - 1] = of_E[n] * turn.x;
      if (n) imaginary[k].falling[n - 1] = of_E[n] * turn.y;
    }
    angle[k] = shift.sign * PI * (1 - shift.complement / Kc);
    const double half_sine = cosine_and_sine(phi / 2).y;
    versine[k] = 2 * half_sine * half_sine;
    sine[k] = cosine_and_sine(phi).y;
  }

  void prepare(double K_, double Kc_, const Shift shifts[], int winding_, double root_of_nome) {
    K = K_;
    Kc = Kc_;
    winding = winding_;
    root = root_of_nome;
    const double q = exponential(-PI * K / Kc);
    const double q2 = q * q, q4 = q2 * q2, q8 = q4 * q4, q16 = q8 * q8;
    const double q5 = q4 * q, q6 = q4 * q2, q9 = q8 * q, q10 = q8 * q2, q12 = q8 * q4;
    const double q20 = q16 * q4;
    // Sums over k = n ... 4 of (-1)^k q^(k^2 + k), and of (-1)^k q^(k^2 + k - n): these are written
    // out, since q may be zero, and the smallest term comes first.
    const double powers[5] = {1 - (q2 - (q6 - (q12 - q20))), -(q2 - (q6 - (q12 - q20))),
                              q6 - (q12 - q20), -(q12 - q20), q20};
    const double inverses[5] = {powers[0], -(q - (q5 - (q10 * q - q16 * q2 * q))),
                                q4 - (q10 - q16 * q2), -(q9 - q16 * q), q16};
    for (int k = 0; k < FUNCTIONS; k++) expand(k, powers, inverses, shifts[k]);
    theta_4.rising[0] = theta_4.falling[0] = 1.0;
    raise_to_squares(q, theta_4.rising + 1);
    theta_4.falling[1] = q2;
    theta_4.falling[2] = q6;
    theta_4.falling[3] = q12;
  }

  // Common parts of the three quotients at one place. The rounding of a large |y| would be an error
  // of the small exp(-|y|/2), which is therefore sqrt(q') exp(above/2) in the upper half of the
  // nutation. What the rounding of the distance has lost is a factor 1 + low/2, since its square is
  // nothing.
  template <class R>
  SYMTOP_INLINE BasisOf<R> find_basis(const LocationOf<R>& at) const {
    const R distance = find_size(at.below);
    const auto is_upper = at.above < distance;
    R decay = choose(is_upper, repeat<R>(root), repeat<R>(1.0)) *
              exponential<R>(choose(is_upper, at.above, -distance) / 2);
    decay = decay + decay * (0.5 * at.low);
    const PairOf<R> rise = expand_exponential<R>(-at.above);
    const R h = rise.x + rise.x * rise.y, E = decay * decay;
    return {find_sign(at.below),
            decay,
            h,
            E,
            (1.0 - rise.x) - rise.x * rise.y,
            -exponential_minus_1<R>(-distance),
            theta_4.sum(h, E)};
  }

  template <class R>
  SYMTOP_INLINE PairOf<R> sum_cofactor(int k, const BasisOf<R>& basis) const {
    return {real[k].sum(basis.h, basis.E), basis.sign * imaginary[k].sum(basis.h, basis.E)};
  }

  // 1 - w = (1 - r) + r (1 - cos(phi)) -+ i r sin(phi), with r = |w| = E or h. Both terms of the
  // real part are positive: nothing cancels where w is near 1.
  template <class R>
  SYMTOP_INLINE PairOf<R> compute_one_minus_w(int k, const BasisOf<R>& basis) const {
    if (is_below(k))
      return {versine[k] * basis.E + basis.falling_gap, -sine[k] * (basis.sign * basis.E)};
    return {versine[k] * basis.h + basis.rising_gap, sine[k] * (basis.sign * basis.h)};
  }

  template <class R>
  SYMTOP_INLINE void compute_values(const LocationOf<R>& at, PairOf<R> values[FUNCTIONS]) const {
    const BasisOf<R> basis = find_basis(at);
    for (int k = 0; k < FUNCTIONS; k++) {
      const R size = (is_below(k) ? repeat<R>(1.0) : basis.decay) / basis.divisor;
      R phase = (angle[k] / (2 * PI) + winding_of(k)) * at.x;
      if (is_below(k)) phase = phase - basis.sign * (0.5 * angle[k]);
      const PairOf<R> numerator = multiply(sum_cofactor(k, basis), compute_one_minus_w(k, basis));
      const PairOf<R> unit = cosine_and_sine(phase);
      values[k] = multiply(numerator, PairOf<R>{size * unit.x, -size * unit.y});
    }
  }

  // The derivative of quotient k with respect to v, with the winding held. A quotient is decay
  // cofactor (1 - w) exp(-i phase)/divisor, without the decay for A. All but the phase depend on
  // |y|, and d|y|/dv is sign pi/K'; the phase depends on x, dx/dv = pi/K.
  Pair compute_slope(int k, Location at) const {
    Pair values[FUNCTIONS];
    compute_values(at, values);
    at.low = 0.0;
    const Pair value = values[k];
    const BasisOf<double> basis = find_basis(at);
    const double sign = basis.sign, h = basis.h, E = basis.E;
    const Pair factor = compute_one_minus_w(k, basis), cofactor = sum_cofactor(k, basis);
    const Pair cofactor_slope = {real[k].slope(h, E), sign * imaginary[k].slope(h, E)};
    const Pair w_slope = is_below(k) ? Pair{1 - factor.x, -factor.y} : Pair{factor.x - 1, factor.y};
    const Pair first = multiply(cofactor_slope, factor), second = multiply(cofactor, w_slope);
    const double turn = angle[k] / (2 * PI);
    double phase = turn * at.x + winding_of(k) * at.x;
    if (is_below(k)) phase -= 0.5 * sign * angle[k];
    const Pair unit = cosine_and_sine(phase);
    const double size = (is_below(k) ? 1.0 : basis.decay) / basis.divisor;
    const Pair sum = {first.x + second.x, first.y + second.y};
    const Pair rate = multiply(sum, Pair{size * unit.x, -size * unit.y});
    const double falling = theta_4.slope(h, E) / basis.divisor + (is_below(k) ? 0.0 : 0.5);
    const double in_y = sign * PI / Kc, in_x = PI / K * turn;
    return {in_y * (rate.x - value.x * falling) + in_x * value.y,
            in_y * (rate.y - value.y * falling) - in_x * value.x};
  }
};

}  // namespace symtop

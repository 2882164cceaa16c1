// The theta quotients summed in the nome q, for m <= 1/2 (derivation.md, section 5).
//
// Each of A, B and conj(omega_xy) is th_k(v + i shift)/th4(v) times a constant and an exponential,
// with k = 4 for A and k = 3 for the other two; th_k(v) = theta_k(pi v/(2 K) | q) are Jacobi's
// theta functions (DLMF 20.2). The series in q = exp(-pi K'/K) converge fast for m <= 1/2 and ever
// more slowly towards the separatrix m = 1; there complementary_series.hpp has the nome q' =
// exp(-pi K/K'). With the better of the two no nome exceeds exp(-pi) = 0.043, and the first term
// left out is below 1e-16 of the sum (design/nomes.py).
//
// A sum in cos(n x) would lose a quotient near its zero, where it is a small difference of large
// terms. Each quotient is therefore expanded about the turning point at which it may vanish: A
// about the lower one, B and omega_xy about the upper one. Its value there is formed without
// cancellation, and the rest are terms in 1 - cos(n delta), with delta the distance from that
// turning point. They are products of y = sin(delta/2)^2:
//
//   1 - cos(delta)   =  2 y                 1 - cos(3 delta) =  2 y (3 - 4 y)^2
//   1 - cos(2 delta) =  8 y (1 - y)         1 - cos(4 delta) = 32 y (1 - y) cos(delta)^2
//
// The factors are powers of two and go into the coefficients. So the digits of a quotient are
// relative to its own size, and the tilt of an axis that passes a pole is right to rounding of
// itself.
#pragma once

#include "nutation_phase.hpp"

namespace symtop {

struct Shift {
  double sign, complement;
};

inline void raise_to_squares(double q, double powers[4]) {
  const double second = q * q, fourth = second * second, eighth = fourth * fourth;
  powers[0] = q;
  powers[1] = fourth;
  powers[2] = eighth * q;
  powers[3] = eighth * eighth;
}

const int DIVISOR = FUNCTIONS;  // place of the denominator among the numerators

struct DirectSeries {
  double K;
  int order, winding;
  double even[FUNCTIONS + 1][5], odd[FUNCTIONS][4], versines[FUNCTIONS + 1][5];

  static bool is_below(int k) { return k == OF_A || k == DIVISOR; }

  // Coefficients of cos(n x) and sin(n x) of a numerator; returns its value at the turning point
  // where it may vanish. Terms below 2^-60 of the largest change no sum.
  double expand(int k, double Kc, const Shift& shift) {
    const double rate = -PI / K, complement = shift.complement;
    double least = -exponential_minus_1(rate * complement);
    even[k][0] = 1.0;
    for (int n = 1; n < 5; n++) even[k][n] = odd[k][n - 1] = 0.0;
    for (int n = 1; n < 5 && Kc < INFINITY; n++) {  // m = 0: the quotient is constant
      const int parity = n & 1 ? -1 : 1, own = is_below(k) ? parity : 1;
      const double large = exponential(rate * (Kc * (n * n - n) + complement * n));
      if (large < 0x1p-60) break;
      const double small = exponential(rate * (Kc * (n * n + n) - complement * n));
      even[k][n] = own * (small + large);
      odd[k][n - 1] = own * shift.sign * (small - large);
      least -= parity * small * exponential_minus_1(rate * complement * (2 * n + 1));
    }
    return least;
  }

  // Coefficients of the versines: theta_4, with alternating signs, is the numerator of A and the
  // denominator.
  void collect(int k, double least) {
    static const int FACTORS[] = {2, 8, 2, 32};
    versines[k][0] = least;
    for (int n = 1; n < 5; n++) {
      const int parity = is_below(k) || !(n & 1) ? 1 : -1;
      versines[k][n] = -FACTORS[n - 1] * parity * even[k][n];
    }
  }

  void prepare(double K_, double Kc, const Shift shifts[], int winding_) {
    K = K_;
    winding = winding_;
    order = 1;
    for (int k = 0; k < FUNCTIONS; k++) {
      collect(k, expand(k, Kc, shifts[k]));
      for (int n = 2; n < 5; n++)
        if (even[k][n] != 0 && n > order) order = n;
    }
    double* divisor = even[DIVISOR];
    double powers[4];
    raise_to_squares(exponential(-PI * Kc / K), powers);
    divisor[0] = 1.0;
    divisor[1] = -2 * powers[0];
    divisor[2] = 2 * powers[1];
    divisor[3] = -2 * powers[2];
    divisor[4] = 2 * powers[3];
    double sum = 0.0;
    for (int n = 4; n >= 0; n--) sum += divisor[n];
    collect(DIVISOR, sum);
  }

  template <class R>
  static SYMTOP_INLINE R add(const double* coefficients, const R* basis, int count) {
    R total = coefficients[0] * basis[0];
    for (int n = 1; n < count; n++) total = total + coefficients[n] * basis[n];
    return total;
  }

  template <class R>
  SYMTOP_INLINE void compute_values(const LocationOf<R>& at, PairOf<R> values[FUNCTIONS]) const {
    // The half angle from the nearer end, where its sine has all its digits.
    const R distance = find_size(at.x);
    const auto is_lower = distance < at.above;
    const PairOf<R> near =
        cosine_and_sine_near_0<R>(0.5 * choose(is_lower, distance, at.above), R{});
    const R s = find_sign(at.x) * choose(is_lower, near.y, near.x);
    const R c = choose(is_lower, near.x, near.y);
    const R sine_x = 2 * s * c, cosine_x = (c - s) * (c + s);
    // sin(n x / 2)^2 and sin(n x) as products: 1 - cos(n x) would cancel next to an end.
    const R one = repeat<R>(1.0);
    R below[5] = {one, s * s}, above[5] = {one, c * c}, sines[4] = {sine_x};
    if (order > 1) {
      below[2] = above[2] = below[1] * above[1];
      sines[1] = 2 * sine_x * cosine_x;
    }
    if (order > 2) {
      R triple = 3 - 4 * below[1];
      below[3] = below[1] * (triple * triple);
      triple = 3 - 4 * above[1];
      above[3] = above[1] * (triple * triple);
      const R square = 4 * cosine_x * cosine_x;
      sines[2] = sine_x * (square - 1);
      sines[3] = sines[1] * (square - 2);
    }
    if (order > 3) below[4] = above[4] = below[2] * (cosine_x * cosine_x);
    const R per_divisor = 1 / add(versines[DIVISOR], below, order + 1);
    for (int k = 0; k < FUNCTIONS; k++)
      values[k] = {add(versines[k], is_below(k) ? below : above, order + 1) * per_divisor,
                   add(odd[k], sines, order) * per_divisor};
    const PairOf<R> turn = {cosine_x, winding < 0 ? sine_x : -sine_x};
    for (int n = 0; n < (winding < 0 ? -winding : winding); n++)
      values[OF_OMEGA_XY] = multiply(values[OF_OMEGA_XY], turn);
  }

  Pair compute_slope(int k, const Location& at) const {
    Pair values[FUNCTIONS];
    compute_values(at, values);
    double size = even[DIVISOR][0], rate_of_size = 0.0;
    Pair rate = {0.0, 0.0};
    for (int n = 1; n <= order; n++) {
      const Pair unit = cosine_and_sine(n * at.x);
      size += even[DIVISOR][n] * unit.x;
      rate_of_size -= n * even[DIVISOR][n] * unit.y;
      rate.x -= n * (even[k][n] * unit.y);
      rate.y += n * (odd[k][n - 1] * unit.x);
    }
    if (k == OF_OMEGA_XY && winding)
      rate = multiply(rate, conjugate(cosine_and_sine(winding * at.x)));
    const double scale = PI / K;
    return {scale * (rate.x - values[k].x * rate_of_size) / size,
            scale * (rate.y - values[k].y * rate_of_size) / size};
  }
};

}  // namespace symtop

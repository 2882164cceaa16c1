// The first instants of a motion, as a Taylor series about the start (derivation.md, section 6).
//
// An axis that starts at rest moves slowly at first. Quotients of theta functions are right to
// rounding of the largest angular velocity of the motion; the first, small angular velocities are
// differences of large numbers there. The series has them to rounding of themselves.
#pragma once

#include "complementary_series.hpp"

namespace symtop {

const int TERMS = 14;
// The series serves times up to so many radians of the fastest rate: the first term left out is
// 0.1^14 times a coefficient below 1.
const double REACH = 0.1;
const double SLOWEST = 1e-290;  // rad/s; the quotient Mgl/Ix may be zero in doubles

struct Series {
  double real[TERMS + 1], imaginary[TERMS + 1];

  Pair sum_powers(double time) const {
    double x = real[TERMS] * time, y = imaginary[TERMS] * time;
    for (int n = TERMS - 1; n > 0; n--) {
      x = (x + real[n]) * time;
      y = (y + imaginary[n]) * time;
    }
    return {x + real[0], y + imaginary[0]};
  }
};

// The coefficient of t^n in the product of two series.
inline Pair convolve(const Series& left, const Series& right, int n) {
  double real = 0.0, imaginary = 0.0;
  for (int m = 0; m <= n; m++) {
    const double x = left.real[m], y = left.imaginary[m];
    const double u = right.real[n - m], v = right.imaginary[n - m];
    real += x * u - y * v;
    imaginary += x * v + y * u;
  }
  return {real, imaginary};
}

// The same of a product with the conjugate of the second series.
inline Pair convolve_with_conjugate(const Series& left, const Series& right, int n) {
  double real = 0.0, imaginary = 0.0;
  for (int m = 0; m <= n; m++) {
    const double x = left.real[m], y = left.imaginary[m];
    const double u = right.real[n - m], v = right.imaginary[n - m];
    real += x * u + y * v;
    imaginary += y * u - x * v;
  }
  return {real, imaginary};
}

inline double find_fastest_rate(const Start& s) {
  const double rates = find_modulus({s.wx, s.wy}), spin = std::fabs(s.wz) * (s.Iz / s.Ix);
  const double weight = std::sqrt(2 * (s.Mgl / s.Ix));
  return std::fmax(std::fmax(rates, spin), std::fmax(weight, SLOWEST));
}

struct FirstInstants {
  double unit;
  Series A, B, omega;
  Steps half_turn;

  void prepare(const Start& s, Pair A0, Pair B0, const Precise& half_c) {
    // In this unit of time all rates are below 1: no power of them overflows. It is a power of two,
    // so that nothing is rounded.
    int exponent;
    std::frexp(find_fastest_rate(s), &exponent);
    unit = std::ldexp(1.0, exponent);
    const double half_spin = 0.5 * (s.wz / unit) * (s.Iz / s.Ix);
    const double beta = 2 * (s.Mgl / s.Ix / unit) / unit;
    A.real[0] = A0.x;
    A.imaginary[0] = A0.y;
    B.real[0] = B0.x;
    B.imaginary[0] = B0.y;
    omega.real[0] = s.wx / unit;
    omega.imaginary[0] = s.wy / unit;
    // Euler's equations and q' = q (0, omega)/2 in the frame that does not turn by c: there gravity
    // alone changes omega_xy. All products are convolutions.
    for (int n = 0; n < TERMS; n++) {
      const Pair over = convolve_with_conjugate(B, omega, n), along = convolve(omega, A, n);
      const Pair weight = convolve_with_conjugate(B, A, n);
      const int order = n + 1;
      omega.real[order] = beta * weight.x / order;
      omega.imaginary[order] = beta * weight.y / order;
      A.real[order] = (-half_spin * A.imaginary[n] - over.x / 2) / order;
      A.imaginary[order] = (half_spin * A.real[n] - over.y / 2) / order;
      B.real[order] = (along.x / 2 + half_spin * B.imaginary[n]) / order;
      B.imaginary[order] = (along.y / 2 - half_spin * B.real[n]) / order;
    }
    half_turn = find_steps(&half_c, 1);
  }

  void compute(double seconds, const Phase& phase, Pair values[FUNCTIONS]) const {
    const double time = unit * seconds;
    const Pair turn = find_unit(phase), back = conjugate(turn);
    const Pair rate = multiply(multiply(omega.sum_powers(time), back), back);
    values[OF_A] = multiply(A.sum_powers(time), turn);
    values[OF_B] = multiply(B.sum_powers(time), back);
    values[OF_OMEGA_XY] = {rate.x * unit, rate.y * unit};
  }
};

}  // namespace symtop

// The equations of motion of a driven top, with quadratic derivatives.
//
// The spin about the axis is split off. It is counted as an angle, and the rest is integrated in a
// frame that turns about the axis at Iz/Ix omega_z instead of omega_z. There friction and weight
// have the same form as in the body, and the angular velocity of a free top is constant. Steps have
// to resolve the nutation only, however fast a slender body spins. See docs/derivation.md, section
// 15.
//
// Let omega be the angular velocity of the body in the axes of this frame, whose own one is Omega =
// (omega_x, omega_y, s omega_z) with s = Iz/Ix, and S the angle of spin, with S' = omega_z. The
// body is turned in the frame by (1 - s) S about the axis. The axis is one of symmetry: L = (Ix
// omega_x, Ix omega_y, Iz omega_z) = Ix Omega in the frame, so that Omega x L = 0. Every derivative
// is then a polynomial of degree 2:
//
// - of the quaternion q of the frame: q' = q (0, Omega)/2,
// - of omega, by Euler's equations in the turning frame, L' + Omega x L = N:
//     omega_x' = N_x/Ix, omega_y' = N_y/Ix, omega_z' = N_z/Iz
//   The directions in N are quadratic in q, and friction is linear in omega.
//
// An error of the angular velocity grows with time, therefore rounding must not accumulate in it.
// The state between two steps and the constants have 32 digits, as sums of two doubles, and the
// largest terms of the series 23 or 32 (parts.hpp), with the same bits on every machine.
#pragma once

#include "double2.hpp"

namespace symtop {

// The length of a vector. Very large or small components are scaled by a power of two, which rounds
// nothing: the squares of a weak torque or a slow rate would be zero, and steps then far too long.
inline double find_length(double x, double y, double z) {
  const double squares = x * x + y * y + z * z;
  if (squares > 0x1p-900 && squares < 0x1p900) return std::sqrt(squares);
  const double largest = std::fmax(std::fmax(std::fabs(x), std::fabs(y)), std::fabs(z));
  if (!(largest > 0 && largest < INFINITY)) return largest;
  int exponent;
  std::frexp(largest, &exponent);
  x = std::ldexp(x, -exponent);
  y = std::ldexp(y, -exponent);
  z = std::ldexp(z, -exponent);
  return std::ldexp(std::sqrt(x * x + y * y + z * z), exponent);
}

// What changes: the quaternion of the frame, and three rates with the spin.
const int W = 0, X = 1, Y = 2, Z = 3;
const int OMEGA_X = 0, OMEGA_Y = 1, OMEGA_Z = 2, SPIN = 3;
struct Variables {
  SumOf<Lanes> q, rates;
};

// Products of two components of q, in blocks of four. The weight has those of the first block
// alone.
enum { WX, XZ, WY, YZ, WW, XX, YY, ZZ, WZ, XY, SQUARES };

struct DrivenArguments {
  double Ix, Iz, Mgl, axial, transverse, torque[3], orientation[4], omega[3];
};

// Coefficients of the angular accelerations, in lanes: of the rates, of the weight's two products,
// and of all products for the torques.
struct Coefficients {
  SumOf<Lanes> friction, weight, torques[SQUARES];

  // For the unit of time u: the variables are q and u omega, and d(u omega)/d(t/u) = u^2 omega', so
  // that friction has the factor u, a torque u^2, and q' and S' are as they were.
  Coefficients in_unit(double unit) const {
    Coefficients scaled = *this;
    scaled.friction = scale(friction, Lanes{unit, unit, unit, 1.0});
    scaled.weight = scale_twice(weight, unit);
    for (int p = 0; p < SQUARES; p++) scaled.torques[p] = scale_twice(torques[p], unit);
    return scaled;
  }

 private:
  // The square of a unit may be out of range.
  static SumOf<Lanes> scale_twice(SumOf<Lanes> a, double unit) {
    const Lanes units = repeat<Lanes>(unit);
    return scale(scale(a, units), units);
  }
};

struct DrivenEquations {
  bool has_torque = false;
  Coefficients coefficients = {};
  // Iz/Ix, and (1 - Iz/Ix)/2: of S half the angle of the body in the frame
  Double2 share, half_rest;
  double swing, decay;

  void prepare(const DrivenArguments& top) {
    const Double2 Ix = {top.Ix, 0.0}, Iz = {top.Iz, 0.0}, Mgl = {top.Mgl, 0.0};
    share = Iz / Ix;
    half_rest = scale(Double2{1.0, 0.0} - share, 0.5);
    const Double2 across = Double2{top.transverse, 0.0} / Ix, along = Double2{top.axial, 0.0} / Iz;
    const Double2 friction[4] = {-across, -across, -along, {1.0, 0.0}};  // S' = omega_z
    coefficients.friction = gather(friction);
    // The weight acts at l on the axis e: -Mgl e x Z = Mgl (Z_y, -Z_x, 0), with the vertical
    // Z = 2 (x z - w y, y z + w x, ...) in the frame. Its component along the axis is zero.
    const Double2 weight = scale(Mgl / Ix, 2.0), weights[4] = {weight, weight};
    coefficients.weight = gather(weights);
    for (int axis = 0; axis < 3; axis++) {
      const Double2 torque = {top.torque[axis], 0.0};
      has_torque |= torque.high != 0;
      add_torque(OMEGA_X, axis, 0, torque / Ix);
      add_torque(OMEGA_Y, axis, 1, torque / Ix);
      add_torque(OMEGA_Z, axis, 2, torque / Iz);
    }
    const double size = find_length(top.torque[0], top.torque[1], top.torque[2]);
    swing = std::sqrt((std::fabs(top.Mgl) + size) / top.Ix);
    decay = std::fmax(across.high, along.high);
  }

  double estimate_rate(const Variables& now) const {
    const Lanes rates = now.rates.high;
    return find_length(rates[OMEGA_X], rates[OMEGA_Y], share.high * rates[OMEGA_Z]) + swing + decay;
  }

 private:
  static SumOf<Lanes> gather(const Double2 a[4]) {
    return {Lanes{a[0].high, a[1].high, a[2].high, a[3].high},
            Lanes{a[0].low, a[1].low, a[2].low, a[3].low}};
  }

  // A torque along the axis `axis` of the world: its component `component` in the frame. This is
  // the entry of the matrix of q in row `axis` and column `component`, of which q v q* gives
  //
  //   w^2 + x^2 - y^2 - z^2   2 (x y - w z)           2 (x z + w y)
  //   2 (x y + w z)           w^2 + y^2 - x^2 - z^2   2 (y z - w x)
  //   2 (x z - w y)           2 (y z + w x)           w^2 + z^2 - x^2 - y^2
  //
  // A row has the components of a world axis in the frame. Of each entry: a product, and its
  // coefficient; 0 where there are less than four.
  void add_torque(int row, int axis, int component, Double2 size) {
    static const int ENTRIES[3][3][4][2] = {
        {{{WW, 1}, {XX, 1}, {YY, -1}, {ZZ, -1}}, {{XY, 2}, {WZ, -2}}, {{XZ, 2}, {WY, 2}}},
        {{{XY, 2}, {WZ, 2}}, {{WW, 1}, {YY, 1}, {XX, -1}, {ZZ, -1}}, {{YZ, 2}, {WX, -2}}},
        {{{XZ, 2}, {WY, -2}}, {{YZ, 2}, {WX, 2}}, {{WW, 1}, {ZZ, 1}, {XX, -1}, {YY, -1}}}};
    for (const auto& entry : ENTRIES[axis][component]) {
      SumOf<Lanes>& all = coefficients.torques[entry[0]];
      const Double2 sum = pick(all, row) + scale(size, double(entry[1]));
      all.high[row] = sum.high;
      all.low[row] = sum.low;
    }
  }
};

}  // namespace symtop

// What a top gains from one state to another: the parts of its energy, and its height.
//
// Changes are products. The change of a square is the difference times the sum, and a height is a
// square of half the tilt: of two states that hardly differ, or next to the vertical, nothing is
// lost in large numbers that cancel.
#pragma once

#include "attitude.hpp"

namespace symtop {

// The rates of a state of which its energies are squares, and half of its tilt.
struct EnergyRates {
  Pair half;       // cosine and sine of theta/2
  double height;   // cos(theta)
  double along;    // phi' sin(theta)
  double tilting;  // theta'
  double axial;    // omega_z

  EnergyRates(const double q[4], const double omega[3])
      : half{find_modulus({q[0], q[3]}), find_modulus({q[1], q[2]})}, axial(omega[2]) {
    const Vertical g(q);
    const double sine = g.find_sine();
    height = g.z;
    if (sine > 0) {
      along = (omega[0] * g.x + omega[1] * g.y) / sine;
      tilting = (omega[0] * g.y - omega[1] * g.x) / sine;
    } else {  // phi' sin(theta) goes to zero when the axis passes the vertical
      along = 0.0;
      tilting = find_modulus({omega[0], omega[1]});
    }
  }
};

inline double subtract_squares(double first, double last) {
  return (last - first) * (last + first);
}

// The change of cos(theta) = 1 - 2 sin^2(theta/2) = 2 cos^2(theta/2) - 1: of both the smaller
// square has more digits.
inline double subtract_heights(const EnergyRates& first, const EnergyRates& last) {
  if (first.half.y + last.half.y < first.half.x + last.half.x)
    return -2 * subtract_squares(first.half.y, last.half.y);
  return 2 * subtract_squares(first.half.x, last.half.x);
}

inline symtop_energies find_energies(const symtop_top& top, const EnergyRates& now) {
  return {top.Mgl * now.height, top.Ix / 2 * (now.along * now.along),
          top.Ix / 2 * (now.tilting * now.tilting), top.Iz / 2 * (now.axial * now.axial)};
}

inline symtop_energies find_gains(const symtop_top& top, const EnergyRates& first,
                                  const EnergyRates& last, double height) {
  return {top.Mgl * height, top.Ix / 2 * subtract_squares(first.along, last.along),
          top.Ix / 2 * subtract_squares(first.tilting, last.tilting),
          top.Iz / 2 * subtract_squares(first.axial, last.axial)};
}

inline double find_larger(double a, double b) { return std::fmax(std::fabs(a), std::fabs(b)); }

inline symtop_exchange find_exchange(const symtop_top& top, const EnergyRates& first,
                                     const EnergyRates& last) {
  symtop_exchange found;
  found.height = subtract_heights(first, last);
  found.gained = find_gains(top, first, last, found.height);
  found.first = find_energies(top, first);
  found.last = find_energies(top, last);
  const symtop_energies &a = found.first, &b = found.last;
  found.sizes = {std::fabs(top.Mgl), std::fmax(a.precession, b.precession),
                 std::fmax(a.nutation, b.nutation), std::fmax(a.spin, b.spin)};
  found.momentum_size =
      top.Ix * (find_larger(first.along, last.along) + find_larger(first.tilting, last.tilting)) +
      top.Iz * find_larger(first.axial, last.axial);
  found.mean_along = (first.along + last.along) / 2;
  found.last_sine = 2 * last.half.x * last.half.y;
  return found;
}

}  // namespace symtop

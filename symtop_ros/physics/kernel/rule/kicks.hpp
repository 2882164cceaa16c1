// Kicks: instantaneous changes of the angular velocity at fixed attitude.
//
// If phi' changes by delta with theta' and psi' held, the angular velocity changes by delta z' (z'
// is the world's vertical). If theta' and the axial momentum are held, only the part of this across
// the axis is added. Neither divides by sin(theta), except to find the present phi'.
#pragma once

#include "../symtop.h"
#include "attitude.hpp"

namespace symtop {

// Adds a change of phi'. A push on the axle cannot change the axial momentum Iz omega_z.
inline void change_precession(const Vertical& g, double change, symtop_hold hold, double omega[3]) {
  omega[0] += change * g.x;
  omega[1] += change * g.y;
  omega[2] += hold == SYMTOP_SPIN_MOMENTUM ? 0.0 : change * g.z;
}

// A kick that ends the precession leaves rounding of what there was. It is taken off as well: a
// later kick would find a rate of 1e-15 rad/s, and hurry or reverse it by its sign. What is then
// left of a top without theta', or without psi', is no more than rounding.
inline void end_precession(const Vertical& g, symtop_hold hold, double omega[3]) {
  const double across = find_modulus({omega[0], omega[1]});
  const double rounding = 8 * EPS * std::fmax(across, std::fabs(omega[2]));
  for (int step = 0; step < 2; step++)
    change_precession(g, -find_precession_rate(g, omega), hold, omega);
  if (find_modulus({omega[0], omega[1]}) <= 8 * EPS * across) omega[0] = omega[1] = 0.0;
  if (std::fabs(omega[2]) <= rounding) omega[2] = 0.0;
}

// The components in the body frame of a vector of the world: q* v q.
inline void turn_to_body(const double q[4], const double v[3], double turned[3]) {
  const double w = -q[0], x = q[1], y = q[2], z = q[3], a = v[0], b = v[1], c = v[2];
  const double t = 2 * (y * c - z * b), u = 2 * (z * a - x * c), s = 2 * (x * b - y * a);
  turned[0] = a + w * t + (y * s - z * u);
  turned[1] = b + w * u + (z * t - x * s);
  turned[2] = c + w * s + (x * u - y * t);
}

// Adds what an angular impulse in the world frame, N m s, changes.
inline void add_impulse(const symtop_top& top, const double q[4], const double impulse[3],
                        double omega[3]) {
  double J[3];
  turn_to_body(q, impulse, J);
  omega[0] += J[0] / top.Ix;
  omega[1] += J[1] / top.Ix;
  omega[2] += J[2] / top.Iz;
}

// Adds what a push on the axle changes, to the side to which phi grows: its angular impulse, N m s,
// is across the axle, in the vertical plane of both.
inline void push_axle(const symtop_top& top, const Vertical& g, double impulse, double omega[3]) {
  const double change = impulse / top.Ix, sine = g.find_sine();
  omega[0] += change * (g.x / sine);
  omega[1] += change * (g.y / sine);
}

// The new precession rate that a kick asks for, given the present one; NaN of one that asks for
// none. Without a default: a compiler names a kind that is missing here.
inline double find_new_rate(symtop_kick_kind kind, double amount, double now) {
  switch (kind) {
    case SYMTOP_NEW_RATE: return amount;
    case SYMTOP_CHANGE_OF_RATE: return now + amount;
    case SYMTOP_FACTOR_OF_RATE: return amount * now;
    case SYMTOP_IMPULSE:
    case SYMTOP_AXLE_IMPULSE: break;
  }
  return NAN;
}

// The angular velocity after a kick; false if the axis is vertical, where phi' is undefined.
inline bool kick(const symtop_top& top, const double q[4], symtop_kick_kind kind, symtop_hold hold,
                 const double* amount, double omega[3]) {
  if (kind == SYMTOP_IMPULSE) {
    add_impulse(top, q, amount, omega);
  } else {
    const Vertical g(q);
    if (g.is_of_vertical_axis()) return false;
    if (kind == SYMTOP_AXLE_IMPULSE) {
      push_axle(top, g, *amount, omega);
    } else {
      const double now = find_precession_rate(g, omega), rate = find_new_rate(kind, *amount, now);
      if (rate == 0)
        end_precession(g, hold, omega);
      else
        change_precession(g, rate - now, hold, omega);
    }
  }
  flush_tiny(omega, 3);
  return true;
}

// A start after a kick by a factor that is only considered; on the vertical it is the start itself.
inline symtop_start consider_kick(symtop_start s, double factor, symtop_hold hold) {
  const symtop_top top = {s.Ix, s.Iz, s.Mgl};
  kick(top, s.orientation, SYMTOP_FACTOR_OF_RATE, hold, &factor, s.angular_velocity);
  return s;
}

}  // namespace symtop

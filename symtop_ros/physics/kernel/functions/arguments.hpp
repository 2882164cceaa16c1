// Arguments that every function checks in the same way.
#pragma once

#include "../gravity.hpp"
#include "../rule/attitude.hpp"
#include "../symtop.h"

namespace symtop {

const double NORM_TOLERANCE = 1e-3;  // a norm further from 1 is an error of the caller
const double LARGEST_DOUBLE = 1.7976931348623157e308;

inline bool is_between(double x, double least, double most) { return least <= x && x <= most; }

// False for a NaN, too.
inline bool are_at_most(const double* numbers, size_t count, double most) {
  for (size_t i = 0; i < count; i++)
    if (!(std::fabs(numbers[i]) <= most)) return false;
  return true;
}

inline bool are_finite(const double* numbers, size_t count) {
  return are_at_most(numbers, count, LARGEST_DOUBLE);
}

inline bool is_top(double Ix, double Iz, double Mgl) {
  return is_between(Ix, SMALLEST, LARGEST) && is_between(Iz, SMALLEST, LARGEST) &&
         Iz <= 2 * Ix && std::fabs(Mgl) <= LARGEST;
}

inline bool is_orientation(const double q[4]) {
  const double norm = std::sqrt((q[0] * q[0] + q[3] * q[3]) + (q[1] * q[1] + q[2] * q[2]));
  return std::fabs(norm - 1) <= NORM_TOLERANCE;
}

// Checks a start, and sets to zero what is too small to be squared.
inline symtop_status accept(symtop_start& s) {
  if (!is_sound()) return SYMTOP_BAD_ARITHMETIC;
  if (!is_top(s.Ix, s.Iz, s.Mgl)) return SYMTOP_BAD_TOP;
  if (!is_orientation(s.orientation)) return SYMTOP_BAD_ORIENTATION;
  if (!are_at_most(s.angular_velocity, 3, LARGEST)) return SYMTOP_BAD_ANGULAR_VELOCITY;
  for (double each : s.friction)
    if (!is_between(each, 0.0, LARGEST_DOUBLE)) return SYMTOP_BAD_FRICTION;
  if (!are_finite(s.torque, 3)) return SYMTOP_BAD_TORQUE;
  flush_tiny(s.orientation, 4), flush_tiny(s.angular_velocity, 3);
  return SYMTOP_OK;
}

inline Start to_start(const symtop_start& s) {
  const double *q = s.orientation, *omega = s.angular_velocity;
  return {s.Ix, s.Iz, s.Mgl, q[0], q[1], q[2], q[3], omega[0], omega[1], omega[2]};
}

inline bool is_driven(const symtop_start& s) {
  for (double each : s.friction)
    if (each != 0) return true;
  for (double each : s.torque)
    if (each != 0) return true;
  return false;
}

}  // namespace symtop

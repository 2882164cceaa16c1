// The arguments of every function of symtop.h: what is refused, and what is normalised.
//
// A caller may pass anything: null pointers, NaN, enums that are none. Each function first asks
// `admit` for what must hold before anything is read. Then it takes each argument by one of the
// functions below, and computes from the copy that this makes. Nothing else of the kernel checks
// what it is given.
#pragma once

#include <initializer_list>

#include "../clock.hpp"
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

// ---- Before anything is read ----

typedef std::initializer_list<const void*> Pointers;

inline bool have_null(Pointers pointers) {
  for (const void* each : pointers)
    if (!each) return true;
  return false;
}

// Of a function without a motion: nothing has looked at the arithmetic yet.
inline symtop_status admit(Pointers pointers) {
  if (have_null(pointers)) return SYMTOP_BAD_POINTER;
  return is_sound() ? SYMTOP_OK : SYMTOP_BAD_ARITHMETIC;
}

// Of a motion, which sound code has made: only the thread may have changed.
inline symtop_status admit_motion(Pointers pointers) {
  if (have_null(pointers)) return SYMTOP_BAD_POINTER;
  return rounds_to_nearest() ? SYMTOP_OK : SYMTOP_BAD_ARITHMETIC;
}

// Of arrays with `count` elements, the largest of so many bytes. No object is larger than
// PTRDIFF_MAX; arrays without elements may be null.
inline symtop_status admit_arrays(size_t count, size_t bytes, Pointers arrays) {
  if (count && have_null(arrays)) return SYMTOP_BAD_POINTER;
  return count <= static_cast<size_t>(PTRDIFF_MAX) / bytes ? SYMTOP_OK : SYMTOP_BAD_COUNT;
}

const size_t ORIENTATION_BYTES = 4 * sizeof(double);  // the largest element of most functions

// Calls `compute` for the places of `count` elements, up to the first that is refused; *done is how
// many are computed. The place is kept apart: a buffer may overlap *done, although it must not.
template <class Compute>
symtop_status compute_each(size_t count, size_t bytes, Pointers arrays, size_t* done,
                           const Compute& compute) {
  if (!done) return SYMTOP_BAD_POINTER;
  *done = 0;
  symtop_status status = admit({});
  if (status == SYMTOP_OK) status = admit_arrays(count, bytes, arrays);
  size_t i = 0;
  while (status == SYMTOP_OK && i < count) {
    status = compute(i);
    if (status == SYMTOP_OK) i++;
  }
  *done = i;
  return status;
}

// ---- What each argument must be ----

// The number of an enum that may have any: to compare it as an enum is undefined if it is none.
template <class Enum>
inline int read_number(const Enum& given) {
  int number;
  static_assert(sizeof number == sizeof given, "an enum of C is an int");
  std::memcpy(&number, &given, sizeof number);
  return number;
}

inline bool is_number_of(int number, int last) { return 0 <= number && number <= last; }

// What a change of phi' holds: SYMTOP_NOTHING is held by impulses alone.
inline symtop_status accept_hold(const symtop_hold& hold) {
  return is_number_of(read_number(hold), SYMTOP_SPIN_MOMENTUM) ? SYMTOP_OK : SYMTOP_BAD_HOLD;
}

inline symtop_status accept_hold_of_kick(const symtop_hold& hold) {
  return is_number_of(read_number(hold), SYMTOP_NOTHING) ? SYMTOP_OK : SYMTOP_BAD_HOLD;
}

inline symtop_status accept_kind_of_kick(const symtop_kick_kind& kind) {
  return is_number_of(read_number(kind), SYMTOP_AXLE_IMPULSE) ? SYMTOP_OK : SYMTOP_BAD_KICK_KIND;
}

inline bool is_impulse(symtop_kick_kind kind) {
  return kind == SYMTOP_IMPULSE || kind == SYMTOP_AXLE_IMPULSE;
}

inline bool is_top(double Ix, double Iz, double Mgl) {
  return is_between(Ix, SMALLEST, LARGEST) && is_between(Iz, SMALLEST, LARGEST) && Iz <= 2 * Ix &&
         std::fabs(Mgl) <= LARGEST;
}

inline symtop_status accept(const symtop_top& top) {
  return is_top(top.Ix, top.Iz, top.Mgl) ? SYMTOP_OK : SYMTOP_BAD_TOP;
}

inline double square_norm(const double q[4]) {
  return (q[0] * q[0] + q[3] * q[3]) + (q[1] * q[1] + q[2] * q[2]);
}

inline bool is_orientation(const double q[4]) {
  return std::fabs(std::sqrt(square_norm(q)) - 1) <= NORM_TOLERANCE;
}

// The squares whose roots are within NORM_ROUNDING, 4 EPS, of 1. Above 1 a root rounds to at most 1
// + 4 EPS if the square is at most 1 + 9 EPS, as its exact root, less than 1 + 4.5 EPS, is nearer
// to that than to the next double. Below 1, where doubles are half as far apart, it is 1 - 8 EPS
// whose root is less than 1 - 4 EPS by its last digits, and 1 - 8.5 EPS whose root rounds to
// another double.
inline bool is_unit(double square) { return 1 - 8 * EPS <= square && square <= 1 + 9 * EPS; }

// A number that is too small to be squared is zero, of its sign: angles on the vertical depend on
// it.
inline double drop_tiny(double x) { return std::fabs(x) < SMALLEST ? std::copysign(0.0, x) : x; }

// Drops what is tiny, and gives norm 1: the doubles of Python's State. Most orientations have it
// already, and then keep their bits without a root and a quotient.
inline symtop_status accept_orientation(const double given[4], double q[4]) {
  for (int k = 0; k < 4; k++) q[k] = drop_tiny(given[k]);
  if (is_unit(square_norm(q))) return SYMTOP_OK;
  if (!is_orientation(q)) return SYMTOP_BAD_ORIENTATION;
  const Start unit = normalize(Start{1.0, 1.0, 0.0, q[0], q[1], q[2], q[3], 0.0, 0.0, 0.0});
  q[0] = unit.w;
  q[1] = unit.x;
  q[2] = unit.y;
  q[3] = unit.z;
  return SYMTOP_OK;
}

inline symtop_status accept_angular_velocity(const double given[3], double omega[3]) {
  bool are = true;
  for (int k = 0; k < 3; k++) {
    are &= std::fabs(given[k]) <= LARGEST;
    omega[k] = drop_tiny(given[k]);
  }
  return are ? SYMTOP_OK : SYMTOP_BAD_ANGULAR_VELOCITY;
}

// An orientation, and an angular velocity.
inline symtop_status accept_state(const double q[4], const double omega[3], double to_q[4],
                                  double to_omega[3]) {
  const symtop_status status = accept_orientation(q, to_q);
  return status == SYMTOP_OK ? accept_angular_velocity(omega, to_omega) : status;
}

// Of a start whose arithmetic is known to be sound. What is too small to be squared is set to zero.
// The orientation keeps the digits that were given: a motion normalises it with 57.
inline symtop_status accept(symtop_start& s) {
  if (!is_top(s.Ix, s.Iz, s.Mgl)) return SYMTOP_BAD_TOP;
  if (!is_orientation(s.orientation)) return SYMTOP_BAD_ORIENTATION;
  if (!are_at_most(s.angular_velocity, 3, LARGEST)) return SYMTOP_BAD_ANGULAR_VELOCITY;
  for (double each : s.friction)
    if (!is_between(each, 0.0, LARGEST_DOUBLE)) return SYMTOP_BAD_FRICTION;
  if (!are_finite(s.torque, 3)) return SYMTOP_BAD_TORQUE;
  flush_tiny(s.orientation, 4);
  flush_tiny(s.angular_velocity, 3);
  return SYMTOP_OK;
}

inline bool is_driven(const symtop_start& s) {
  for (double each : s.friction)
    if (each != 0) return true;
  for (double each : s.torque)
    if (each != 0) return true;
  return false;
}

// The axis is tilted, so that phi is defined, and nothing acts that would need a series.
inline symtop_status accept_clamped(const symtop_start& s) {
  const double* q = s.orientation;
  const bool is_vertical = (q[0] == 0 && q[3] == 0) || (q[1] == 0 && q[2] == 0);
  return is_vertical || is_driven(s) ? SYMTOP_BAD_CLAMP : SYMTOP_OK;
}

inline symtop_status accept_angles(const double* angles, size_t count) {
  return are_finite(angles, count) ? SYMTOP_OK : SYMTOP_BAD_ANGLES;
}

inline symtop_status accept_rates(Pair rates) {
  return are_at_most(&rates.x, 1, LARGEST) && are_at_most(&rates.y, 1, LARGEST) ? SYMTOP_OK
                                                                                : SYMTOP_BAD_RATE;
}

inline symtop_status accept_times(const double* times, size_t count) {
  return are_finite(times, count) ? SYMTOP_OK : SYMTOP_BAD_TIME;
}

inline bool is_part_of_clock(double x) {
  return x == 0 || is_between(std::fabs(x), SMALLEST, LARGEST);
}

inline symtop_status accept(const symtop_clock& given, Clock& clock) {
  clock = {given.factor, {}};
  bool is_valid = is_part_of_clock(given.factor);
  for (int i = 0; i < ELAPSED_PARTS; i++) {
    clock.elapsed[i] = given.elapsed[i];
    is_valid &= is_part_of_clock(given.elapsed[i]);
  }
  return is_valid ? SYMTOP_OK : SYMTOP_BAD_TIME;
}

const double LEAST_TOLERANCE = 1e-15, LARGEST_TOLERANCE = 1e-6;

inline symtop_status accept_tolerance(double tolerance) {
  const bool is = tolerance == 0 || is_between(tolerance, LEAST_TOLERANCE, LARGEST_TOLERANCE);
  return is ? SYMTOP_OK : SYMTOP_BAD_TOLERANCE;
}

inline symtop_status accept_steps(double most_steps) {
  return most_steps >= 0 ? SYMTOP_OK : SYMTOP_BAD_STEPS;
}

// The first of some answers that is a refusal.
inline symtop_status find_refusal(std::initializer_list<symtop_status> answers) {
  for (const symtop_status each : answers)
    if (each != SYMTOP_OK) return each;
  return SYMTOP_OK;
}

// ---- What they are for the rest of the kernel ----

inline Start to_start(const symtop_start& s) {
  const double *q = s.orientation, *omega = s.angular_velocity;
  return {s.Ix, s.Iz, s.Mgl, q[0], q[1], q[2], q[3], omega[0], omega[1], omega[2]};
}

}  // namespace symtop

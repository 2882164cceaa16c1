// A state in the axes of the body, with 32 digits, and how it is one of the turning frame.
#pragma once

#include "equations.hpp"
#include "series.hpp"

namespace symtop {

struct Unit {
  Double2 c, s;
};

const Double2 QUARTER = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};  // of a turn

// Cosine and sine of an angle, to some digits more than doubles have.
inline Unit find_unit(Double2 angle) {
  const double quarters = round_to_integer(angle.high * QUARTERS);
  const Double2 near = angle - QUARTER * quarters;
  const double x = near.high, square = x * x;
  static const double SINE[] = {
      1.0 / 355687428096000, -1.0 / 1307674368000, 1.0 / 6227020800, -1.0 / 39916800,
      1.0 / 362880,          -1.0 / 5040,          1.0 / 120};
  static const double VERSINE[] = {
      -1.0 / 20922789888000, 1.0 / 87178291200, -1.0 / 479001600, 1.0 / 3628800,
      -1.0 / 40320,          1.0 / 720,         -1.0 / 24};
  double of_sine = 0.0, of_versine = 0.0;
  for (double each : SINE) of_sine = (of_sine + each) * square;
  for (double each : VERSINE) of_versine = (of_versine + each) * square;
  // The largest terms, x - x^3/6 and 1 - x^2/2, as sums of two doubles.
  const Double2 near_2 = near * near, sixth = INVERSES[6];
  const Double2 sine = near - near * near_2 * sixth + Double2{x * (square * of_sine), 0.0};
  const Double2 cosine = Double2{1.0, 0.0} - scale(near_2, 0.5) - Double2{square * of_versine, 0.0};
  const int64_t turns = static_cast<int64_t>(quarters);
  const Unit unit = turns & 1 ? Unit{sine, cosine} : Unit{cosine, sine};
  return {(turns + 1) & 2 ? -unit.c : unit.c, turns & 2 ? -unit.s : unit.s};
}

// The same to 24 digits. Of the angle x that is 2^-7 of this one, at most 0.025 rad, doubles round
// the terms from x^4/24 on, by 2e-24 of sine and cosine. Doubling the angle keeps a relative error
// of the sine.
inline Unit find_fine_unit(Double2 angle) {
  const int DOUBLINGS_OF_ANGLE = 7;
  const Double2 near = angle - QUARTER * (4 * round_to_integer(angle.high * QUARTERS / 4));
  Unit unit = find_unit(scale(near, 1.0 / (1 << DOUBLINGS_OF_ANGLE)));
  for (int n = 0; n < DOUBLINGS_OF_ANGLE; n++)
    unit = {Double2{1.0, 0.0} - scale(unit.s * unit.s, 2.0), scale(unit.c * unit.s, 2.0)};
  return unit;
}

// The body is turned in the frame by (1 - s) S about the axis: see equations.hpp. Half of that.
inline Double2 find_spin_in_frame(const Variables& now, const DrivenEquations& equations) {
  return pick(now.rates, SPIN) * equations.half_rest;
}

struct BodyState {
  Double2 q[4], omega[3];

  // The numbers that were given, and the orientation with more digits of norm 1.
  explicit BodyState(const DrivenArguments& given) {
    Double2 norm = {0.0, 0.0};
    for (double each : given.orientation) norm = norm + Double2{each, 0.0} * each;
    norm = root(norm);
    for (int k = 0; k < 4; k++) q[k] = Double2{given.orientation[k], 0.0} / norm;
    for (int k = 0; k < 3; k++) omega[k] = {given.omega[k], 0.0};
  }

  // From a state in the frame, in which the body is turned about the axis; `half` has cosine and
  // sine of half the angle.
  BodyState(const Variables& now, const Unit& half) {
    const Double2 w = pick(now.q, W), x = pick(now.q, X), y = pick(now.q, Y), z = pick(now.q, Z);
    const Double2 omega_x = pick(now.rates, OMEGA_X), omega_y = pick(now.rates, OMEGA_Y);
    const Double2 c = half.c, s = half.s;
    q[0] = w * c - z * s;
    q[1] = x * c + y * s;
    q[2] = y * c - x * s;
    q[3] = z * c + w * s;
    const Double2 c2 = c * c - s * s, s2 = scale(c * s, 2.0);
    omega[0] = omega_x * c2 + omega_y * s2;
    omega[1] = omega_y * c2 - omega_x * s2;
    omega[2] = pick(now.rates, OMEGA_Z);
  }

  // In a frame that begins as the body, without spin.
  Variables in_frame() const {
    Variables now = {};
    for (int k = 0; k < 4; k++) {
      now.q.high[k] = q[k].high;
      now.q.low[k] = q[k].low;
    }
    for (int k = 0; k < 3; k++) {
      now.rates.high[k] = omega[k].high;
      now.rates.low[k] = omega[k].low;
    }
    return now;
  }
};

}  // namespace symtop

// Where rounding decides the kind of a motion: that of its start reaches the separatrix, and one
// last place of an input can be seen from some time on (derivation.md, section 13).
#pragma once

#include "../gravity.hpp"
#include "attitude.hpp"

namespace symtop {

const double TOLD_APART = 0.01;  // rad between the axes
const int INPUTS = 10;           // of a start without friction and torque
const int LOOKS = 500;           // in two periods

// The z axis of the body in the world: that of the world in the body, turned back.
inline Vertical find_axis(const double q[4]) {
  const double back[] = {q[0], -q[1], -q[2], -q[3]};
  return Vertical(back);
}

// Between the ends of the axes of two motions: their angle, for small ones.
inline double find_distance(GravityMotion& one, GravityMotion& other, double t) {
  double p[4], q[4], omega[3];
  if (!one.read(t, {p, omega}) || !other.read(t, {q, omega})) return 0.0;
  const Vertical a = find_axis(p), b = find_axis(q);
  return find_modulus({find_modulus({a.x - b.x, a.y - b.y}), a.z - b.z});
}

// The first time at which two motions are seen to differ, within two of their nutations; infinite
// if they do not. Next to the separatrix a period takes 2 ln(1/EPS), 72 times that in which an
// error grows by e, so that it grows by less than a half from one look to the next.
inline double find_parting(GravityMotion& one, GravityMotion& other) {
  double longest = 0.0;
  for (GravityMotion* each : {&one, &other}) {
    const double period = each->find_rates().nutation_period;
    if (std::isfinite(period) && period > longest) longest = period;
  }
  const double step = 2 * longest / LOOKS;
  for (int k = 1; k <= LOOKS; k++) {
    if (find_distance(one, other, k * step) <= TOLD_APART) continue;
    double before = (k - 1) * step, after = k * step;
    for (int halvings = 0; halvings < 30; halvings++) {
      const double middle = (before + after) / 2;
      (find_distance(one, other, middle) > TOLD_APART ? after : before) = middle;
    }
    return after;
  }
  return INFINITY;
}

// The inputs of a start, to be changed one by one.
inline double& find_input(Start& s, int k) {
  double* const inputs[INPUTS] = {&s.Ix, &s.Iz, &s.Mgl, &s.w,  &s.x,
                                  &s.y,  &s.z,  &s.wx,  &s.wy, &s.wz};
  return *inputs[k];
}

// True if the rounding of a start reaches the separatrix: on the vertical where the weight is
// highest no energy is left for theta', if phi' needs none there. Ix |omega_xy|^2/2 is then what
// the weight takes on the way, 2 |Mgl| times the square of the part of the quaternion that vanishes
// there.
inline bool may_be_asymptotic(const Start& s) {
  const auto square = [](double x) { return Precise(x) * Precise(x); };
  const Precise upper = square(s.w) + square(s.z), lower = square(s.x) + square(s.y);
  const Precise turning = Precise(s.Ix) * (square(s.wx) + square(s.wy)) * (upper + lower);
  const Precise way = (Precise(std::fabs(s.Mgl)) * (s.Mgl > 0 ? lower : upper)).scale(2);
  return size(turning - way) <= Precise(START_ROUNDING) * (turning + way);
}

// The time from which on a start and one of its neighbours differ; infinite if they do not.
inline double find_doubt(const Start& start) {
  double shows_at = INFINITY;
  if (!may_be_asymptotic(start)) return shows_at;
  GravityMotion motion(start);
  for (int k = 0; k < INPUTS; k++)
    for (const double towards : {-INFINITY, INFINITY}) {
      Start changed = start;
      double& input = find_input(changed, k);
      if (input == 0) continue;  // its neighbours are too small to count
      input = std::nextafter(input, towards);
      if (changed.Iz > 2 * changed.Ix) continue;
      GravityMotion neighbour(changed);
      const double parting = find_parting(motion, neighbour);
      if (parting < shows_at) shows_at = parting;
    }
  return shows_at;
}

}  // namespace symtop

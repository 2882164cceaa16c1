// The motion without a torque that turns the axis (derivation.md, section 8): Mgl is 0, or the axis
// rests on the vertical. The body turns about L by |L| t/Ix, and about its axis by c t.
#pragma once

#include <initializer_list>

#include "kind.hpp"

namespace symtop {

// Below this share of the kinetic energy the weight changes no digit of any phase, and the largest
// root of the cubic, of the order of 1/Mgl, would leave the range of doubles.
const double WEIGHTLESS = 1e-200;

// True if no torque turns the axis: for circular functions instead of elliptic ones. It is not omega_z
// that counts, but Iz/Ix omega_z: a rod may spin fast.
inline bool is_free(const Start& s) {
  const bool is_vertical = (s.w == 0 && s.z == 0) || (s.x == 0 && s.y == 0);
  if (s.wx == 0 && s.wy == 0 && is_vertical) return true;
  const double weight = std::fabs(s.Mgl) / s.Ix;
  for (double rate : {s.wx, s.wy, s.Iz / s.Ix * s.wz})
    if (weight <= WEIGHTLESS * rate * rate) return true;
  return false;
}

typedef double Triple[3];

// The angle between a direction of the body and the vertical, by its sine and cosine: an arc cosine
// would lose half the digits of a small one.
inline double find_angle_to_vertical(const Start& s, const Triple& direction) {
  const double gx = 2 * (s.x * s.z - s.w * s.y), gy = 2 * (s.y * s.z + s.w * s.x);
  const double gz = (s.w * s.w + s.z * s.z) - (s.x * s.x + s.y * s.y);
  const double lx = direction[0], ly = direction[1], lz = direction[2];
  const double across = find_modulus({gy * lz - gz * ly, gz * lx - gx * lz});
  const double cross = find_modulus({across, gx * ly - gy * lx});
  return arc_tangent(cross, gx * lx + gy * ly + gz * lz);
}

struct FreeMotion {
  Start start;  // with norm 1
  bool is_turned_over;
  Precise nutation_rate, turning_rate;
  Steps steps;
  Triple direction;
  double tilt, cone;
  Kind kind;

  void solve(const Start& given, bool turned_over) {
    is_turned_over = turned_over;
    start = normalize(given);
    const Precise Ix(given.Ix);
    const Precise dropped = given.is_clamped ? drop_precession(find_nutation<3>(given), start)
                                             : Precise();
    const WholeStart<Precise> all(start);
    const Precise L[3] = {Ix * all.wx, Ix * all.wy, Precise(given.Iz) * Precise(given.wz)};
    // Of a clamped motion the rounded parts of omega would give another rate.
    const Precise size = given.is_clamped ? Ix * dropped
                                          : root(L[0] * L[0] + L[1] * L[1] + L[2] * L[2]);
    turning_rate = find_turning_rate<3>(given);
    nutation_rate = size / Ix;
    const Precise rates[] = {nutation_rate.scale(-1), turning_rate.scale(-1), -turning_rate};
    steps = find_steps(rates, 3);
    for (int i = 0; i < 3; i++)
      direction[i] = size.sign ? (L[i] / size).to_double() : i == 2 ? 1.0 : 0.0;
    tilt = find_angle_to_vertical(start, direction);
    Start upright = {};
    upright.w = 1.0;
    cone = find_angle_to_vertical(upright, direction);
    const bool is_resting = start.wx == 0 && start.wy == 0;
    const bool is_vertical = (start.w == 0 && start.z == 0) || (start.x == 0 && start.y == 0);
    if (given.is_clamped && size.sign > 0) tilt = cone = PI / 2;  // L is along the line of nodes
    kind = is_resting && is_vertical ? SLEEPING : classify_free(tilt, cone);
  }

  bool is_far(double t) const { return std::fabs(t) >= steps.farthest; }

  // For a time that is not far.
  Attitude at(double t) const {
    Phase phases[FUNCTIONS];
    find_phases(steps, FUNCTIONS, t, phases);
    return at_phases(phases);
  }

  Attitude at_phases(const Phase phases[]) const {
    const Pair half = find_unit(phases[0]), turn = find_unit(phases[1]);
    const double lx = direction[0], ly = direction[1], lz = direction[2];
    const Pair A = {start.w, start.z}, B = {start.x, start.y};
    const Pair along = {half.x, lz * half.y}, over = {lx * half.y, ly * half.y};
    const Pair a = multiply(A, along), b = multiply(B, conjugate(over));
    const Pair d = multiply(A, over), e = multiply(B, conjugate(along));
    Pair values[FUNCTIONS];
    values[OF_A] = multiply(Pair{a.x - b.x, a.y - b.y}, turn);
    values[OF_B] = multiply(Pair{d.x + e.x, d.y + e.y}, conjugate(turn));
    values[OF_OMEGA_XY] = multiply(Pair{start.wx, start.wy}, find_unit(phases[2]));
    return complete_attitude(values, is_turned_over);
  }

  // The axis moves on a circle of angle `cone` about L, which has the angle `tilt` to the vertical.
  void find_turning_angles(bool from_below, double angles[2]) const {
    const double far = tilt + cone;
    double low = std::fabs(tilt - cone), high = far < 2 * PI - far ? far : 2 * PI - far;
    if (from_below) {
      const double before = low;
      low = PI - high, high = PI - before;
    }
    angles[0] = low <= high ? low : high, angles[1] = low <= high ? high : low;
  }

  // The part of the axis along L is all that is left of it in a turn about L.
  double find_mean_cosine() const { return cosine_and_sine(tilt).x * cosine_and_sine(cone).x; }

  // Half turns of arg A and arg B in a turn about L: whether the circle encloses a pole.
  int upper_turns() const { return tilt + cone <= PI ? 1 : -1; }
  int lower_turns() const { return cone >= tilt ? 1 : -1; }
};

}  // namespace symtop

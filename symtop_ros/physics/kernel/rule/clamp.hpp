// What a clamp makes of a motion: how the axis moves while a hand holds phi, and what it would do
// without (derivation.md, section 11).
#pragma once

#include "../gravity.hpp"
#include "attitude.hpp"

namespace symtop {

// Times sqrt(Ix/|Mgl|): who then has not passed comes to rest upright
const double NEVER_LOWEST = 60;

// The moving axis of a clamped motion without its spin, which counts in nothing that is asked here:
// A and B then keep their directions, and only their sizes change.
class HeldAxis {
 public:
  HeldAxis(Start s, bool is_turned_over)
      : is_turned_over_(is_turned_over), motion_((s.wz = 0.0, clamp(s))) {
    motion_.read(0.0, {first_, omega_});
  }

  double find_rate() const { return find_modulus({omega_[0], omega_[1]}); }

  // The first time at which the weight is lowest; NaN if it never is. The part of the quaternion
  // that vanishes there, A for Mgl > 0, changes its sign once in a period of theta. That there is a
  // period says that the axis passes: it is known from the exact constants, while the sign after
  // one period is that of a rounding error for a start next to the lowest point, at theta = 1e-17
  // with Mgl < 0.
  double find_lowest_time(double longest) {
    const double period = motion_.find_rates().nutation_period;
    const bool returns = std::isfinite(period);
    double before = 0.0, after = returns ? period : longest;
    if (!returns && !has_passed(after)) return NAN;
    for (;;) {
      const double middle = before + (after - before) / 2;
      if (!(before < middle && middle < after)) return after;
      (has_passed(middle) ? after : before) = middle;
    }
  }

 private:
  bool is_turned_over_;
  GravityMotion motion_;
  double first_[4], omega_[3];

  bool has_passed(double t) {
    double q[4], omega[3];
    motion_.read(t, {q, omega});
    const double along =
        is_turned_over_ ? q[1] * first_[1] + q[2] * first_[2] : q[0] * first_[0] + q[3] * first_[3];
    return along < 0;
  }
};

inline symtop_held_kind name_held(double Mgl, bool is_at_rest, double lowest_in) {
  if (Mgl == 0) return is_at_rest ? SYMTOP_HELD_RESTS : SYMTOP_HELD_TURNS;
  if (is_at_rest) return SYMTOP_HELD_FALLS;
  return std::isnan(lowest_in) ? SYMTOP_HELD_RISES : SYMTOP_HELD_SWINGS;
}

// The start is one that can be clamped.
inline symtop_held judge_clamp(const symtop_start& s, const Start& start) {
  GravityMotion without(start);
  HeldAxis axis(start, s.Mgl < 0);
  const double weight = std::sqrt(std::fabs(s.Mgl) / s.Ix);
  // A start with theta' = 0 has one of some EPS of its precession.
  const double across = find_modulus({start.wx, start.wy});
  const bool is_at_rest = axis.find_rate() <= START_ROUNDING * across;
  double angles[3];
  find_angles(s.orientation, angles);
  symtop_held held = {};
  held.subject = s.Mgl < 0 ? SYMTOP_AXIS : SYMTOP_TOP;
  held.theta = angles[1];
  held.rate = is_at_rest ? 0.0 : axis.find_rate();
  held.lowest_in = s.Mgl == 0 ? NAN : axis.find_lowest_time(NEVER_LOWEST / weight);
  held.kind = name_held(s.Mgl, is_at_rest, held.lowest_in);
  without.find_turning_angles(held.angles_without);
  return held;
}

}  // namespace symtop

// theta'' as a function of phi' at the tilt of a state, and the place of a rate among the regular
// ones.
#pragma once

#include "regular.hpp"

namespace symtop {

// cos(theta) of a quaternion: four squares, each rounded, and its norm.
const double STATE_ROUNDING = 8 * EPS;

inline double find_largest_rate(const symtop_start& s) {
  const double* omega = s.angular_velocity;
  return std::fmax(std::fmax(std::fabs(omega[0]), std::fabs(omega[1])), std::fabs(omega[2]));
}

// A start, with the vertical of its normalised orientation.
struct Instant {
  const symtop_start& start;
  symtop_top top;
  Vertical vertical;

  explicit Instant(const symtop_start& s)
      : start(s), top{s.Ix, s.Iz, s.Mgl}, vertical(find_vertical(s.orientation)) {}

  // The tilt, which a quaternion has whatever its norm.
  double find_theta() const {
    double angles[3];
    find_angles(start.orientation, angles);
    return angles[1];
  }
  double find_largest_rate() const { return symtop::find_largest_rate(start); }

 private:
  static Vertical find_vertical(const double given[4]) {
    const Start unit =
        normalize(Start{1.0, 1.0, 0.0, given[0], given[1], given[2], given[3], 0.0, 0.0, 0.0});
    const double q[4] = {unit.w, unit.x, unit.y, unit.z};
    return Vertical(q);
  }
};

struct SpinAndPrecession {
  double phi_dot, psi_dot;
};

// True if phi' sin(theta) is what rounding leaves of the rates of a start, or of the kick that
// ended the precession: a kick from there would hurry, delay or reverse it by chance. The scale of
// the rates is the larger one of those of the start and of the swing that the weight makes.
inline bool is_no_precession(const symtop_start& s, const Precise& along,
                             const Precise& upper_lower) {
  const double scale = std::fmax(find_largest_rate(s), std::sqrt(std::fabs(s.Mgl) / s.Ix));
  const Precise least(STATE_ROUNDING * scale);  // along is phi' sin(theta)^2/2, the product sin^2/4
  return along * along <= least * least * upper_lower;
}

// phi' and psi', the nearest doubles to those of the doubles of a start. Next to the vertical phi'
// is a quotient of small differences: with the rounding of doubles it has half of its digits there,
// and a large factor can take the kicked rate to a place where the others decide.
inline SpinAndPrecession find_exact_rates(const symtop_start& s) {
  const double* q = s.orientation;
  const Precise w(q[0]), x(q[1]), y(q[2]), z(q[3]);
  const Precise wx(s.angular_velocity[0]), wy(s.angular_velocity[1]), wz(s.angular_velocity[2]);
  const Precise upper = w * w + z * z, lower = x * x + y * y;
  const Precise along = wx * (x * z - w * y) + wy * (y * z + w * x);
  if (is_no_precession(s, along, upper * lower)) return {0.0, wz.to_double()};
  const Precise norm = upper + lower;  // 1 but for the rounding of the quaternion
  const Precise phi_dot = along / upper / lower * norm.scale(-1);
  return {phi_dot.to_double(), (wz - phi_dot * (upper - lower) / norm).to_double()};
}

class TiltAcceleration {
 public:
  // `hold` decides what is held while phi' varies.
  TiltAcceleration(const Instant& now, symtop_hold hold)
      : quadratic(now.top, find_cosine(now), find_spin(now, hold), hold),
        sine_per_moment_(now.vertical.find_sine() / now.top.Ix) {}

  const TiltQuadratic quadratic;

  // theta'' in rad/s^2; exactly 0 if it vanishes up to rounding.
  double at(double phi_dot) const {
    if (quadratic.is_balanced(phi_dot)) return 0.0;
    return (Precise(sine_per_moment_) * quadratic.at(phi_dot)).to_double();
  }

  symtop_place place(double phi_dot) const {
    symtop_place place = {SYMTOP_NO_REGULAR_RATE, phi_dot, {NAN, NAN}};
    quadratic.find_roots(place.regular_rates);
    place.kind = find_place(phi_dot, place.regular_rates);
    return place;
  }

 private:
  double sine_per_moment_;

  // A state has cos(theta) and psi' to some EPS of 1 and of its rates. What is smaller is zero:
  // else a horizontal axis without spin would rise or fall by the chance of its rounding. The
  // second number is the size of the terms: near the horizontal a fast precession has a centrifugal
  // torque that the rounding of a small cosine decides.
  static Pair find_cosine(const Instant& now) {
    return {std::fabs(now.vertical.z) <= STATE_ROUNDING ? 0.0 : now.vertical.z, 1.0};
  }
  static Pair find_spin(const Instant& now, symtop_hold hold) {
    const double spin = hold == SYMTOP_SPIN_MOMENTUM ? now.start.angular_velocity[2]
                                                     : find_exact_rates(now.start).psi_dot;
    const double size = std::fabs(spin), largest = now.find_largest_rate();
    return {size <= STATE_ROUNDING * largest ? 0.0 : spin, std::fmax(size, largest)};
  }

  symtop_place_kind find_place(double rate, const double roots[2]) const {
    const double slow = roots[0], fast = roots[1];
    if (quadratic.is_nothing()) return SYMTOP_EVERY_RATE;
    if (std::isnan(slow)) return SYMTOP_NO_REGULAR_RATE;
    const bool is_only = std::isnan(fast) || fast == slow;  // two equal roots are one rate
    if (quadratic.is_balanced(rate)) {
      if (is_only) return SYMTOP_AT_THE_ONLY_RATE;
      // Without spin both are as fast, one to the left and one to the right: no mirror makes one
      // slow.
      const bool is_slow =
          std::fabs(slow - rate) <= std::fabs(fast - rate) || std::fabs(slow) == std::fabs(fast);
      return is_slow ? SYMTOP_AT_THE_SLOW_RATE : SYMTOP_AT_THE_FAST_RATE;
    }
    if (is_only) return rate > slow ? SYMTOP_ABOVE_THE_ONLY_RATE : SYMTOP_BELOW_THE_ONLY_RATE;
    const bool is_between = std::fmin(slow, fast) < rate && rate < std::fmax(slow, fast);
    return is_between ? SYMTOP_BETWEEN_THE_RATES : SYMTOP_OUTSIDE_THE_RATES;
  }
};

}  // namespace symtop

// Why the axis moves as it does: angles between torque, L, omega and axle over a nutation, and what
// they allow one to say (derivation.md, "What explains the motion").
//
// Gravity's torque is along the line of nodes, n. L has the components Ix theta' along n, p_psi
// along the axis and p_phi along the vertical. With p_psi and p_phi constant, its length is a
// function of the height alone, (|L|/Ix)^2 = a^2 + alpha - beta u in the names of
// exact/nutation.hpp; so are its angles with the axis and with the vertical, and those of omega,
// and they are monotone in u. Their extremes are those at the turning angles. Only the torque's
// angle with L has its own in between.
#pragma once

#include "../gravity.hpp"
#include "tilt.hpp"

namespace symtop {

// Sentences say how large an angle is; beyond these limits they are not made. The torque that stays
// within 30 degrees of perpendicular to L changes its direction more than its length.
const double NEAR_PERPENDICULAR = PI / 6, NEAR_THE_AXLE = PI / 6, NEAR_THE_VERTICAL = PI / 18;
// The change of a rate, or of |L|, that one sees, as a share of the larger one.
const double SEEN_CHANGE = 0.05;
// By so much the axle turns about L faster than L is turned: L moves by less than a right angle
// while the axle goes round once.
const double MUCH_FASTER = 4;
// The share of its terms below which a sum in doubles has no sign. The turning angles are some EPS
// of 1, or the square root of it where two roots nearly meet.
const double SURE = 1e-7;

// L over Ix at a height, in a unit of time in which no square overflows.
class Momentum {
 public:
  double a, b, beta;  // p_psi/Ix, p_phi/Ix, 2 Mgl/Ix
  double spin;        // omega_z

  explicit Momentum(const Instant& now) : vertical_(now.vertical) {
    const symtop_top& top = now.top;
    const double* omega = now.start.angular_velocity;
    const double fastest =
        std::fmax(now.find_largest_rate(), std::sqrt(std::fabs(top.Mgl) / top.Ix));
    unit = fastest > 0 ? fastest : 1.0;
    const double x = omega[0] / unit, y = omega[1] / unit;
    spin = omega[2] / unit;
    a = top.Iz / top.Ix * spin;
    along_ = x * vertical_.x + y * vertical_.y;
    across_ = x * vertical_.y - y * vertical_.x;
    b = along_ + a * vertical_.z;
    beta = 2 * (top.Mgl / top.Ix / unit / unit);
    squared_ = x * x + y * y;
    theta_ = arc_tangent(vertical_.find_sine(), vertical_.z);
  }

  double unit;  // rad/s

  // u0 - u, as a product: for small tilts a difference of cosines would have no digit.
  double fall_to(double theta) const { return fall_of(theta); }

  // sin^2(theta) phi' = b - a u
  double turning_at(double theta) const { return along_ + a * fall_to(theta); }

  // phi', where the axis is not vertical.
  double rate_at(double theta) const {
    const double sine = cosine_and_sine(theta).y;
    return turning_at(theta) / sine / sine;
  }

  // Between L, or omega, and the line of the axle, where |omega_xy| is `across` rad/s.
  double momentum_from_axle(double across) const {
    return arc_tangent(across / unit, std::fabs(a));
  }
  double velocity_from_axle(double across) const {
    return arc_tangent(across / unit, std::fabs(spin));
  }
  double across_now() const { return std::sqrt(squared_) * unit; }

  // Between L and the line of the vertical, if the horizontal part of L over Ix is `level` rad/s.
  double momentum_from_vertical(double level) const {
    return arc_tangent(level / unit, std::fabs(b));
  }

  // That part now: |L x z'| in the body frame, where L/Ix = (omega_x, omega_y, a).
  double level_now(const double omega[3]) const {
    const double x = omega[0] / unit, y = omega[1] / unit;
    const Vertical& g = vertical_;
    return find_modulus({find_modulus({y * g.z - a * g.y, a * g.x - x * g.z}), across_}) * unit;
  }

  // The square of the tangent of the angle between the torque and the plane perpendicular to L,
  // which has theta' along the torque, and a and sin(theta) phi' at right angles to it and to each
  // other.
  template <class R>
  SYMTOP_INLINE R square_from_perpendicular(R theta) const {
    const R sine = cosine_and_sine<R>(theta).y, fall = fall_of(theta);
    const R around = (along_ + a * fall) / sine;
    const R nodding = leave_positive(leave_positive(squared_ + beta * fall) - around * around);
    return choose(sine <= SURE * SURE, R{}, nodding / (a * a + around * around));  // no torque: 0
  }
  double torque_from_perpendicular_now() const {
    const double sine = vertical_.find_sine();
    if (sine == 0) return 0.0;
    return arc_tangent(std::fabs(across_) / sine, find_modulus({a, along_ / sine}));
  }

  double size_now() const { return find_modulus({a, std::sqrt(squared_)}) * unit; }
  double theta() const { return theta_; }
  // The change of phi' with the height, (1 - u^2)^2 dphi'/du = 2 u (b - a u) - a (1 - u^2), and the
  // size of its terms: next to the horizontal u is what rounding has left of 1.
  Pair slope_at(double theta) const {
    const Pair tilt = cosine_and_sine(theta);
    const double first = 2 * turning_at(theta), second = a * tilt.y * tilt.y;
    return {tilt.x * first - second, std::fabs(first) + std::fabs(second)};
  }
  double turning_terms(double theta) const {
    return std::fabs(along_) + std::fabs(a * fall_to(theta));
  }

 private:
  template <class R>
  SYMTOP_INLINE R fall_of(R theta) const {
    return 2.0 * cosine_and_sine<R>((theta + theta_) * 0.5).y *
           cosine_and_sine<R>((theta - theta_) * 0.5).y;
  }
  template <class R>
  static SYMTOP_INLINE R leave_positive(R x) {
    return choose(x > 0.0, x, R{});
  }

  Vertical vertical_;
  // Sin^2(theta) phi', sin(theta) theta' but for the sign
  double along_, across_, squared_, theta_;
};

// The largest angle over a nutation between the torque and the plane perpendicular to L: the best
// of some tilts, and its neighbourhood in ever smaller parts, four tilts at a time. The angle is
// smooth in theta: where phi' has a spike, it is small.
SYMTOP_CLONES inline double find_most_from_perpendicular(const Momentum& L,
                                                         const double angles[2]) {
  const int PARTS = 64, ROUNDS = 12;  // 0.4^12 of two parts: less than 1e-6 of the way
  double width = (angles[1] - angles[0]) / PARTS, most = 0.0, place = angles[0];
  for (int k = 0; k < PARTS / LANES + 1 + ROUNDS; k++) {
    double from = k < PARTS / LANES ? angles[0] + LANES * k * width : angles[1] - 3 * width;
    if (k > PARTS / LANES) {
      const double low = std::fmax(place - width, angles[0]);
      width = (std::fmin(place + width, angles[1]) - low) / (LANES + 1);
      from = low + width;
    }
    const Lanes theta = from + width * Lanes{0.0, 1.0, 2.0, 3.0};
#ifdef __wasm__  // whose lanes are single numbers, of which one is less code than four
    Lanes squares;
    for (int i = 0; i < LANES; i++) squares[i] = L.square_from_perpendicular(double(theta[i]));
#else
    const Lanes squares = L.square_from_perpendicular(theta);
#endif
    for (int i = 0; i < LANES; i++)
      if (squares[i] > most) {
        most = squares[i];
        place = theta[i];
      }
  }
  return arc_tangent(std::sqrt(most), 1.0);
}

inline int find_sign(double sum, double terms) {
  return std::fabs(sum) <= SURE * terms ? 0 : sum > 0 ? 1 : -1;
}

// How |phi'| changes on the way to a turning angle, if it does so in one direction all the way, and
// so much that it is seen. In (-1, 1) phi' has at most one zero, u = b/a, and one extreme: the
// product of the roots of a u^2 - 2 b u + a is 1. So the signs at both ends say whether one of them
// lies between. An extreme at an end itself, as that of a spherical pendulum at the horizontal,
// lies not between.
inline symtop_pace find_pace(const Momentum& L, double end) {
  const double begin = L.theta();
  const int turns[] = {find_sign(L.turning_at(begin), L.turning_terms(begin)),
                       find_sign(L.turning_at(end), L.turning_terms(end))};
  const Pair first = L.slope_at(begin), last = L.slope_at(end);
  const int slopes[] = {find_sign(first.x, first.y), find_sign(last.x, last.y)};
  const int slope = slopes[0] ? slopes[0] : slopes[1];
  if (!slope || slopes[0] * slopes[1] < 0) return SYMTOP_PACE_UNSAID;
  const int turn = turns[0] ? turns[0] : turns[1];
  if (!turn || turns[0] * turns[1] < 0) return SYMTOP_PACE_UNSAID;
  const double rates[] = {std::fabs(L.rate_at(begin)), std::fabs(L.rate_at(end))};
  if (!(std::fabs(rates[1] - rates[0]) > SEEN_CHANGE * std::fmax(rates[0], rates[1])))
    return SYMTOP_PACE_UNSAID;
  const int height = end < begin ? 1 : -1;  // of du
  return turn * slope * height > 0 ? SYMTOP_PACE_SPEEDS : SYMTOP_PACE_SLOWS;
}

// phi' compared with the rate at which gravity's torque would turn L, where theta' = 0. To turn L
// with the axis takes the torque phi' (p_psi - Ix phi' cos(theta)) sin(theta); a share of gravity's
// torque is left, which is Ix theta''. More than all of it is needed for the weight to rise, for
// both signs of Mgl. None is needed where L is vertical, as that of a sphere which turns about the
// vertical, or where the axis hardly goes round.
inline symtop_turn find_turn(double share, double phi_dot, double momentum_from_vertical) {
  if (phi_dot == 0) return SYMTOP_TURN_RESTS;
  if (share < -SURE) return SYMTOP_TURN_AGAINST;
  if (share > 1) return SYMTOP_TURN_FASTER;
  if (share > SURE) return SYMTOP_TURN_SLOWER;
  return momentum_from_vertical <= SURE ? SYMTOP_TURN_VERTICAL : SYMTOP_TURN_UNSAID;
}

inline bool is_swinging(const Instant& now) {
  const double* omega = now.start.angular_velocity;
  const Vertical& g = now.vertical;
  return std::fabs(omega[0] * g.y - omega[1] * g.x) >
         START_ROUNDING * now.find_largest_rate() * g.find_sine();
}

class CauseFinder {
 public:
  // The turning angles are those of the motion: next to a pole those that a verdict takes as equal
  // may differ by all of the tilt.
  CauseFinder(const Instant& now, const symtop_verdict& verdict, GravityMotion& motion)
      : now_(now), verdict_(verdict), L_(now) {
    motion.find_turning_angles(angles_);
    motion.find_rates_at_ends(across_, level_);
    advance_ = 2 * PI * std::fabs(motion.find_rates().precession_per_nutation);
  }

  symtop_cause find() const {
    symtop_cause cause = {};
    measure(cause);
    cause.explanation = explain(cause);
    if (cause.explanation == SYMTOP_EXPLANATION_PLANE) lay_along_torque(cause);
    cause.constant = find_constant();
    cause.turn = SYMTOP_TURN_UNSAID;
    cause.pace = SYMTOP_PACE_UNSAID;
    cause.torque_share = NAN;
    if (departs()) compare_rates(cause);
    return cause;
  }

 private:
  const Instant& now_;
  const symtop_verdict& verdict_;
  const Momentum L_;
  // theta, |omega_xy| and the horizontal part of L over Ix at the turning points
  double angles_[2], across_[2], level_[2];
  double advance_;  // rad, of phi in a nutation; NaN where it has none

  bool is_zero(double rate) const { return std::fabs(rate) <= START_ROUNDING; }  // in L_.unit
  bool is_at_rest() const { return L_.size_now() == 0; }

  void measure(symtop_cause& cause) const {
    const double across = L_.across_now();
    cause.rate_about_momentum = L_.size_now();
    cause.torque_from_perpendicular[0] = L_.torque_from_perpendicular_now();
    cause.torque_from_perpendicular[1] = find_most_from_perpendicular(L_, angles_);
    write(cause.momentum_from_axle, L_.momentum_from_axle(across),
          [&](int end) { return L_.momentum_from_axle(across_[end]); });
    write(cause.omega_from_axle, L_.velocity_from_axle(across),
          [&](int end) { return L_.velocity_from_axle(across_[end]); });
    const double level = L_.level_now(now_.start.angular_velocity);
    write(cause.momentum_from_vertical, L_.momentum_from_vertical(level),
          [&](int end) { return L_.momentum_from_vertical(level_[end]); });
  }

  // Now, and the smallest and the largest of a nutation, which are those at its turning angles. The
  // turning angles of doubles may leave out the start by some EPS.
  template <class Function>
  void write(double to[3], double present, const Function& at) const {
    const double first = at(0), last = at(1);
    to[0] = present;
    to[1] = std::fmin(present, std::fmin(first, last));
    to[2] = std::fmax(present, std::fmax(first, last));
  }

  // L is along the torque, also where it vanishes and the angles above are those of rounding.
  void lay_along_torque(symtop_cause& cause) const {
    for (double& each : cause.torque_from_perpendicular) each = PI / 2;
    for (double* each :
         {cause.momentum_from_axle, cause.omega_from_axle, cause.momentum_from_vertical})
      for (int k = 0; k < 3; k++) each[k] = PI / 2;
  }

  symtop_explanation explain(const symtop_cause& cause) const {
    if (now_.top.Mgl == 0)
      return is_at_rest() || cause.momentum_from_axle[2] <= SURE ? SYMTOP_EXPLANATION_FIXED
                                                                 : SYMTOP_EXPLANATION_FREE;
    if (verdict_.motion == SYMTOP_SLEEPING) return SYMTOP_EXPLANATION_UPRIGHT;
    if (verdict_.motion == SYMTOP_REGULAR) return SYMTOP_EXPLANATION_STEADY;
    if (is_zero(L_.a) && is_zero(L_.b)) return SYMTOP_EXPLANATION_PLANE;
    // Without spin phi' = b/sin^2(theta), unless the rounding of the spin is as large.
    if (is_zero(L_.a) && std::fabs(L_.a) <= SURE * std::fabs(L_.b))
      return SYMTOP_EXPLANATION_NO_SPIN;
    if (goes_about_L(cause)) return SYMTOP_EXPLANATION_ABOUT_MOMENTUM;
    const bool is_wide = is_wider_than_its_advance();
    if (!is_wide && goes_with_L(cause)) return SYMTOP_EXPLANATION_WITH_MOMENTUM;
    if (is_wide && circles_about_L()) return SYMTOP_EXPLANATION_CIRCLES;
    const bool swings = cause.torque_from_perpendicular[1] > NEAR_PERPENDICULAR &&
                        angles_[1] - angles_[0] > SURE && changes_size_of_L();
    return swings ? SYMTOP_EXPLANATION_SWINGS : SYMTOP_EXPLANATION_UNSAID;
  }

  bool have_one_sign(double first, double last) const { return first * last > 0; }

  // L stays so near the vertical that the axle, which turns about L, goes round the vertical. With
  // both turning angles further from the vertical than L is, phi' keeps its sign.
  bool goes_about_L(const symtop_cause& cause) const {
    const double most = cause.momentum_from_vertical[2];
    return most <= NEAR_THE_VERTICAL && cause.momentum_from_axle[1] >= 2 * most &&
           have_one_sign(L_.turning_at(angles_[0]), L_.turning_at(angles_[1]));
  }

  // The torque turns L about the vertical, at the rate Mgl (p_psi - p_phi u)/(L^2 - p_phi^2),
  // always in the same direction. The axle is nearer to L than to the vertical: it goes round with
  // L.
  bool goes_with_L(const symtop_cause& cause) const {
    const double most = cause.momentum_from_axle[2],
                 margin = std::fmin(angles_[0], PI - angles_[1]);
    const double first = L_.a - L_.b * cosine_and_sine(angles_[0]).x;
    const double last = L_.a - L_.b * cosine_and_sine(angles_[1]).x;
    return most <= NEAR_THE_AXLE && most < margin &&
           cause.torque_from_perpendicular[1] <= NEAR_PERPENDICULAR && have_one_sign(first, last);
  }

  // What is seen is then the nutation, and not the way round: in loops, where the axle goes back in
  // each, and where it nods further than it advances, at the middle of its tilts.
  bool is_wider_than_its_advance() const {
    const double width = angles_[1] - angles_[0];
    if (width <= SURE) return false;
    if (verdict_.motion == SYMTOP_LOOPING) return true;
    return width > advance_ * cosine_and_sine((angles_[0] + angles_[1]) / 2).y;
  }

  // |L| over Ix at a turning point, in rad/s: omega without its part along the axle, and p_psi/Ix.
  double size_at(int end) const { return find_modulus({across_[end], L_.a * L_.unit}); }

  // The axle turns about L at |L|/Ix, as it would without a torque; the torque turns L at no more
  // than |Mgl| sin(theta)/|L|. So the axle goes round on a circle that moves along (Butikov,
  // section 4). |L| is monotone in the height.
  bool circles_about_L() const {
    const bool reaches_horizontal = angles_[0] < PI / 2 && angles_[1] > PI / 2;
    const double most = reaches_horizontal ? 1.0
                                           : std::fmax(cosine_and_sine(angles_[0]).y,
                                                       cosine_and_sine(angles_[1]).y);
    const double least = std::fmin(size_at(0), size_at(1)) / L_.unit;
    return least * least > MUCH_FASTER * std::fabs(L_.beta) / 2 * most;
  }

  bool changes_size_of_L() const {
    const double sizes[] = {size_at(0), size_at(1)};
    return std::fabs(sizes[1] - sizes[0]) > SEEN_CHANGE * std::fmax(sizes[0], sizes[1]);
  }

  unsigned find_constant() const {
    const bool stays = verdict_.motion == SYMTOP_REGULAR || verdict_.motion == SYMTOP_SLEEPING;
    const bool is_untouched = now_.top.Mgl == 0 || verdict_.motion == SYMTOP_SLEEPING;
    return (stays || is_untouched ? SYMTOP_PART_SIZE : 0) |
           (is_untouched ? SYMTOP_PART_DIRECTION : 0) | (stays ? SYMTOP_PART_TILT : 0);
  }

  // True if the axis leaves its tilt from rest, by the torque that turning L does not take.
  bool departs() const {
    return now_.top.Mgl != 0 && verdict_.direction != SYMTOP_STAYS &&
           verdict_.motion != SYMTOP_REGULAR && !now_.vertical.is_of_vertical_axis() &&
           !is_swinging(now_);
  }

  void compare_rates(symtop_cause& cause) const {
    const TiltAcceleration tilt(now_, SYMTOP_SPIN_MOMENTUM);
    double phi_dot = find_exact_rates(now_.start).phi_dot;
    // A kick that ends the precession leaves some EPS of the other rates.
    if (is_zero(phi_dot / L_.unit)) phi_dot = 0.0;
    if (tilt.quadratic.is_balanced(phi_dot)) return;
    const Precise left = tilt.quadratic.at(phi_dot) / Precise(now_.top.Mgl);
    const double share = (Precise(1.0) - left).to_double();
    const bool rises = share > 1, axis_rises = rises == (now_.top.Mgl > 0);
    // At a turning point that rounding has moved the axis may go the other way.
    if (axis_rises != (verdict_.direction == SYMTOP_RISES)) return;
    cause.turn = find_turn(share, phi_dot, cause.momentum_from_vertical[0]);
    if (cause.turn == SYMTOP_TURN_UNSAID) return;
    cause.torque_share = share;
    // phi' is undefined where the way ends at a pole, or never ends.
    if (verdict_.motion != SYMTOP_THROUGH_THE_POLE && verdict_.motion != SYMTOP_ASYMPTOTIC)
      cause.pace = find_pace(L_, angles_[axis_rises ? 0 : 1]);
  }
};

inline symtop_cause find_cause(const Instant& now, const symtop_verdict& verdict,
                               GravityMotion& motion) {
  return CauseFinder(now, verdict, motion).find();
}

// Under friction or a torque of other origin nothing of this holds for long.
inline symtop_cause leave_cause() {
  symtop_cause cause = {};
  cause.explanation = SYMTOP_EXPLANATION_UNSAID;
  cause.turn = SYMTOP_TURN_UNSAID;
  cause.pace = SYMTOP_PACE_UNSAID;
  cause.torque_share = cause.rate_about_momentum = NAN;
  for (double& each : cause.torque_from_perpendicular) each = NAN;
  for (double* each :
       {cause.momentum_from_axle, cause.omega_from_axle, cause.momentum_from_vertical})
    for (int k = 0; k < 3; k++) each[k] = NAN;
  return cause;
}

}  // namespace symtop

// What follows from a start or a kick: direction, turning angles, averages and Perry's rule, "hurry
// on the precession, and the body rises in opposition to gravity".
//
// One definition of the rule serves a start, a kick and a map. The kicked top is compared with the
// same top not kicked. Hurried (a factor above 1), the rule holds if theta'' is lower with the
// kick; delayed (0 to 1), if it is higher. It says nothing if phi' = 0, if the factor is 1 or
// negative, about an angular impulse that is no push along the precession, without weight (Mgl =
// 0), if theta'' is the same with the kick as without it, and on the vertical, where phi' is
// undefined. At a root of regular precession theta'' is 0 without the kick, so the hurried axis
// rises if and only if the rule holds: the article's case.
#pragma once

#include "../gravity.hpp"
#include "cause.hpp"
#include "means.hpp"
#include "tilt.hpp"

namespace symtop {

// Turning angles that differ by less count as equal: next to a pole, or where two roots of the
// cubic nearly meet, an angle is the square root of a quantity that is known to EPS (section 2).
const double SAME_ANGLE = 1e-7;  // rad
// Of Mgl/p_psi, by which the mean precession rate may differ from it to be compared with it.
const double LIKE_A_FAST_TOP = 0.3;

// Direction of the axis from a state on: by theta', or by theta'' if theta' vanishes up to
// rounding.
inline symtop_direction find_direction(const Instant& now) {
  const double* omega = now.start.angular_velocity;
  const Vertical& g = now.vertical;
  if (g.is_of_vertical_axis()) {
    // A moving axis leaves the upper pole downwards, and the lower one upwards.
    if (omega[0] == 0 && omega[1] == 0) return SYMTOP_STAYS;
    return g.z > 0 ? SYMTOP_FALLS : SYMTOP_RISES;
  }
  const double sine = g.find_sine();
  double change = (omega[0] * g.y - omega[1] * g.x) / sine;
  if (std::fabs(change) <= START_ROUNDING * now.find_largest_rate()) {
    change = TiltAcceleration(now, SYMTOP_SPIN_RATE).at(find_precession_rate(g, omega));
  }
  return change == 0 ? SYMTOP_STAYS : change < 0 ? SYMTOP_RISES : SYMTOP_FALLS;
}

// Where the axis goes before it turns back: with theta' or theta'' of some rounding it may have
// been at its turning point already, and it goes nowhere between turning angles that count as
// equal.
inline symtop_direction find_visible_direction(const Instant& now, const double angles[2]) {
  const symtop_direction first = find_direction(now);
  if (angles[1] - angles[0] <= SAME_ANGLE) return SYMTOP_STAYS;
  const double theta = arc_tangent(now.vertical.find_sine(), now.vertical.z);
  if (first == SYMTOP_FALLS && angles[1] - theta <= SAME_ANGLE) return SYMTOP_RISES;
  if (first == SYMTOP_RISES && theta - angles[0] <= SAME_ANGLE) return SYMTOP_FALLS;
  return first;
}

// True if an axis at rest on the vertical stays near it after a small kick: p_psi^2 >= 4 Ix |Mgl|
// for a centre of mass above the pivot (Goldstein, section 5.7), and always below it. Without
// weight a kick turns the axis about L, which leaves it near the vertical only if it spins.
inline bool is_sleeping_stable(const Instant& now) {
  const double weight = now.vertical.z > 0 ? now.top.Mgl : -now.top.Mgl;
  if (weight == 0) return now.start.angular_velocity[2] != 0;
  if (weight < 0) return true;
  // Roots, not squares: those would overflow. The critical spin itself is stable, whichever way its
  // double is rounded.
  const double least = 2 * std::sqrt(now.top.Ix) * std::sqrt(weight);
  return std::fabs(now.top.Iz * now.start.angular_velocity[2]) >= (1 - 8 * EPS) * least;
}

// The tilt to which the least disturbance lets an axis go that rests on the vertical and is
// unstable: with p_phi = p_psi the cubic leaves 1 + u = p_psi^2/(2 Ix Mgl) (Goldstein, section
// 5.7), so that the cosine of half the way is the spin over the critical one.
inline double find_disturbed(const Instant& now) {
  const double critical = 2 * std::sqrt(now.top.Ix) * std::sqrt(std::fabs(now.top.Mgl));
  const double share =
      critical > 0 ? std::fabs(now.top.Iz * now.start.angular_velocity[2]) / critical : 0.0;
  const double way = 2 * arc_tangent(std::sqrt((1 - share) * (1 + share)), share);
  return now.vertical.z > 0 ? way : PI - way;
}

inline symtop_reason explain_vertical(const Instant& now) {
  const double* omega = now.start.angular_velocity;
  const bool is_moving = omega[0] != 0 || omega[1] != 0;
  const symtop_reason_kind kind = is_moving                 ? SYMTOP_VERTICAL_UNDEFINED
                                  : is_sleeping_stable(now) ? SYMTOP_VERTICAL_STABLE
                                                            : SYMTOP_VERTICAL_UNSTABLE;
  return {kind,
          SYMTOP_RULE_SAYS_NOTHING,
          NAN,
          NAN,
          NAN,
          NAN,
          SYMTOP_EFFECT_ENOUGH,
          {SYMTOP_NO_REGULAR_RATE, NAN, {NAN, NAN}}};
}

// A change of phi' by a factor (NaN for an angular impulse): done by a kick, or only considered.
struct PrecessionChange {
  double before, after, factor;
  bool is_done, has_weight;

  // The reason why the rule says nothing; that of a change if it says something.
  symtop_reason_kind find_kind(bool has_effect) const {
    if (std::isnan(factor)) return SYMTOP_ANGULAR_IMPULSE;
    if (before == 0) return SYMTOP_NO_PRECESSION;
    if (factor == 1) return SYMTOP_UNCHANGED;
    if (factor < 0) return SYMTOP_REVERSED;
    if (!has_effect) return SYMTOP_NO_EFFECT;
    if (!has_weight) return SYMTOP_WEIGHTLESS;
    if (factor > 1) return is_done ? SYMTOP_HURRIED : SYMTOP_IF_HURRIED;
    return is_done ? SYMTOP_DELAYED : SYMTOP_IF_DELAYED;
  }
};

inline bool says_something(symtop_reason_kind kind) { return kind <= SYMTOP_IF_DELAYED; }

// Perry's rule for a change of phi', by the sign of the change of theta''.
inline symtop_rule judge_change(const PrecessionChange& by, int change) {
  if (!says_something(by.find_kind(change != 0))) return SYMTOP_RULE_SAYS_NOTHING;
  return (change < 0) == (by.factor > 1) ? SYMTOP_RULE_HOLDS : SYMTOP_RULE_FAILS;
}

// `theta_ddot` is 0 where it vanishes up to rounding.
inline symtop_effect find_effect(int change, double theta_ddot) {
  if (change < 0 && theta_ddot > 0) return SYMTOP_EFFECT_UP;
  return change > 0 && theta_ddot < 0 ? SYMTOP_EFFECT_DOWN : SYMTOP_EFFECT_ENOUGH;
}

inline symtop_reason explain_change(const TiltAcceleration& tilt, const PrecessionChange& by) {
  const int change = tilt.quadratic.change(by.before, by.after).sign;
  const double theta_ddot = tilt.at(by.after);
  const symtop_rule rule = judge_change(by, change);
  return {by.find_kind(change != 0),
          rule,
          by.before,
          by.after,
          tilt.at(by.before),
          theta_ddot,
          rule == SYMTOP_RULE_SAYS_NOTHING ? SYMTOP_EFFECT_ENOUGH : find_effect(change, theta_ddot),
          tilt.place(by.is_done ? by.after : by.before)};
}

// The kick that leads from one state to another of the same attitude. It has rounded the angular
// velocity: a rate or a change of this size is no rate and no change, as its sign would decide the
// verdict by chance.
inline PrecessionChange find_change(const Instant& before, const Instant& after, symtop_hold hold) {
  const double was = find_exact_rates(before.start).phi_dot;
  double now = find_exact_rates(after.start).phi_dot;
  const double* omega = before.start.angular_velocity;
  const double across = find_modulus({omega[0], omega[1]});
  const double rounding = 8 * EPS * across / before.vertical.find_sine();
  if (std::fabs(now - was) <= rounding)
    now = was;
  else if (std::fabs(now) <= rounding)
    now = 0.0;
  const double factor = hold == SYMTOP_NOTHING ? NAN : was != 0 ? now / was : 1.0;
  return {was, now, factor, true, before.top.Mgl != 0};
}

// True if a kick leaves theta' and the axial momentum as they were, up to rounding: a push on the
// axle along the precession or against it, Perry's own experiment.
inline bool is_push_along(const Instant& before, const Instant& after) {
  const double* was = before.start.angular_velocity;
  const double* now = after.start.angular_velocity;
  const Vertical& g = before.vertical;
  const double rounding =
      8 * EPS * std::fmax(before.find_largest_rate(), after.find_largest_rate());
  const double along_nodes = (now[0] - was[0]) * g.y - (now[1] - was[1]) * g.x;
  return std::fabs(now[2] - was[2]) <= rounding &&
         std::fabs(along_nodes) <= rounding * g.find_sine();
}

inline symtop_average find_average(const symtop_start& s, GravityMotion& motion) {
  const Rates rates = motion.find_rates();
  const double p_psi = s.Iz * s.angular_velocity[2];
  // Mgl/p_psi is meant for p_psi^2 >> 4 Ix |Mgl|, and for starts near the slow precession: of
  // another one it can be the wrong sign. A thin rod may have that p_psi and spin more slowly than
  // it precesses.
  const double least = 2 * std::sqrt(s.Ix) * std::sqrt(std::fabs(s.Mgl)) / s.Iz;
  const double rate = rates.mean_precession_rate, slow = p_psi != 0 ? s.Mgl / p_psi : NAN;
  const bool is_fast = s.Mgl != 0 && std::fabs(s.angular_velocity[2]) > least &&
                       std::fabs(rate - slow) <= LIKE_A_FAST_TOP * std::fabs(slow) &&
                       std::fabs(rate) < std::fabs(rates.mean_spin_rate);
  const double turn = rate != 0 ? 2 * PI / std::fabs(rate) : INFINITY;
  return {rate, turn, rates.precession_per_nutation, slow, is_fast, rates.spin_reverses};
}

inline symtop_average leave_average() { return {NAN, NAN, NAN, NAN, 0, 0}; }

// Direction, turning angles and averages of what follows from a start.
inline symtop_verdict describe_course(const Instant& now, GravityMotion& motion) {
  symtop_verdict verdict = {};
  verdict.subject = now.top.Mgl < 0 ? SYMTOP_AXIS : SYMTOP_TOP;
  motion.find_turning_angles(verdict.turning_angles);
  verdict.direction = find_visible_direction(now, verdict.turning_angles);
  // Neither end of a way that is not seen would be the tilt of a mirror image, so it is that of
  // now.
  if (verdict.direction == SYMTOP_STAYS)
    verdict.turning_angles[0] = verdict.turning_angles[1] = now.find_theta();
  verdict.motion = static_cast<symtop_kind>(motion.find_kind());
  return verdict;
}

inline double find_disturbed_to(const Instant& now, const symtop_reason& reason) {
  return reason.kind == SYMTOP_VERTICAL_UNSTABLE ? find_disturbed(now) : NAN;
}

// The verdict on a start, and on a kick by a factor that is only considered: `kicked` is the start
// after it, and `with` its motion. False if that would lead to a rate beyond the largest.
inline bool judge(const symtop_start& s, const symtop_start& kicked, GravityMotion& motion,
                  GravityMotion& with, double factor, symtop_hold hold, symtop_verdict& verdict) {
  const Instant now(s);
  const bool is_vertical = now.vertical.is_of_vertical_axis();
  const double rate = is_vertical ? 0.0 : find_exact_rates(s).phi_dot, after = factor * rate;
  if (!(std::fabs(after) <= LARGEST)) return false;
  verdict = describe_course(now, motion);
  verdict.average = find_average(s, motion);
  verdict.cause = find_cause(now, verdict, motion);
  verdict.factor = factor;
  verdict.reason = is_vertical ? explain_vertical(now)
                               : explain_change(TiltAcceleration(now, hold),
                                                {rate, after, factor, false, s.Mgl != 0});
  verdict.disturbed_to = find_disturbed_to(now, verdict.reason);
  // On the vertical and at rest in phi there is nothing to multiply.
  verdict.means = after == rate ? leave_means()
                                : compare_means(after - rate, now, Instant(kicked), motion, with);
  return true;
}

// How much higher a turning point is than it would be without the kick.
inline symtop_lift find_lift(double was, double now) {
  const double change = std::fabs(was - now) > SAME_ANGLE ? was - now : 0.0;
  return {change == 0  ? SYMTOP_AS_HIGH
          : change > 0 ? SYMTOP_HIGHER
                       : SYMTOP_LOWER,
          std::fabs(change)};
}

// The verdict on a kick that was made; the motions are those without it and with it.
inline symtop_verdict judge_kick(const symtop_start& before, const symtop_start& after,
                                 GravityMotion& without, GravityMotion& with, bool is_driven,
                                 symtop_hold given) {
  const Instant was(before), now(after);
  const symtop_hold hold =
      given == SYMTOP_NOTHING && is_push_along(was, now) ? SYMTOP_SPIN_MOMENTUM : given;
  symtop_verdict verdict = describe_course(now, with);
  verdict.average = is_driven ? leave_average() : find_average(after, with);
  verdict.cause = is_driven ? leave_cause() : find_cause(now, verdict, with);
  if (is_driven) verdict.motion = SYMTOP_DRIVEN;
  verdict.factor = NAN;
  double of_rate = 0.0;  // the change of phi', if the kick is one
  if (was.vertical.is_of_vertical_axis()) {
    verdict.reason = explain_vertical(now);
  } else {
    // After an angular impulse psi' is another: theta'' is compared at the spin that it left.
    const TiltAcceleration tilt(hold == SYMTOP_NOTHING ? now : was,
                                hold == SYMTOP_NOTHING ? SYMTOP_SPIN_RATE : hold);
    const PrecessionChange change = find_change(was, now, hold);
    verdict.reason = explain_change(tilt, change);
    verdict.factor = change.factor;
    if (hold != SYMTOP_NOTHING) of_rate = change.after - change.before;
  }
  verdict.disturbed_to = find_disturbed_to(now, verdict.reason);
  verdict.means = is_driven ? leave_means() : compare_means(of_rate, was, now, without, with);
  double angles[2];
  without.find_turning_angles(angles);
  verdict.highest = find_lift(angles[0], verdict.turning_angles[0]);
  verdict.lowest = find_lift(angles[1], verdict.turning_angles[1]);
  return verdict;
}

}  // namespace symtop

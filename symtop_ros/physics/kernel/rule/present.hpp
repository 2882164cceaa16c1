// Why the weight speeds up, slows down or turns at an instant of a nutation (derivation.md, "What
// explains the motion").
//
// In the frame that goes round with the axle L stands still but for Ix theta' along the line of
// nodes. To turn L with the axle takes the torque phi' z' x L, whose part along the line of nodes
// is phi' (p_psi - Ix phi' cos(theta)) sin(theta); what is left of gravity's is Ix theta''. It says
// nothing of theta': that is what the impulses up to now have left.
#pragma once

#include "cause.hpp"

namespace symtop {

// Below these nothing is seen: of a nutation, in rad; of gravity's torque.
const double SEEN_NUTATION = 5e-4, SEEN_SHARE = 0.05;
// Of the nutation period: theta' vanishes so soon, or did so just now.
const double TURNING = 0.01;

class PresentFinder {
 public:
  PresentFinder(const symtop_start& start, GravityMotion& motion) : now_(start), motion_(motion) {}

  symtop_present find() {
    symtop_present present = {SYMTOP_GOING_UNSAID, SYMTOP_TURN_UNSAID, NAN};
    if (now_.top.Mgl == 0 || now_.vertical.is_of_vertical_axis() || !nutates()) return present;
    const TiltAcceleration tilt(now_, SYMTOP_SPIN_MOMENTUM);
    const double phi_dot = find_exact_rates(now_.start).phi_dot;
    const double left = (tilt.quadratic.at(phi_dot) / Precise(now_.top.Mgl)).to_double();
    if (!(std::fabs(left) > SEEN_SHARE)) return present;
    const symtop_going going = find_going(left);
    if (going == SYMTOP_GOING_UNSAID) return present;
    const double share = (Precise(1.0) - Precise(left)).to_double();
    return {going, name_share(share), share};
  }

 private:
  const Instant now_;
  GravityMotion& motion_;

  bool nutates() {
    double angles[2];
    motion_.find_turning_angles(angles);
    return angles[1] - angles[0] > SEEN_NUTATION;
  }

  // A share is a number of many digits, and its sign that of phi' and L: near zero neither is seen.
  static symtop_turn name_share(double share) {
    if (std::fabs(share) <= SEEN_SHARE) return SYMTOP_TURN_RESTS;
    if (share < 0) return SYMTOP_TURN_AGAINST;
    return share > 1 ? SYMTOP_TURN_FASTER : SYMTOP_TURN_SLOWER;
  }

  // By the rates at which the weight goes down. A motion without a period has no part of it.
  symtop_going find_going(double left) {
    const double period = motion_.find_rates().nutation_period;
    if (!std::isfinite(period)) return SYMTOP_GOING_UNSAID;
    const double sine = now_.vertical.find_sine(), weight = std::fabs(now_.top.Mgl);
    const double* omega = now_.start.angular_velocity;
    const double swing = (omega[0] * now_.vertical.y - omega[1] * now_.vertical.x) / sine;
    const double fall = now_.top.Mgl > 0 ? swing : -swing;
    const double gain = weight * sine / now_.top.Ix * left;
    if (std::fabs(fall) <= TURNING * period * std::fabs(gain))
      return gain > 0 ? SYMTOP_GOING_TURNS_DOWN : SYMTOP_GOING_TURNS_UP;
    return fall > 0 ? SYMTOP_GOING_FALLS : SYMTOP_GOING_RISES;
  }
};

}  // namespace symtop

// Ways of a free motion from a state with 32 digits to another: what a series of pushes carries on
// from one to the next, where doubles would lose half a last place each time (derivation.md,
// section 15).
#pragma once

#include "../gravity.hpp"
#include "body_state.hpp"
#include "stepper.hpp"

namespace symtop {

// The terms that a step leaves out, and the rounding of those that are doubles, count in all pieces
// that follow. In half a step the first are smaller by 2^-34 and the second by 2^-11: some 1e-24.
const double CARRIED_SHARE = 0.5;
// rad of the fastest rate, some three steps, that take less time than a set-up. A longer way begins
// with whole nutations.
const double FEW_RADIANS = 4.0;
// Steps of half a nutation are some five, and a hundred next to the separatrix, where it is long.
const int MOST_CARRIED = 1000;
// The square of a smaller sine would be no normal number.
const double LEAST_SINE = 1e-100;

inline Double2 to_double2(const Precise& x) {
  const double high = x.to_double();
  return {high, rest_of(x, high)};
}

// A state stays in the turning frame, and the angle of spin is a number of its own with 32 digits.
// In the frame of the body the sine of this angle would be needed, which has fewer digits, as the
// angle grows.
class Chain {
 public:
  explicit Chain(const DrivenArguments& top) { stepper_.equations.prepare(top); }

  // Moves the start of a motion on by whole ns; false if the way is too long.
  bool advance(Variables& state, double ns, GravityMotion& motion) {
    const Precise time = Precise(ns) * per_ns_;
    if (time.to_double() * stepper_.equations.estimate_rate(state) < FEW_RADIANS)
      return follow(state, time);
    const Turning turning = motion.find_turning();
    const double nutations = round_to_integer((time * turning.nutation * PER_TURN).to_double());
    if (!nutations) return follow(state, time);
    const Precise seconds_a_radian = invert(turning.nutation), count(nutations);
    const Precise passed = count * TWO_PI * seconds_a_radian;
    turn(state, count * turning.of_A * seconds_a_radian, count * turning.of_B * seconds_a_radian);
    const Double2 spin = pick(state.rates, SPIN) + pick(state.rates, OMEGA_Z) * to_double2(passed);
    state.rates.high[SPIN] = spin.high;
    state.rates.low[SPIN] = spin.low;
    return follow(state, time - passed);
  }

  // A push on the axle, as push_axle in rule/kicks.hpp: it is across the axle, and in the frame the
  // same as in the body. False where the direction has too few digits.
  static bool push(Variables& state, Double2 change) {
    const Double2 w = pick(state.q, W), p = pick(state.q, X), q = pick(state.q, Y),
                  r = pick(state.q, Z);
    const Double2 x = p * r - w * q, y = q * r + w * p, sine = root(x * x + y * y);
    if (!(sine.high > LEAST_SINE)) return false;
    const Double2 across[2] = {x, y};
    for (int k = OMEGA_X; k <= OMEGA_Y; k++) {
      const Double2 pushed = pick(state.rates, k) + change * (across[k] / sine);
      state.rates.high[k] = pushed.high;
      state.rates.low[k] = pushed.low;
    }
    return true;
  }

  BodyState find_state(const Variables& state) const {
    return BodyState(state, find_fine_unit(find_spin_in_frame(state, stepper_.equations)));
  }

 private:
  const Precise per_ns_ = invert(Precise(1e9));  // in s
  Stepper stepper_{CARRIED_SHARE, IN_SUMS};
  Piece piece_;

  // By Taylor series, in either direction of time; false if that takes too many steps.
  bool follow(Variables& state, const Precise& time) {
    const Double2 wanted = to_double2(time);
    const int direction = time.sign < 0 ? -1 : 1;
    Knot knot = {0.0, state};
    for (int n = 0; n < MOST_CARRIED; n++) {
      stepper_.expand(knot, direction, piece_);
      if (piece_.end == knot.t) return false;
      if (std::fabs(piece_.end) >= std::fabs(wanted.high)) {
        state = piece_.evaluate(piece_.locate(wanted.high, wanted.low));
        return true;
      }
      piece_.find_end();
      knot = piece_.following;
    }
    return false;
  }

  // Whole nutations turn a state by two angles, here in turns: A and B have the phases of quotients
  // that are what they were, and omega_xy turns as conj(A) B (section 6).
  static void turn(Variables& state, const Precise& turns_of_A, const Precise& turns_of_B) {
    const Unit A = find_unit_of(turns_of_A), B = find_unit_of(turns_of_B);
    turn(state.q, W, Z, A);
    turn(state.q, X, Y, B);
    turn(state.rates, OMEGA_X, OMEGA_Y, {A.c * B.c + A.s * B.s, A.c * B.s - A.s * B.c});
  }

  static Unit find_unit_of(const Precise& turns) {
    const Precise part = turns - Precise(round_to_integer(turns.to_double()));
    return find_fine_unit(to_double2(part * TWO_PI));
  }

  static void turn(SumOf<Lanes>& all, int real, int imaginary, Unit by) {
    const Double2 x = pick(all, real), y = pick(all, imaginary);
    const Double2 turned[2] = {x * by.c - y * by.s, y * by.c + x * by.s};
    all.high[real] = turned[0].high;
    all.low[real] = turned[0].low;
    all.high[imaginary] = turned[1].high;
    all.low[imaginary] = turned[1].low;
  }
};

}  // namespace symtop

// Short ways of a free motion from a state with 32 digits to another: what a series of pushes carries on
// from one to the next, where doubles would lose half a last place each time (derivation.md, section 15).
#pragma once

#include "body_state.hpp"
#include "stepper.hpp"

namespace symtop {

// So many steps take as long as the closed form, for one and a half nutations or more. A longer way
// has it.
const int MOST_CARRIED = 8;
// The square of a smaller sine would be no normal number.
const double LEAST_SINE = 1e-100;

// A state stays in the turning frame: the angle of spin, which grows, has its digits, and those of its
// sine would be some less than 32.
class Chain {
 public:
  explicit Chain(const DrivenArguments& top) { stepper_.equations.prepare(top); }

  // Moves a state on by a time in two parts; false if the way is too long.
  bool advance(Variables& state, double t, double rest) {
    Knot knot = {0.0, state};
    for (int n = 0; n < MOST_CARRIED; n++) {
      stepper_.step(knot, 1, piece_);
      if (piece_.end == knot.t || piece_.end * MOST_CARRIED < t) return false;
      if (piece_.end >= t) {
        state = piece_.evaluate(piece_.locate(t, rest));
        return true;
      }
      knot = piece_.following;
    }
    return false;
  }

  // A push on the axle, as push_axle in rule/kicks.hpp: it is across the axle, and in the frame the same as
  // in the body. False where the direction has too few digits.
  static bool push(Variables& state, Double2 change) {
    const Double2 w = pick(state.q, W), p = pick(state.q, X), q = pick(state.q, Y), r = pick(state.q, Z);
    const Double2 x = p * r - w * q, y = q * r + w * p, sine = root(x * x + y * y);
    if (!(sine.high > LEAST_SINE)) return false;
    const Double2 across[2] = {x, y};
    for (int k = OMEGA_X; k <= OMEGA_Y; k++) {
      const Double2 pushed = pick(state.rates, k) + change * (across[k] / sine);
      state.rates.high[k] = pushed.high, state.rates.low[k] = pushed.low;
    }
    return true;
  }

  BodyState find_state(const Variables& state) const { return BodyState(state, stepper_.equations); }

 private:
  Stepper stepper_;
  Piece piece_;
};

}  // namespace symtop

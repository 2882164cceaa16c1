// The steps of an integration in one direction of time, and states at any times.
//
// The pieces depend on the motion alone, not on earlier requests: a state is the same to the last bit
// whatever was asked before. Some knots and pieces are kept, so that one can go back.
#pragma once

#include <memory>
#include <new>

#include "stepper.hpp"

namespace symtop {

// Knots that are kept over the whole integration (beyond them every other one is dropped), and pieces
// up to the present one. So few that the two arrays are no mappings of their own: for a short motion
// that would take as long as all of its steps.
const int KEPT = 512, RECENT = 16;
// Steps from what has been reached, up to a minute. A way is judged after the first ones, some tenths
// of a second: friction may have slowed the top by then.
const double LONGEST_WAY = 1e7;
const long UNJUDGED = 200000;

enum Progress {
  ARRIVED, IS_TOO_FAST, IS_TOO_STIFF, IS_TOO_LONG, NEEDS_STEPS, HAS_NO_MEMORY
};

class Trail {
 public:
  // False if there is no memory.
  bool prepare(const DrivenArguments& top, int direction) {
    kept_.reset(new (std::nothrow) Knot[KEPT + 1]);
    recent_.reset(new (std::nothrow) Piece[RECENT]);
    if (!kept_ || !recent_) return false;
    direction_ = direction;
    stepper_.equations.prepare(top);
    kept_[0] = start(top);
    kept_count_ = spacing_ = 1;
    return true;
  }

  // Integrates towards a time, and returns the time reached; *steps is lowered by those taken. It stops
  // if the motion is too fast to go on, or if more steps seem to be left than `longest`: back in time
  // friction drives a top, and steps become shorter and shorter.
  double reach(double t, double* steps, double longest, Progress* progress) {
    go_back(t);
    *progress = NEEDS_STEPS;
    while (*steps > 0 && std::fabs(present().end) < std::fabs(t)) {
      if (present().end == present().start.t)
        *progress = IS_TOO_FAST;
      else if (is_judged() && count_steps_to(t) > longest)
        *progress = IS_TOO_LONG;
      if (*progress != NEEDS_STEPS) break;
      step();
      *steps -= 1;
    }
    if (std::fabs(t) > std::fabs(present().end)) return present().end;
    *progress = ARRIVED;
    return t;
  }

  // Write the state at t + rest; the time has been reached.
  void read(double t, double rest, double orientation[4], double omega[3]) const {
    const Piece& piece = present();
    const Variables now = piece.evaluate(piece.locate(t, rest));
    const Double2 w = pick(now.q, W), x = pick(now.q, X), y = pick(now.q, Y), z = pick(now.q, Z);
    const Double2 omega_x = pick(now.rates, OMEGA_X), omega_y = pick(now.rates, OMEGA_Y);
    Double2 c, s;
    find_unit(pick(now.rates, SPIN) * stepper_.equations.half_rest, c, s);
    const Double2 q[4] = {w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s};
    const Double2 c2 = c * c - s * s, s2 = scale(c * s, 2.0);
    for (int k = 0; k < 4; k++) orientation[k] = q[k].high;
    omega[0] = (omega_x * c2 + omega_y * s2).high;
    omega[1] = (omega_y * c2 - omega_x * s2).high;
    omega[2] = now.rates.high[OMEGA_Z];
  }

  double decay() const { return stepper_.equations.decay; }

 private:
  Stepper stepper_;
  int direction_ = 1;
  std::unique_ptr<Knot[]> kept_;  // knots over the whole integration, with `spacing_` pieces between two
  long kept_count_ = 0, spacing_ = 1;
  std::unique_ptr<Piece[]> recent_;  // a ring: the last pieces up to the present one
  int recent_count_ = 0, last_ = 0;
  long count_ = 0;  // pieces before the present one

  const Piece& present() const { return recent_[last_]; }

  bool is_judged() const { return count_ >= UNJUDGED && recent_count_ == RECENT; }

  // Steps from the end of the present piece to a time, if they are as long as the last ones.
  double count_steps_to(double t) const {
    const Piece& first = recent_[(last_ + RECENT - recent_count_ + 1) % RECENT];
    return (t - present().end) / (present().end - first.start.t) * recent_count_;
  }

  // The numbers that were given, and the orientation with more digits of norm 1.
  static Knot start(const DrivenArguments& top) {
    Knot knot = {};
    Double2 norm = {0.0, 0.0};
    for (double q : top.orientation) norm = norm + Double2{q, 0.0} * q;
    norm = root(norm);
    for (int k = 0; k < 4; k++) {
      const Double2 q = Double2{top.orientation[k], 0.0} / norm;
      knot.now.q.high[k] = q.high, knot.now.q.low[k] = q.low;
    }
    for (int k = 0; k < 3; k++) knot.now.rates.high[k] = top.omega[k];
    return knot;
  }

  // Cosine and sine of an angle, to some digits more than doubles have.
  static void find_unit(Double2 angle, Double2& c, Double2& s) {
    const Double2 QUARTER = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
    const double quarters = round_to_integer(angle.high * QUARTERS);
    const Double2 near = angle - QUARTER * quarters;
    const double x = near.high, square = x * x;
    static const double SINE[] = {1.0 / 355687428096000, -1.0 / 1307674368000, 1.0 / 6227020800,
                                  -1.0 / 39916800, 1.0 / 362880, -1.0 / 5040, 1.0 / 120};
    static const double VERSINE[] = {-1.0 / 20922789888000, 1.0 / 87178291200, -1.0 / 479001600,
                                     1.0 / 3628800, -1.0 / 40320, 1.0 / 720, -1.0 / 24};
    double of_sine = 0.0, of_versine = 0.0;
    for (double each : SINE) of_sine = (of_sine + each) * square;
    for (double each : VERSINE) of_versine = (of_versine + each) * square;
    // The largest terms, x - x^3/6 and 1 - x^2/2, as sums of two doubles.
    const Double2 near_2 = near * near, sixth = INVERSES[6];
    const Double2 sine = near - near * near_2 * sixth + Double2{x * (square * of_sine), 0.0};
    const Double2 cosine = Double2{1.0, 0.0} - scale(near_2, 0.5) -
                           Double2{square * of_versine, 0.0};
    const int64_t turns = static_cast<int64_t>(quarters);
    c = turns & 1 ? sine : cosine, s = turns & 1 ? cosine : sine;
    if ((turns + 1) & 2) c = -c;
    if (turns & 2) s = -s;
  }

  void append(const Knot& knot) {
    last_ = (last_ + 1) % RECENT;
    if (recent_count_ < RECENT) recent_count_++;
    stepper_.step(knot, direction_, recent_[last_]);
  }

  void step() {
    const Knot knot = present().following;
    count_++;
    if (count_ == kept_count_ * spacing_) kept_[kept_count_++] = knot;
    if (kept_count_ > KEPT) {
      kept_count_ = (kept_count_ + 1) / 2;
      for (long n = 0; n < kept_count_; n++) kept_[n] = kept_[2 * n];
      spacing_ *= 2;
    }
    append(knot);
  }

  void go_back(double t) {
    while (recent_count_ && std::fabs(present().start.t) >= std::fabs(t) && count_) {
      last_ = (last_ + RECENT - 1) % RECENT;
      recent_count_--;
      count_--;
    }
    if (recent_count_) return;
    long place = 0;
    while (place + 1 < kept_count_ && std::fabs(kept_[place + 1].t) < std::fabs(t)) place++;
    count_ = place * spacing_;
    append(kept_[place]);
  }
};

}  // namespace symtop

// The steps of an integration in one direction of time, and states at any times.
//
// The pieces depend on the motion alone, not on earlier requests: a state is the same to the last
// bit whatever was asked before. Some knots and pieces are kept, so that one can go back.
#pragma once

#include <memory>
#include <new>

#include "body_state.hpp"
#include "stepper.hpp"

namespace symtop {

// Knots that are kept over the whole integration (beyond them every other one is dropped), and
// pieces up to the present one. So few that the two arrays are no mappings of their own: for a
// short motion that would take as long as all of its steps.
const int KEPT = 512, RECENT = 16;
// Steps from what has been reached, up to a minute. A way is judged after the first ones, some
// tenths of a second: friction may have slowed the top by then.
const double LONGEST_WAY = 1e7;
const long UNJUDGED = 200000;

enum Progress { ARRIVED, IS_TOO_FAST, IS_TOO_STIFF, IS_TOO_LONG, NEEDS_STEPS, HAS_NO_MEMORY };

class Trail {
 public:
  // False if there is no memory. Steps may have the local error `tolerance`.
  bool prepare(const DrivenArguments& top, const Variables& start, int direction,
               double tolerance) {
    kept_.reset(new (std::nothrow) Knot[KEPT + 1]);
    recent_.reset(new (std::nothrow) Piece[RECENT]);
    if (!kept_ || !recent_) return false;
    direction_ = direction;
    stepper_.equations.prepare(top);
    stepper_.allow(tolerance);
    kept_[0] = {0.0, start};
    kept_count_ = spacing_ = 1;
    return true;
  }

  // Integrates towards a time, and returns the time reached; *steps is lowered by those taken. It
  // stops if the motion is too fast to go on, or if more steps seem to be left than `longest`: back
  // in time friction drives a top, and steps become shorter and shorter.
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

  // The variables at t + rest; the time has been reached.
  Variables find(double t, double rest) const {
    return present().evaluate(present().locate(t, rest));
  }

  void read(double t, double rest, double orientation[4], double omega[3]) const {
    const Variables found = find(t, rest);
    const BodyState now(found, find_unit(find_spin_in_frame(found, stepper_.equations)));
    for (int k = 0; k < 4; k++) orientation[k] = now.q[k].high;
    for (int k = 0; k < 3; k++) omega[k] = now.omega[k].high;
  }

  double decay() const { return stepper_.equations.decay; }

 private:
  Stepper stepper_;
  int direction_ = 1;
  // Knots over the whole integration, with `spacing_` pieces between two
  std::unique_ptr<Knot[]> kept_;
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

// The motion with friction or an applied torque: trails in both directions of time from the start.
#pragma once

#include <memory>
#include <new>

#include "../blocks.hpp"
#include "../lock.hpp"
#include "trail.hpp"

namespace symtop {

const double MOST_DECAYS = 1e5;  // decay times on the way, each of which takes a step

// A call moves along the pieces of a trail: a lock keeps it whole.
class DrivenMotion {
 public:
  // Steps may have the local error `tolerance`. `carried` is the start with 32 digits, if it has
  // them.
  explicit DrivenMotion(const DrivenArguments& given, double tolerance,
                        const Variables* carried = nullptr)
      : given_(given), tolerance_(tolerance), is_carried_(carried) {
    if (carried) carried_ = *carried;

    Start s = {};
    s.w = given.orientation[0];
    s.x = given.orientation[1];
    s.y = given.orientation[2];
    s.z = given.orientation[3];
    start_ = normalize(s);
  }

  // States at times that are sums of two doubles, as `split` returns them for a place; *steps is
  // lowered by those taken.
  template <class Split>
  Progress fill(const Split& split, int64_t count, double* steps, const Target& to,
                int64_t* written) {
    const Lock lock(mutex_);
    for (*written = 0; *written < count; ++*written) {
      const Pair time = split(*written);
      const Progress progress = read(time.x, time.y, steps, to.from(*written));
      if (progress != ARRIVED) return progress;
    }
    return ARRIVED;
  }

  // What the integration has at t + rest.
  Progress find(double t, double rest, double* steps, Variables* found) {
    const Lock lock(mutex_);
    Progress progress;
    Trail* trail = move(t, steps, &progress);
    if (progress == ARRIVED) *found = trail->find(t, rest);
    return progress;
  }

  Progress reach(double t, double steps, double* reached) {
    const Lock lock(mutex_);
    Trail* trail = find_trail(t);
    if (!trail) return HAS_NO_MEMORY;
    Progress progress;
    // A caller that allows few steps limits the time itself: for it no way is too long.
    const double longest = steps > LONGEST_WAY ? LONGEST_WAY : INFINITY;
    *reached = trail->reach(t, &steps, longest, &progress);
    return progress;
  }

 private:
  DrivenArguments given_;
  double tolerance_;
  bool is_carried_;
  Variables carried_;
  Start start_;
  std::unique_ptr<Trail> forward_, backward_;
  Mutex mutex_;

  Trail* find_trail(double t) {
    std::unique_ptr<Trail>& trail = t >= 0 ? forward_ : backward_;
    if (!trail) {
      trail.reset(new (std::nothrow) Trail());
      const Variables start = is_carried_ ? carried_ : BodyState(given_).in_frame();
      if (trail && !trail->prepare(given_, start, t >= 0 ? 1 : -1, tolerance_)) trail.reset();
    }
    return trail.get();
  }

  Progress read(double t, double rest, double* steps, const Target& to) {
    if (t == 0) {
      write_state({start_.w, start_.x, start_.y, start_.z, given_.omega[0], given_.omega[1]},
                  given_.omega[2], to);
      return ARRIVED;
    }
    Progress progress;
    const Trail* trail = move(t, steps, &progress);
    if (progress == ARRIVED) trail->read(t, rest, to.orientation, to.omega);
    return progress;
  }

  // Integrates to a time, and returns the trail that has got there.
  Trail* move(double t, double* steps, Progress* progress) {
    Trail* trail = find_trail(t);
    *progress = HAS_NO_MEMORY;
    if (!trail) return nullptr;
    double none = 0.0;
    const double before = trail->reach(t, &none, LONGEST_WAY, progress);
    if (std::fabs(t - before) * trail->decay() > MOST_DECAYS)
      *progress = IS_TOO_STIFF;
    else if (before != t)
      trail->reach(t, steps, LONGEST_WAY, progress);
    return trail;
  }
};

}  // namespace symtop

// Many states of one motion: LANES at a time where all of them lie after the first instants, else
// one by one. Both are the same templates of exact/closed_form.hpp.
#pragma once

#include "clock.hpp"
#include "exact/free.hpp"
#include "target.hpp"

namespace symtop {

// States at LANES times; phases are turns (3, LANES) and rests (3, LANES), as in Phase.
SYMTOP_CLONES inline void fill_lanes(const ClosedForm& motion, const double* times,
                                     const uint64_t (*turns)[LANES], const double (*rests)[LANES],
                                     const Target& to) {
  PhaseOf<Lanes> phases[FUNCTIONS];
  PairOf<Lanes> values[FUNCTIONS];
  for (int k = 0; k < FUNCTIONS; k++) {
    std::memcpy(&phases[k].turns, turns[k], sizeof phases[k].turns);
    std::memcpy(&phases[k].rest, rests[k], sizeof phases[k].rest);
  }
  Lanes t;
  std::memcpy(&t, times, sizeof t);
  motion.evaluate(t, phases, values);
  const AttitudeOf<Lanes> state = motion.complete(values);
  for (int i = 0; i < LANES; i++)
    write_state(
        {state.w[i], state.x[i], state.y[i], state.z[i], state.omega_x[i], state.omega_y[i]},
        motion.start.wz, to.from(i));
}

// The times in s to a few roundings.
inline double find_rough_time(const double* times, int64_t i) { return times[i]; }

// True if some of the times lie in the first instants, or if they are so many that to look at all
// of them would take longer than to prepare for it.
template <class Times>
bool needs_first_instants(const ClosedForm& motion, const Times& times, int64_t count) {
  bool needs = count > LANES;
  for (int64_t i = 0; i < count && !needs; i++) needs = motion.is_first(find_rough_time(times, i));
  return needs;
}

// True if a time lies after the first instants and is not far.
inline bool is_later(const ClosedForm& motion, double t) {
  return std::fabs(t) > motion.first_end && std::fabs(t) < motion.steps.farthest;
}

inline bool are_later(const ClosedForm& motion, const double* times) {
  bool are = true;
  for (int i = 0; i < LANES; i++) are &= is_later(motion, times[i]);
  return are;
}

// States at times, up to the first that is too far; returns how many.
inline int64_t fill(const ClosedForm& motion, const double* times, int64_t count,
                    const Target& to) {
  uint64_t turns[FUNCTIONS][LANES];
  double rests[FUNCTIONS][LANES];
  for (int64_t i = 0; i < count;) {
    if (i + LANES <= count && are_later(motion, times + i)) {
      for (int lane = 0; lane < LANES; lane++) {
        Phase phases[FUNCTIONS];
        find_phases(motion.steps, FUNCTIONS, times[i + lane], phases);
        for (int k = 0; k < FUNCTIONS; k++) {
          turns[k][lane] = phases[k].turns;
          rests[k][lane] = phases[k].rest;
        }
      }
      fill_lanes(motion, times + i, turns, rests, to.from(i));
      i += LANES;
    } else {
      if (motion.is_far(times[i])) return i;
      write_state(motion.at(times[i]), motion.start.wz, to.from(i));
      i++;
    }
  }
  return count;
}

inline int64_t fill(const FreeMotion& motion, const double* times, int64_t count,
                    const Target& to) {
  for (int64_t i = 0; i < count; i++) {
    if (motion.is_far(times[i])) return i;
    write_state(motion.at(times[i]), motion.start.wz, to.from(i));
  }
  return count;
}

// Stamps of a clock, with times in s that are right to a few roundings: ExactTimes.rough_seconds.
struct Stamps {
  const int64_t* stamps;
  const Clock& clock;
  Exact elapsed;
  double elapsed_seconds;

  Stamps(const int64_t* given, const Clock& of_clock)
      : stamps(given),
        clock(of_clock),
        elapsed(find_elapsed(clock)),
        elapsed_seconds(to_seconds(elapsed)) {}

  double find_rough_seconds(int64_t i) const {
    return elapsed_seconds + clock.factor * (static_cast<double>(stamps[i]) * 1e-9);
  }
  Exact find_exact_time(int64_t i) const { return find_time(clock, elapsed, stamps[i]); }
  double find_seconds(int64_t i) const { return to_seconds(find_exact_time(i)); }
};

inline double find_rough_time(const Stamps& stamps, int64_t i) {
  return stamps.find_rough_seconds(i);
}

// States at stamps. Between the first instants and the first time that is too far, LANES at once.
class StampedStates {
 public:
  // What is not needed may not be prepared, or just now by another thread.
  StampedStates(const ClosedForm& motion, const Stamps& stamps, bool needs_first)
      : motion_(motion),
        stamps_(stamps),
        steps_(motion.steps, FUNCTIONS, stamps.clock),
        half_turn_(needs_first ? motion.first_instants.half_turn : Steps(), needs_first,
                   stamps.clock) {}

  int64_t fill(int64_t count, const Target& to) const {
    for (int64_t i = 0; i < count;) {
      if (i + LANES <= count && are_all_later(i)) {
        fill_later(i, to.from(i));
        i += LANES;
      } else {
        if (std::fabs(stamps_.find_rough_seconds(i)) >= motion_.steps.farthest) return i;
        write_state(find_state(i), motion_.start.wz, to.from(i));
        i++;
      }
    }
    return count;
  }

 private:
  const ClosedForm& motion_;
  const Stamps& stamps_;
  ClockSteps steps_, half_turn_;

  bool are_all_later(int64_t first) const {
    bool are = true;
    for (int64_t i = first; i < first + LANES; i++)
      are &= is_later(motion_, stamps_.find_rough_seconds(i));
    return are;
  }

  // The time itself counts on the separatrix only, where no phase grows at a constant rate.
  double find_own_time(int64_t i) const {
    return motion_.nutation_phase.is_separatrix ? stamps_.find_seconds(i) : 0.0;
  }

  void fill_later(int64_t first, const Target& to) const {
    static const double RESTS[FUNCTIONS][LANES] = {};
    uint64_t turns[FUNCTIONS][LANES];
    double times[LANES];
    for (int lane = 0; lane < LANES; lane++) {
      Phase phases[FUNCTIONS];
      steps_.find_phases(stamps_.stamps[first + lane], phases);
      for (int k = 0; k < FUNCTIONS; k++) turns[k][lane] = phases[k].turns;
      times[lane] = find_own_time(first + lane);
    }
    fill_lanes(motion_, times, turns, RESTS, to);
  }

  Attitude find_state(int64_t i) const {
    const double rough = stamps_.find_rough_seconds(i);
    if (rough == 0) return motion_.complete(motion_.start_values);
    Phase phases[FUNCTIONS];
    Pair values[FUNCTIONS];
    if (motion_.is_first(rough)) {
      half_turn_.find_phases(stamps_.stamps[i], phases);
      motion_.first_instants.compute(stamps_.find_seconds(i), phases[0], values);
    } else {
      steps_.find_phases(stamps_.stamps[i], phases);
      motion_.evaluate(find_own_time(i), phases, values);
    }
    return motion_.complete(values);
  }
};

inline int64_t fill(const ClosedForm& motion, const Stamps& stamps, int64_t count,
                    const Target& to) {
  return StampedStates(motion, stamps, needs_first_instants(motion, stamps, count)).fill(count, to);
}

inline int64_t fill(const FreeMotion& motion, const Stamps& stamps, int64_t count,
                    const Target& to) {
  const ClockSteps steps(motion.steps, FUNCTIONS, stamps.clock);
  for (int64_t i = 0; i < count; i++) {
    if (motion.is_far(stamps.find_rough_seconds(i))) return i;
    Phase phases[FUNCTIONS];
    steps.find_phases(stamps.stamps[i], phases);
    write_state(motion.at_phases(phases), motion.start.wz, to.from(i));
  }
  return count;
}

}  // namespace symtop

// Many states of one motion: LANES at a time where all of them lie after the first instants, else one
// by one. Both are the same templates of exact/closed_form.hpp.
#pragma once

#include "exact/closed_form.hpp"

namespace symtop {

enum Place : uint8_t { LATER, IN_FIRST_INSTANTS, AT_START };

struct Target {  // where states are written: orientation (n, 4) and omega (n, 3)
  double *orientation, *omega;

  Target from(int64_t i) const { return {orientation + 4 * i, omega + 3 * i}; }
};

inline void write_state(const Attitude& state, double omega_z, const Target& to) {
  double *q = to.orientation, *omega = to.omega;
  q[0] = state.w, q[1] = state.x, q[2] = state.y, q[3] = state.z;
  omega[0] = state.omega_x, omega[1] = state.omega_y, omega[2] = omega_z;
}

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
    write_state({state.w[i], state.x[i], state.y[i], state.z[i], state.omega_x[i],
                 state.omega_y[i]}, motion.start.wz, to.from(i));
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

// States at times, but for those that are too far, which are marked.
inline void fill(ClosedForm& motion, const double* times, int64_t count, const Target& to,
                 uint8_t* is_far) {
  uint64_t turns[FUNCTIONS][LANES];
  double rests[FUNCTIONS][LANES];
  for (int64_t i = 0; i < count;) {
    if (i + LANES <= count && are_later(motion, times + i)) {
      for (int lane = 0; lane < LANES; lane++) {
        Phase phases[FUNCTIONS];
        find_phases(motion.steps, FUNCTIONS, times[i + lane], phases);
        for (int k = 0; k < FUNCTIONS; k++)
          turns[k][lane] = phases[k].turns, rests[k][lane] = phases[k].rest;
      }
      fill_lanes(motion, times + i, turns, rests, to.from(i));
      std::memset(is_far + i, 0, LANES);
      i += LANES;
    } else {
      is_far[i] = motion.is_far(times[i]);
      if (!is_far[i]) write_state(motion.at(times[i]), motion.start.wz, to.from(i));
      i++;
    }
  }
}

// States at phases that Python has computed from exact times; turns are (4, n): three phases and
// that of the first instants, which are prepared.
inline void fill_phases(const ClosedForm& motion, const double* times, const uint8_t* places,
                        const uint64_t* turns, int64_t count, const Target& to) {
  static const double RESTS[FUNCTIONS][LANES] = {};
  for (int64_t i = 0; i < count;) {
    if (i + LANES <= count && !(places[i] | places[i + 1] | places[i + 2] | places[i + 3])) {
      uint64_t block[FUNCTIONS][LANES];
      for (int k = 0; k < FUNCTIONS; k++)
        std::memcpy(block[k], turns + k * count + i, sizeof block[k]);
      fill_lanes(motion, times + i, block, RESTS, to.from(i));
      i += LANES;
      continue;
    }
    Pair values[FUNCTIONS];
    const Phase phases[] = {{turns[i], 0.0}, {turns[count + i], 0.0}, {turns[2 * count + i], 0.0}};
    if (places[i] == LATER)
      motion.evaluate(times[i], phases, values);
    else
      motion.first_instants.compute(times[i], {turns[3 * count + i], 0.0}, values);
    const Attitude state = motion.complete(places[i] == AT_START ? motion.start_values : values);
    write_state(state, motion.start.wz, to.from(i));
    i++;
  }
}

}  // namespace symtop

// One motion: its states, and what is constant in it.
#pragma once

#include "pushes.hpp"

struct symtop_motion {
  symtop::Stretch first;
  symtop::Stretches stretches;  // from push to push; without pushes there is the first one alone

  symtop_motion(const symtop_start& s, const symtop_pushes& pushes, bool clamped, double tolerance)
      : first(s, clamped, tolerance),
        stretches(pushes),
        is_clamped(clamped),
        tolerance(tolerance) {}

  bool is_clamped;
  double tolerance;  // local error of steps under friction or a torque; 0 to rounding
};

namespace symtop {

inline symtop_status make_motion(const symtop_start* start, const symtop_pushes& pushes,
                                 symtop_motion** motion, bool is_clamped = false,
                                 double tolerance = 0.0) {
  symtop_start s = *start;
  symtop_status status = find_refusal({accept(s), accept(pushes)});
  if (status == SYMTOP_OK && is_clamped) status = accept_clamped(s);
  if (status == SYMTOP_OK) status = accept_tolerance(tolerance);
  if (status != SYMTOP_OK) return status;
  *motion = new (std::nothrow) symtop_motion(s, pushes, is_clamped, tolerance);
  if (*motion && (*motion)->stretches.prepare(&(*motion)->first)) return SYMTOP_OK;
  delete *motion;
  *motion = nullptr;
  return SYMTOP_NO_MEMORY;
}

}  // namespace symtop

symtop_status symtop_new(const symtop_start* start, symtop_motion** motion) {
  if (motion) *motion = nullptr;
  const symtop_status status = symtop::admit({start, motion});
  return status == SYMTOP_OK ? symtop::make_motion(start, symtop::NO_PUSHES, motion) : status;
}

symtop_status symtop_new_pushed(const symtop_start* start, const symtop_pushes* pushes,
                                symtop_motion** motion) {
  if (motion) *motion = nullptr;
  const symtop_status status = symtop::admit({start, pushes, motion});
  return status == SYMTOP_OK ? symtop::make_motion(start, *pushes, motion) : status;
}

symtop_status symtop_new_clamped(const symtop_start* start, symtop_motion** motion) {
  if (motion) *motion = nullptr;
  const symtop_status status = symtop::admit({start, motion});
  if (status != SYMTOP_OK) return status;
  return symtop::make_motion(start, symtop::NO_PUSHES, motion, true);
}

symtop_status symtop_new_coarse(const symtop_start* start, double tolerance,
                                symtop_motion** motion) {
  if (motion) *motion = nullptr;
  const symtop_status status = symtop::admit({start, motion});
  if (status != SYMTOP_OK) return status;
  return symtop::make_motion(start, symtop::NO_PUSHES, motion, false, tolerance);
}

void symtop_free(symtop_motion* motion) { delete motion; }

symtop_status symtop_continue(symtop_motion* motion, double t, const double torque[3],
                              symtop_motion** continued) {
  if (continued) *continued = nullptr;
  symtop_status status = symtop::admit_motion({motion, torque, continued});
  if (status != SYMTOP_OK) return status;
  symtop_start s = motion->first.start;
  std::memcpy(s.torque, torque, sizeof s.torque);
  status = symtop_state(motion, t, s.orientation, s.angular_velocity);
  if (status != SYMTOP_OK) return status;
  if (motion->is_clamped) return symtop_new_clamped(&s, continued);
  return symtop_new_coarse(&s, motion->tolerance, continued);
}

symtop_status symtop_state(symtop_motion* motion, double t, double orientation[4],
                           double angular_velocity[3]) {
  using namespace symtop;
  const symtop_status status = admit_motion({motion, orientation, angular_velocity});
  if (status != SYMTOP_OK) return status;
  if (!std::isfinite(t)) return SYMTOP_BAD_TIME;
  return motion->stretches.read(t, {orientation, angular_velocity});
}

symtop_status symtop_states(symtop_motion* motion, const double* times, size_t count,
                            double most_steps, double* orientation, double* angular_velocity,
                            size_t* written) {
  using namespace symtop;
  if (written) *written = 0;
  symtop_status status = admit_motion({motion, written});
  if (status == SYMTOP_OK)
    status = admit_arrays(count, ORIENTATION_BYTES, {times, orientation, angular_velocity});
  if (status != SYMTOP_OK) return status;
  status = find_refusal({accept_steps(most_steps), accept_times(times, count)});
  if (status != SYMTOP_OK) return status;
  return motion->stretches.fill(Seconds{times}, count, most_steps, {orientation, angular_velocity},
                                written);
}

symtop_status symtop_states_of_clock(symtop_motion* motion, const symtop_clock* clock,
                                     const int64_t* stamps, size_t count, double most_steps,
                                     double* orientation, double* angular_velocity,
                                     size_t* written) {
  using namespace symtop;
  if (written) *written = 0;
  symtop_status status = admit_motion({motion, clock, written});
  if (status == SYMTOP_OK)
    status = admit_arrays(count, ORIENTATION_BYTES, {stamps, orientation, angular_velocity});
  Clock exact;
  if (status == SYMTOP_OK) status = find_refusal({accept_steps(most_steps), accept(*clock, exact)});
  if (status != SYMTOP_OK) return status;
  for (size_t i = 0; i < count; i++)
    if (stamps[i] == INT64_MIN) return SYMTOP_BAD_TIME;
  return motion->stretches.fill(ClockTimes{exact, stamps}, count, most_steps,
                                {orientation, angular_velocity}, written);
}

symtop_status symtop_find_piece(symtop_motion* motion, const symtop_clock* clock, int64_t stamp,
                                double most_steps, symtop_piece* piece) {
  using namespace symtop;
  symtop_status status = admit_motion({motion, clock, piece});
  Clock exact;
  if (status == SYMTOP_OK) status = find_refusal({accept_steps(most_steps), accept(*clock, exact)});
  if (status != SYMTOP_OK) return status;
  if (stamp == INT64_MIN) return SYMTOP_BAD_TIME;
  return motion->stretches.find_piece(ClockTimes{exact, &stamp}, most_steps, piece);
}

symtop_status symtop_reach(symtop_motion* motion, double t, double most_steps, double* reached) {
  using namespace symtop;
  symtop_status status = admit_motion({motion, reached});
  if (status == SYMTOP_OK) status = find_refusal({accept_steps(most_steps), accept_times(&t, 1)});
  return status == SYMTOP_OK ? motion->stretches.reach(t, most_steps, reached) : status;
}

// What a motion has been prepared for is kept, and other threads use it: nothing is prepared with
// another rounding.
symtop_kind symtop_find_kind(symtop_motion* motion) {
  if (symtop::admit_motion({motion}) != SYMTOP_OK) return SYMTOP_UNKNOWN_KIND;
  if (motion->first.is_driven || motion->stretches.has_pushes()) return SYMTOP_DRIVEN;
  return static_cast<symtop_kind>(motion->first.gravity.find_kind());
}

symtop_engine symtop_find_engine(symtop_motion* motion) {
  if (!motion) return SYMTOP_UNKNOWN_ENGINE;
  if (motion->first.is_driven) return SYMTOP_TAYLOR;
  return motion->first.gravity.is_free() ? SYMTOP_FREE : SYMTOP_CLOSED_FORM;
}

symtop_status symtop_find_turning_angles(symtop_motion* motion, double angles[2]) {
  const symtop_status status = symtop::admit_motion({motion, angles});
  if (status == SYMTOP_OK) motion->first.gravity.find_turning_angles(angles);
  return status;
}

symtop_status symtop_find_rates(symtop_motion* motion, symtop_rates* rates) {
  const symtop_status status = symtop::admit_motion({motion, rates});
  if (status != SYMTOP_OK) return status;
  const symtop::Rates found = motion->first.gravity.find_rates();
  *rates = {found.nutation_period,         found.mean_precession_rate, found.mean_spin_rate,
            found.precession_per_nutation, found.mean_cosine,          found.spin_reverses};
  return SYMTOP_OK;
}

symtop_status symtop_find_farthest_time(symtop_motion* motion, double* t) {
  const symtop_status status = symtop::admit_motion({motion, t});
  if (status == SYMTOP_OK)
    *t = motion->first.is_driven ? INFINITY : motion->stretches.find_farthest_time();
  return status;
}

symtop_status symtop_find_nutation_rate(symtop_motion* motion, double rate[2]) {
  const symtop_status status = symtop::admit_motion({motion, rate});
  if (status == SYMTOP_OK) motion->first.gravity.find_nutation_rate(rate);
  return status;
}

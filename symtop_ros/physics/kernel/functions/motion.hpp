// One motion: its states, and what is constant in it.
#pragma once

#include <new>

#include "../driven/motion.hpp"
#include "../gravity.hpp"
#include "arguments.hpp"

struct symtop_motion {
  symtop_start start;
  symtop::GravityMotion gravity;
  symtop::DrivenMotion driven;
  bool is_driven;

  explicit symtop_motion(const symtop_start& s);
};

namespace symtop {

inline DrivenArguments to_driven(const symtop_start& s) {
  DrivenArguments a = {s.Ix, s.Iz, s.Mgl, s.friction[0], s.friction[1], {}, {}, {}};
  std::memcpy(a.torque, s.torque, sizeof a.torque);
  std::memcpy(a.orientation, s.orientation, sizeof a.orientation);
  std::memcpy(a.omega, s.angular_velocity, sizeof a.omega);
  return a;
}

inline symtop_status to_status(Progress progress) {
  static const symtop_status STATUSES[] = {SYMTOP_OK, SYMTOP_TOO_FAST, SYMTOP_TOO_STIFF,
                                           SYMTOP_TOO_LONG, SYMTOP_MORE_STEPS,
                                           SYMTOP_NO_MEMORY};
  return STATUSES[progress];
}

// States at the times that `split` returns in two parts, or under gravity at `times`.
template <class Split, class... Times>
symtop_status fill(symtop_motion* motion, size_t count, double most_steps, const Target& to,
                   size_t* written, const Split& split, const Times&... times) {
  const int64_t n = static_cast<int64_t>(count);
  int64_t done = 0;
  symtop_status status = SYMTOP_OK;
  if (motion->is_driven) {
    status = to_status(motion->driven.fill(split, n, most_steps, to, &done));
  } else {
    done = motion->gravity.fill(to, n, times...);
    if (done < n) status = SYMTOP_TOO_FAR;
  }
  *written = static_cast<size_t>(done);
  return status;
}

}  // namespace symtop

symtop_motion::symtop_motion(const symtop_start& s)
    : start(s), gravity(symtop::to_start(s)), driven(symtop::to_driven(s)),
      is_driven(symtop::is_driven(s)) {}

symtop_status symtop_new(const symtop_start* start, symtop_motion** motion) {
  if (motion) *motion = nullptr;
  symtop_status status = symtop::admit({start, motion});
  if (status != SYMTOP_OK) return status;
  symtop_start s = *start;
  status = symtop::accept(s);
  if (status != SYMTOP_OK) return status;
  *motion = new (std::nothrow) symtop_motion(s);
  return *motion ? SYMTOP_OK : SYMTOP_NO_MEMORY;
}

void symtop_free(symtop_motion* motion) { delete motion; }

symtop_status symtop_continue(symtop_motion* motion, double t, const double torque[3],
                              symtop_motion** continued) {
  if (continued) *continued = nullptr;
  symtop_status status = symtop::admit_motion({motion, torque, continued});
  if (status != SYMTOP_OK) return status;
  symtop_start s = motion->start;
  std::memcpy(s.torque, torque, sizeof s.torque);
  status = symtop_state(motion, t, s.orientation, s.angular_velocity);
  return status == SYMTOP_OK ? symtop_new(&s, continued) : status;
}

symtop_status symtop_state(symtop_motion* motion, double t, double orientation[4],
                           double angular_velocity[3]) {
  const symtop_status status = symtop::admit_motion({motion, orientation, angular_velocity});
  if (status != SYMTOP_OK) return status;
  if (!std::isfinite(t)) return SYMTOP_BAD_TIME;
  const symtop::Target to = {orientation, angular_velocity};
  if (!motion->is_driven) return motion->gravity.read(t, to) ? SYMTOP_OK : SYMTOP_TOO_FAR;
  int64_t written;
  const auto split = [t](int64_t) { return symtop::Pair{t, 0.0}; };
  return symtop::to_status(motion->driven.fill(split, 1, INFINITY, to, &written));
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
  const auto split = [times](int64_t i) { return Pair{times[i], 0.0}; };
  return fill(motion, count, most_steps, {orientation, angular_velocity}, written, split, times);
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
  const Stamps all(stamps, exact);
  const auto split = [&all](int64_t i) { return split_seconds(all.find_exact_time(i)); };
  return fill(motion, count, most_steps, {orientation, angular_velocity}, written, split, all);
}

symtop_status symtop_reach(symtop_motion* motion, double t, double most_steps, double* reached) {
  using namespace symtop;
  symtop_status status = admit_motion({motion, reached});
  if (status == SYMTOP_OK)
    status = find_refusal({accept_steps(most_steps), accept_times(&t, 1)});
  if (status != SYMTOP_OK) return status;
  *reached = t;
  return motion->is_driven ? to_status(motion->driven.reach(t, most_steps, reached)) : SYMTOP_OK;
}

// What a motion has been prepared for is kept, and other threads use it: nothing is prepared with
// another rounding.
symtop_kind symtop_find_kind(symtop_motion* motion) {
  if (symtop::admit_motion({motion}) != SYMTOP_OK) return SYMTOP_UNKNOWN_KIND;
  if (motion->is_driven) return SYMTOP_DRIVEN;
  return static_cast<symtop_kind>(motion->gravity.find_kind());
}

symtop_engine symtop_find_engine(symtop_motion* motion) {
  if (!motion) return SYMTOP_UNKNOWN_ENGINE;
  if (motion->is_driven) return SYMTOP_TAYLOR;
  return motion->gravity.is_free() ? SYMTOP_FREE : SYMTOP_CLOSED_FORM;
}

symtop_status symtop_find_turning_angles(symtop_motion* motion, double angles[2]) {
  const symtop_status status = symtop::admit_motion({motion, angles});
  if (status == SYMTOP_OK) motion->gravity.find_turning_angles(angles);
  return status;
}

symtop_status symtop_find_rates(symtop_motion* motion, symtop_rates* rates) {
  const symtop_status status = symtop::admit_motion({motion, rates});
  if (status != SYMTOP_OK) return status;
  const symtop::Rates found = motion->gravity.find_rates();
  *rates = {found.nutation_period, found.mean_precession_rate, found.mean_spin_rate,
            found.precession_per_nutation, found.spin_reverses};
  return SYMTOP_OK;
}

symtop_status symtop_find_farthest_time(symtop_motion* motion, double* t) {
  const symtop_status status = symtop::admit_motion({motion, t});
  if (status == SYMTOP_OK)
    *t = motion->is_driven ? INFINITY : motion->gravity.find_farthest_time();
  return status;
}

symtop_status symtop_find_nutation_rate(symtop_motion* motion, double rate[2]) {
  const symtop_status status = symtop::admit_motion({motion, rate});
  if (status == SYMTOP_OK) motion->gravity.find_nutation_rate(rate);
  return status;
}

// One motion: its states, and what is constant in it.
#pragma once

#include <new>

#include "../driven/motion.hpp"
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
                                           SYMTOP_MORE_STEPS, SYMTOP_NO_MEMORY};
  return STATUSES[progress];
}

inline bool is_part_of_clock(double x) {
  return x == 0 || is_between(std::fabs(x), SMALLEST, LARGEST);
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
  *motion = nullptr;
  symtop_start s = *start;
  const symtop_status status = symtop::accept(s);
  if (status != SYMTOP_OK) return status;
  *motion = new (std::nothrow) symtop_motion(s);
  return *motion ? SYMTOP_OK : SYMTOP_NO_MEMORY;
}

void symtop_free(symtop_motion* motion) { delete motion; }

symtop_status symtop_continue(symtop_motion* motion, double t, const double torque[3],
                              symtop_motion** continued) {
  *continued = nullptr;
  symtop_start s = motion->start;
  const symtop_status status = symtop_state(motion, t, s.orientation, s.angular_velocity);
  if (status != SYMTOP_OK) return status;
  std::memcpy(s.torque, torque, sizeof s.torque);
  return symtop_new(&s, continued);
}

symtop_status symtop_state(symtop_motion* motion, double t, double orientation[4],
                           double angular_velocity[3]) {
  if (!symtop::rounds_to_nearest()) return SYMTOP_BAD_ARITHMETIC;
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
  *written = 0;
  if (!symtop::rounds_to_nearest()) return SYMTOP_BAD_ARITHMETIC;
  for (size_t i = 0; i < count; i++)
    if (!std::isfinite(times[i])) return SYMTOP_BAD_TIME;
  const auto split = [times](int64_t i) { return symtop::Pair{times[i], 0.0}; };
  return symtop::fill(motion, count, most_steps, {orientation, angular_velocity}, written, split, times);
}

symtop_status symtop_states_of_clock(symtop_motion* motion, const symtop_clock* clock,
                                     const int64_t* stamps, size_t count, double most_steps,
                                     double* orientation, double* angular_velocity,
                                     size_t* written) {
  *written = 0;
  if (!symtop::rounds_to_nearest()) return SYMTOP_BAD_ARITHMETIC;
  symtop::Clock exact = {clock->factor, {}};
  bool is_valid = symtop::is_part_of_clock(clock->factor);
  for (int i = 0; i < symtop::ELAPSED_PARTS; i++) {
    exact.elapsed[i] = clock->elapsed[i];
    is_valid &= symtop::is_part_of_clock(exact.elapsed[i]);
  }
  for (size_t i = 0; i < count; i++) is_valid &= stamps[i] != INT64_MIN;
  if (!is_valid) return SYMTOP_BAD_TIME;
  const symtop::Stamps all(stamps, exact);
  const auto split = [&all](int64_t i) { return symtop::split_seconds(all.find_exact_time(i)); };
  return symtop::fill(motion, count, most_steps, {orientation, angular_velocity}, written, split, all);
}

symtop_status symtop_reach(symtop_motion* motion, double t, double most_steps, double* reached) {
  *reached = t;
  if (!symtop::rounds_to_nearest()) return SYMTOP_BAD_ARITHMETIC;
  if (!std::isfinite(t)) return SYMTOP_BAD_TIME;
  return motion->is_driven ? symtop::to_status(motion->driven.reach(t, most_steps, reached)) : SYMTOP_OK;
}

// What a motion has been prepared for is kept, and other threads use it: nothing is prepared with
// another rounding.
symtop_kind symtop_find_kind(symtop_motion* motion) {
  if (!symtop::rounds_to_nearest()) return SYMTOP_UNKNOWN_KIND;
  if (motion->is_driven) return SYMTOP_DRIVEN;
  return static_cast<symtop_kind>(motion->gravity.find_kind());
}

symtop_engine symtop_find_engine(symtop_motion* motion) {
  if (motion->is_driven) return SYMTOP_TAYLOR;
  return motion->gravity.is_free() ? SYMTOP_FREE : SYMTOP_CLOSED_FORM;
}

void symtop_find_turning_angles(symtop_motion* motion, double angles[2]) {
  angles[0] = angles[1] = NAN;
  if (symtop::rounds_to_nearest()) motion->gravity.find_turning_angles(angles);
}

void symtop_find_rates(symtop_motion* motion, symtop_rates* rates) {
  *rates = {NAN, NAN, NAN, NAN, 0};
  if (!symtop::rounds_to_nearest()) return;
  const symtop::Rates found = motion->gravity.find_rates();
  *rates = {found.nutation_period, found.mean_precession_rate, found.mean_spin_rate,
            found.precession_per_nutation, found.spin_reverses};
}

void symtop_find_farthest_time(symtop_motion* motion, double* t) {
  *t = !symtop::rounds_to_nearest() ? NAN
       : motion->is_driven          ? INFINITY
                                    : motion->gravity.find_farthest_time();
}

void symtop_find_nutation_rate(symtop_motion* motion, double rate[2]) {
  rate[0] = rate[1] = NAN;
  if (symtop::rounds_to_nearest()) motion->gravity.find_nutation_rate(rate);
}

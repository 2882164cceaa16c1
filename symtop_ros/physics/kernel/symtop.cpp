// The functions of symtop.h: arguments are checked here, and computed in the headers.
#include "symtop.h"

#include <new>

#include "driven/motion.hpp"
#include "gravity.hpp"

using symtop::DrivenArguments;
using symtop::DrivenMotion;
using symtop::GravityMotion;
using symtop::Pair;
using symtop::Progress;
using symtop::Start;
using symtop::Stamps;
using symtop::Target;

struct symtop_motion {
  symtop_start start;
  GravityMotion gravity;
  DrivenMotion driven;
  bool is_driven;

  explicit symtop_motion(const symtop_start& s);
};

namespace {

// Limits of values.py and state.py.
const double LARGEST = 1e100, SMALLEST = 1e-100, NORM_TOLERANCE = 1e-3;

// Numbers whose squares would underflow are zero: _flush_tiny of state.py.
void flush_tiny(double* numbers, int count) {
  for (int i = 0; i < count; i++)
    if (std::fabs(numbers[i]) < SMALLEST) numbers[i] = 0.0;
}

bool are_at_most(const double* numbers, int count, double most) {
  for (int i = 0; i < count; i++)
    if (!(std::fabs(numbers[i]) <= most)) return false;
  return true;
}

bool is_between(double x, double least, double most) { return least <= x && x <= most; }

symtop_status validate(const symtop_start& s) {
  const double *q = s.orientation, most = 1.7976931348623157e308;
  if (!is_between(s.Ix, SMALLEST, LARGEST) || !is_between(s.Iz, SMALLEST, LARGEST) ||
      !(s.Iz <= 2 * s.Ix) || !(std::fabs(s.Mgl) <= LARGEST))
    return SYMTOP_BAD_TOP;
  const double norm = std::sqrt((q[0] * q[0] + q[3] * q[3]) + (q[1] * q[1] + q[2] * q[2]));
  if (!(std::fabs(norm - 1) <= NORM_TOLERANCE)) return SYMTOP_BAD_ORIENTATION;
  if (!are_at_most(s.angular_velocity, 3, LARGEST)) return SYMTOP_BAD_ANGULAR_VELOCITY;
  if (!is_between(s.friction[0], 0.0, most) || !is_between(s.friction[1], 0.0, most))
    return SYMTOP_BAD_FRICTION;
  return are_at_most(s.torque, 3, most) ? SYMTOP_OK : SYMTOP_BAD_TORQUE;
}

Start to_start(const symtop_start& s) {
  const double *q = s.orientation, *omega = s.angular_velocity;
  return {s.Ix, s.Iz, s.Mgl, q[0], q[1], q[2], q[3], omega[0], omega[1], omega[2]};
}

DrivenArguments to_driven(const symtop_start& s) {
  DrivenArguments a = {s.Ix, s.Iz, s.Mgl, s.friction[0], s.friction[1], {}, {}, {}};
  std::memcpy(a.torque, s.torque, sizeof a.torque);
  std::memcpy(a.orientation, s.orientation, sizeof a.orientation);
  std::memcpy(a.omega, s.angular_velocity, sizeof a.omega);
  return a;
}

bool is_driven(const symtop_start& s) {
  for (double each : s.friction)
    if (each) return true;
  for (double each : s.torque)
    if (each) return true;
  return false;
}

symtop_status to_status(Progress progress) {
  static const symtop_status STATUSES[] = {SYMTOP_OK, SYMTOP_TOO_FAST, SYMTOP_TOO_STIFF,
                                           SYMTOP_MORE_STEPS, SYMTOP_NO_MEMORY};
  return STATUSES[progress];
}

bool is_part_of_clock(double x) {
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

}  // namespace

symtop_motion::symtop_motion(const symtop_start& s)
    : start(s), gravity(to_start(s)), driven(to_driven(s)), is_driven(::is_driven(s)) {}

const char* symtop_describe_status(symtop_status status) {
  switch (status) {
    case SYMTOP_OK: return "done";
    case SYMTOP_NO_MEMORY: return "memory must suffice for the motion";
    case SYMTOP_BAD_TOP:
      return "Ix, Iz and Mgl must be finite, 1e-100 to 1e100 in size, with Iz > 0 and at most 2 Ix";
    case SYMTOP_BAD_ORIENTATION: return "orientation must be a quaternion of norm 1 within 0.001";
    case SYMTOP_BAD_ANGULAR_VELOCITY:
      return "angular_velocity must be finite, at most 1e100 rad/s in size";
    case SYMTOP_BAD_FRICTION: return "friction must be finite and >= 0 N m s";
    case SYMTOP_BAD_TORQUE: return "torque must be finite";
    case SYMTOP_BAD_TIME:
      return "times must be finite, and the parts of a clock 0 or 1e-100 to 1e100 in size";
    case SYMTOP_TOO_FAR: return "times must be within 1e15 turns of the start";
    case SYMTOP_TOO_FAST: return "times must be before the motion becomes too fast for doubles";
    case SYMTOP_TOO_STIFF: return "times must be within 1e5 decay times of what has been reached";
    case SYMTOP_MORE_STEPS: return "most_steps must suffice for the way: call again to go on";
  }
  return "status must be one of symtop_status";
}

symtop_status symtop_new(const symtop_start* start, symtop_motion** motion) {
  *motion = nullptr;
  symtop_start s = *start;
  const symtop_status status = validate(s);
  if (status != SYMTOP_OK) return status;
  flush_tiny(s.orientation, 4);
  flush_tiny(s.angular_velocity, 3);
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
  if (!std::isfinite(t)) return SYMTOP_BAD_TIME;
  const Target to = {orientation, angular_velocity};
  if (!motion->is_driven) return motion->gravity.read(t, to) ? SYMTOP_OK : SYMTOP_TOO_FAR;
  int64_t written;
  const auto split = [t](int64_t) { return Pair{t, 0.0}; };
  return to_status(motion->driven.fill(split, 1, INFINITY, to, &written));
}

symtop_status symtop_states(symtop_motion* motion, const double* times, size_t count,
                            double most_steps, double* orientation, double* angular_velocity,
                            size_t* written) {
  *written = 0;
  for (size_t i = 0; i < count; i++)
    if (!std::isfinite(times[i])) return SYMTOP_BAD_TIME;
  const auto split = [times](int64_t i) { return Pair{times[i], 0.0}; };
  return fill(motion, count, most_steps, {orientation, angular_velocity}, written, split, times);
}

symtop_status symtop_states_of_clock(symtop_motion* motion, const symtop_clock* clock,
                                     const int64_t* stamps, size_t count, double most_steps,
                                     double* orientation, double* angular_velocity,
                                     size_t* written) {
  *written = 0;
  symtop::Clock exact = {clock->factor, {}};
  bool is_valid = is_part_of_clock(clock->factor);
  for (int i = 0; i < symtop::ELAPSED_PARTS; i++) {
    exact.elapsed[i] = clock->elapsed[i];
    is_valid &= is_part_of_clock(exact.elapsed[i]);
  }
  for (size_t i = 0; i < count; i++) is_valid &= stamps[i] != INT64_MIN;
  if (!is_valid) return SYMTOP_BAD_TIME;
  const Stamps all(stamps, exact);
  const auto split = [&all](int64_t i) { return symtop::split_seconds(all.find_exact_time(i)); };
  return fill(motion, count, most_steps, {orientation, angular_velocity}, written, split, all);
}

symtop_status symtop_reach(symtop_motion* motion, double t, double most_steps, double* reached) {
  *reached = t;
  if (!std::isfinite(t)) return SYMTOP_BAD_TIME;
  return motion->is_driven ? to_status(motion->driven.reach(t, most_steps, reached)) : SYMTOP_OK;
}

symtop_kind symtop_find_kind(symtop_motion* motion) {
  if (motion->is_driven) return SYMTOP_DRIVEN;
  return static_cast<symtop_kind>(motion->gravity.find_kind());
}

void symtop_find_turning_angles(symtop_motion* motion, double angles[2]) {
  motion->gravity.find_turning_angles(angles);
}

void symtop_find_rates(symtop_motion* motion, symtop_rates* rates) {
  const symtop::Rates found = motion->gravity.find_rates();
  *rates = {found.nutation_period, found.mean_precession_rate, found.mean_spin_rate,
            found.precession_per_nutation, found.spin_reverses};
}

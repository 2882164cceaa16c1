// What is known of a start, a kick or a rate without a state at another time.
#pragma once

#include "../rule/clamp.hpp"
#include "../rule/doubt.hpp"
#include "../rule/hurried.hpp"
#include "../rule/kicks.hpp"
#include "../rule/present.hpp"
#include "../rule/spreads.hpp"
#include "../rule/starts.hpp"
#include "arguments.hpp"

symtop_status symtop_normalize(const double* orientation, const double* angular_velocity,
                               size_t count, double* normalized, double* rates) {
  using namespace symtop;
  size_t done;
  const Pointers arrays = {orientation, angular_velocity, normalized, rates};
  return compute_each(count, ORIENTATION_BYTES, arrays, &done, [&](size_t i) {
    double q[4], omega[3];
    const symtop_status status =
        accept_state(orientation + 4 * i, angular_velocity + 3 * i, q, omega);
    if (status != SYMTOP_OK) return status;
    std::memcpy(normalized + 4 * i, q, sizeof q);
    std::memcpy(rates + 3 * i, omega, sizeof omega);
    return status;
  });
}

symtop_status symtop_from_angles(const double* angles, const double* rates, size_t count,
                                 double* orientation, double* angular_velocity, size_t* done) {
  using namespace symtop;
  const Pointers arrays = {angles, rates, orientation, angular_velocity};
  return compute_each(count, ORIENTATION_BYTES, arrays, done, [&](size_t i) {
    const double *given = angles + 3 * i, *turning = rates + 3 * i;
    const symtop_status status = find_refusal({accept_angles(given, 3), accept_angles(turning, 3)});
    if (status != SYMTOP_OK) return status;
    double q[4], omega[3];
    find_state(given, turning, q, omega);
    for (int k = 0; k < 4; k++) orientation[4 * i + k] = q[k];
    // One that is refused is written as well, for the words of the refusal.
    for (int k = 0; k < 3; k++) angular_velocity[3 * i + k] = omega[k];
    return are_at_most(omega, 3, LARGEST) ? SYMTOP_OK : SYMTOP_BAD_ANGULAR_VELOCITY;
  });
}

symtop_status symtop_find_angles(const double* orientation, size_t count, double* angles) {
  using namespace symtop;
  size_t done;
  return compute_each(count, ORIENTATION_BYTES, {orientation, angles}, &done, [&](size_t i) {
    double q[4];
    const symtop_status status = accept_orientation(orientation + 4 * i, q);
    if (status == SYMTOP_OK) find_angles(q, angles + 3 * i);
    return status;
  });
}

symtop_status symtop_find_angle_rates(const double* orientation, const double* angular_velocity,
                                      size_t count, double* rates) {
  using namespace symtop;
  size_t done;
  const Pointers arrays = {orientation, angular_velocity, rates};
  return compute_each(count, ORIENTATION_BYTES, arrays, &done, [&](size_t i) {
    double q[4], omega[3];
    const symtop_status status =
        accept_state(orientation + 4 * i, angular_velocity + 3 * i, q, omega);
    if (status == SYMTOP_OK) find_angle_rates(q, omega, rates + 3 * i);
    return status;
  });
}

symtop_status symtop_find_regular_rates(const symtop_top* tops, const double* thetas,
                                        const double* spins, size_t count, symtop_hold hold,
                                        double* rates) {
  using namespace symtop;
  size_t done;
  const symtop_status held = accept_hold(hold);
  const Pointers arrays = {tops, thetas, spins, rates};
  return compute_each(count, sizeof(symtop_top), arrays, &done, [&](size_t i) {
    const symtop_status status = find_refusal(
        {held, accept(tops[i]), accept_angles(thetas + i, 1), accept_angles(spins + i, 1)});
    if (status == SYMTOP_OK) find_regular_rates(tops[i], thetas[i], spins[i], hold, rates + 2 * i);
    return status;
  });
}

symtop_status symtop_find_tilt_torques(const symtop_top* tops, const double* thetas,
                                       const double* phi_dots, const double* psi_dots, size_t count,
                                       double* torques) {
  using namespace symtop;
  size_t done;
  const Pointers arrays = {tops, thetas, phi_dots, psi_dots, torques};
  return compute_each(count, ORIENTATION_BYTES, arrays, &done, [&](size_t i) {
    const symtop_status status = find_refusal(
        {accept(tops[i]), accept_angles(thetas + i, 1), accept_rates({phi_dots[i], psi_dots[i]})});
    if (status == SYMTOP_OK)
      find_tilt_torques(tops[i], thetas[i], phi_dots[i], psi_dots[i], torques + 4 * i);
    return status;
  });
}

symtop_status symtop_find_tilt_accelerations(const symtop_start* start, symtop_hold hold,
                                             const double* phi_dots, size_t count,
                                             double* theta_ddots) {
  using namespace symtop;
  symtop_status status = admit({start});
  if (status == SYMTOP_OK) status = admit_arrays(count, sizeof(double), {phi_dots, theta_ddots});
  if (status != SYMTOP_OK) return status;
  symtop_start s = *start;
  status = find_refusal({accept(s), accept_hold(hold)});
  if (status != SYMTOP_OK) return status;
  const Instant now(s);
  if (now.vertical.is_of_vertical_axis()) return SYMTOP_VERTICAL;
  if (!are_at_most(phi_dots, count, LARGEST)) return SYMTOP_BAD_KICK;
  const TiltAcceleration tilt(now, hold);
  for (size_t i = 0; i < count; i++) theta_ddots[i] = tilt.at(phi_dots[i]);
  return SYMTOP_OK;
}

namespace symtop {

// A top, and what is seen of it.
inline symtop_status accept_question(const symtop_top& top, symtop_question seen) {
  const symtop_status status = accept(top);
  if (status != SYMTOP_OK) return status;
  return is_number_of(read_number(seen), SYMTOP_GOLDSTEIN) ? SYMTOP_OK : SYMTOP_BAD_QUESTION;
}

}  // namespace symtop

symtop_status symtop_solve_start(const symtop_top* top, symtop_question seen, const double known[3],
                                 symtop_solutions* solutions) {
  using namespace symtop;
  symtop_status status = admit({top, known, solutions});
  if (status != SYMTOP_OK) return status;
  const symtop_top given = *top;
  status = accept_question(given, seen);
  if (status != SYMTOP_OK) return status;
  const double numbers[] = {known[0], known[1], known[2]};
  *solutions = solve_start(given, seen, numbers);
  return SYMTOP_OK;
}

symtop_status symtop_find_spreads(const symtop_top* top, symtop_question seen,
                                  const double known[3], const double half_widths[3],
                                  symtop_spreads* spreads) {
  using namespace symtop;
  symtop_status status = admit({top, known, half_widths, spreads});
  if (status != SYMTOP_OK) return status;
  const symtop_top given = *top;
  status = accept_question(given, seen);
  if (status != SYMTOP_OK) return status;
  const double numbers[] = {known[0], known[1], known[2]};
  const double widths[] = {half_widths[0], half_widths[1], half_widths[2]};
  *spreads = find_spreads(given, seen, numbers, widths);
  return SYMTOP_OK;
}

symtop_status symtop_kick(const symtop_top* tops, const double* orientation,
                          const double* angular_velocity, symtop_kick_kind kind, symtop_hold hold,
                          const double* amounts, size_t count, double* kicked, size_t* done) {
  using namespace symtop;
  if (done) *done = 0;
  const symtop_status kind_status = accept_kind_of_kick(kind);
  if (kind_status != SYMTOP_OK) return kind_status;
  const symtop_status held = is_impulse(kind) ? accept_hold_of_kick(hold) : accept_hold(hold);
  const size_t width = kind == SYMTOP_IMPULSE ? 3 : 1;
  const Pointers arrays = {tops, orientation, angular_velocity, amounts, kicked};
  return compute_each(count, ORIENTATION_BYTES, arrays, done, [&](size_t i) {
    if (held != SYMTOP_OK) return held;
    symtop_status status = accept(tops[i]);
    if (status != SYMTOP_OK) return status;
    double q[4], omega[3];
    status = accept_state(orientation + 4 * i, angular_velocity + 3 * i, q, omega);
    if (status != SYMTOP_OK) return status;
    const double* amount = amounts + width * i;
    if (!are_finite(amount, width)) return SYMTOP_BAD_KICK;
    if (!kick(tops[i], q, kind, hold, amount, omega)) return SYMTOP_VERTICAL;
    if (!are_at_most(omega, 3, LARGEST)) return SYMTOP_BAD_KICK;
    for (int k = 0; k < 3; k++) kicked[3 * i + k] = omega[k];
    return SYMTOP_OK;
  });
}

symtop_status symtop_judge(const symtop_start* starts, const double* factors, size_t count,
                           symtop_hold hold, symtop_verdict* verdicts, size_t* done) {
  using namespace symtop;
  const symtop_status held = accept_hold(hold);
  const Pointers arrays = {starts, factors, verdicts};
  return compute_each(count, sizeof(symtop_verdict), arrays, done, [&](size_t i) {
    symtop_start s = starts[i];
    const symtop_status status = find_refusal({held, accept(s)});
    if (status != SYMTOP_OK) return status;
    const symtop_start kicked = consider_kick(s, factors[i], hold);
    GravityMotion motion(to_start(s)), with(to_start(kicked));
    return judge(s, kicked, motion, with, factors[i], hold, verdicts[i]) ? SYMTOP_OK
                                                                         : SYMTOP_BAD_KICK;
  });
}

symtop_status symtop_compare_hurried(const symtop_top* tops, const double* thetas,
                                     const double* phi_dots, const double* psi_dots, size_t count,
                                     double factor, symtop_hold hold, double* angles,
                                     unsigned char* rules) {
  using namespace symtop;
  size_t done;
  const symtop_status held = accept_hold(hold);
  const Pointers arrays = {tops, thetas, phi_dots, psi_dots, angles, rules};
  return compute_each(count, sizeof(symtop_top), arrays, &done, [&](size_t i) {
    const symtop_status status =
        find_refusal({held, accept(tops[i]), accept_angles(thetas + i, 1)});
    if (status != SYMTOP_OK) return status;
    const double rates[] = {phi_dots[i], psi_dots[i], factor * phi_dots[i]};
    if (!are_at_most(rates, 3, LARGEST) || !are_finite(&factor, 1)) return SYMTOP_BAD_KICK;
    const symtop_rule rule =
        compare_hurried(tops[i], thetas[i], rates[0], rates[1], factor, hold, angles + 2 * i);
    rules[i] = static_cast<unsigned char>(rule);
    return SYMTOP_OK;
  });
}

symtop_status symtop_judge_clamp(const symtop_start* start, symtop_held* held) {
  using namespace symtop;
  symtop_status status = admit({start, held});
  if (status != SYMTOP_OK) return status;
  symtop_start s = *start;
  status = accept(s);
  if (status == SYMTOP_OK) status = accept_clamped(s);
  if (status == SYMTOP_OK) *held = judge_clamp(s, to_start(s));
  return status;
}

symtop_status symtop_judge_kick(const symtop_start* before, const symtop_start* after,
                                symtop_hold hold, symtop_verdict* verdict) {
  using namespace symtop;
  symtop_status status = admit({before, after, verdict});
  if (status != SYMTOP_OK) return status;
  symtop_start was = *before, now = *after;
  status = find_refusal({accept(was), accept(now), accept_hold_of_kick(hold)});
  if (status != SYMTOP_OK) return status;
  GravityMotion without(to_start(was)), with(to_start(now));
  *verdict = judge_kick(was, now, without, with, is_driven(now), hold);
  return SYMTOP_OK;
}

symtop_status symtop_explain_present(const symtop_start* start, symtop_present* present) {
  using namespace symtop;
  symtop_status status = admit({start, present});
  if (status != SYMTOP_OK) return status;
  symtop_start s = *start;
  status = accept(s);
  if (status != SYMTOP_OK) return status;
  GravityMotion motion(to_start(s));
  *present = PresentFinder(s, motion).find();
  return SYMTOP_OK;
}

symtop_status symtop_find_doubt(const symtop_start* start, double* shows_at) {
  using namespace symtop;
  symtop_status status = admit({start, shows_at});
  if (status != SYMTOP_OK) return status;
  symtop_start s = *start;
  status = accept(s);
  if (status == SYMTOP_OK) *shows_at = is_driven(s) ? INFINITY : find_doubt(to_start(s));
  return status;
}

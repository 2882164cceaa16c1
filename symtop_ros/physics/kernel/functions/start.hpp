// What is known of a start, a kick or a rate without a state at another time.
#pragma once

#include "../rule/hurried.hpp"
#include "../rule/kicks.hpp"
#include "arguments.hpp"

symtop_status symtop_from_angles(const double* angles, const double* rates, size_t count,
                                 double* orientation, double* angular_velocity, size_t* done) {
  *done = 0;
  if (!symtop::is_sound()) return SYMTOP_BAD_ARITHMETIC;
  for (; *done < count; ++*done) {
    const size_t i = *done;
    if (!symtop::are_finite(angles + 3 * i, 3) || !symtop::are_finite(rates + 3 * i, 3))
      return SYMTOP_BAD_ANGLES;
    double* omega = angular_velocity + 3 * i;
    symtop::find_state(angles + 3 * i, rates + 3 * i, orientation + 4 * i, omega);
    if (!symtop::are_at_most(omega, 3, symtop::LARGEST)) return SYMTOP_BAD_ANGULAR_VELOCITY;
  }
  return SYMTOP_OK;
}

symtop_status symtop_find_angles(const double* orientation, size_t count, double* angles) {
  if (!symtop::is_sound()) return SYMTOP_BAD_ARITHMETIC;
  for (size_t i = 0; i < count; i++) symtop::find_angles(orientation + 4 * i, angles + 3 * i);
  return SYMTOP_OK;
}

symtop_status symtop_find_angle_rates(const double* orientation, const double* angular_velocity,
                                      size_t count, double* rates) {
  if (!symtop::is_sound()) return SYMTOP_BAD_ARITHMETIC;
  for (size_t i = 0; i < count; i++)
    symtop::find_angle_rates(orientation + 4 * i, angular_velocity + 3 * i, rates + 3 * i);
  return SYMTOP_OK;
}

symtop_status symtop_find_regular_rates(const symtop_top* tops, const double* thetas,
                                        const double* spins, size_t count, symtop_hold hold,
                                        double* rates) {
  if (!symtop::is_sound()) return SYMTOP_BAD_ARITHMETIC;
  for (size_t i = 0; i < count; i++) {
    if (!symtop::is_top(tops[i].Ix, tops[i].Iz, tops[i].Mgl)) return SYMTOP_BAD_TOP;
    if (!symtop::are_finite(thetas + i, 1) || !symtop::are_finite(spins + i, 1))
      return SYMTOP_BAD_ANGLES;
    symtop::find_regular_rates(tops[i], thetas[i], spins[i], hold, rates + 2 * i);
  }
  return SYMTOP_OK;
}

symtop_status symtop_find_tilt_torques(const symtop_top* tops, const double* thetas,
                                        const double* phi_dots, const double* psi_dots,
                                        size_t count, double* torques) {
  if (!symtop::is_sound()) return SYMTOP_BAD_ARITHMETIC;
  for (size_t i = 0; i < count; i++) {
    if (!symtop::are_finite(thetas + i, 1)) return SYMTOP_BAD_ANGLES;
    symtop::find_tilt_torques(tops[i], thetas[i], phi_dots[i], psi_dots[i], torques + 4 * i);
  }
  return SYMTOP_OK;
}

symtop_status symtop_find_tilt_accelerations(const symtop_start* start, symtop_hold hold,
                                             const double* phi_dots, size_t count,
                                             double* theta_ddots) {
  symtop_start s = *start;
  const symtop_status status = symtop::accept(s);
  if (status != SYMTOP_OK) return status;
  const symtop::Instant now(s);
  if (now.vertical.is_of_vertical_axis()) return SYMTOP_VERTICAL;
  if (!symtop::are_at_most(phi_dots, count, symtop::LARGEST)) return SYMTOP_BAD_KICK;
  const symtop::TiltAcceleration tilt(now, hold);
  for (size_t i = 0; i < count; i++) theta_ddots[i] = tilt.at(phi_dots[i]);
  return SYMTOP_OK;
}

symtop_status symtop_kick(const symtop_top* tops, const double* orientation,
                          const double* angular_velocity, symtop_kick_kind kind, symtop_hold hold,
                          const double* amounts, size_t count, double* kicked, size_t* done) {
  const size_t width = kind == SYMTOP_IMPULSE ? 3 : 1;
  *done = 0;
  if (!symtop::is_sound()) return SYMTOP_BAD_ARITHMETIC;
  for (; *done < count; ++*done) {
    const double *q = orientation + 4 * *done, *amount = amounts + width * *done;
    double* omega = kicked + 3 * *done;
    std::memcpy(omega, angular_velocity + 3 * *done, 3 * sizeof(double));
    if (!symtop::are_finite(amount, width)) return SYMTOP_BAD_KICK;
    if (!symtop::kick(tops[*done], q, kind, hold, amount, omega)) return SYMTOP_VERTICAL;
    if (!symtop::are_at_most(omega, 3, symtop::LARGEST)) return SYMTOP_BAD_KICK;
  }
  return SYMTOP_OK;
}

symtop_status symtop_judge(const symtop_start* starts, const double* factors, size_t count,
                           symtop_hold hold, symtop_verdict* verdicts, size_t* done) {
  for (*done = 0; *done < count; ++*done) {
    symtop_start s = starts[*done];
    const symtop_status status = symtop::accept(s);
    if (status != SYMTOP_OK) return status;
    symtop::GravityMotion motion(symtop::to_start(s));
    if (!symtop::judge(s, motion, factors[*done], hold, verdicts[*done])) return SYMTOP_BAD_KICK;
  }
  return SYMTOP_OK;
}

symtop_status symtop_compare_hurried(const symtop_top* tops, const double* thetas,
                                     const double* phi_dots, const double* psi_dots, size_t count,
                                     double factor, symtop_hold hold, double* angles,
                                     unsigned char* rules) {
  if (!symtop::is_sound()) return SYMTOP_BAD_ARITHMETIC;
  for (size_t i = 0; i < count; i++) {
    if (!symtop::is_top(tops[i].Ix, tops[i].Iz, tops[i].Mgl)) return SYMTOP_BAD_TOP;
    if (!symtop::are_finite(thetas + i, 1)) return SYMTOP_BAD_ANGLES;
    const double rates[] = {phi_dots[i], psi_dots[i], factor * phi_dots[i]};
    if (!symtop::are_at_most(rates, 3, symtop::LARGEST)) return SYMTOP_BAD_KICK;
    rules[i] = static_cast<unsigned char>(symtop::compare_hurried(
        tops[i], thetas[i], phi_dots[i], psi_dots[i], factor, hold, angles + 2 * i));
  }
  return SYMTOP_OK;
}

symtop_status symtop_judge_kick(const symtop_start* before, const symtop_start* after,
                                symtop_hold hold, symtop_verdict* verdict) {
  symtop_start was = *before, now = *after;
  for (symtop_start* each : {&was, &now}) {
    const symtop_status status = symtop::accept(*each);
    if (status != SYMTOP_OK) return status;
  }
  symtop::GravityMotion without(symtop::to_start(was)), with(symtop::to_start(now));
  *verdict = symtop::judge_kick(was, now, without, with, symtop::is_driven(now), hold);
  return SYMTOP_OK;
}

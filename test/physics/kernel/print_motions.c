/* A program that knows the kernel by symtop.h alone: it reads motions from stdin and writes what the
 * kernel says of them to stdout, as doubles and in the order in which they were given. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#ifdef _WIN32
#include <fcntl.h>
#include <io.h>
#endif

#include "symtop.h"

static void read_all(void* to, size_t count) {
  if (fread(to, 8, count, stdin) != count) exit(1);
}

static size_t read_count(void) {
  double number;
  read_all(&number, 1);
  return (size_t)number;
}

static double* allocate(size_t count) {
  double* memory = (double*)malloc(8 * count + 8);
  if (!memory) exit(2);
  return memory;
}

static void demand(symtop_status status) {
  if (status == SYMTOP_OK) return;
  fprintf(stderr, "%s\n", symtop_describe_status(status));
  exit(3);
}

static void write_all(const void* from, size_t count) {
  fwrite(from, sizeof(double), count, stdout);
}

static void write_states(const double* orientation, const double* omega, size_t count) {
  for (size_t i = 0; i < count; i++) {
    write_all(orientation + 4 * i, 4);
    write_all(omega + 3 * i, 3);
  }
}

static void print_constants(symtop_motion* motion) {
  symtop_rates rates;
  double numbers[9];
  symtop_find_rates(motion, &rates);
  numbers[0] = symtop_find_kind(motion);
  symtop_find_turning_angles(motion, numbers + 1);
  numbers[3] = rates.nutation_period;
  numbers[4] = rates.mean_precession_rate;
  numbers[5] = rates.mean_spin_rate;
  numbers[6] = rates.precession_per_nutation;
  numbers[7] = rates.mean_cosine;
  numbers[8] = rates.spin_reverses;
  write_all(numbers, 9);
}

/* The number of times, and the times: at each of them alone, and all of them together. */
static void print_states(symtop_motion* motion) {
  const size_t count = read_count();
  double *times = allocate(count), *orientation = allocate(4 * count), *omega = allocate(3 * count);
  size_t written;
  read_all(times, count);
  for (size_t i = 0; i < count; i++) {
    demand(symtop_state(motion, times[i], orientation, omega));
    write_states(orientation, omega, 1);
  }
  demand(symtop_states(motion, times, count, INFINITY, orientation, omega, &written));
  write_states(orientation, omega, written);
  free(times);
  free(orientation);
  free(omega);
}

/* A clock, the number of stamps, and the stamps. */
static void print_states_of_clock(symtop_motion* motion) {
  symtop_clock clock;
  int64_t* stamps;
  double *orientation, *omega;
  size_t count, written;
  read_all(&clock, 5);
  count = read_count();
  stamps = (int64_t*)allocate(count);
  orientation = allocate(4 * count);
  omega = allocate(3 * count);
  read_all(stamps, count);
  demand(symtop_states_of_clock(motion, &clock, stamps, count, INFINITY, orientation, omega,
                                &written));
  write_states(orientation, omega, written);
  free(stamps);
  free(orientation);
  free(omega);
}

/* A time and a torque: the state as long after the torque has changed. */
static void print_continued(symtop_motion* motion) {
  double numbers[4], orientation[4], omega[3];
  symtop_motion* continued;
  read_all(numbers, 4);
  demand(symtop_continue(motion, numbers[0], numbers + 1, &continued));
  demand(symtop_state(continued, numbers[0], orientation, omega));
  write_states(orientation, omega, 1);
  symtop_free(continued);
}

static void print_verdict(const symtop_verdict* v) {
  const symtop_reason* r = &v->reason;
  const symtop_cause* c = &v->cause;
  /* clang-format off: not one number a line */
  const double numbers[] = {v->subject,
                            v->direction,
                            v->turning_angles[0],
                            v->turning_angles[1],
                            v->motion,
                            r->kind,
                            r->rule,
                            r->before,
                            r->after,
                            r->theta_ddot_without,
                            r->theta_ddot,
                            r->effect,
                            r->place.kind,
                            r->place.rate,
                            r->place.regular_rates[0],
                            r->place.regular_rates[1],
                            v->average.rate,
                            v->average.precession_period,
                            v->average.turns,
                            v->average.fast_top_rate,
                            v->average.is_fast,
                            v->average.spin_reverses,
                            c->explanation,
                            c->turn,
                            c->pace,
                            c->torque_share,
                            c->rate_about_momentum,
                            c->torque_from_perpendicular[0],
                            c->torque_from_perpendicular[1],
                            c->momentum_from_axle[0],
                            c->momentum_from_axle[1],
                            c->momentum_from_axle[2],
                            c->omega_from_axle[0],
                            c->omega_from_axle[1],
                            c->omega_from_axle[2],
                            c->momentum_from_vertical[0],
                            c->momentum_from_vertical[1],
                            c->momentum_from_vertical[2],
                            c->constant,
                            v->factor,
                            v->means.sense,
                            v->means.height,
                            v->means.rates[0],
                            v->means.rates[1],
                            v->means.cosines[0],
                            v->means.cosines[1],
                            v->disturbed_to,
                            v->highest.kind,
                            v->highest.amount,
                            v->lowest.kind,
                            v->lowest.amount};
  /* clang-format on */
  write_all(numbers, sizeof numbers / sizeof numbers[0]);
}

/* The start from its angles, its regular rates and verdicts by both holds, and on a kick. */
static void print_verdicts(const symtop_start* start) {
  const symtop_top top = {start->Ix, start->Iz, start->Mgl};
  const double factor = 1.4;
  double angles[3], rates[3], q[4], omega[3], found[2];
  size_t done;
  demand(symtop_find_angles(start->orientation, 1, angles));
  demand(symtop_find_angle_rates(start->orientation, start->angular_velocity, 1, rates));
  demand(symtop_from_angles(angles, rates, 1, q, omega, &done));
  write_all(angles, 3);
  write_all(rates, 3);
  write_states(q, omega, 1);
  for (int hold = SYMTOP_SPIN_RATE; hold <= SYMTOP_SPIN_MOMENTUM; hold++) {
    symtop_start after = *start;
    symtop_verdict verdicts[2] = {0};
    demand(symtop_find_regular_rates(&top, angles + 1, rates + 2, 1, (symtop_hold)hold, found));
    write_all(found, 2);
    if (symtop_kick(&top, start->orientation, start->angular_velocity, SYMTOP_FACTOR_OF_RATE,
                    (symtop_hold)hold, &factor, 1, after.angular_velocity,
                    &done) == SYMTOP_VERTICAL)
      continue;
    write_all(after.angular_velocity, 3);
    demand(symtop_judge(start, &factor, 1, (symtop_hold)hold, verdicts, &done));
    demand(symtop_judge_kick(start, &after, (symtop_hold)hold, verdicts + 1));
    for (int k = 0; k < 2; k++) print_verdict(verdicts + k);
  }
}

int main(void) {
#ifdef _WIN32 /* where a stream is one of lines */
  _setmode(0, _O_BINARY);
  _setmode(1, _O_BINARY);
#endif
  for (size_t count = read_count(); count > 0; count--) {
    symtop_start start;
    symtop_motion* motion;
    read_all(&start, sizeof start / sizeof(double));
    demand(symtop_new(&start, &motion));
    print_constants(motion);
    print_verdicts(&start);
    print_states(motion);
    print_states_of_clock(motion);
    if (read_count()) print_continued(motion);
    symtop_free(motion);
  }
  return 0;
}

/* Calls of every function of symtop.h with whatever a caller may pass: bits at random, extremes, and
 * ordinary numbers among them. What is not refused is answered; nothing may crash or hang. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "symtop.h"

#define TIMES 6

static const double ODD[] = {0.0,    -0.0,   1.0,    -1.0,   NAN,   INFINITY, -INFINITY, 5e-324,
                             1e-300, 1e300,  1e-100, 1e100,  0.5,   2.0,      1e-8,      1e-16,
                             1e9,    -1e17,  1e30,   0x1p63, 1e-9,  3.0,      0.1,       1e-200};

static uint64_t state;

static uint64_t draw(void) { /* xorshift64* */
  state ^= state >> 12, state ^= state << 25, state ^= state >> 27;
  return state * 2685821657736338717u;
}

static double draw_unit(void) { return (double)(draw() >> 11) * 0x1p-53; }

static double draw_bits(void) {
  const uint64_t bits = draw();
  double number;
  memcpy(&number, &bits, sizeof number);
  return number;
}

/* One of `oddness` numbers is odd, the others lie about `usual`. */
static double draw_number(double usual, int oddness) {
  if (draw() % oddness) return usual * (draw_unit() - (draw() % 4 ? 0 : 0.5));
  return draw() % 2 ? ODD[draw() % (sizeof ODD / sizeof ODD[0])] : draw_bits();
}

static void draw_start(symtop_start* start, int oddness) {
  double norm = 0.0;
  start->Ix = draw_number(1.0, oddness), start->Iz = draw_number(1.0, oddness);
  start->Mgl = draw_number(100.0, oddness);
  for (int k = 0; k < 4; k++) {
    start->orientation[k] = draw_number(1.0, oddness);
    norm += start->orientation[k] * start->orientation[k];
  }
  for (int k = 0; k < 4; k++) start->orientation[k] /= sqrt(norm);
  for (int k = 0; k < 3; k++) start->angular_velocity[k] = draw_number(100.0, oddness);
  for (int k = 0; k < 2; k++)
    start->friction[k] = draw() % 3 ? 0.0 : fabs(draw_number(0.1, oddness));
  for (int k = 0; k < 3; k++) start->torque[k] = draw() % 3 ? 0.0 : draw_number(1.0, oddness);
}

/* The status of every call is a sentence, and no more states are written than were asked for. */
static void check(symtop_status status, size_t written) {
  if (symtop_describe_status(status)[0] && written <= TIMES) return;
  fprintf(stderr, "status %d, %zu states\n", (int)status, written);
  exit(1);
}

/* The count is read after the call. */
#define CHECK(call, written)             \
  do {                                   \
    const symtop_status found_ = (call); \
    check(found_, written);              \
  } while (0)

static void call_all(symtop_motion* motion, int oddness) {
  double times[TIMES], orientation[4 * TIMES], omega[3 * TIMES], angles[2], reached, torque[3];
  int64_t stamps[TIMES];
  symtop_clock clock;
  symtop_rates rates;
  symtop_motion* continued = NULL;
  size_t written = 0;
  for (int i = 0; i < TIMES; i++) {
    times[i] = draw_number(10.0, oddness);
    stamps[i] = (int64_t)(draw() % 3 ? draw() >> 30 : draw());
  }
  clock.factor = draw_number(1.0, oddness);
  for (int k = 0; k < 4; k++) clock.elapsed[k] = draw() % 2 ? 0.0 : draw_number(1e9, oddness);
  for (int k = 0; k < 3; k++) torque[k] = draw_number(1.0, oddness);
  CHECK(symtop_states(motion, times, TIMES, 40, orientation, omega, &written), written);
  CHECK(symtop_states_of_clock(motion, &clock, stamps, TIMES, 40, orientation, omega, &written),
        written);
  CHECK(symtop_reach(motion, times[0], 40, &reached), 0);
  CHECK(symtop_state(motion, reached, orientation, omega), 0);
  CHECK(symtop_continue(motion, reached, torque, &continued), 0);
  if (continued)
    CHECK(symtop_states(continued, times, TIMES, 40, orientation, omega, &written), written);
  symtop_free(continued);
  if ((unsigned)symtop_find_kind(motion) > SYMTOP_DRIVEN) exit(1);
  if ((unsigned)symtop_find_engine(motion) > SYMTOP_TAYLOR) exit(1);
  symtop_find_nutation_rate(motion, angles);
  symtop_find_farthest_time(motion, &reached);
  symtop_find_turning_angles(motion, angles);
  symtop_find_rates(motion, &rates);
}

/* What is known of a start: the same numbers go to every function, refused by some of them. */
static void ask_of_start(const symtop_start* start, int oddness) {
  const symtop_top top = {start->Ix, start->Iz, start->Mgl};
  const symtop_hold hold = (symtop_hold)(draw() % 3);
  double angles[3], rates[3], q[4], omega[3], kicked[3], found[4], amounts[3], time = 1.0;
  size_t done;
  uint8_t left = 0;
  symtop_start after = *start;
  symtop_verdict verdict;
  symtop_constants constants;
  for (int k = 0; k < 3; k++) {
    angles[k] = draw_number(10.0, oddness), rates[k] = draw_number(100.0, oddness);
    amounts[k] = draw_number(2.0, oddness);
  }
  CHECK(symtop_from_angles(angles, rates, 1, q, omega, &done), done);
  CHECK(symtop_find_angles(start->orientation, 1, angles), 0);
  CHECK(symtop_find_angle_rates(start->orientation, start->angular_velocity, 1, rates), 0);
  CHECK(symtop_find_regular_rates(&top, amounts, rates, 1, hold, found), 0);
  CHECK(symtop_find_disc(&top, amounts[0], found), 0);
  symtop_top disc_top;
  CHECK(symtop_find_disc_top(amounts, amounts[1], &disc_top), 0);
  CHECK(symtop_find_tilt_torques(&top, amounts, rates, rates + 1, 1, found), 0);
  CHECK(symtop_find_tilt_accelerations(start, hold, rates, 3, found), 0);
  CHECK(symtop_compare_hurried(&top, amounts, rates, rates + 1, 1, amounts[1], hold, found, &left),
        0);
  if (left > SYMTOP_RULE_FAILS) exit(1);
  CHECK(symtop_kick(&top, start->orientation, start->angular_velocity,
                    (symtop_kick_kind)(draw() % 5), hold, amounts, 1, kicked, &done), done);
  CHECK(symtop_judge(start, amounts, 1, hold, &verdict, &done), done);
  memcpy(after.angular_velocity, kicked, sizeof kicked);
  CHECK(symtop_judge_kick(start, &after, hold, &verdict), 0);
  CHECK(symtop_describe_many(start, 1, &constants, &done), done);
  if (symtop_describe_many(start, 0, NULL, &done) || done) exit(1);
  after = *start;
  memset(after.friction, 0, sizeof after.friction), memset(after.torque, 0, sizeof after.torque);
  CHECK(symtop_states_of_many(&after, 1, &time, 1, q, omega, &left), left);
}

/* Arguments: the first seed, and the number of motions. Prints how many were made. */
int main(int count, char** words) {
  const long first = count > 1 ? atol(words[1]) : 1, number = count > 2 ? atol(words[2]) : 1000;
  long made = 0;
  for (long seed = first; seed < first + number; seed++) {
    symtop_start start;
    symtop_motion* motion;
    const int oddness = seed % 2 ? 3 : 30;
    state = (uint64_t)seed * 0x9e3779b97f4a7c15u | 1;
    for (int i = 0; i < 8; i++) draw();
    draw_start(&start, oddness);
    ask_of_start(&start, oddness);
    CHECK(symtop_new(&start, &motion), 0);
    if (!motion) continue;
    made++;
    call_all(motion, oddness);
    symtop_free(motion);
  }
  symtop_free(NULL);
  printf("%ld of %ld motions made\n", made, number);
  return 0;
}

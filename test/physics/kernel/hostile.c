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
  check(symtop_states(motion, times, TIMES, 40, orientation, omega, &written), written);
  check(symtop_states_of_clock(motion, &clock, stamps, TIMES, 40, orientation, omega, &written),
        written);
  check(symtop_reach(motion, times[0], 40, &reached), 0);
  check(symtop_state(motion, reached, orientation, omega), 0);
  check(symtop_continue(motion, reached, torque, &continued), 0);
  if (continued)
    check(symtop_states(continued, times, TIMES, 40, orientation, omega, &written), written);
  symtop_free(continued);
  if ((unsigned)symtop_find_kind(motion) > SYMTOP_DRIVEN) exit(1);
  symtop_find_turning_angles(motion, angles);
  symtop_find_rates(motion, &rates);
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
    check(symtop_new(&start, &motion), 0);
    if (!motion) continue;
    made++;
    call_all(motion, oddness);
    symtop_free(motion);
  }
  symtop_free(NULL);
  printf("%ld of %ld motions made\n", made, number);
  return 0;
}

/* Calls the functions of symtop.h in a thread with another rounding, and prints their statuses. The
 * argument is "usual", "upward", "downward", "towards zero", "flushed" (results below the normal
 * numbers become zero) or "zeros" (arguments below them count as zero). */
#include <fenv.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "symtop.h"

static void set_state(const char* name) {
  if (!strcmp(name, "upward")) fesetround(FE_UPWARD);
  if (!strcmp(name, "downward")) fesetround(FE_DOWNWARD);
  if (!strcmp(name, "towards zero")) fesetround(FE_TOWARDZERO);
#ifdef __SSE2__
  if (!strcmp(name, "flushed")) _mm_setcsr(_mm_getcsr() | 0x8000);
  if (!strcmp(name, "zeros")) _mm_setcsr(_mm_getcsr() | 0x0040);
#endif
}

/* No number is written by a call that is refused. */
static void show(symtop_status status, const double* numbers, int count) {
  printf("%d\n", (int)status);
  for (int k = 0; k < count; k++)
    if (status != SYMTOP_OK && numbers[k] != -7.0) exit(1);
}

static void clear(double* numbers, int count) {
  for (int k = 0; k < count; k++) numbers[k] = -7.0;
}

int main(int count, char** words) {
  const symtop_start start = {0.000228, 0.0000572, 0.068, {0.8, 0.6, 0, 0}, {0, 0, 200}, {0}, {0}};
  const symtop_top top = {0.000228, 0.0000572, 0.068};
  const double angles[3] = {0, 0.5, 0}, rates[3] = {1, 0, 200}, factor = 1.4;
  symtop_motion *motion = NULL, *refused = NULL;
  const symtop_pushes pushes = {1e-5, 20.0, 3.0};
  const symtop_clock clock = {1.0, {0}};
  symtop_piece piece = {{0}, -7.0, -7.0};
  symtop_verdict verdict;
  symtop_rates found = {-7.0, -7.0, -7.0, -7.0, -7.0, 0};
  double q[4], omega[3], few[4];
  size_t done;
  unsigned char rule;
  if (count < 2) return 2;
  const symtop_status first = symtop_new(&start, &motion);
  set_state(words[1]);
  clear(q, 4);
  clear(omega, 3);
  clear(few, 4);
  if (motion) { /* it was made before; nothing is computed of it now */
    show(symtop_state(motion, 0.3, q, omega), q, 4);
    show(symtop_states(motion, rates, 1, INFINITY, q, omega, &done), q, 4);
    show(symtop_find_turning_angles(motion, q), q, 2);
    show(symtop_find_nutation_rate(motion, q), q, 2);
    show(symtop_find_farthest_time(motion, q), q, 1);
    show(symtop_reach(motion, 1.0, 100.0, q), q, 1);
    show(symtop_find_piece(motion, &clock, 1, 100.0, &piece), &piece.begin, 1);
    const symtop_status last = symtop_find_rates(motion, &found);
    show(last, &found.mean_spin_rate, 1);
    if ((symtop_find_kind(motion) == SYMTOP_UNKNOWN_KIND) != (last != SYMTOP_OK)) return 3;
  } else {
    show(first, q, 4);
  }
  show(symtop_new(&start, &refused), q, 0);
  symtop_free(refused);
  show(symtop_new_pushed(&start, &pushes, &refused), q, 0);
  symtop_free(refused);
  show(symtop_new_coarse(&start, 1e-9, &refused), q, 0);
  symtop_free(refused);
  show(symtop_new_clamped(&start, &refused), q, 0);
  symtop_held held;
  show(symtop_judge_clamp(&start, &held), q, 0);
  clear(q, 4);
  clear(omega, 3);
  show(symtop_from_angles(angles, rates, 1, q, omega, &done), q, 4);
  show(symtop_find_angles(start.orientation, 1, few), few, 3);
  show(symtop_find_regular_rates(&top, angles + 1, rates + 2, 1, SYMTOP_SPIN_RATE, few), q, 0);
  show(symtop_find_disc(&top, 9.81, few), q, 0);
  const symtop_part_of_body part = {1.0, 0.5, 0.25};
  const symtop_part_kind kind = SYMTOP_DISC;
  symtop_body body = {1.0, 0.25, 0.0625, 0.125};
  symtop_top made;
  symtop_solutions solutions;
  show(symtop_find_body(&kind, &part, 1, &body, &done), q, 0);
  show(symtop_find_body_top(&body, 9.81, &made), q, 0);
  show(symtop_solve_start(&top, SYMTOP_TILT_AND_SPIN, angles, &solutions), q, 0);
  symtop_spreads spreads;
  show(symtop_find_spreads(&top, SYMTOP_TILT_AND_SPIN, angles, rates, &spreads), q, 0);
  show(symtop_find_doubt(&start, few), q, 0);
  symtop_present present;
  show(symtop_explain_present(&start, &present), q, 0);
  double two[8], turning[6];
  for (int k = 0; k < 8; k++) two[k] = start.orientation[k % 4];
  for (int k = 0; k < 6; k++) turning[k] = rates[k % 3];
  symtop_exchange exchange;
  show(symtop_find_exchange(&top, two, turning, &exchange), q, 0);
  show(symtop_find_tilt_torques(&top, angles + 1, rates, rates + 2, 1, few), q, 0);
  show(symtop_compare_hurried(&top, angles + 1, rates, rates + 2, 1, 1.5, SYMTOP_SPIN_RATE, few,
                              &rule),
       q, 0);
  show(symtop_kick(&top, start.orientation, rates, SYMTOP_FACTOR_OF_RATE, SYMTOP_SPIN_RATE, &factor,
                   1, omega, &done),
       q, 0);
  show(symtop_judge(&start, &factor, 1, SYMTOP_SPIN_RATE, &verdict, &done), q, 0);
  show(symtop_judge_kick(&start, &start, SYMTOP_SPIN_RATE, &verdict), q, 0);
  symtop_free(refused);
  symtop_free(motion);
  return 0;
}

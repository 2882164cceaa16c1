/* Threads that share two motions, one of them driven: each reads states in another order, and all
 * get the same bits. */
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "symtop.h"

enum { THREADS = 4, TIMES = 400 };

static symtop_motion* motions[2];
static double found[THREADS][2][TIMES][7];

static void* read_all(void* number) {
  const size_t thread = *(const size_t*)number;
  for (size_t k = 0; k < TIMES; k++) {
    const size_t place = (k * 7 + thread * 100) % TIMES; /* forwards and back */
    const double t = 0.01 * (double)place - 1.0;
    for (int which = 0; which < 2; which++) {
      double* to = found[thread][which][place];
      symtop_rates rates;
      if (symtop_state(motions[which], t, to, to + 4) != SYMTOP_OK) return number;
      symtop_find_rates(motions[which], &rates);
    }
  }
  return NULL;
}

int main(void) {
  symtop_start start = {0.000228,          0.0000572,  0.068,          {0.96875, 0.25, 0.0, 0.0},
                        {0.0, 0.0, 200.0}, {0.0, 0.0}, {0.0, 0.0, 0.0}};
  pthread_t threads[THREADS];
  size_t numbers[THREADS];
  int failed = 0;
  if (symtop_new(&start, &motions[0]) != SYMTOP_OK) return 1;
  start.friction[0] = 1e-6;
  if (symtop_new(&start, &motions[1]) != SYMTOP_OK) return 1;
  for (size_t n = 0; n < THREADS; n++) {
    numbers[n] = n;
    if (pthread_create(&threads[n], NULL, read_all, &numbers[n])) return 2;
  }
  for (size_t n = 0; n < THREADS; n++) {
    void* result;
    pthread_join(threads[n], &result);
    failed |= result != NULL || memcmp(found[n], found[0], sizeof found[0]);
  }
  symtop_free(motions[0]), symtop_free(motions[1]);
  return failed;
}

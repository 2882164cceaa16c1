/* Calls of every function of symtop.h with whatever a caller may pass: bits at random, extremes, norms,
 * numbers that are no enum, null pointers and buffers that overlap, and ordinary arguments among them.
 * Of each argument it is known here, by the words of the header alone, whether it is allowed. What is
 * not must be refused, with a status that has a sentence, and leave what is written as it was; what is
 * answered must be finite, but where the header says NaN. Nothing may crash or hang.
 *
 * A module of WebAssembly has no `main`: it exports `run`, and `digest` of what all calls answered. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "symtop.h"

enum { MOST = 3, WORDS = 4096, STEPS = 40 };

static const double ODD[] = {0.0,    -0.0,  1.0,    -1.0,   NAN,  INFINITY, -INFINITY, 5e-324,
                             1e-300, 1e300, 1e-100, 1e100,  0.5,  2.0,      1e-8,      1e-16,
                             1e9,    -1e17, 1e30,   0x1p63, 1e-9, 3.0,      0.1,       1e-200};
static const double UNTOUCHED = -7.25;

/* ---- Numbers ---- */

static uint64_t state;

static uint64_t draw(void) { /* xorshift64* */
  state ^= state >> 12;
  state ^= state << 25;
  state ^= state >> 27;
  return state * 2685821657736338717u;
}

static int is_rare(unsigned one_in) { return draw() % one_in == 0; }
static double draw_unit(void) { return (double)(draw() >> 11) * 0x1p-53; }

static double draw_bits(void) {
  const uint64_t bits = draw();
  double number;
  memcpy(&number, &bits, sizeof number);
  return number;
}

static unsigned oddness; /* one number in so many is odd */

static double draw_number(double usual) {
  if (!is_rare(oddness)) return usual * (draw_unit() - (is_rare(4) ? 0.5 : 0.0));
  return is_rare(2) ? ODD[draw() % (sizeof ODD / sizeof ODD[0])] : draw_bits();
}

/* An enum of `count` values, or a number that is none. */
static int draw_enum(int count) {
  return is_rare(8) ? (int)(draw() % 9) - 2 : (int)(draw() % (unsigned)count);
}

/* ---- Buffers ---- */

typedef union {
  double number;
  uint64_t bits;
} word;

static word arena[WORDS];
static size_t used;
static int has_null, has_overlap; /* of the call that is prepared */
static void* last;

static void prepare(void) {
  used = 0;
  has_null = has_overlap = 0;
  last = NULL;
}

/* Room for so many words; or null, or the room of another argument, if `is_hostile`. */
static void* take(size_t words, int is_hostile) {
  word* room = arena + used;
  used += words + 1;
  if (used > WORDS) abort();
  for (size_t k = 0; k <= words; k++) room[k].number = UNTOUCHED;
  if (is_hostile && is_rare(40)) return has_null = 1, NULL;
  if (is_hostile && last && is_rare(40)) return has_overlap = 1, (word*)last + draw() % 2;
  return last = room;
}

static double* take_room(size_t words) { return (double*)take(words, 1); }

static double* take_numbers(size_t count, double usual) {
  double* room = (double*)take(count, 1);
  for (size_t k = 0; room && k < count; k++) room[k] = draw_number(usual);
  return room;
}

static int is_untouched(const double* room, size_t count) {
  for (size_t k = 0; room && k < count; k++)
    if (memcmp(room + k, &UNTOUCHED, sizeof UNTOUCHED)) return 0;
  return 1;
}

/* ---- What the header allows ---- */

static int are_within(const double* numbers, size_t count, double most) {
  for (size_t k = 0; k < count; k++)
    if (!(fabs(numbers[k]) <= most)) return 0;
  return 1;
}

static int are_finite(const double* numbers, size_t count) {
  return are_within(numbers, count, DBL_MAX);
}

static int is_hold(int hold) { return hold == SYMTOP_SPIN_RATE || hold == SYMTOP_SPIN_MOMENTUM; }

static int is_top(const symtop_top* top) {
  return top->Ix >= 1e-100 && top->Ix <= 1e100 && top->Iz >= 1e-100 && top->Iz <= 2 * top->Ix &&
         top->Iz <= 1e100 && fabs(top->Mgl) <= 1e100;
}

static int is_unit(const double q[4]) {
  return fabs(sqrt((q[0] * q[0] + q[3] * q[3]) + (q[1] * q[1] + q[2] * q[2])) - 1) <= 1e-3;
}

static int is_start(const symtop_start* s) {
  const symtop_top top = {s->Ix, s->Iz, s->Mgl};
  return is_top(&top) && is_unit(s->orientation) && are_within(s->angular_velocity, 3, 1e100) &&
         are_finite(s->friction, 2) && s->friction[0] >= 0 && s->friction[1] >= 0 &&
         are_finite(s->torque, 3);
}

/* ---- What a call answered ---- */

static uint64_t hash;
static long calls, answered;
static int fault; /* the line of the first call that was not as promised */

static void add_to_hash(uint64_t bits) { hash = (hash ^ bits) * 1099511628211u; }

static void add_numbers(const double* numbers, size_t count) {
  for (size_t k = 0; k < count; k++) {
    uint64_t bits;
    memcpy(&bits, numbers + k, sizeof bits);
    add_to_hash(isnan(numbers[k]) ? 1 : bits); /* the sign of a NaN is that of the processor */
  }
}

/* Whether the status fits: `is_allowed` says that all arguments are. */
static int judge(symtop_status status, int is_allowed, int line) {
  const int has_sentence =
      strcmp(symtop_describe_status(status), symtop_describe_status((symtop_status)99)) != 0;
  const int is_bad_argument = status == SYMTOP_BAD_POINTER || status == SYMTOP_BAD_COUNT ||
                              status == SYMTOP_BAD_HOLD || status == SYMTOP_BAD_KICK_KIND ||
                              status == SYMTOP_BAD_TOP || status == SYMTOP_BAD_ORIENTATION ||
                              status == SYMTOP_BAD_STEPS || status == SYMTOP_BAD_RATE ||
                              status == SYMTOP_BAD_ARITHMETIC || status == SYMTOP_BAD_TORQUE ||
                              status == SYMTOP_BAD_FRICTION || status == SYMTOP_BAD_PUSHES;
  calls++;
  answered += status == SYMTOP_OK;
  /* Of buffers that overlap nothing is promised but that the call ends: a count that is written to
     one of them has another length elsewhere. */
  if (!has_overlap) add_to_hash((uint64_t)status);
  if (!has_overlap &&
      (!has_sentence || (status == SYMTOP_OK && !is_allowed) || (is_allowed && is_bad_argument)))
    fault = fault ? fault : line;
  return status == SYMTOP_OK && !has_overlap;
}

/* What a call may write: as it was after a refusal, finite after an answer. */
static void check_room(symtop_status status, const double* room, size_t count, int may_be_nan,
                       int line) {
  if (has_overlap || !room) return;
  if (status == SYMTOP_OK) add_numbers(room, count);
  if (status == SYMTOP_OK ? !may_be_nan && !are_finite(room, count) : !is_untouched(room, count))
    fault = fault ? fault : line;
}

/* ---- Arguments ---- */

static double* take_orientations(size_t count, int* are_allowed) {
  double* room = (double*)take(4 * count, 1);
  for (size_t i = 0; room && i < count; i++) {
    double* q = room + 4 * i;
    double norm = 0.0;
    for (int k = 0; k < 4; k++) {
      q[k] = draw_number(1.0);
      norm += q[k] * q[k];
    }
    /* of norm 1 to rounding, or nearly, or hardly */
    const double wanted = is_rare(3) ? 1 + 4e-3 * (draw_unit() - 0.5) : 1.0;
    if (!is_rare(10))
      for (int k = 0; k < 4; k++) q[k] *= wanted / sqrt(norm);
    if (is_rare(10))
      memset(q + 1, 0, 2 * sizeof q[0]); /* seldom of norm 1 then, or on the vertical */
    *are_allowed &= is_unit(q);
  }
  return room;
}

static double* take_omegas(size_t count, int* are_allowed) {
  double* room = take_numbers(3 * count, 100.0);
  if (room) *are_allowed &= are_within(room, 3 * count, 1e100);
  return room;
}

static symtop_top draw_top(void) {
  symtop_top top;
  top.Ix = draw_number(1.0);
  top.Iz = draw_number(1.0);
  top.Mgl = draw_number(100.0);
  return top;
}

static symtop_top* take_tops(size_t count, int* are_allowed) {
  symtop_top* room = (symtop_top*)take(3 * count, 1);
  for (size_t i = 0; room && i < count; i++) {
    room[i] = draw_top();
    *are_allowed &= is_top(room + i);
  }
  return room;
}

static void draw_start(symtop_start* start) {
  double norm = 0.0;
  const symtop_top top = draw_top();
  start->Ix = top.Ix;
  start->Iz = top.Iz;
  start->Mgl = top.Mgl;
  for (int k = 0; k < 4; k++) {
    start->orientation[k] = draw_number(1.0);
    norm += start->orientation[k] * start->orientation[k];
  }
  const double wanted = is_rare(3) ? 1 + 4e-3 * (draw_unit() - 0.5) : 1.0;
  for (int k = 0; k < 4; k++) start->orientation[k] *= wanted / sqrt(norm);
  for (int k = 0; k < 3; k++) start->angular_velocity[k] = draw_number(100.0);
  for (int k = 0; k < 2; k++) start->friction[k] = is_rare(3) ? fabs(draw_number(0.1)) : 0.0;
  for (int k = 0; k < 3; k++) start->torque[k] = is_rare(3) ? draw_number(1.0) : 0.0;
}

/* `is_free` leaves friction and torque out: integrations may take a minute each. */
static symtop_start* take_starts(size_t count, int is_free, int* are_allowed) {
  symtop_start* room = (symtop_start*)take(15 * count, 1);
  for (size_t i = 0; room && i < count; i++) {
    draw_start(room + i);
    if (is_free) memset(room[i].friction, 0, sizeof room[i].friction + sizeof room[i].torque);
    *are_allowed &= is_start(room + i);
  }
  return room;
}

/* How many elements: few, none, or so many that no memory has them. */
static size_t draw_count(int* is_allowed) {
  if (!is_rare(20)) return draw() % (MOST + 1);
  *is_allowed = 0;
  return (size_t)-1 >> draw() % 2;
}

/* For arrays of more elements than there can be, room for some is enough. */
static size_t bound(size_t count) { return count < MOST ? count : MOST; }

static size_t* take_done(void) { return (size_t*)take(1, 1); }

/* Null arrays are allowed if they have no elements. */
static int allow(int are_allowed, size_t count, const size_t* done) {
  return count ? are_allowed && !has_null : done != NULL;
}

#define CHECK(status, is_allowed) judge(status, is_allowed, __LINE__)
#define ROOM(status, room, count) check_room(status, room, count, 0, __LINE__)
#define ROOM_OR_NAN(status, room, count) check_room(status, room, count, 1, __LINE__)

/* ---- Functions that know no motion ---- */

static void try_angles(void) {
  int good = 1;
  prepare();
  const size_t count = draw_count(&good), n = bound(count);
  double *angles = take_numbers(3 * n, 10.0), *rates = take_numbers(3 * n, 100.0);
  double *q = take_room(4 * n), *omega = take_room(3 * n);
  size_t* done = take_done();
  if (angles && rates) good &= are_finite(angles, 3 * n) && are_finite(rates, 3 * n);
  const symtop_status status = symtop_from_angles(angles, rates, count, q, omega, done);
  if (CHECK(status, allow(good, count, done) && done)) {
    ROOM(status, q, 4 * n);
    ROOM(status, omega, 3 * n);
  }
}

static void try_orientations(void) {
  int good = 1;
  prepare();
  const size_t count = draw_count(&good), n = bound(count);
  double *q = take_orientations(n, &good), *room = take_room(3 * n);
  symtop_status status = symtop_find_angles(q, count, room);
  CHECK(status, allow(good, count, &count));
  if (n < 2) ROOM(status, room, 3 * n);
  good = 1;
  prepare();
  q = take_orientations(n, &good);
  double* omega = take_omegas(n, &good);
  room = take_room(3 * n);
  good &= count == n;
  status = symtop_find_angle_rates(q, omega, count, room);
  CHECK(status, allow(good, count, &count));
  if (n < 2) ROOM(status, room, 3 * n);
  good = count == n;
  prepare();
  q = take_orientations(n, &good);
  omega = take_omegas(n, &good);
  double* unit = take_room(4 * n);
  room = take_room(3 * n);
  status = symtop_normalize(q, omega, count, unit, room);
  CHECK(status, allow(good, count, &count));
  if (n < 2) {
    ROOM(status, unit, 4 * n);
    ROOM(status, room, 3 * n);
  }
}

static void try_regular_rates(void) {
  int good = 1;
  const int hold = draw_enum(2);
  prepare();
  const size_t count = draw_count(&good), n = bound(count);
  symtop_top* tops = take_tops(n, &good);
  double *thetas = take_numbers(n, 3.0), *spins = take_numbers(n, 300.0), *room = take_room(2 * n);
  if (thetas && spins) good &= are_finite(thetas, n) && are_finite(spins, n);
  const symtop_status status =
      symtop_find_regular_rates(tops, thetas, spins, count, (symtop_hold)hold, room);
  CHECK(status, count ? allow(good, count, &count) && is_hold(hold) : 1);
  if (n < 2) ROOM_OR_NAN(status, room, 2 * n);
}

static void try_tilts(void) {
  int good = 1;
  const int hold = draw_enum(2);
  prepare();
  const size_t count = draw_count(&good), n = bound(count);
  symtop_top* tops = take_tops(n, &good);
  double *thetas = take_numbers(n, 3.0), *phi_dots = take_numbers(n, 300.0);
  double *psi_dots = take_numbers(n, 300.0), *torques = take_room(4 * n);
  if (thetas && phi_dots && psi_dots)
    good &=
        are_finite(thetas, n) && are_within(phi_dots, n, 1e100) && are_within(psi_dots, n, 1e100);
  symtop_status status = symtop_find_tilt_torques(tops, thetas, phi_dots, psi_dots, count, torques);
  CHECK(status, allow(good, count, &count));
  if (n < 2) ROOM(status, torques, 4 * n);
  good = count == n;
  prepare();
  symtop_start* start = take_starts(1, 0, &good);
  phi_dots = take_numbers(n, 300.0);
  double* found = take_room(n);
  status = symtop_find_tilt_accelerations(start, (symtop_hold)hold, phi_dots, count, found);
  CHECK(status, start && good && is_hold(hold) && (!count || !has_null));
  ROOM(status, found, n);
}

static void try_discs(void) {
  int good = 1;
  double gravity = draw_number(10.0);
  prepare();
  symtop_top* top = take_tops(1, &good);
  double* disc = take_room(3);
  symtop_status status = symtop_find_disc(top, gravity, disc);
  CHECK(status, good && !has_null && isfinite(gravity));
  ROOM_OR_NAN(status, disc, 3);
}

static void try_exchange(void) {
  int good = 1;
  prepare();
  symtop_top* top = take_tops(1, &good);
  double* q = take_orientations(2, &good);
  double* omega = take_omegas(2, &good);
  double* room = take_room(sizeof(symtop_exchange) / sizeof(double));
  symtop_exchange* exchange = (symtop_exchange*)(void*)room;
  symtop_status status = symtop_find_exchange(top, q, omega, exchange);
  CHECK(status, good && !has_null);
  ROOM(status, room, sizeof *exchange / sizeof(double));
}

static int is_part(int kind, const double* part) {
  return kind >= SYMTOP_POINT && kind <= SYMTOP_BALL && part[0] > 0 && isfinite(part[0]) &&
         isfinite(part[2]) && (kind == SYMTOP_POINT || (part[1] > 0 && isfinite(part[1])));
}

static void try_bodies(void) {
  int good = 1;
  double gravity = draw_number(10.0);
  prepare();
  const size_t count = draw_count(&good), n = bound(count);
  double* parts = take_numbers(3 * n, 1.0);
  double* room = take_room(4);
  size_t* done = take_done();
  symtop_part_kind kinds[MOST];
  for (size_t k = 0; k < n; k++) {
    kinds[k] = (symtop_part_kind)draw_enum(5);
    if (parts) good &= is_part((int)kinds[k], parts + 3 * k);
  }
  symtop_body* body = (symtop_body*)(void*)room;
  symtop_status status =
      symtop_find_body(kinds, (const symtop_part_of_body*)(void*)parts, count, body, done);
  CHECK(status, good && n && !has_null);
  if (status != SYMTOP_OK || has_overlap) return;
  symtop_top top;
  status = symtop_find_body_top(body, gravity, &top);
  /* the top that is found may be none */
  if (status == SYMTOP_OK) CHECK(status, is_top(&top) && isfinite(gravity));
}

static void check_solution(const symtop_solution* each) {
  const double *x = &each->theta, pi = 3.141592653589793;
  if (!(x[0] >= 0 && x[0] <= pi)) fault = fault ? fault : __LINE__;
  for (int k = 1; k < 4; k++)
    if (!(fabs(x[k]) <= 1e100)) fault = fault ? fault : __LINE__;
}

static void try_starts(void) {
  int good = 1;
  const int seen = draw_enum(7);
  prepare();
  symtop_top* top = take_tops(1, &good);
  double* known = take_numbers(3, 2.0);
  double* room = take_room(sizeof(symtop_solutions) / sizeof(double));
  symtop_solutions* found = (symtop_solutions*)(void*)room;
  const symtop_status status = symtop_solve_start(top, (symtop_question)seen, known, found);
  CHECK(status, good && !has_null && seen >= 0 && seen < 7);
  if (status != SYMTOP_OK || has_overlap) return;
  const int number = (int)found->number;
  if ((number == 0) != (found->demand != SYMTOP_DEMANDS_NOTHING)) fault = fault ? fault : __LINE__;
  for (int k = 0; k < number; k++) check_solution(&found->each[k]);
}

static void try_spreads(void) {
  int good = 1;
  const int seen = draw_enum(7);
  prepare();
  symtop_top* top = take_tops(1, &good);
  double *known = take_numbers(3, 2.0), *half_widths = take_numbers(3, 2.0);
  double* room = take_room(sizeof(symtop_spreads) / sizeof(double));
  symtop_spreads* found = (symtop_spreads*)(void*)room;
  const symtop_status status =
      symtop_find_spreads(top, (symtop_question)seen, known, half_widths, found);
  CHECK(status, good && !has_null && seen >= 0 && seen < 7);
  if (status != SYMTOP_OK || has_overlap) return;
  for (int k = 0; k < 4 && !isnan(found->least[k].theta); k++) {
    check_solution(&found->least[k]);
    check_solution(&found->most[k]);
    if (!(found->least[k].psi_dot <= found->most[k].psi_dot)) fault = fault ? fault : __LINE__;
  }
}

static void try_kicks(void) {
  int good = 1;
  const int kind = draw_enum(5), hold = draw_enum(3);
  const int is_impulse = kind == SYMTOP_IMPULSE || kind == SYMTOP_AXLE_IMPULSE;
  const size_t width = kind == SYMTOP_IMPULSE ? 3 : 1;
  prepare();
  const size_t count = draw_count(&good), n = bound(count);
  symtop_top* tops = take_tops(n, &good);
  double *q = take_orientations(n, &good), *omega = take_omegas(n, &good);
  double *amounts = take_numbers(3 * n, 2.0), *kicked = take_room(3 * n);
  size_t* done = take_done();
  if (amounts) good &= are_finite(amounts, width * n);
  const int is_held = is_hold(hold) || (is_impulse && hold == SYMTOP_NOTHING);
  const int is_kind = kind >= 0 && kind <= SYMTOP_AXLE_IMPULSE;
  const symtop_status status = symtop_kick(tops, q, omega, (symtop_kick_kind)kind,
                                           (symtop_hold)hold, amounts, count, kicked, done);
  CHECK(status, is_kind && allow(good && is_held, count, done) && done);
  if (n < 2) ROOM(status, kicked, 3 * n);
}

static void hash_verdict(const symtop_verdict* v) {
  add_numbers(v->turning_angles, 2);
  add_numbers(&v->factor, 1);
  add_numbers(&v->average.rate, 1);
  add_numbers(&v->reason.before, 4);
  add_to_hash((uint64_t)v->motion);
  add_numbers(&v->cause.torque_share, 1);
  add_numbers(v->cause.torque_from_perpendicular, 2);
  add_numbers(v->cause.momentum_from_axle, 3);
  add_numbers(v->cause.momentum_from_vertical, 3);
  add_to_hash(v->cause.constant + 10u * (unsigned)v->cause.explanation);
  add_numbers(v->means.rates, 2);
  add_numbers(v->means.cosines, 2);
  add_numbers(&v->disturbed_to, 1);
  add_to_hash((unsigned)v->means.sense + 10u * (unsigned)v->means.height);
  add_to_hash((unsigned)v->direction + 1000u * (unsigned)v->reason.kind);
  if (!are_finite(v->turning_angles, 2) || v->motion > SYMTOP_DRIVEN)
    fault = fault ? fault : __LINE__;
}

static void try_verdicts(void) {
  int good = 1;
  const int hold = draw_enum(3);
  const size_t words = (sizeof(symtop_verdict) + 7) / 8;
  prepare();
  const size_t count = draw_count(&good), n = bound(count);
  symtop_start* starts = take_starts(n, 0, &good);
  double* factors = take_numbers(n, 2.0);
  symtop_verdict* verdicts = (symtop_verdict*)take(n * words, 1);
  size_t* done = take_done();
  if (factors) good &= are_finite(factors, n);
  symtop_status status = symtop_judge(starts, factors, count, (symtop_hold)hold, verdicts, done);
  if (CHECK(status, allow(good && is_hold(hold), count, done) && done))
    for (size_t i = 0; i < n; i++) hash_verdict(verdicts + i);
  else if (n < 2)
    ROOM(status, (double*)(void*)verdicts, words * n);
  good = 1;
  prepare();
  symtop_start *before = take_starts(1, 0, &good), *after = take_starts(1, 0, &good);
  symtop_verdict* verdict = (symtop_verdict*)take(words, 1);
  if (before && after && !is_rare(4)) { /* often the same attitude */
    memmove(after->orientation, before->orientation, sizeof after->orientation);
    good = is_start(before) && is_start(after);
  }
  status = symtop_judge_kick(before, after, (symtop_hold)hold, verdict);
  if (CHECK(status, good && !has_null && hold >= 0 && hold <= SYMTOP_NOTHING))
    hash_verdict(verdict);
  else
    ROOM(status, (double*)(void*)verdict, words);
}

static void try_map(void) {
  int good = 1;
  const int hold = draw_enum(2);
  const double factor = draw_number(2.0);
  prepare();
  const size_t count = draw_count(&good), n = bound(count);
  symtop_top* tops = take_tops(n, &good);
  double *thetas = take_numbers(n, 3.0), *phi_dots = take_numbers(n, 300.0);
  double *psi_dots = take_numbers(n, 300.0), *angles = take_room(2 * n);
  unsigned char* rules = (unsigned char*)take(1, 1);
  if (thetas && phi_dots && psi_dots)
    good &=
        are_finite(thetas, n) && are_within(phi_dots, n, 1e100) && are_within(psi_dots, n, 1e100);
  good &= isfinite(factor) != 0;
  const symtop_status status = symtop_compare_hurried(tops, thetas, phi_dots, psi_dots, count,
                                                      factor, (symtop_hold)hold, angles, rules);
  CHECK(status, allow(good && is_hold(hold), count, &count) || (!count && 1));
  if (n < 2) ROOM(status, angles, 2 * n);
  for (size_t i = 0; status == SYMTOP_OK && !has_overlap && i < n; i++)
    if (rules[i] > SYMTOP_RULE_FAILS) fault = fault ? fault : __LINE__;
}

static void try_many(void) {
  int good = 1, count_is_good = 1;
  const size_t words = (sizeof(symtop_constants) + 7) / 8;
  prepare();
  const size_t count = draw_count(&count_is_good), n = bound(count), each = draw() % (MOST + 1);
  int are_starts = 1; /* a start that is refused is left, and no refusal of the call */
  symtop_start* starts = take_starts(n, 1, &are_starts);
  double *times = take_numbers(each, 1.0), *q = take_room(4 * n * each),
         *omega = take_room(3 * n * each);
  uint8_t* left = (uint8_t*)take(2, 1);
  if (times) good &= are_finite(times, each);
  symtop_status status = symtop_states_of_many(starts, count, times, each, q, omega, left);
  const int has_states = count && each;
  CHECK(status, count_is_good && (!count || starts) && (!each || times) &&
                    (!has_states || (good && q && omega && left)));
  for (size_t k = 0; status == SYMTOP_OK && !has_overlap && k < n * each; k++)
    if (left[k] > 1 || (!left[k] && !are_finite(q + 4 * k, 4))) fault = fault ? fault : __LINE__;
  good = count == n;
  prepare();
  starts = take_starts(n, 0, &good);
  symtop_constants* found = (symtop_constants*)take(n * words, 1);
  size_t* done = take_done();
  status = symtop_describe_many(starts, count, found, done);
  if (CHECK(status, allow(good, count, done) && done))
    for (size_t i = 0; i < n; i++) {
      add_to_hash((uint64_t)found[i].kind);
      add_numbers(found[i].turning_angles, 2);
      if (found[i].kind > SYMTOP_DRIVEN || !are_finite(found[i].turning_angles, 2))
        fault = fault ? fault : __LINE__;
    }
}

/* ---- Motions ---- */

static symtop_motion* draw_handle(symtop_motion* motion) {
  if (!is_rare(40)) return motion;
  has_null = 1;
  return NULL;
}

static void try_states(symtop_motion* given) {
  int good = 1;
  prepare();
  symtop_motion* motion = draw_handle(given);
  const size_t count = draw_count(&good), n = bound(count);
  const double steps = is_rare(10) ? draw_number(10.0) : STEPS;
  double *times = take_numbers(n, 10.0), *q = take_room(4 * n), *omega = take_room(3 * n);
  size_t* done = take_done();
  if (steps > STEPS) return; /* a minute may pass */
  const int has_arrays = times && q && omega;
  if (times) good &= are_finite(times, n);
  symtop_status status = symtop_states(motion, times, count, steps, q, omega, done);
  good &= motion && done && steps >= 0;
  if (CHECK(status, good && (has_arrays || !count))) {
    ROOM(status, q, 4 * n);
    ROOM(status, omega, 3 * n);
  }
  good = count == n;
  prepare();
  motion = draw_handle(given);
  symtop_clock* clock = (symtop_clock*)take(5, 1);
  int64_t* stamps = (int64_t*)take(n, 1);
  q = take_room(4 * n);
  omega = take_room(3 * n);
  done = take_done();
  for (size_t i = 0; stamps && i < n; i++)
    stamps[i] = is_rare(30) ? INT64_MIN : (int64_t)(is_rare(3) ? draw() : draw() >> 30);
  if (clock) {
    clock->factor = draw_number(1.0);
    for (int k = 0; k < 4; k++) clock->elapsed[k] = is_rare(2) ? draw_number(1e9) : 0.0;
    const double parts[] = {clock->factor, clock->elapsed[0], clock->elapsed[1], clock->elapsed[2],
                            clock->elapsed[3]};
    for (int k = 0; k < 5; k++)
      good &= parts[k] == 0 || (fabs(parts[k]) >= 1e-100 && fabs(parts[k]) <= 1e100);
  }
  for (size_t i = 0; stamps && i < n; i++) good &= stamps[i] != INT64_MIN;
  status = symtop_states_of_clock(motion, clock, stamps, count, STEPS, q, omega, done);
  good &= motion && clock && done && (!count || !has_null);
  if (CHECK(status, good)) {
    ROOM(status, q, 4 * n);
    ROOM(status, omega, 3 * n);
  }
}

static void try_one_state(symtop_motion* given) {
  int good;
  prepare();
  symtop_motion *motion = draw_handle(given), *continued = given;
  const double t = draw_number(10.0), steps = is_rare(10) ? draw_number(10.0) : STEPS;
  double* reached = take_room(1);
  if (steps > STEPS) return;
  symtop_status status = symtop_reach(motion, t, steps, reached);
  CHECK(status, !has_null && isfinite(t) && steps >= 0);
  const double time = status == SYMTOP_OK && reached ? *reached : 0.0;
  prepare();
  motion = draw_handle(given);
  double *q = take_room(4), *omega = take_room(3);
  /* A time that is not finite is refused at once; to another one integrations may take a minute. */
  const double asked = isfinite(t) ? time : t;
  status = symtop_state(motion, asked, q, omega);
  CHECK(status, !has_null && isfinite(asked));
  ROOM(status, q, 4);
  ROOM(status, omega, 3);
  prepare();
  motion = draw_handle(given);
  double* torque = take_numbers(3, 1.0);
  good = torque && are_finite(torque, 3);
  symtop_motion** to = is_rare(20) ? NULL : &continued;
  status = symtop_continue(motion, asked, torque, to);
  CHECK(status, good && motion && to && isfinite(asked));
  if (to && (status == SYMTOP_OK) != (continued != NULL)) fault = fault ? fault : __LINE__;
  if (to) symtop_free(continued);
}

static void try_constants(symtop_motion* given) {
  prepare();
  symtop_motion* motion = draw_handle(given);
  const symtop_kind kind = symtop_find_kind(motion);
  const symtop_engine engine = symtop_find_engine(motion);
  if ((kind == SYMTOP_UNKNOWN_KIND) != !motion || (engine == SYMTOP_UNKNOWN_ENGINE) != !motion ||
      (unsigned)kind > SYMTOP_UNKNOWN_KIND || (unsigned)engine > SYMTOP_UNKNOWN_ENGINE)
    fault = fault ? fault : __LINE__;
  add_to_hash((uint64_t)kind);
  calls += 2;
  double *angles = take_room(2), *rate = take_room(2), *farthest = take_room(1);
  symtop_rates* rates = (symtop_rates*)take(5, 1);
  symtop_status status = symtop_find_turning_angles(motion, angles);
  CHECK(status, motion && angles);
  ROOM(status, angles, 2);
  status = symtop_find_nutation_rate(motion, rate);
  CHECK(status, motion && rate);
  ROOM(status, rate, 2);
  status = symtop_find_farthest_time(motion, farthest);
  CHECK(status, motion && farthest);
  ROOM_OR_NAN(status, farthest, 1);
  status = symtop_find_rates(motion, rates);
  CHECK(status, motion && rates);
  ROOM_OR_NAN(status, (double*)(void*)rates, 4);
}

static void try_piece(symtop_motion* given) {
  prepare();
  symtop_motion* motion = draw_handle(given);
  symtop_clock* clock = (symtop_clock*)take(5, 1);
  double* piece = (double*)take(17, 1);
  if (clock) {
    memset(clock, 0, sizeof *clock);
    clock->factor = draw_number(1.0);
  }
  const double size = clock ? fabs(clock->factor) : 1.0;
  const int64_t stamp = is_rare(30) ? INT64_MIN : (int64_t)(draw() >> 30);
  const symtop_status status =
      symtop_find_piece(motion, clock, stamp, STEPS, (symtop_piece*)(void*)piece);
  CHECK(status,
        !has_null && stamp != INT64_MIN && (size == 0 || (size >= 1e-100 && size <= 1e100)));
  ROOM(status, piece, 17);
  if (status == SYMTOP_OK && !has_overlap && !(piece[15] >= 0 && piece[16] >= 1))
    fault = fault ? fault : __LINE__;
}

static void use(symtop_status status, symtop_motion* motion, int is_asked) {
  if (is_asked && (status == SYMTOP_OK) != (motion != NULL)) fault = fault ? fault : __LINE__;
  if (!motion) return;
  try_states(motion);
  try_one_state(motion);
  try_constants(motion);
  try_piece(motion);
  symtop_free(motion);
}

static void try_motion(void) {
  int good = 1;
  symtop_motion *motion = NULL, **to = is_rare(40) ? NULL : &motion;
  prepare();
  symtop_start* start = take_starts(1, 0, &good);
  const symtop_status status = symtop_new(start, to);
  CHECK(status, good && start && to);
  use(status, motion, to != NULL);
}

static void try_coarse(void) {
  int good = 1;
  symtop_motion *motion = NULL, **to = is_rare(40) ? NULL : &motion;
  prepare();
  symtop_start* start = take_starts(1, 0, &good);
  const double tolerance = is_rare(4) ? draw_number(1e-7) : 1e-6;
  good &= tolerance == 0 || (tolerance >= 1e-15 && tolerance <= 1e-6);
  const symtop_status status = symtop_new_coarse(start, tolerance, to);
  CHECK(status, good && start && to);
  use(status, motion, to != NULL);
}

/* Few pushes: each costs what a motion costs. */
static void try_pushed(void) {
  int good = 1;
  symtop_motion *motion = NULL, **to = is_rare(40) ? NULL : &motion;
  prepare();
  symtop_start* start = take_starts(1, 0, &good);
  symtop_pushes* pushes = (symtop_pushes*)take(3, 1);
  if (pushes) {
    pushes->impulse = draw_number(1.0);
    pushes->rate = draw_number(30.0);
    pushes->number = is_rare(8) ? draw_number(30.0) : (double)(draw() % 8);
    good &= are_finite(&pushes->impulse, 1) && pushes->rate >= 0.01 && pushes->rate <= 1000;
    good &=
        pushes->number >= 1 && pushes->number <= 1000 && pushes->number == floor(pushes->number);
  }
  const symtop_status status = symtop_new_pushed(start, pushes, to);
  CHECK(status, good && start && pushes && to);
  use(status, motion, to != NULL);
}

static int is_zero(double x) { return fabs(x) < 1e-100; }

static void try_clamped(void) {
  int good = 1;
  symtop_motion *motion = NULL, **to = is_rare(40) ? NULL : &motion;
  prepare();
  symtop_start* start = take_starts(1, 0, &good);
  if (start) {
    if (is_rare(20)) start->orientation[1] = start->orientation[2] = draw_number(1e-100);
    memset(start->friction, 0, is_rare(4) ? 0 : sizeof start->friction);
    memset(start->torque, 0, is_rare(4) ? 0 : sizeof start->torque);
    const double *q = start->orientation, *force = start->torque, *drag = start->friction;
    good =
        is_start(start) && !(is_zero(q[0]) && is_zero(q[3])) && !(is_zero(q[1]) && is_zero(q[2]));
    good &= force[0] == 0 && force[1] == 0 && force[2] == 0 && drag[0] == 0 && drag[1] == 0;
  }
  const symtop_status status = symtop_new_clamped(start, to);
  CHECK(status, good && start && to);
  symtop_held held, *room = is_rare(40) ? NULL : &held;
  const symtop_status judged = symtop_judge_clamp(start, room);
  CHECK(judged, good && start && room);
  if (judged == SYMTOP_OK && !(held.theta >= 0 && held.rate >= 0)) fault = fault ? fault : __LINE__;
  double shows_at = 0.0, *place = is_rare(40) ? NULL : &shows_at;
  const symtop_status doubted = symtop_find_doubt(start, place);
  CHECK(doubted, start && is_start(start) && place);
  if (doubted == SYMTOP_OK && !(shows_at > 0)) fault = fault ? fault : __LINE__;
  symtop_present present, *now = is_rare(40) ? NULL : &present;
  const symtop_status explained = symtop_explain_present(start, now);
  CHECK(explained, start && is_start(start) && now);
  const int said = explained == SYMTOP_OK && present.going != SYMTOP_GOING_UNSAID;
  if (said && !isfinite(present.torque_share)) fault = fault ? fault : __LINE__;
  use(status, motion, to != NULL);
}

/* Calls with so many seeds from the first one on. Returns 0, or the line of the first fault. */
int run(unsigned first, unsigned number);
int run(unsigned first, unsigned number) {
  static void (*const TRIALS[])(void) = {
      try_angles, try_orientations, try_regular_rates, try_tilts,    try_discs,   try_bodies,
      try_starts, try_spreads,      try_kicks,         try_verdicts, try_map,     try_many,
      try_motion, try_coarse,       try_pushed,        try_clamped,  try_exchange};
  hash = 14695981039346656037u;
  calls = answered = 0;
  fault = 0;
  for (unsigned seed = first; seed < first + number && !fault; seed++) {
    oddness = seed % 2 ? 6 : 60;
    state = (uint64_t)seed * 0x9e3779b97f4a7c15u | 1;
    for (int i = 0; i < 8; i++) draw();
    for (size_t k = 0; k < sizeof TRIALS / sizeof TRIALS[0]; k++) TRIALS[k]();
    symtop_free(NULL);
    if (!symtop_describe_status((symtop_status)draw_enum(99))[0]) fault = __LINE__;
  }
  return fault;
}

/* Of all answers, in 32 bits; how many calls, and how many were answered. */
unsigned digest(void);
unsigned digest(void) { return (unsigned)(hash ^ hash >> 32); }
int count_calls(void);
int count_calls(void) { return (int)calls; }
int count_answers(void);
int count_answers(void) { return (int)answered; }

#ifndef __wasm__
#include <stdio.h>

/* Arguments: the first seed, and how many. */
int main(int count, char** words) {
  const int line =
      run(count > 1 ? (unsigned)atol(words[1]) : 1, count > 2 ? (unsigned)atol(words[2]) : 100);
  if (line) return fprintf(stderr, "hostile.c:%d: not as promised\n", line), 1;
  printf("%d of %d calls answered, digest %08x\n", count_answers(), count_calls(), digest());
  return 0;
}
#endif

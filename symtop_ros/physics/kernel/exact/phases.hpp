// Phases that grow at constant rates, reduced to one turn without error (derivation.md, section 9).
//
// They are integers of 64 bits, a turn being 2^64. Their products wrap round after whole turns,
// which is the reduction itself: it is exact however many turns there are, while the product rate *
// t in doubles would have an error of EPS times the whole phase (design/phases.py).
#pragma once

#include "quotients.hpp"
#include "rows.hpp"

namespace symtop {

const int STEP_LIMBS = 4;  // 256 bits

// Up to three phases. The fastest one grows by 2^-11 to 2^-10 of a turn in a tick: so a count of
// ticks in 63 bits reaches 4e15 turns, and the rest of a tick is small enough for a product in
// doubles.
struct Steps {
  int exponent = 0;
  double ticks = 1.0, farthest = 0.0;          // per s; s
  uint64_t limbs[FUNCTIONS][STEP_LIMBS] = {};  // of 2^-256 turns in a tick, the lowest first
  double rest_rates[FUNCTIONS] = {};
};

// The integer part of x 2^256, for |x| < 1/2, as a number with sign; and its double times 2^-256.
inline double truncate_step(const Precise& x, uint64_t limbs[STEP_LIMBS]) {
  uint64_t bits[STEP_LIMBS] = {};
  const int shift = x.sign ? -x.exponent : 256;  // x = 0.mantissa * 2^-shift
  Precise kept = x;
  if (shift >= 256) kept = Precise();
  if (kept.sign) {
    const int places = shift / 64, rest = shift % 64;
    for (int i = 0; i < 3; i++) {  // limb i of the mantissa, shifted down by `shift` bits
      const int place = i + 1 - places;
      if (place >= 0) bits[place] |= x.limbs[i] >> rest;
      if (rest && place >= 1) bits[place - 1] |= x.limbs[i] << (64 - rest);
    }
    const int lost = shift - 64;  // lowest bits of the mantissa that are below 2^-256
    for (int i = 0; i < 3 && lost > 64 * i; i++) {
      const int low = lost - 64 * i;
      kept.limbs[i] = low >= 64 ? 0 : kept.limbs[i] >> low << low;
    }
  }
  uint64_t carry = kept.sign < 0;
  for (int i = 0; i < STEP_LIMBS; i++) {
    limbs[i] = kept.sign < 0 ? ~bits[i] + carry : bits[i];
    carry = carry && limbs[i] == 0;
  }
  return kept.to_double();
}

inline Steps find_steps(const Precise* rates, int count) {
  Precise turns[FUNCTIONS];
  double fastest = 0.0;
  for (int i = 0; i < count; i++) {
    turns[i] = rates[i] * PER_TURN;
    fastest = std::fmax(fastest, std::fabs(turns[i].to_double()));
  }
  Steps steps;
  if (!fastest)
    steps.exponent = -1000;  // of any unit of time
  else {
    std::frexp(fastest, &steps.exponent);
    steps.exponent += 10;
  }
  if (steps.exponent > 1000) steps.exponent = 1000;
  if (steps.exponent < -1000) steps.exponent = -1000;
  steps.ticks = std::ldexp(1.0, steps.exponent);
  steps.farthest = std::ldexp(1.0, 62 - steps.exponent > 1023 ? 1023 : 62 - steps.exponent);
  if (!fastest) steps.farthest = INFINITY;  // phases that stand still are known at any time
  for (int i = 0; i < count; i++)
    steps.rest_rates[i] = 2 * PI * truncate_step(turns[i].scale(-steps.exponent), steps.limbs[i]);
  return steps;
}

template <class R>
struct PhaseOf {
  Integer<R> turns;  // in units of 2^-64 turns, with sign
  R rest;            // to be added, in rad
};
typedef PhaseOf<double> Phase;

// A count of ticks times a step, in units of 2^-64 turns. Of the products of 32 bits only what
// reaches the first 64 bits is added: the carries left out are at most 3 units, 2^-62 of a turn.
inline uint64_t multiply_step(const uint64_t limbs[STEP_LIMBS], int64_t count) {
  const uint64_t size = count < 0 ? -static_cast<uint64_t>(count) : count;
  const uint64_t whole = limbs[3], upper = limbs[2] >> 32, lower = limbs[2] & 0xffffffff;
  const uint64_t above = size >> 32, below = size & 0xffffffff;
  uint64_t turns = size * whole;
  turns += above * upper;
  turns += (above * lower) >> 32;
  turns += (below * upper) >> 32;
  return count < 0 ? -turns : turns;
}

// The phases at a time in s that is not far.
inline void find_phases(const Steps& steps, int number, double t, Phase* phases) {
  const double ticks = t * steps.ticks, counts = round_to_integer(ticks), rest = ticks - counts;
  const int64_t count = static_cast<int64_t>(counts);
  for (int i = 0; i < number; i++)
    phases[i] = {multiply_step(steps.limbs[i], count), steps.rest_rates[i] * rest};
}

// The phase in rad, between -pi and pi up to the rest, as a sum of two doubles: 27 bits of it times
// the first part of 2 pi, of 26 bits, are exact.
template <class R>
SYMTOP_INLINE PairOf<R> find_radians(const PhaseOf<R>& phase) {
  const double TWO_PI_HIGH = 4 * QUARTER_HIGH, TWO_PI_LOW = 4 * QUARTER_LOW;
  const uint64_t LOWER = (uint64_t(1) << 37) - 1;
  R small = to_double(phase.turns & LOWER) * (2 * PI * 0x1p-64);
  const R units = to_double(phase.turns & ~LOWER) * 0x1p-64;
  const R coarse = units * TWO_PI_HIGH;
  small += units * TWO_PI_LOW;
  small += phase.rest;
  const R high = coarse + small;
  return {high, (coarse - high) + small};
}

// Cosine and sine: an entry of the table of 512, turned by what is left, of which the series are
// short. The rests of the entries make them right to half an ulp.
template <class R>
SYMTOP_INLINE PairOf<R> find_unit(const PhaseOf<R>& phase) {
  const Integer<R> shifted = phase.turns + (uint64_t(1) << 54);
  R row[4];
  read_row(ROWS.entries, (shifted >> 55) & (ENTRIES - 1), row);
  const Integer<R> part = shifted & ((uint64_t(1) << 55) - 1);
  R angle = to_double(part - (uint64_t(1) << 54)) * (2 * PI * 0x1p-64);
  angle += phase.rest;
  const R square = angle * angle;
  const R s = angle + angle * (square * (square * (1.0 / 120) - 1.0 / 6));
  const R versine = square * (0.5 - square * (1.0 / 24 - square * (1.0 / 720)));
  return {row[0] + (row[2] - (row[0] * versine + row[1] * s)),
          row[1] + (row[3] + (row[0] * s - row[1] * versine))};
}

}  // namespace symtop

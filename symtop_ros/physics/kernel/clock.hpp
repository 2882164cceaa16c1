// Exact times of a motion: elapsed + factor * nanoseconds, as samples are stamped.
//
// The phases of a motion are reduced to one turn in integers, so that the time of a sample is never
// rounded: as many limbs are used as the numbers have.
#pragma once

#include "exact/phases.hpp"

namespace symtop {

const int ELAPSED_PARTS = 4;         // that a caller gives
const uint64_t SECOND = 1000000000;  // ns

struct Clock {
  double factor;  // time of the motion per time of the clock
  // Their sum is the time of the motion in ns at stamp 0; the last one takes off the begin of a
  // stretch.
  double elapsed[ELAPSED_PARTS + 1];
};

// The whole part of limbs divided by 10^9, in place, and whether something is left.
inline bool divide_by_second(uint64_t* limbs, int count) {
  uint64_t rest = 0;
  for (int i = count - 1; i >= 0; i--) {
    const Wide part = static_cast<Wide>(rest) << 64 | limbs[i];
    limbs[i] = static_cast<uint64_t>(part / SECOND);
    rest = static_cast<uint64_t>(part % SECOND);
  }
  return rest != 0;
}

// The double that is nearest to a time in ns divided by 10^9.
inline double to_seconds(const Exact& time) {
  if (!time.sign) return 0.0;
  uint64_t limbs[25] = {};
  std::memcpy(limbs + 1, time.limbs, sizeof time.limbs);
  const bool has_rest = divide_by_second(limbs, 25);
  Exact seconds;
  seconds.sign = time.sign;
  seconds.exponent = time.exponent;
  normalize(limbs, seconds);
  seconds.limbs[0] |= has_rest;
  return seconds.to_double();
}

inline Exact find_elapsed(const Clock& clock) {
  Exact sum;
  for (double part : clock.elapsed) sum = sum + Exact(part);
  return sum;
}

// An integer of 63 bits with sign, as the sum of two doubles.
inline Exact to_exact(int64_t n) {
  const int64_t low = n & 0xffffffff;
  return Exact(static_cast<double>(n - low)) + Exact(static_cast<double>(low));
}

inline Exact find_time(const Clock& clock, const Exact& elapsed, int64_t stamp) {
  return elapsed + Exact(clock.factor) * to_exact(stamp);
}

// A time in ns as seconds: the nearest double, and what it lacks.
inline Pair split_seconds(const Exact& time) {
  const double high = to_seconds(time);
  return {high, to_seconds(time - Exact(high) * Exact(static_cast<double>(SECOND)))};
}

// The whole part, towards minus infinity, of a step times x 2^exponent/10^9, modulo
// 2^256. The step is an integer of 256 bits with sign.
inline void scale_step(const uint64_t step[STEP_LIMBS], double x, int exponent,
                       uint64_t scaled[STEP_LIMBS]) {
  const int LIMBS = 48;  // more than 256 + 53 + 1000 + 1024 bits
  uint64_t limbs[LIMBS] = {}, size[STEP_LIMBS];
  const bool is_negative = step[STEP_LIMBS - 1] >> 63;
  uint64_t carry = is_negative;
  for (int i = 0; i < STEP_LIMBS; i++) {
    size[i] = is_negative ? ~step[i] + carry : step[i];
    carry = carry && size[i] == 0;
  }
  int power;
  const double fraction = std::frexp(std::fabs(x), &power);
  const uint64_t mantissa = static_cast<uint64_t>(std::ldexp(fraction, 53));
  power += exponent - 53;
  // The product has five limbs; its lowest bit gets the place `shift`, or is shifted out.
  uint64_t product[STEP_LIMBS + 1] = {};
  carry = 0;
  for (int i = 0; i < STEP_LIMBS; i++) {
    const Wide sum = static_cast<Wide>(size[i]) * mantissa + carry;
    product[i] = static_cast<uint64_t>(sum);
    carry = static_cast<uint64_t>(sum >> 64);
  }
  product[STEP_LIMBS] = carry;
  bool has_rest = false;
  const int places = power >= 0 ? power / 64 : -((-power + 63) / 64), bits = power - 64 * places;
  int used = 0;
  for (int i = 0; i <= STEP_LIMBS + 1; i++) {
    const uint64_t upper = i <= STEP_LIMBS ? product[i] : 0, lower = i ? product[i - 1] : 0;
    const uint64_t limb = bits ? upper << bits | lower >> (64 - bits) : upper;
    const int place = i + places;
    if (place < 0)
      has_rest |= limb != 0;
    else if (place < LIMBS) {
      limbs[place] = limb;
      used = place + 1;
    }
  }
  has_rest |= divide_by_second(limbs, used);
  // The whole part of a negative number is below it.
  const bool is_below = is_negative != (x < 0);
  carry = is_below && !has_rest;
  for (int i = 0; i < STEP_LIMBS; i++) {
    scaled[i] = is_below ? ~limbs[i] + carry : limbs[i];
    carry = carry && scaled[i] == 0;
  }
}

// Phases that grow by a step in a nanosecond of the clock.
class ClockSteps {
 public:
  ClockSteps(const Steps& steps, int count, const Clock& clock) : count_(count) {
    for (int k = 0; k < count; k++) {
      scale_step(steps.limbs[k], clock.factor, steps.exponent, steps_[k]);
      starts_[k] = find_start(steps, k, clock);
    }
  }

  void find_phases(int64_t stamp, Phase phases[]) const {
    for (int k = 0; k < count_; k++)
      phases[k] = {multiply_step(steps_[k], stamp) + starts_[k], 0.0};
  }

 private:
  int count_;
  uint64_t steps_[FUNCTIONS][STEP_LIMBS], starts_[FUNCTIONS];

  // The phase at stamp 0. Each part of the elapsed time is rounded down to 2^-256 of a turn, of
  // which 64 bits are kept.
  static uint64_t find_start(const Steps& steps, int k, const Clock& clock) {
    uint64_t sum[STEP_LIMBS] = {}, part[STEP_LIMBS];
    for (double elapsed : clock.elapsed) {
      if (!elapsed) continue;
      scale_step(steps.limbs[k], elapsed, steps.exponent, part);
      uint64_t carry = 0;
      for (int i = 0; i < STEP_LIMBS; i++) {
        const Wide total = static_cast<Wide>(sum[i]) + part[i] + carry;
        sum[i] = static_cast<uint64_t>(total);
        carry = static_cast<uint64_t>(total >> 64);
      }
    }
    return sum[STEP_LIMBS - 1];
  }
};

}  // namespace symtop

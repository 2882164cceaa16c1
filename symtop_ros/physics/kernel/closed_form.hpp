// The closed form of symtop_ros/physics/exact, function by function and in the same order of
// operations: what is computed here with Precise is computed there with Decimal. Read the Python
// first; it says where each formula comes from and why it is written so. The names are the same.
#pragma once

#include "numbers.hpp"

namespace symtop {

// ---- nutation.py --------------------------------------------------------------------------------

struct Start {  // what a motion starts from; Mgl > 0 and the orientation as it was given
  double Ix, Iz, Mgl;
  double w, x, y, z;
  double wx, wy, wz;
};

struct Nutation {
  Precise a, beta, one_minus_u, one_plus_u, b_minus_au, u_dot, omega_xy_squared, b_minus_a,
      alpha_minus_beta;

  Precise u() const { return (one_plus_u - one_minus_u).scale(-1); }
  Precise b_minus_au_at(const Precise& s) const { return b_minus_au - a * s; }
};

// _compare_with_upright: exact sums of products, rounded at the end
inline void compare_with_upright(const Start& start, Nutation& nutation) {
  const Exact Ix(start.Ix), Iz(start.Iz), Mgl(start.Mgl), w(start.w), x(start.x), y(start.y),
      z(start.z), wx(start.wx), wy(start.wy), wz(start.wz);
  const Exact lower = x * x + y * y, norm = w * w + z * z + lower;
  const Exact gx = x * z - w * y, gy = y * z + w * x;
  const Exact b_minus_a = Ix * (wx * gx + wy * gy) - wz * Iz * lower;
  const Exact alpha_minus_beta = (wx * wx + wy * wy) * Ix * norm - Exact(4.0) * Mgl * lower;
  const Precise divisor = Precise(Ix) * Precise(norm);
  nutation.b_minus_a = Precise(b_minus_a).scale(1) / divisor;
  nutation.alpha_minus_beta = Precise(alpha_minus_beta) / divisor;
}

inline const Precise& cancelled() {
  static const Precise SHARE = Precise(1.0) / Precise(1e10);
  return SHARE;
}

// Nutation.of
inline Nutation find_nutation(const Start& start) {
  const Precise Ix(start.Ix), Iz(start.Iz), Mgl(start.Mgl), w(start.w), x(start.x), y(start.y),
      z(start.z), wx(start.wx), wy(start.wy), wz(start.wz);
  const Precise upper = w * w + z * z, lower = x * x + y * y;
  const Precise twice = Precise(2.0) / (upper + lower), per_Ix = invert(Ix);
  const Precise gx = twice * (x * z - w * y), gy = twice * (y * z + w * x);
  const Precise along_x = wx * gx, along_y = wy * gy;
  Nutation n;
  n.a = wz * Iz * per_Ix;
  n.beta = Mgl.scale(1) * per_Ix;
  n.one_minus_u = twice * lower;
  n.one_plus_u = twice * upper;
  n.b_minus_au = along_x + along_y;
  n.u_dot = wy * gx - wx * gy;
  n.omega_xy_squared = wx * wx + wy * wy;
  n.b_minus_a = n.b_minus_au - n.a * n.one_minus_u;
  n.alpha_minus_beta = n.omega_xy_squared - n.beta * n.one_minus_u;
  if (size(n.b_minus_a) <= cancelled() * (size(along_x) + size(along_y)) ||
      size(n.alpha_minus_beta) <= cancelled() * n.omega_xy_squared)
    compare_with_upright(start, n);
  return n;
}

struct Roots {
  Precise s1, s2, s3, s21, s32, below_pole, above_pole;
  Precise s31() const { return s21 + s32; }
};

struct Cubic {
  Precise a2, a1, a0;
  Precise at(const Precise& s) const { return ((s + a2) * s + a1) * s + a0; }
};

// _estimate_largest_root
inline Precise estimate_largest_root(const Cubic& cubic, double s) {
  const double EPS = 0x1p-52;
  const double a2 = cubic.a2.to_double(), a1 = cubic.a1.to_double(), a0 = cubic.a0.to_double();
  for (int step = 0; step < 60; step++) {
    const double value = ((s + a2) * s + a1) * s + a0, slope = (3 * s + 2 * a2) * s + a1;
    if (!(value > 0 && slope > 0) || value < 4 * EPS * slope * s) break;
    s -= value / slope;
  }
  return std::isfinite(s) ? Precise(s * (1 + 32 * EPS)) : Precise();
}

// _find_largest_root
inline Precise find_largest_root(const Cubic& cubic, Precise s) {
  static const Precise CONVERGED = Precise(1e-26);
  if (!cubic.a0.sign && cubic.a1.sign > 0 && cubic.a2.sign > 0) return Precise();
  const Precise three(3.0), estimate = estimate_largest_root(cubic, s.to_double());
  if (three * estimate > -cubic.a2 && cubic.at(estimate).sign > 0) s = estimate;
  for (;;) {
    const Precise value = cubic.at(s), slope = (three * s + cubic.a2.scale(1)) * s + cubic.a1;
    if (value.sign <= 0 || slope.sign <= 0) return s;
    const Precise step = value / slope;
    if (step < CONVERGED * s) return s - step;
    s = s - step;
  }
}

// _distances_from_pole
inline void find_distances_from_pole(const Nutation& n, const Precise& v1, Roots& roots) {
  const Precise scale = n.beta * v1, per_scale = invert(scale);
  const Precise product = n.b_minus_a * n.b_minus_a * per_scale;
  const Precise excess = n.alpha_minus_beta - n.a * n.b_minus_a;
  const Precise half_sum = (product / v1).scale(-1) - excess * per_scale;
  const Precise half_gap = root(half_sum * half_sum + product);
  if (half_sum.sign > 0) {
    roots.below_pole = half_sum + half_gap;
    roots.above_pole = product / roots.below_pole;
  } else {
    roots.above_pole = half_gap - half_sum;
    roots.below_pole = roots.above_pole.sign ? product / roots.above_pole : Precise();
  }
}

// _roots_from_lowest
inline Roots find_roots_from_lowest(const Nutation& n, const Cubic& cubic) {
  Roots roots;
  const Cubic reflected = {-cubic.a2, cubic.a1, -cubic.a0};
  roots.s1 = -find_largest_root(reflected, n.one_plus_u);
  if (roots.s1.sign > 0) roots.s1 = Precise();
  const Precise total = -(cubic.a2 + roots.s1);
  const Precise product =
      total >= -roots.s1 ? cubic.a1 - roots.s1 * total : -cubic.a0 / roots.s1;
  find_distances_from_pole(n, n.one_minus_u - roots.s1, roots);
  roots.s3 = n.one_minus_u + roots.above_pole;
  roots.s2 = product / roots.s3;
  roots.s21 = roots.s2 - roots.s1;
  roots.s32 = roots.below_pole + roots.above_pole;
  return roots;
}

// _roots_from_highest
inline Roots find_roots_from_highest(const Nutation& n, const Cubic& cubic) {
  Roots roots;
  const Precise zero;
  Precise bound = (cubic.a2.sign < 0 ? -cubic.a2 : zero) +
                  root(cubic.a1.sign < 0 ? -cubic.a1 : zero);
  if (bound < n.one_minus_u) bound = n.one_minus_u;
  roots.s3 = find_largest_root(cubic, bound);
  const Precise per_s3 = invert(roots.s3), product = cubic.a0 * per_s3;
  const Precise half_sum = ((cubic.a1 + product) * per_s3).scale(-1);
  const Precise half_gap = root(half_sum * half_sum + product);
  roots.s2 = half_sum.sign >= 0 ? half_sum + half_gap : product / (half_gap - half_sum);
  if (half_sum.sign < 0)
    roots.s1 = half_sum - half_gap;
  else if (roots.s2.sign)
    roots.s1 = -product / roots.s2;
  roots.below_pole = n.one_minus_u - roots.s2;
  roots.above_pole = roots.s3 - n.one_minus_u;
  roots.s21 = half_gap.scale(1);
  roots.s32 = roots.s3 - roots.s2;
  return roots;
}

inline Roots find_roots(const Nutation& n) {
  const Precise u = n.u(), u_dot_dot = n.a * n.b_minus_au - u * n.omega_xy_squared;
  const Precise per_beta = invert(n.beta);
  const Cubic cubic = {u.scale(1) - (n.omega_xy_squared + n.a * n.a) * per_beta,
                       u_dot_dot.scale(1) * per_beta - n.one_plus_u * n.one_minus_u,
                       n.u_dot * n.u_dot * per_beta};
  const Precise mean = -cubic.a2 / Precise(3.0);
  return cubic.at(mean).sign > 0 ? find_roots_from_lowest(n, cubic)
                                 : find_roots_from_highest(n, cubic);
}

// ---- quotients.py -------------------------------------------------------------------------------

enum { OF_A, OF_B, OF_OMEGA_XY, FUNCTIONS };

struct Zero {
  bool is_below;
  Precise d, from_u1, from_u2, from_u3;
  bool is_negative() const { return d.sign < 0; }
};

// _zero_below
inline Zero find_zero_below(const Nutation& n, const Roots& roots) {
  const Precise d = n.b_minus_au_at(-n.one_plus_u);
  const Precise from_u2 = n.one_plus_u + roots.s2, from_u3 = n.one_plus_u + roots.s3;
  return {true, d, d * d / (n.beta * from_u2 * from_u3), from_u2, from_u3};
}

// _zero_above
inline Zero find_zero_above(const Nutation& n, const Precise& d, const Precise& from_u1,
                            Precise from_u2, Precise from_u3) {
  const Precise product = d * d / (n.beta * from_u1);
  if (!(from_u2 + from_u3).sign)
    from_u2 = from_u3 = Precise();
  else if (from_u2 <= from_u3)
    from_u2 = product / from_u3;
  else
    from_u3 = product / from_u2;
  return {false, d, from_u1, from_u2, from_u3};
}

inline void find_zeros(const Nutation& n, const Roots& roots, Zero zeros[FUNCTIONS]) {
  const Precise above = n.omega_xy_squared / n.beta;
  Precise d = n.b_minus_au_at(above), from_u2 = above - roots.s2, from_u3 = roots.s3 - above;
  if (roots.s32 < cancelled() * n.one_minus_u) {
    const Precise lift = n.alpha_minus_beta / n.beta;
    d = n.b_minus_a - n.a * lift;
    from_u2 = roots.below_pole + lift, from_u3 = roots.above_pole - lift;
  }
  zeros[OF_A] = find_zero_below(n, roots);
  zeros[OF_B] = find_zero_above(n, n.b_minus_a, n.one_minus_u - roots.s1, roots.below_pole,
                                roots.above_pole);
  zeros[OF_OMEGA_XY] = find_zero_above(n, d, above - roots.s1, from_u2, from_u3);
}

// _iterate_mean
inline Precise iterate_mean(const Precise& k, Precise* products, int& count) {
  static const Precise CONVERGED = Precise(1e-24);
  Precise a(1.0), b = k;
  count = 0;
  while (a - b > CONVERGED * a) {
    const Precise mean = (a + b).scale(-1);
    b = root(a * b);
    a = mean;
    count++;
    if (products) products[count - 1] = (a * b).scale(2 * count);
  }
  return (a + b).scale(-1);
}

// _third_kind
inline Precise integrate_third_kind(const Zero& zero, const Precise& root_near, const Precise& k,
                                    const Precise& mean, const Precise* products, int count) {
  const Precise near = root_near * root_near, one(1.0);
  Precise c = one + near, d = (one + k).scale(1), p = zero.is_below ? one + k * near : k + near;
  for (int n = 0; n < count; n++) {
    const Precise per_p = invert(p), e = products[n] * per_p, next = near * d * per_p + c;
    d = (c * e + d).scale(1), c = next, p = near * e + p;
  }
  const Precise m = mean.scale(count + 1);
  return (c * m + root_near * d) / (m * (root_near * m + p));
}

const int MOST_MEANS = 64;

// compute_mean_rates
inline Precise compute_mean_rates(const Nutation& n, const Zero zeros[], const Precise& k,
                                  Precise means[FUNCTIONS]) {
  if (!k.sign) {
    for (int i = 0; i < FUNCTIONS; i++)
      means[i] = zeros[i].is_below ? zeros[i].d / zeros[i].from_u2.scale(1) : Precise();
    return Precise();
  }
  Precise products[MOST_MEANS];
  int count;
  const Precise mean = iterate_mean(k, products, count);
  for (int i = 0; i < FUNCTIONS; i++) {
    const Zero& zero = zeros[i];
    const Precise rate = root(n.beta * zero.from_u3);
    const Precise& near = zero.is_below ? zero.from_u2 : zero.from_u1;
    const Precise nearness = zero.is_below ? zero.from_u1 / near : zero.from_u2 / near;
    const Precise root_near = rate.sign ? size(zero.d) / (rate * near) : root(nearness);
    means[i] = (mean * rate *
                integrate_third_kind(zero, root_near, k, mean, products, count)).scale(-1);
    if (zero.is_negative()) means[i] = -means[i];
  }
  return mean;
}

// _compute_shift_complement
inline double compute_shift_complement(const Zero& zero, const Roots& roots) {
  const Precise &g1 = zero.from_u1, &g2 = zero.from_u2, &g3 = zero.from_u3, s31 = roots.s31();
  if (zero.is_below) {
    const double share = (roots.s21 / g2).to_double();
    return std::sqrt((g1 / g2).to_double()) *
           integrate_rf_in_doubles(share, share * (g3 / s31).to_double());
  }
  if (!roots.s32.sign) return 0.0;
  const double share = (roots.s21 / g1).to_double();
  const double scale = std::sqrt((g2 / roots.s32 * s31 / g1).to_double());
  return scale * integrate_rf_in_doubles(share * (g3 / roots.s32).to_double(), share);
}

// ---- phases.py ----------------------------------------------------------------------------------

const int STEP_LIMBS = 4;  // 256 bits

struct Steps {  // Phases: up to three phases that grow at constant rates
  int exponent = 0;
  double ticks = 1.0, farthest = 0.0;  // per s; s
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

// Phases.__init__
inline Steps find_steps(const Precise* rates, int count) {
  Precise turns[FUNCTIONS];
  double fastest = 0.0;
  for (int i = 0; i < count; i++) {
    turns[i] = rates[i] * PER_TURN;
    fastest = std::fmax(fastest, std::fabs(turns[i].to_double()));
  }
  Steps steps;
  if (fastest) std::frexp(fastest, &steps.exponent), steps.exponent += 10;
  if (steps.exponent > 1000) steps.exponent = 1000;
  if (steps.exponent < -1000) steps.exponent = -1000;
  steps.ticks = std::ldexp(1.0, steps.exponent);
  steps.farthest = std::ldexp(1.0, 62 - steps.exponent > 1023 ? 1023 : 62 - steps.exponent);
  for (int i = 0; i < count; i++)
    steps.rest_rates[i] =
        2 * PI * truncate_step(turns[i].scale(-steps.exponent), steps.limbs[i]);
  return steps;
}

template <class R>
struct PhaseOf {
  Integer<R> turns;  // in units of 2^-64 turns, with sign
  R rest;            // to be added, in rad
};
typedef PhaseOf<double> Phase;

// _Counts.multiply
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

// Phases.at
inline void find_phases(const Steps& steps, int number, double t, Phase* phases) {
  const double ticks = t * steps.ticks, counts = round_to_integer(ticks), rest = ticks - counts;
  const int64_t count = static_cast<int64_t>(counts);
  for (int i = 0; i < number; i++)
    phases[i] = {multiply_step(steps.limbs[i], count), steps.rest_rates[i] * rest};
}

// Phase.radians
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

const int ENTRIES = 512;
static double ROWS[ENTRIES][4];  // cosines, sines and their rests: set by the module from phases.py

// Phase.unit
template <class R>
SYMTOP_INLINE PairOf<R> find_unit(const PhaseOf<R>& phase) {
  const Integer<R> shifted = phase.turns + (uint64_t(1) << 54);
  R row[4];
  read_row(ROWS, (shifted >> 55) & (ENTRIES - 1), row);
  const Integer<R> part = shifted & ((uint64_t(1) << 55) - 1);
  R angle = to_double(part - (uint64_t(1) << 54)) * (2 * PI * 0x1p-64);
  angle += phase.rest;
  const R square = angle * angle;
  const R s = angle + angle * (square * (square * (1.0 / 120) - 1.0 / 6));
  const R versine = square * (0.5 - square * (1.0 / 24 - square * (1.0 / 720)));
  return {row[0] + (row[2] - (row[0] * versine + row[1] * s)),
          row[1] + (row[3] + (row[0] * s - row[1] * versine))};
}

// ---- nutation_phase.py --------------------------------------------------------------------------

template <class R>
struct LocationOf {
  R x, below, above, low;
};
typedef LocationOf<double> Location;

struct NutationPhase {
  double Omega, K, Kc;
  bool is_stretched, is_separatrix, from_top;
  Pair origin;
  double ratio, ratio_high, ratio_low, root_of_nome;
  Location start;

  bool is_direct() const { return Kc >= K; }
  double shortest_change() const { return 0.5 / PI * (K < Kc ? K : Kc) / Omega; }
  Location lower_turning_point() const {
    return {0.0, 0.0, PI * (1.0 > K / Kc ? 1.0 : K / Kc), 0.0};
  }

  template <class R>
  SYMTOP_INLINE LocationOf<R> locate(R t, R high, R low) const {
    if (is_separatrix) {
      const R longest = repeat<R>(1e6 / Omega);
      R seconds = choose(t < longest, t, longest);
      seconds = choose(seconds < -longest, -longest, seconds);
      const R y = origin.x + 2 * Omega * seconds;
      return {0.0 * y, y, repeat<R>(INFINITY), R{}};
    }
    R total = high + origin.x;
    const R part = total - high;
    R error = (high - (total - part)) + (origin.x - part) + (low + origin.y);
    const R turns = round_to_integer(total / (2 * PI));
    total = total - turns * (2 * PI_HIGH);
    error = error - turns * (2 * PI_LOW);
    const R sign = find_sign(total), distance = find_size(total);
    const PairOf<R> near = {distance, sign * error}, far = {PI_HIGH - distance, PI_LOW - near.y};
    const PairOf<R> below = from_top ? far : near, above = from_top ? near : far;
    const R x = (below.x + below.y) * (from_top ? -sign : sign);
    if (is_direct()) return {x, x, above.x + above.y, R{}};
    return stretch(x, below, above);
  }

  template <class R>
  SYMTOP_INLINE LocationOf<R> stretch(R x, PairOf<R> below, PairOf<R> above) const {
    const R y = x * ratio, rise = (above.x + above.y) * ratio;
    if (!is_stretched) return {x, y, rise, R{}};
    const auto is_upper = rise < find_size(y);
    const R high = choose(is_upper, above.x, -below.x), low = choose(is_upper, above.y, -below.y);
    // find_rest
    const R product = (high + low) * ratio, shifted = 134217729.0 * high;
    const R upper = shifted - (shifted - high), lower = high - upper;
    const R rest = ((upper * ratio_high - product) + lower * ratio_high) +
                   (high * ratio_low + low * ratio_high);
    return {x, y, rise, rest};
  }
};

// _starting_phase
inline Precise find_starting_phase(const Nutation& n, const Roots& roots, bool is_precise,
                                   bool& from_top) {
  const Precise s1 = -roots.s1, &s2 = roots.s2, &s3 = roots.s3;
  const Precise &s21 = roots.s21, s31 = roots.s31(), &s32 = roots.s32;
  const auto integrate = [is_precise](const Precise& x, const Precise& y) {
    return is_precise ? integrate_rf(x, y)
                      : Precise(integrate_rf_in_doubles(x.to_double(), y.to_double()));
  };
  from_top = false;
  if (!s21.sign) return Precise();
  if (s2 * s2 * s31 >= s1 * s1 * s32) {
    const Precise v = root(s1 / s21) * integrate(s2 / s21, s3 / s31);
    return n.u_dot.sign < 0 ? -v : v;
  }
  from_top = true;
  const Precise per_product = invert(s21 * s3);
  const Precise v =
      root(s2 * s31 * per_product) * integrate(s32 * s1 * per_product, s32 / s3);
  return n.u_dot.sign < 0 ? v : -v;
}

inline bool comes_near_a_pole(const Zero zeros[]) {
  static const Precise NEAR_POLE = Precise(1.0) / Precise(100.0);
  return zeros[OF_A].from_u1 < NEAR_POLE * zeros[OF_A].from_u2 ||
         zeros[OF_B].from_u2 < NEAR_POLE * zeros[OF_B].from_u1;
}

// NutationPhase.__init__ and its cached properties
inline NutationPhase find_nutation_phase(const Nutation& n, const Roots& roots, const Zero zeros[],
                                         const Precise& mean, const Precise& frequency) {
  NutationPhase phase;
  phase.Omega = frequency.to_double() / 2;
  phase.is_separatrix = !mean.sign;
  phase.K = mean.sign ? PI / (2 * mean.to_double()) : INFINITY;
  const Precise modulus = root(roots.s21 / roots.s31());
  phase.Kc = quarter_period(modulus.to_double());
  phase.is_stretched = 1.5 * phase.Kc < phase.K;
  const Precise v = find_starting_phase(n, roots, phase.is_stretched || comes_near_a_pole(zeros),
                                        phase.from_top);
  const Precise origin = ((mean.sign ? mean : Precise(1.0)) * v).scale(1);
  phase.origin.x = origin.to_double();
  phase.origin.y = rest_of(origin, phase.origin.x);
  if (phase.is_stretched && mean.sign) {
    int count;
    const Precise ratio = iterate_mean(modulus, nullptr, count) / mean;
    phase.ratio = ratio.to_double();
    split_short(ratio, phase.ratio_high, phase.ratio_low);
    phase.root_of_nome = exponential(-(TWO_PI * ratio).scale(-2));
  } else {
    phase.ratio = phase.K / phase.Kc;
    phase.ratio_high = phase.ratio_low = 0.0;
    phase.root_of_nome = exponential(-PI / 2 * phase.K / phase.Kc);
  }
  phase.start = phase.locate(0.0, 0.0, 0.0);
  return phase;
}

// ---- direct_series.py ---------------------------------------------------------------------------

struct Shift {
  double sign, complement;
};

inline void raise_to_squares(double q, double powers[4]) {
  const double second = q * q, fourth = second * second, eighth = fourth * fourth;
  powers[0] = q, powers[1] = fourth, powers[2] = eighth * q, powers[3] = eighth * eighth;
}

const int DIVISOR = FUNCTIONS;  // place of the denominator among the numerators

struct DirectSeries {
  double K;
  int order, winding;
  double even[FUNCTIONS + 1][5], odd[FUNCTIONS][4], versines[FUNCTIONS + 1][5];

  static bool is_below(int k) { return k == OF_A || k == DIVISOR; }

  // _expand_numerator
  double expand(int k, double Kc, const Shift& shift) {
    const double rate = -PI / K, complement = shift.complement;
    double least = -exponential_minus_1(rate * complement);
    even[k][0] = 1.0;
    for (int n = 1; n < 5; n++) even[k][n] = odd[k][n - 1] = 0.0;
    for (int n = 1; n < 5; n++) {
      const int parity = n & 1 ? -1 : 1, own = is_below(k) ? parity : 1;
      const double large = exponential(rate * (Kc * (n * n - n) + complement * n));
      if (large < 0x1p-60) break;
      const double small = exponential(rate * (Kc * (n * n + n) - complement * n));
      even[k][n] = own * (small + large);
      odd[k][n - 1] = own * shift.sign * (small - large);
      least -= parity * small * exponential_minus_1(rate * complement * (2 * n + 1));
    }
    return least;
  }

  // _collect
  void collect(int k, double least) {
    static const int FACTORS[] = {2, 8, 2, 32};
    versines[k][0] = least;
    for (int n = 1; n < 5; n++) {
      const int parity = is_below(k) || !(n & 1) ? 1 : -1;
      versines[k][n] = -FACTORS[n - 1] * parity * even[k][n];
    }
  }

  void prepare(double K_, double Kc, const Shift shifts[], int winding_) {
    K = K_, winding = winding_, order = 1;
    for (int k = 0; k < FUNCTIONS; k++) {
      collect(k, expand(k, Kc, shifts[k]));
      for (int n = 2; n < 5; n++)
        if (even[k][n] != 0 && n > order) order = n;
    }
    double* divisor = even[DIVISOR];
    double powers[4];
    raise_to_squares(exponential(-PI * Kc / K), powers);
    divisor[0] = 1.0, divisor[1] = -2 * powers[0], divisor[2] = 2 * powers[1];
    divisor[3] = -2 * powers[2], divisor[4] = 2 * powers[3];
    double sum = 0.0;
    for (int n = 4; n >= 0; n--) sum += divisor[n];
    collect(DIVISOR, sum);
  }

  template <class R>
  static SYMTOP_INLINE R add(const double* coefficients, const R* basis, int count) {
    R total = coefficients[0] * basis[0];
    for (int n = 1; n < count; n++) total = total + coefficients[n] * basis[n];
    return total;
  }

  template <class R>
  SYMTOP_INLINE void compute_values(const LocationOf<R>& at, PairOf<R> values[FUNCTIONS]) const {
    // _find_half_angle
    const R distance = find_size(at.x);
    const auto is_lower = distance < at.above;
    const PairOf<R> near =
        cosine_and_sine_near_0<R>(0.5 * choose(is_lower, distance, at.above), R{});
    const R s = find_sign(at.x) * choose(is_lower, near.y, near.x);
    const R c = choose(is_lower, near.x, near.y);
    const R sine_x = 2 * s * c, cosine_x = (c - s) * (c + s);
    // _list_versines and _list_sines
    const R one = repeat<R>(1.0);
    R below[5] = {one, s * s}, above[5] = {one, c * c}, sines[4] = {sine_x};
    if (order > 1) {
      below[2] = above[2] = below[1] * above[1];
      sines[1] = 2 * sine_x * cosine_x;
    }
    if (order > 2) {
      R triple = 3 - 4 * below[1];
      below[3] = below[1] * (triple * triple);
      triple = 3 - 4 * above[1];
      above[3] = above[1] * (triple * triple);
      const R square = 4 * cosine_x * cosine_x;
      sines[2] = sine_x * (square - 1);
      sines[3] = sines[1] * (square - 2);
    }
    if (order > 3) below[4] = above[4] = below[2] * (cosine_x * cosine_x);
    const R per_divisor = 1 / add(versines[DIVISOR], below, order + 1);
    for (int k = 0; k < FUNCTIONS; k++)
      values[k] = {add(versines[k], is_below(k) ? below : above, order + 1) * per_divisor,
                   add(odd[k], sines, order) * per_divisor};
    const PairOf<R> turn = {cosine_x, winding < 0 ? sine_x : -sine_x};
    for (int n = 0; n < (winding < 0 ? -winding : winding); n++)
      values[OF_OMEGA_XY] = multiply(values[OF_OMEGA_XY], turn);
  }

  Pair compute_slope(int k, const Location& at) const {
    Pair values[FUNCTIONS];
    compute_values(at, values);
    double size = even[DIVISOR][0], rate_of_size = 0.0;
    Pair rate = {0.0, 0.0};
    for (int n = 1; n <= order; n++) {
      const Pair unit = cosine_and_sine(n * at.x);
      size += even[DIVISOR][n] * unit.x;
      rate_of_size -= n * even[DIVISOR][n] * unit.y;
      rate.x -= n * (even[k][n] * unit.y);
      rate.y += n * (odd[k][n - 1] * unit.x);
    }
    if (k == OF_OMEGA_XY && winding)
      rate = multiply(rate, conjugate(cosine_and_sine(winding * at.x)));
    const double scale = PI / K;
    return {scale * (rate.x - values[k].x * rate_of_size) / size,
            scale * (rate.y - values[k].y * rate_of_size) / size};
  }
};

// ---- complementary_series.py --------------------------------------------------------------------

struct Exponentials {
  double rising[5], falling[4];

  template <class R>
  SYMTOP_INLINE R sum(R h, R E) const {
    const double *c = rising, *d = falling;
    return c[0] + (h * (c[1] + h * (c[2] + h * (c[3] + h * c[4]))) +
                   E * (d[0] + E * (d[1] + E * (d[2] + E * d[3]))));
  }

  double slope(double h, double E) const {
    const double *c = rising, *d = falling;
    const double up = h * (c[1] + h * (2 * c[2] + h * (3 * c[3] + h * (4 * c[4]))));
    return up - E * (d[0] + E * (2 * d[1] + E * (3 * d[2] + E * (4 * d[3]))));
  }
};

template <class R>
struct BasisOf {
  R sign, decay, h, E, rising_gap, falling_gap, divisor;
};

struct ComplementarySeries {
  double K, Kc, root;
  int winding;
  Exponentials real[FUNCTIONS], imaginary[FUNCTIONS], theta_4;
  double angle[FUNCTIONS], versine[FUNCTIONS], sine[FUNCTIONS];

  static bool is_below(int k) { return k == OF_A; }
  int winding_of(int k) const { return k == OF_OMEGA_XY ? winding : 0; }

  // _expand_numerator
  void expand(int k, const double powers[5], const double inverses[5], const Shift& shift) {
    const double phi = shift.sign * PI * shift.complement / Kc;
    const double *of_h = is_below(k) ? inverses : powers, *of_E = is_below(k) ? powers : inverses;
    for (int n = 0; n < 5; n++) {
      const Pair turn = cosine_and_sine(phi * n);
      real[k].rising[n] = of_h[n] * turn.x;
      imaginary[k].rising[n] = -of_h[n] * turn.y;
      if (n) real[k].falling[n - 1] = of_E[n] * turn.x;
      if (n) imaginary[k].falling[n - 1] = of_E[n] * turn.y;
    }
    angle[k] = shift.sign * PI * (1 - shift.complement / Kc);
    const double half_sine = cosine_and_sine(phi / 2).y;
    versine[k] = 2 * half_sine * half_sine;
    sine[k] = cosine_and_sine(phi).y;
  }

  void prepare(double K_, double Kc_, const Shift shifts[], int winding_, double root_of_nome) {
    K = K_, Kc = Kc_, winding = winding_, root = root_of_nome;
    const double q = exponential(-PI * K / Kc);
    const double q2 = q * q, q4 = q2 * q2, q8 = q4 * q4, q16 = q8 * q8;
    const double q5 = q4 * q, q6 = q4 * q2, q9 = q8 * q, q10 = q8 * q2, q12 = q8 * q4;
    const double q20 = q16 * q4;
    // _sum_powers
    const double powers[5] = {1 - (q2 - (q6 - (q12 - q20))), -(q2 - (q6 - (q12 - q20))),
                              q6 - (q12 - q20), -(q12 - q20), q20};
    const double inverses[5] = {powers[0], -(q - (q5 - (q10 * q - q16 * q2 * q))),
                                q4 - (q10 - q16 * q2), -(q9 - q16 * q), q16};
    for (int k = 0; k < FUNCTIONS; k++) expand(k, powers, inverses, shifts[k]);
    theta_4.rising[0] = theta_4.falling[0] = 1.0;
    raise_to_squares(q, theta_4.rising + 1);
    theta_4.falling[1] = q2, theta_4.falling[2] = q6, theta_4.falling[3] = q12;
  }

  // _find_basis and _find_decay
  template <class R>
  SYMTOP_INLINE BasisOf<R> find_basis(const LocationOf<R>& at) const {
    const R distance = find_size(at.below);
    const auto is_upper = at.above < distance;
    R decay = choose(is_upper, repeat<R>(root), repeat<R>(1.0)) *
              exponential<R>(choose(is_upper, at.above, -distance) / 2);
    decay = decay + decay * (0.5 * at.low);
    const PairOf<R> rise = expand_exponential<R>(-at.above);
    const R h = rise.x + rise.x * rise.y, E = decay * decay;
    return {find_sign(at.below), decay, h, E, (1.0 - rise.x) - rise.x * rise.y,
            -exponential_minus_1<R>(-distance), theta_4.sum(h, E)};
  }

  // _sum_cofactor
  template <class R>
  SYMTOP_INLINE PairOf<R> sum_cofactor(int k, const BasisOf<R>& basis) const {
    return {real[k].sum(basis.h, basis.E), basis.sign * imaginary[k].sum(basis.h, basis.E)};
  }

  // _compute_one_minus_w
  template <class R>
  SYMTOP_INLINE PairOf<R> compute_one_minus_w(int k, const BasisOf<R>& basis) const {
    if (is_below(k))
      return {versine[k] * basis.E + basis.falling_gap, -sine[k] * (basis.sign * basis.E)};
    return {versine[k] * basis.h + basis.rising_gap, sine[k] * (basis.sign * basis.h)};
  }

  template <class R>
  SYMTOP_INLINE void compute_values(const LocationOf<R>& at, PairOf<R> values[FUNCTIONS]) const {
    const BasisOf<R> basis = find_basis(at);
    for (int k = 0; k < FUNCTIONS; k++) {
      const R size = (is_below(k) ? repeat<R>(1.0) : basis.decay) / basis.divisor;
      R phase = (angle[k] / (2 * PI) + winding_of(k)) * at.x;
      if (is_below(k)) phase = phase - basis.sign * (0.5 * angle[k]);
      const PairOf<R> numerator = multiply(sum_cofactor(k, basis), compute_one_minus_w(k, basis));
      const PairOf<R> unit = cosine_and_sine(phase);
      values[k] = multiply(numerator, PairOf<R>{size * unit.x, -size * unit.y});
    }
  }

  Pair compute_slope(int k, Location at) const {
    Pair values[FUNCTIONS];
    compute_values(at, values);
    at.low = 0.0;
    const Pair value = values[k];
    const BasisOf<double> basis = find_basis(at);
    const double sign = basis.sign, h = basis.h, E = basis.E;
    const Pair factor = compute_one_minus_w(k, basis), cofactor = sum_cofactor(k, basis);
    const Pair cofactor_slope = {real[k].slope(h, E), sign * imaginary[k].slope(h, E)};
    const Pair w_slope = is_below(k) ? Pair{1 - factor.x, -factor.y} : Pair{factor.x - 1, factor.y};
    const Pair first = multiply(cofactor_slope, factor), second = multiply(cofactor, w_slope);
    const double turn = angle[k] / (2 * PI);
    double phase = turn * at.x + winding_of(k) * at.x;
    if (is_below(k)) phase -= 0.5 * sign * angle[k];
    const Pair unit = cosine_and_sine(phase);
    const double size = (is_below(k) ? 1.0 : basis.decay) / basis.divisor;
    const Pair sum = {first.x + second.x, first.y + second.y};
    const Pair rate = multiply(sum, Pair{size * unit.x, -size * unit.y});
    const double falling = theta_4.slope(h, E) / basis.divisor + (is_below(k) ? 0.0 : 0.5);
    const double in_y = sign * PI / Kc, in_x = PI / K * turn;
    return {in_y * (rate.x - value.x * falling) + in_x * value.y,
            in_y * (rate.y - value.y * falling) - in_x * value.x};
  }
};

// ---- first_instants.py --------------------------------------------------------------------------

const int TERMS = 14;

struct Series {
  double real[TERMS + 1], imaginary[TERMS + 1];

  Pair sum_powers(double time) const {
    double x = real[TERMS] * time, y = imaginary[TERMS] * time;
    for (int n = TERMS - 1; n > 0; n--) {
      x = (x + real[n]) * time;
      y = (y + imaginary[n]) * time;
    }
    return {x + real[0], y + imaginary[0]};
  }
};

// _convolve
inline Pair convolve(const Series& left, const Series& right, int n) {
  double real = 0.0, imaginary = 0.0;
  for (int m = 0; m <= n; m++) {
    const double x = left.real[m], y = left.imaginary[m];
    const double u = right.real[n - m], v = right.imaginary[n - m];
    real += x * u - y * v;
    imaginary += x * v + y * u;
  }
  return {real, imaginary};
}

// _convolve_with_conjugate
inline Pair convolve_with_conjugate(const Series& left, const Series& right, int n) {
  double real = 0.0, imaginary = 0.0;
  for (int m = 0; m <= n; m++) {
    const double x = left.real[m], y = left.imaginary[m];
    const double u = right.real[n - m], v = right.imaginary[n - m];
    real += x * u + y * v;
    imaginary += y * u - x * v;
  }
  return {real, imaginary};
}

inline double find_fastest_rate(const Start& s) {
  const double rates = find_modulus({s.wx, s.wy}), spin = std::fabs(s.wz) * (s.Iz / s.Ix);
  const double weight = std::sqrt(2 * (s.Mgl / s.Ix));
  return std::fmax(std::fmax(rates, spin), std::fmax(weight, 1e-290));
}

struct FirstInstants {
  double unit;
  Series A, B, omega;
  Steps half_turn;

  void prepare(const Start& s, Pair A0, Pair B0, const Precise& half_c) {
    int exponent;
    std::frexp(find_fastest_rate(s), &exponent);
    unit = std::ldexp(1.0, exponent);
    const double half_spin = 0.5 * (s.wz / unit) * (s.Iz / s.Ix);
    const double beta = 2 * (s.Mgl / s.Ix / unit) / unit;
    A.real[0] = A0.x, A.imaginary[0] = A0.y, B.real[0] = B0.x, B.imaginary[0] = B0.y;
    omega.real[0] = s.wx / unit, omega.imaginary[0] = s.wy / unit;
    for (int n = 0; n < TERMS; n++) {
      const Pair over = convolve_with_conjugate(B, omega, n), along = convolve(omega, A, n);
      const Pair weight = convolve_with_conjugate(B, A, n);
      const int order = n + 1;
      omega.real[order] = beta * weight.x / order, omega.imaginary[order] = beta * weight.y / order;
      A.real[order] = (-half_spin * A.imaginary[n] - over.x / 2) / order;
      A.imaginary[order] = (half_spin * A.real[n] - over.y / 2) / order;
      B.real[order] = (along.x / 2 + half_spin * B.imaginary[n]) / order;
      B.imaginary[order] = (along.y / 2 - half_spin * B.real[n]) / order;
    }
    half_turn = find_steps(&half_c, 1);
  }

  void compute(double seconds, const Phase& phase, Pair values[FUNCTIONS]) const {
    const double time = unit * seconds;
    const Pair turn = find_unit(phase), back = conjugate(turn);
    const Pair rate = multiply(multiply(omega.sum_powers(time), back), back);
    values[OF_A] = multiply(A.sum_powers(time), turn);
    values[OF_B] = multiply(B.sum_powers(time), back);
    values[OF_OMEGA_XY] = {rate.x * unit, rate.y * unit};
  }
};

// ---- closed_form.py -----------------------------------------------------------------------------

template <class R>
struct AttitudeOf {  // a state without omega_z, which is constant
  R w, x, y, z, omega_x, omega_y;
};
typedef AttitudeOf<double> Attitude;

struct ClosedForm {
  Start start;
  bool is_turned_over, has_first_instants = false;
  Pair start_values[FUNCTIONS];
  Precise half_c;
  double first_end;
  Steps steps;
  NutationPhase nutation_phase;
  DirectSeries direct;
  ComplementarySeries complementary;
  Pair factors[FUNCTIONS];
  FirstInstants first_instants;

  // ClosedFormMotion.__init__, _series and _factors
  void prepare(const Start& given, bool turned_over) {
    start = given, is_turned_over = turned_over;
    const Nutation n = find_nutation(start);
    const Roots roots = find_roots(n);
    Zero zeros[FUNCTIONS];
    find_zeros(n, roots, zeros);
    Precise means[FUNCTIONS];
    const Precise mean = compute_mean_rates(n, zeros, root(roots.s32 / roots.s31()), means);
    const Precise frequency = root(n.beta * roots.s31()), nutation_rate = frequency * mean;
    const Precise Ix(start.Ix), Iz(start.Iz), wz(start.wz);
    half_c = (wz * (Ix - Iz) / Ix).scale(-1);
    const Precise rates[FUNCTIONS] = {nutation_rate, means[OF_A] + half_c, means[OF_B] - half_c};
    steps = find_steps(rates, FUNCTIONS);
    first_end = 0.1 / find_fastest_rate(start);
    nutation_phase = find_nutation_phase(n, roots, zeros, mean, frequency);
    Shift shifts[FUNCTIONS];
    for (int k = 0; k < FUNCTIONS; k++) {
      const double complement = compute_shift_complement(zeros[k], roots);
      shifts[k] = {zeros[k].is_negative() ? -1.0 : 1.0,
                   nutation_phase.Kc < complement ? nutation_phase.Kc : complement};
    }
    int winding = 0;
    if (nutation_rate.sign) {
      const Precise difference = means[OF_A] - means[OF_B] - means[OF_OMEGA_XY] - n.a.scale(-1);
      winding = static_cast<int>(round_to_integer((difference / nutation_rate).to_double()));
    }
    if (nutation_phase.is_direct())
      direct.prepare(nutation_phase.K, nutation_phase.Kc, shifts, winding);
    else
      complementary.prepare(nutation_phase.K, nutation_phase.Kc, shifts, winding,
                            nutation_phase.root_of_nome);
    find_factors(n, zeros, means);
  }

  template <class R>
  SYMTOP_INLINE void compute_series(const LocationOf<R>& at, PairOf<R> values[FUNCTIONS]) const {
    if (nutation_phase.is_direct())
      direct.compute_values(at, values);
    else
      complementary.compute_values(at, values);
  }

  // _initial_values
  void find_initial_values(Pair changes[FUNCTIONS]) {
    const Start& s = start;
    double norm = std::sqrt((s.w * s.w + s.z * s.z) + (s.x * s.x + s.y * s.y));
    if (std::fabs(norm - 1.0) <= 4 * 0x1p-52) norm = 1.0;
    const double w = s.w / norm, x = s.x / norm, y = s.y / norm, z = s.z / norm;
    const Pair A = {w, z}, B = {x, y}, omega_xy = {s.wx, s.wy};
    const double spin = 0.5 * s.wz * (s.Iz / s.Ix), weight = 2 * (s.Mgl / s.Ix);
    const Pair of_A = multiply_by_conjugate(B, omega_xy), of_B = multiply(omega_xy, A);
    const Pair of_omega_xy = multiply_by_conjugate(B, A);
    start_values[OF_A] = A, start_values[OF_B] = B, start_values[OF_OMEGA_XY] = omega_xy;
    changes[OF_A] = {-spin * z - of_A.x / 2, spin * w - of_A.y / 2};
    changes[OF_B] = {of_B.x / 2 + spin * y, of_B.y / 2 - spin * x};
    changes[OF_OMEGA_XY] = {weight * of_omega_xy.x - spin * s.wy,
                            weight * of_omega_xy.y + spin * s.wx};
  }

  // _factors, with Quotient.find_factor
  void find_factors(const Nutation& n, const Zero zeros[], const Precise means[]) {
    Pair changes[FUNCTIONS], values[FUNCTIONS];
    find_initial_values(changes);
    changes[OF_OMEGA_XY] = conjugate(changes[OF_OMEGA_XY]);
    const Precise from_start[] = {n.one_plus_u, n.one_minus_u, n.omega_xy_squared / n.beta};
    compute_series(nutation_phase.start, values);
    for (int k = 0; k < FUNCTIONS; k++) {
      const Pair at_start =
          k == OF_OMEGA_XY ? conjugate(start_values[k]) : start_values[k];
      const bool is_small =
          from_start[k].scale(2) <
          (zeros[k].from_u1 > zeros[k].from_u2 ? zeros[k].from_u1 : zeros[k].from_u2);
      factors[k] = find_factor(k, at_start, changes[k], values[k], means[k].to_double(), is_small);
    }
    const double modulus = find_modulus(factors[OF_OMEGA_XY]);
    if (modulus) {
      compute_series(nutation_phase.lower_turning_point(), values);
      const double largest = std::sqrt((n.beta * zeros[OF_OMEGA_XY].from_u1).to_double());
      const double share = largest / find_modulus(values[OF_OMEGA_XY]) / modulus;
      factors[OF_OMEGA_XY] = {factors[OF_OMEGA_XY].x * share, factors[OF_OMEGA_XY].y * share};
    }
    factors[OF_OMEGA_XY] = conjugate(factors[OF_OMEGA_XY]);
  }

  Pair find_factor(int k, Pair at_start, Pair change, Pair value, double mean,
                   bool is_small) const {
    if (is_small) {
      const Location& at = nutation_phase.start;
      Pair slope = nutation_phase.is_direct() ? direct.compute_slope(k, at)
                                              : complementary.compute_slope(k, at);
      slope = {slope.x * nutation_phase.Omega, slope.y * nutation_phase.Omega};
      if (find_modulus(value) < nutation_phase.shortest_change() * find_modulus(slope))
        return divide({change.x + mean * at_start.y, change.y - mean * at_start.x}, slope);
    }
    return divide(at_start, value);
  }

  // _evaluate
  template <class R>
  SYMTOP_INLINE void evaluate(R t, const PhaseOf<R> phases[FUNCTIONS],
                              PairOf<R> values[FUNCTIONS]) const {
    const PairOf<R> radians = find_radians(phases[0]);
    const LocationOf<R> at = nutation_phase.locate(t, radians.x, radians.y);
    const PairOf<R> turn_A = find_unit(phases[1]), turn_B = find_unit(phases[2]);
    const PairOf<R> turn_omega = multiply_by_conjugate(turn_B, turn_A);
    PairOf<R> series[FUNCTIONS];
    compute_series(at, series);
    values[OF_A] = multiply(multiply(factors[OF_A], series[OF_A]), turn_A);
    values[OF_B] = multiply(multiply(factors[OF_B], series[OF_B]), turn_B);
    values[OF_OMEGA_XY] = multiply(
        multiply_by_conjugate(factors[OF_OMEGA_XY], series[OF_OMEGA_XY]), turn_omega);
  }

  // Motion._evaluate
  template <class R>
  SYMTOP_INLINE AttitudeOf<R> complete(const PairOf<R> values[FUNCTIONS]) const {
    R w = values[OF_A].x, z = values[OF_A].y, x = values[OF_B].x, y = values[OF_B].y;
    if (is_turned_over) {
      const R w_before = w, y_before = y;
      w = x, x = -w_before, y = z, z = -y_before;
    }
    const R upper = w * w + z * z, lower = x * x + y * y;
    const R step = 0.5 - 0.5 * (upper + lower), share = step * (upper - lower);
    const R of_B = step - upper * share, of_A = of_B + share;
    return {w + w * of_A, x + x * of_B, y + y * of_B, z + z * of_A, values[OF_OMEGA_XY].x,
            values[OF_OMEGA_XY].y};
  }

  // True if a time is too long for a count of ticks: Python serves it.
  bool is_far(double t) {
    if (std::fabs(t) > first_end) return std::fabs(t) >= steps.farthest;
    prepare_first_instants();
    return std::fabs(t) >= first_instants.half_turn.farthest;
  }

  // Before a time within the first instants.
  void prepare_first_instants() {
    if (has_first_instants) return;
    first_instants.prepare(start, start_values[OF_A], start_values[OF_B], half_c);
    has_first_instants = true;
  }

  // ClosedFormMotion.cayley_klein, for a time that is not far
  Attitude at(double t) {
    if (t == 0) return complete(start_values);
    Pair values[FUNCTIONS];
    Phase phases[FUNCTIONS];
    if (std::fabs(t) <= first_end) {
      prepare_first_instants();
      find_phases(first_instants.half_turn, 1, t, phases);
      first_instants.compute(t, phases[0], values);
    } else {
      find_phases(steps, FUNCTIONS, t, phases);
      evaluate(t, phases, values);
    }
    return complete(values);
  }
};

}  // namespace symtop

// Starts of a top from what is seen of its motion (derivation.md, section 12).
//
// Numbers that are given are doubles, and exact. What would cancel is formed with 134 digits, and
// rounded at the end.
#pragma once

#include "regular.hpp"

namespace symtop {

inline void refuse(symtop_solutions& found, symtop_demand demand, double which = 0.0,
                   double least = NAN, double most = NAN) {
  found.demand = demand;
  found.which = which;
  found.least = least;
  found.most = most;
}

inline bool is_in_range(double x) { return std::fabs(x) <= LARGEST; }

// A start whose rates are too large for a motion is no solution; if there is no other, they are
// why.
inline void keep(symtop_solutions& found, const symtop_solution& start) {
  const bool is_kept =
      is_in_range(start.theta_dot) && is_in_range(start.phi_dot) && is_in_range(start.psi_dot);
  if (is_kept)
    found.each[static_cast<int>(found.number++)] = start;
  else
    found.demand = SYMTOP_DEMANDS_RATES;
}

inline bool has_none(const symtop_solutions& found) {
  return found.number == 0 && found.demand != SYMTOP_DEMANDS_RATES;
}

// The place at which `is_below` becomes false, between two positive numbers, to 60 bits more than a
// double has. Exponents are halved first: they may be any, as neither a tilt nor a weight has a
// smallest one.
template <class Number, class Below>
Number bisect(Number low, Number high, const Below& is_below) {
  while (high.exponent - low.exponent > 1) {
    Number middle(0.5);
    middle.exponent = low.exponent + (high.exponent - low.exponent) / 2;
    (is_below(middle) ? low : high) = middle;
  }
  for (int bits = 0; bits < 114; bits++) {
    const Number middle = (low + high).scale(-1);
    (is_below(middle) ? low : high) = middle;
  }
  return low;
}

// ---- Regular precession ----

// psi' of the tilt and phi' = +-2 pi/T: the quadratic of regular precession is linear in psi'.
inline void solve_tilt_and_turn(const symtop_top& top, double theta, double period,
                                symtop_solutions& found) {
  const Long centrifugal = (Long(top.Ix) - Long(top.Iz)) * find_long_cosine(theta);
  for (const double sign : {1.0, -1.0}) {
    const Long rate = Long(TWO_PI) / Long(sign * period);
    const Long spin = (centrifugal * rate * rate + Long(top.Mgl)) / (Long(top.Iz) * rate);
    keep(found, {theta, 0.0, rate.to_double(), spin.to_double()});
  }
  if (has_none(found)) refuse(found, SYMTOP_DEMANDS_REGULAR, 1);
}

// A spin below 2 sqrt((Ix - Iz) cos(theta) Mgl)/Iz has no regular rate. Without spin, weight and
// centrifugal torque each rate is one.
inline void solve_tilt_and_spin(const symtop_top& top, double theta, double psi_dot,
                                symtop_solutions& found) {
  double rates[2];
  find_regular_rates(top, theta, psi_dot, SYMTOP_SPIN_RATE, rates);
  for (const bool is_positive : {true, false})
    for (int k = 0; k < (rates[0] == rates[1] ? 1 : 2); k++)  // a double root is one start
      if (!std::isnan(rates[k]) && (rates[k] > 0) == is_positive)
        keep(found, {theta, 0.0, rates[k], psi_dot});
  if (!has_none(found)) return;
  const Long product = (Long(top.Ix) - Long(top.Iz)) * find_long_cosine(theta) * Long(top.Mgl);
  double least = product.sign > 0 ? (root(product).scale(1) / Long(top.Iz)).to_double() : 0.0;
  // The nearest double may be below the least spin, and the next one is above it.
  find_regular_rates(top, theta, least, SYMTOP_SPIN_RATE, rates);
  if (least > 0 && std::isnan(rates[0])) least = std::nextafter(least, INFINITY);
  const symtop_demand other = top.Mgl == 0 ? SYMTOP_DEMANDS_SPIN : SYMTOP_DEMANDS_REGULAR;
  refuse(found, least > 0 ? SYMTOP_DEMANDS_SIZE : other, 1, least);
}

// |Iz psi' p - Mgl| < |Ix - Iz| p^2 for one of the two directions: |psi'| lies between the
// quotients of |Mgl| -+ |Ix - Iz| p^2 and Iz |p|. If the smaller one is negative, every smaller
// spin does.
inline void refuse_spin_and_turn(const symtop_top& top, const Long& pace, symtop_solutions& found) {
  const Long weight = size(Long(top.Mgl)), per_spin = invert(Long(top.Iz) * pace);
  const Long whole = size(Long(top.Ix) - Long(top.Iz)) * pace * pace;
  const Long least = (weight - whole) * per_spin, most = (weight + whole) * per_spin;
  refuse(found, SYMTOP_DEMANDS_RANGE, 0, least.sign < 0 ? NAN : least.to_double(),
         most.to_double());
}

// cos(theta) = N/D with N = Iz psi' p - Mgl and D = (Ix - Iz) p^2. The half angle has the tangent
// sqrt((D - N)/(D + N)): an arc cosine would lose half the digits next to the vertical.
inline void solve_spin_and_turn(const symtop_top& top, double psi_dot, double period,
                                symtop_solutions& found) {
  const Long difference = Long(top.Ix) - Long(top.Iz);
  if (!difference.sign) return refuse(found, SYMTOP_DEMANDS_UNEQUAL);
  const Long pace = Long(TWO_PI) / Long(period), whole = difference * pace * pace;
  for (const double sign : {1.0, -1.0}) {
    const Long rate = pace * Long(sign);
    const Long share = Long(top.Iz) * Long(psi_dot) * rate - Long(top.Mgl);
    const Long above = whole - share, below = whole + share;
    if (above.sign * below.sign <= 0) continue;  // |N| < |D| does not hold
    const double tangent = root(above / below).to_double();
    keep(found, {2 * arc_tangent(tangent, 1.0), 0.0, rate.to_double(), psi_dot});
  }
  if (has_none(found)) refuse_spin_and_turn(top, pace, found);
}

// ---- Let go at rest ----

// With p_psi^2 = 2 |Mgl| Ix x, and both signs.
inline void keep_spins(const symtop_top& top, double theta, const Precise& x,
                       symtop_solutions& found) {
  const Precise momentum = root(x.scale(1) * size(Precise(top.Mgl)) * Precise(top.Ix));
  const double spin = (momentum / Precise(top.Iz)).to_double();
  keep(found, {theta, 0.0, 0.0, spin});
  if (spin > 0) keep(found, {theta, 0.0, 0.0, -spin});
}

// The axis comes to rest again where x (cos(theta) - cos(end)) = sin(end)^2, x as above. The
// difference is 2 sin(theta + dip/2) sin(dip/2). The sums are exact: next to pi, what that of two
// doubles loses is more than rounding.
inline void solve_tilt_and_dip(const symtop_top& top, double theta, double dip,
                               symtop_solutions& found) {
  if (top.Mgl == 0) return refuse(found, SYMTOP_DEMANDS_WEIGHT);
  const double way = std::copysign(dip, top.Mgl), nearest = theta + way;
  const double most = top.Mgl > 0 ? PI - theta : theta;
  if (!(nearest >= 0 && nearest <= PI)) return refuse(found, SYMTOP_DEMANDS_POSITIVE, 1, NAN, most);
  const Long end = Long(theta) + Long(way), half = Long(theta) + Long(way).scale(-1);
  // The double next to pi is the vertical, and so is what a sum that rounds to it has beyond.
  const Long sine = end >= Long(PI) ? Long() : find_long_sine(end);
  const Long difference = find_long_sine(half) * find_long_sine(Long(dip).scale(-1));
  keep_spins(top, theta, Precise(sine * sine / difference.scale(1)), found);
}

// sqrt(r)/agm(1, sqrt(1 + r^2)): the nutation period in its unit. It grows up to LONGEST_AT.
inline Precise find_relative_period(const Precise& r) {
  int count;
  const Precise one(1.0), modulus = root(one + r * r);
  // agm(1, m) = m agm(1, 1/m): the mean is taken of a number up to 1.
  return root(r) / (modulus * iterate_agm<3>(invert(modulus), nullptr, count));
}

const double LONGEST_AT = 2.179660431678698;

// The r between two, in which the period grows or falls, at which it is a given one.
inline Precise find_period_at(const Precise& period, const Precise& low, const Precise& high,
                              bool grows) {
  return bisect(low, high,
                [&](const Precise& r) { return (find_relative_period(r) < period) == grows; });
}

// With r between 0, for an infinite spin, and R = cot(theta/2), for none, of a top with Mgl > 0.
// The spin next to a pendulum's comes from R - r, and so both are precise.
struct LetGo {
  Precise sine, R, per_unit;  // 1/s, of the unit 2 pi sqrt(Ix/(2 |Mgl| sin(theta)))

  LetGo(const symtop_top& top, double theta) {
    const Long half = Long(theta).scale(-1), quarter_turn(find_long_turn().scale(-2));
    const Precise s(find_long_sine(half)), c(find_long_sine(quarter_turn - half));
    sine = (s * c).scale(1);
    R = top.Mgl > 0 ? c / s : s / c;
    per_unit = root(size(Precise(top.Mgl)).scale(1) * sine / Precise(top.Ix)) * PER_TURN;
  }

  Precise find_x(const Precise& r) const {
    const Precise x = sine * (R - r) * (Precise(1.0) + invert(r * R));
    return x.sign < 0 ? Precise() : x;
  }
};

// A period is a rounded number: up to 16 EPS beyond the longest one it is the longest, and up to 16
// EPS below the pendulum's, where no slow spin would be left, the pendulum's.
inline void solve_tilt_and_nutation(const symtop_top& top, double theta, double period,
                                    symtop_solutions& found) {
  if (top.Mgl == 0) return refuse(found, SYMTOP_DEMANDS_WEIGHT);
  const LetGo go(top, theta);
  const bool is_folded = go.R > Precise(LONGEST_AT);  // there are periods beyond the pendulum's
  const Precise still = find_relative_period(go.R), asked = Precise(period) * go.per_unit;
  const Precise longest = is_folded ? find_relative_period(Precise(LONGEST_AT)) : still;
  if (asked > longest * Precise(1 + 16 * EPS))
    return refuse(found, SYMTOP_DEMANDS_POSITIVE, 1, NAN, (longest / go.per_unit).to_double());
  const auto keep_at = [&](const Precise& r) { keep_spins(top, theta, go.find_x(r), found); };
  if (asked >= longest) return keep_at(is_folded ? Precise(LONGEST_AT) : go.R);
  const Precise fold(LONGEST_AT), end = go.R * Precise(1 + EPS);  // not below R
  // agm(1, ...) >= 1, so that r >= asked^2.
  const Precise square = (asked * asked).scale(-1), least = end.scale(-2);
  keep_at(find_period_at(asked, square < least ? square : least, is_folded ? fold : end, true));
  if (!is_folded || asked < still * Precise(1 - 16 * EPS)) return;
  keep_at(asked < still ? go.R : find_period_at(asked, fold, end, false));
}

// ---- Constants ----

const double LEAST_Q = 0x1p-1000, MOST_Q = 0x1p1000;  // the tilts of which the axis is vertical

// Goldstein's alpha, a and b, and Mgl/Ix. With q = tan(theta/2)^2 the axis can be where
//
//   h(q) = 4 alpha q (1 + q) - 8 (Mgl/Ix) q (1 - q) - (1 + q) ((b - a) + (b + a) q)^2 >= 0,
//
// as theta'^2 = h/(4 q (1 + q)). Its sums are formed of numbers of 134 digits.
struct Well {
  Long alpha, a, b, weight;

  Long at(const Long& q) const {
    const Long one(1.0), turn = (b - a) + (b + a) * q;
    return (alpha.scale(2) * q - turn * turn) * (one + q) - weight.scale(3) * q * (one - q);
  }

  // The sign of the slope of the effective potential: it has one zero, the bottom.
  int find_slope(const Long& q) const {
    const Long one(1.0), square = (one + q) * (one + q);
    const Long out = (b - a) * (b - a), in = (b + a) * (b + a) * q * q;
    return ((in - out) * square - weight.scale(4) * q * q).sign;
  }

  // theta'^2 at a place, in 1/s^2: below 0 it is what the energy lacks, times 2/Ix.
  Long find_square(const Long& q) const { return at(q) / ((Long(1.0) + q) * q).scale(2); }

  Long find_bottom() const {
    return bisect(Long(LEAST_Q), Long(MOST_Q), [&](const Long& q) { return find_slope(q) < 0; });
  }
};

// On the vertical the axis has all of theta'^2, and psi' counts the whole spin.
inline symtop_solution start_on_vertical(const Well& well, bool is_upright, const Long& spin) {
  const Long weight = well.weight.scale(1), square = well.alpha + (is_upright ? -weight : weight);
  const double rate = square.sign > 0 ? root(square).to_double() : 0.0;
  return {is_upright ? 0.0 : PI, rate, 0.0, spin.to_double()};
}

inline symtop_solution start_at(const Well& well, const Long& q, const Long& spin) {
  const double place = q.to_double(), theta = 2 * arc_tangent(std::sqrt(place), 1.0);
  // Next to pi, too: there phi' would be that of a place that no double is.
  if (place <= 2 * LEAST_Q || theta >= PI) return start_on_vertical(well, place < 1, spin);
  const Long one(1.0), turn = (well.b - well.a) + (well.b + well.a) * q;
  const Long rate = turn * (one + q) / q.scale(2);
  const Long psi_dot = spin - rate * (one - q) / (one + q);
  return {theta, 0.0, rate.to_double(), psi_dot.to_double()};
}

// Constants of a motion. `rounding` is that of the energy, times 2/Ix, up to which a regular
// precession has too little of it, or too much.
struct Conserved {
  Well well;
  Long spin, rounding;  // omega_z
};

inline Conserved read_constants(const symtop_top& top, const double known[3]) {
  const Long Ix(top.Ix), momentum(known[2]), spin = momentum / Long(top.Iz);
  const Long along = momentum * spin;
  const Long terms = (size(Long(known[0])).scale(1) + along + size(Long(top.Mgl)).scale(1)) / Ix;
  return {{(Long(known[0]).scale(1) - along) / Ix, momentum / Ix, Long(known[1]) / Ix,
           Long(top.Mgl) / Ix},
          spin,
          terms * Long(START_ROUNDING)};
}

inline Conserved read_goldstein(const symtop_top& top, const double known[3]) {
  const Long Ix(top.Ix), a(known[1]), alpha(known[0]), weight = Long(top.Mgl) / Ix;
  const Long terms = size(alpha) + size(weight).scale(1);
  return {{alpha, a, Long(known[2]), weight}, a * Ix / Long(top.Iz), terms * Long(START_ROUNDING)};
}

// The turning angles of what has these constants. Returns what the energy lacks, times 2/Ix, or 0.
inline Long solve_well(const Conserved& known, symtop_solutions& found) {
  const Well& well = known.well;
  const Long bottom = well.find_bottom(), square = well.find_square(bottom);
  if (size(square) <= known.rounding) {
    keep(found, start_at(well, bottom, known.spin));
    return Long();
  }
  if (square.sign < 0) return -square;
  const auto lacks = [&](const Long& q) { return well.at(q).sign < 0; };
  const auto has = [&](const Long& q) { return well.at(q).sign >= 0; };
  const Long first = bisect(Long(LEAST_Q), bottom, lacks), last = bisect(bottom, Long(MOST_Q), has);
  const symtop_solution high = start_at(well, first, known.spin);
  const symtop_solution low = start_at(well, last, known.spin);
  // What only approaches the vertical starts at its other turning angle.
  const auto moves = [](const symtop_solution& start) {
    return start.theta_dot > 0 || (start.theta > 0 && start.theta < PI);
  };
  if (moves(high) || !moves(low)) keep(found, high);
  if (moves(low) && low.theta != high.theta) keep(found, low);
  return Long();
}

inline void solve_constants(const symtop_top& top, const double known[3], symtop_solutions& found) {
  const Long lacking = solve_well(read_constants(top, known), found);
  if (!has_none(found)) return;
  const Long least = Long(known[0]) + (lacking * Long(top.Ix)).scale(-1);
  refuse(found, SYMTOP_DEMANDS_LEAST, 0, least.to_double());
}

inline void solve_goldstein(const symtop_top& top, const double known[3], symtop_solutions& found) {
  const Long lacking = solve_well(read_goldstein(top, known), found);
  if (!has_none(found)) return;
  refuse(found, SYMTOP_DEMANDS_LEAST, 0, (Long(known[0]) + lacking).to_double());
}

// ---- All of them ----

struct Question {
  int numbers;
  int tilt, duration;  // which of them must be between 0 and pi, and which above 0; -1 for none
  void (*solve)(const symtop_top&, const double*, symtop_solutions&);
};

template <void (*solve)(const symtop_top&, double, double, symtop_solutions&)>
void solve_two(const symtop_top& top, const double* known, symtop_solutions& found) {
  solve(top, known[0], known[1], found);
}

// In the order of symtop_question.
inline const Question& find_question(symtop_question seen) {
  static const Question QUESTIONS[] = {
      {2, 0, 1, solve_two<solve_tilt_and_turn>},
      {2, 0, -1, solve_two<solve_tilt_and_spin>},
      {2, -1, 1, solve_two<solve_spin_and_turn>},
      {2, 0, 1, solve_two<solve_tilt_and_dip>},
      {2, 0, 1, solve_two<solve_tilt_and_nutation>},
      {3, -1, -1, solve_constants},
      {3, -1, -1, solve_goldstein},
  };
  return QUESTIONS[seen];
}

inline symtop_solutions solve_start(const symtop_top& top, symtop_question seen,
                                    const double* known) {
  symtop_solutions found = {SYMTOP_DEMANDS_NOTHING, 0.0, NAN, NAN, 0.0, {}};
  for (symtop_solution& each : found.each) each = {NAN, NAN, NAN, NAN};
  const Question& question = find_question(seen);
  for (int k = 0; k < question.numbers; k++) {
    const double x = known[k];
    if (!is_in_range(x))
      refuse(found, SYMTOP_DEMANDS_FINITE, k);
    else if (k == question.tilt && !(x > 0 && x < PI))
      refuse(found, SYMTOP_DEMANDS_BETWEEN, k, 0.0, PI);
    else if (k == question.duration && !(x > 0))
      refuse(found, SYMTOP_DEMANDS_POSITIVE, k, NAN, INFINITY);
    if (found.demand != SYMTOP_DEMANDS_NOTHING) return found;
  }
  question.solve(top, known, found);
  if (found.number > 0) found.demand = SYMTOP_DEMANDS_NOTHING;
  if (found.demand == SYMTOP_DEMANDS_RATES) found.which = question.numbers - 1;
  return found;
}

}  // namespace symtop

// Steps of a driven motion, whose length follows from the last two coefficients (A. Jorba and M.
// Zou, A software package for the numerical integration of ODEs, Experimental Mathematics 14 (2005)
// 99).
#pragma once

#include "series.hpp"

namespace symtop {

// Size of the last terms of a step, for variables of size 1. It is far below EPS, because what is
// left out has the same sign in many steps, while rounding has not: with 1e-19 steps would be 7 %
// longer, and errors after a thousand seconds ten times as large.
const double LAST = 1e-20;
// The terms of an axis near the vertical may be larger than this by a factor, compared with its
// tilt: so that steps do not become shorter at ordinary tilts.
const double CLOSER = 8.0;
const double LONGEST = 16.0;  // in units of about 1/rate; so the powers of a step stay in range
// rad by which the frame turns in a step at most. Further on, terms after the first ten would need
// more digits than a double, too (piece.hpp).
const double LARGEST_TURN = 2.0;
// The same in a coarse motion, whose last two terms would say nothing if they vanished by chance.
const double LARGEST_COARSE_TURN = 4.0;
const double LARGEST_ANGULAR_VELOCITY = 1e100;
// The unit of time is next to the length of the step before, so that terms in parts are about 1 in
// size (parts.hpp). A step is expanded again if its length is not between these in its unit.
const double SHORTEST_PART = 0.35, LONGEST_PART = 2.0;
const int MOST_TRIES = 4;
const int LENGTH_BITS = 10;  // a length has so few bits that the sum of lengths, the time, is exact
const double LARGEST_SPIN = 1e15;  // rad of half the spin angle; far beyond, no digit of it is left

// A power of two; the library's function takes as long as ten products.
inline double make_power(int exponent) {
  if (exponent < -1000 || exponent > 1000) return std::ldexp(1.0, exponent);
  return read_bits_as<double>(static_cast<uint64_t>(exponent + 1023) << 52);
}

// The fraction of a number, 0.5 to 1, and its exponent: as the library's function, which is a call.
inline double split_power(double x, int* exponent) {
  const int biased = static_cast<int>(read_bits(x) >> 52) & 2047;
  if (biased == 0 || biased == 2047) return std::frexp(x, exponent);
  *exponent = biased - 1022;
  const uint64_t bits = read_bits(x) & ~(uint64_t(2047) << 52);
  return read_bits_as<double>(bits | (uint64_t(1022) << 52));
}

// The root of order n of x, 0.6 % off at most for n >= 21: a length needs no more, and the last bit
// of the C library's power depends on the version. The logarithm to base 2 runs straight between
// powers of two, at most 0.09 below itself, and 2^f on 0 to 1 is a parabola, at most 0.3 % off.
inline double find_root(double x, int n) {
  int exponent;
  const double digits = split_power(x, &exponent);
  const double logarithm = ((exponent - 2) + 2 * digits) / n;
  const double whole = std::floor(logarithm), f = logarithm - whole;
  return (1 + f * (0.6565 + 0.3435 * f)) * make_power(static_cast<int>(whole));
}

class Stepper {
 public:
  DrivenEquations equations;

  // Steps have a share of their usual length, a power of two, and first terms in parts. IN_SUMS:
  // these are sums of two doubles, whatever time it takes, in a unit of about 1/rate.
  explicit Stepper(double share = 1.0, Digits digits = IN_PARTS) : share_(share), digits_(digits) {}

  // The local error that steps may have: 0 if it is far below rounding.
  void allow(double tolerance) {
    if (!tolerance) return;
    digits_ = IN_DOUBLES;
    last_ = tolerance;
    largest_turn_ = LARGEST_COARSE_TURN;
    terms_ = COARSE_TERMS;
  }

  void step(const Knot& knot, int direction, Piece& piece) {
    if (!expand(knot, direction, piece)) return;
    piece.find_end();
    double length = piece.end - knot.t;
    while (std::fabs(piece.following.now.rates.high[SPIN] * equations.half_rest.high) >
           LARGEST_SPIN) {
      length /= 2;
      piece.end = knot.t + length;
      piece.find_end();
    }
  }

  // The series of a step and its end, without the state there; false if nothing moves or all too
  // fast.
  bool expand(const Knot& knot, int direction, Piece& piece) {
    piece.start = knot;
    const double rate = equations.estimate_rate(knot.now);
    if (!(rate < LARGEST_ANGULAR_VELOCITY)) {
      piece.rest_until(knot.t);
      return false;
    }
    int exponent = 0;
    if (rate) split_power(1 / rate, &exponent);
    const double usual = make_power(exponent);
    double unit = knot.unit ? knot.unit : usual, length = 0.0;
    for (int tries = 0; tries < MOST_TRIES; tries++) {
      expand_in(unit, piece);
      if (!is_moving(piece)) {
        piece.rest_until(direction * INFINITY);
        return false;
      }
      length = share_ * find_length(piece.terms, LONGEST * usual / unit_);
      if (digits_ == IN_SUMS || (length > SHORTEST_PART && length < LONGEST_PART)) break;
      unit = unit_ * find_power(length);
    }
    piece.end = knot.t + direction * length * unit_;
    if (digits_ != IN_SUMS) piece.following.unit = unit_ * find_power(length);
    return true;
  }

 private:
  double share_, unit_ = 0.0;
  Digits digits_;
  double last_ = LAST, largest_turn_ = LARGEST_TURN;
  int terms_ = DRIVEN_TERMS;
  Coefficients in_unit_;
  TaylorSeries series_;

  void expand_in(double unit, Piece& piece) {
    set_unit(unit);
    piece.unit = unit_;
    piece.put_first();
    series_.expand(in_unit_, equations.share, equations.has_torque, digits_, piece);
  }

  // The power of two next to a length.
  static double find_power(double length) {
    int exponent;
    const double digits = split_power(length, &exponent);
    return make_power(exponent - (digits < 0x1.6ap-1));
  }

  void set_unit(double unit) {
    if (unit != unit_) in_unit_ = equations.coefficients.in_unit(unit);
    unit_ = unit;
  }

  static bool is_moving(const Piece& piece) {
    bool moves = false;
    for (int k = 0; k < LANES; k++) moves |= piece.terms[1][0][k] != 0 || piece.terms[1][1][k] != 0;
    return moves;
  }

  // The components that say how far an axis near the vertical is from it: what is small of q, x and
  // y above, and w and z below; and omega across.
  struct Swing {
    int q[2];

    double find_largest(const Lanes row[2]) const {
      return std::max(std::max(std::fabs(row[0][q[0]]), std::fabs(row[0][q[1]])),
                      std::max(std::fabs(row[1][OMEGA_X]), std::fabs(row[1][OMEGA_Y])));
    }

    // How far the axis swings in a step: its terms count by this size.
    double measure(const Lanes terms[][2]) const {
      double size = 0.0;
      for (int order = 0; order < 4; order++)
        size = std::max(size, CLOSER * find_largest(terms[order]));
      return size > 1.0 || size == 0 ? 1.0 : size;
    }
  };

  double find_length(const Lanes terms[][2], double longest) const {
    const Lanes q = terms[0][0], rates = terms[0][1];
    const double spin = equations.share.high * rates[OMEGA_Z];
    const double turn =
        std::sqrt(rates[OMEGA_X] * rates[OMEGA_X] + rates[OMEGA_Y] * rates[OMEGA_Y] + spin * spin);
    double length = largest_turn_ / std::max(turn, largest_turn_ / longest);
    const double axial = std::max(1.0, std::fabs(rates[OMEGA_Z]));
    // cos^2 and sin^2 of half the tilt: tan(theta/2)^2 = lower/upper.
    const double upper = q[W] * q[W] + q[Z] * q[Z], lower = q[X] * q[X] + q[Y] * q[Y];
    const bool swings = CLOSER * CLOSER * std::min(upper, lower) < 1;
    const Swing swing = upper > lower ? Swing{{X, Y}} : Swing{{W, Z}};
    const double size = swings ? swing.measure(terms) : 1.0;
    for (int order = terms_ - 1; order <= terms_; order++) {
      const Lanes* row = terms[order];
      double largest = find_largest_lane(
          find_larger(find_size(row[0]), find_size(row[1]) * Lanes{1.0, 1.0, 1 / axial, 0.0}));
      if (swings) largest = std::max(largest, swing.find_largest(row) / size);
      if (largest) length = std::min(length, find_root(last_ / largest, order));
    }
    int exponent;
    const double fraction = split_power(length, &exponent);
    return std::floor(fraction * (1 << LENGTH_BITS)) * make_power(exponent - LENGTH_BITS);
  }
};

}  // namespace symtop

// The motion of the heavy top for Mgl > 0, in closed form and without a singular coordinate
// (derivation.md, sections 3 to 6).
//
// The Cayley-Klein parameters A and B have no pole on the vertical, in contrast to Euler's angles,
// and their phases grow linearly in time except for a periodic part. So nothing is divided by
// sin(theta), and no error accumulates (Klein & Sommerfeld, The Theory of the Top, chapter VI).
// u(t) = u1 + (u2 - u1) sn(v)^2 with v = v0 + Omega t (DLMF 22.2); the phase of the nutation is
// x = pi v/K, 0 at the lower turning point u1 and pi at the upper one.
//
// The constants of a motion are computed once, with 57 digits, and evaluated often, in doubles:
// they are those of exactly the doubles that were given, so that no error grows with time.
#pragma once

#include "first_instants.hpp"

namespace symtop {

template <class R>
struct AttitudeOf {  // a state without omega_z, which is constant
  R w, x, y, z, omega_x, omega_y;
};
typedef AttitudeOf<double> Attitude;

// The state of A, B and omega_xy, with one step to norm 1. Newton's step would correct A and B by
// the same factor, and so give a small B the error of A. Least squares correct the larger one more,
// by |A|^2/(|A|^4 + |B|^4) of the step, and B by |B|^2 over the same; a cubic of |A|^2 = 1 - |B|^2
// is near enough. Of equal sizes both take the same, which removes their common error.
template <class R>
SYMTOP_INLINE AttitudeOf<R> complete_attitude(const PairOf<R> values[FUNCTIONS],
                                              bool is_turned_over) {
  R w = values[OF_A].x, z = values[OF_A].y, x = values[OF_B].x, y = values[OF_B].y;
  if (is_turned_over) {  // the world that was turned by pi about x' is turned back (section 1)
    const R w_before = w, y_before = y;
    w = x;
    x = -w_before;
    y = z;
    z = -y_before;
  }
  const R upper = w * w + z * z, lower = x * x + y * y;
  const R step = 0.5 - 0.5 * (upper + lower), share = step * (upper - lower);
  const R of_B = step - upper * share, of_A = of_B + share;
  return {w + w * of_A, x + x * of_B,          y + y * of_B,
          z + z * of_A, values[OF_OMEGA_XY].x, values[OF_OMEGA_XY].y};
}

// The rate of arg A or arg B; zero if rounding is all that it has.
inline Precise add_rates(const Precise& mean, const Precise& half_c) {
  const Precise rate = mean + half_c;
  return is_lost(rate, half_c) ? Precise() : rate;
}

// A motion whose axis moves under gravity, with Mgl > 0. It is solved in three stages: what kind
// and turning angles need, what states need, and what the first instants need.
struct ClosedForm {
  Start start;
  bool is_turned_over;

  Nutation nutation;
  Roots roots;
  Zero zeros[FUNCTIONS];
  Precise agm, means[FUNCTIONS], frequency, nutation_rate, half_c;

  Pair start_values[FUNCTIONS];
  double first_end;
  Steps steps;
  NutationPhase nutation_phase;
  DirectSeries direct;
  ComplementarySeries complementary;
  Pair factors[FUNCTIONS];
  FirstInstants first_instants;

  void solve(const Start& given, bool turned_over) {
    start = given;
    is_turned_over = turned_over;
    nutation = find_nutation<3>(start);
    if (start.is_clamped) drop_precession(nutation, start);
    roots = find_roots(nutation);
    find_zeros(nutation, roots, zeros);
    // The complementary modulus from s32, not as sqrt(1 - m): near the separatrix that would have
    // no digits.
    agm = compute_mean_rates(nutation, zeros, root(roots.s32 / roots.s31()), means);
    frequency = root(nutation.beta * roots.s31());
    nutation_rate = frequency * agm;
    half_c = find_turning_rate<3>(start).scale(-1);
  }

  // |omega_xy| at the lower turning point, in rad/s.
  Precise find_largest_rate_across() const {
    return root(nutation.beta * zeros[OF_OMEGA_XY].from_u1);
  }

  // Phases, the place in the nutation, series, and constant factors.
  void prepare_states() {
    const Precise rates[FUNCTIONS] = {nutation_rate, add_rates(means[OF_A], half_c),
                                      add_rates(means[OF_B], -half_c)};
    steps = find_steps(rates, FUNCTIONS);
    first_end = REACH / find_fastest_rate(start);
    nutation_phase = find_nutation_phase(nutation, roots, zeros, agm, frequency);
    Shift shifts[FUNCTIONS];
    for (int k = 0; k < FUNCTIONS; k++) {
      const double complement = compute_shift_complement(zeros[k], roots);
      shifts[k] = {zeros[k].is_negative() ? -1.0 : 1.0,
                   nutation_phase.Kc < complement ? nutation_phase.Kc : complement};
    }
    const int winding = count_windings();
    if (nutation_phase.is_direct())
      direct.prepare(nutation_phase.K, nutation_phase.Kc, shifts, winding);
    else
      complementary.prepare(nutation_phase.K, nutation_phase.Kc, shifts, winding,
                            nutation_phase.root_of_nome);
    find_factors();
  }

  void prepare_first_instants() {
    first_instants.prepare(start, start_values[OF_A], start_values[OF_B], half_c);
  }

  // Whole turns of omega_xy in a nutation, compared with conj(A) B. In the frame of the line of
  // nodes omega_xy is theta' + i sin(theta) phi', which is periodic. conj(A) B has the argument of
  // the line of nodes in the body. So the mean rates of the two arguments differ by whole turns in
  // a nutation, one if phi' reverses. With the integer known no third phase is needed, and its
  // rounding cannot separate omega_xy from the attitude. (The rate of arg omega_xy is -omega -
  // p_psi/(2 Ix) - c: c cancels.)
  int count_windings() const {
    if (!nutation_rate.sign) return 0;
    const Precise difference =
        means[OF_A] - means[OF_B] - means[OF_OMEGA_XY] - nutation.a.scale(-1);
    return static_cast<int>(round_to_integer((difference / nutation_rate).to_double()));
  }

  template <class R>
  SYMTOP_INLINE void compute_series(const LocationOf<R>& at, PairOf<R> values[FUNCTIONS]) const {
    if (nutation_phase.is_direct())
      direct.compute_values(at, values);
    else
      complementary.compute_values(at, values);
  }

  // A, B and omega_xy at t = 0, and their derivatives without the constant turning by c.
  void find_initial_values(Pair changes[FUNCTIONS]) {
    const Start& s = start;
    const Start unit = normalize(s);
    const double w = unit.w, x = unit.x, y = unit.y, z = unit.z;
    const Pair A = {w, z}, B = {x, y}, omega_xy = {s.wx, s.wy};
    const double spin = 0.5 * s.wz * (s.Iz / s.Ix), weight = 2 * (s.Mgl / s.Ix);
    const Pair of_A = multiply_by_conjugate(B, omega_xy), of_B = multiply(omega_xy, A);
    const Pair of_omega_xy = multiply_by_conjugate(B, A);
    start_values[OF_A] = A;
    start_values[OF_B] = B;
    start_values[OF_OMEGA_XY] = omega_xy;
    changes[OF_A] = {-spin * z - of_A.x / 2, spin * w - of_A.y / 2};
    changes[OF_B] = {of_B.x / 2 + spin * y, of_B.y / 2 - spin * x};
    changes[OF_OMEGA_XY] = {weight * of_omega_xy.x - spin * s.wy,
                            weight * of_omega_xy.y + spin * s.wx};
  }

  // Constant factors that make A, B and omega_xy right at t = 0 (section 6).
  void find_factors() {
    const Nutation& n = nutation;
    Pair changes[FUNCTIONS], values[FUNCTIONS];
    find_initial_values(changes);
    changes[OF_OMEGA_XY] = conjugate(changes[OF_OMEGA_XY]);
    const Precise from_start[] = {n.one_plus_u, n.one_minus_u, n.omega_xy_squared / n.beta};
    compute_series(nutation_phase.start, values);
    for (int k = 0; k < FUNCTIONS; k++) {
      const Pair at_start = k == OF_OMEGA_XY ? conjugate(start_values[k]) : start_values[k];
      const bool is_small =
          from_start[k].scale(2) <
          (zeros[k].from_u1 > zeros[k].from_u2 ? zeros[k].from_u1 : zeros[k].from_u2);
      factors[k] = find_factor(k, at_start, changes[k], values[k], means[k].to_double(), is_small);
    }
    const double modulus = find_modulus(factors[OF_OMEGA_XY]);
    if (modulus) {
      const double share = find_modulus_of_third_factor(modulus) / modulus;
      factors[OF_OMEGA_XY] = {factors[OF_OMEGA_XY].x * share, factors[OF_OMEGA_XY].y * share};
    }
    factors[OF_OMEGA_XY] = conjugate(factors[OF_OMEGA_XY]);
  }

  // The modulus of the factor of omega_xy, from all places where that is known to all digits: at
  // the turning points |omega_xy|^2 is beta times the distance of the height alpha/beta. A start
  // where omega_xy is small would give it with the rounding of that start.
  double find_modulus_of_third_factor(double from_start) const {
    const Nutation& n = nutation;
    const Zero& zero = zeros[OF_OMEGA_XY];
    double total = 0.0;
    int count = 0;
    const auto add = [&](double estimate) {
      total += estimate;
      count++;
    };
    const auto add_turning_point = [&](const Precise& square, const Location& place) {
      if (square.scale(2) < zero.from_u1) return;
      Pair values[FUNCTIONS];
      compute_series(place, values);
      add(std::sqrt((n.beta * square).to_double()) / find_modulus(values[OF_OMEGA_XY]));
    };
    add_turning_point(zero.from_u1, nutation_phase.lower_turning_point());
    add_turning_point(zero.from_u2, nutation_phase.upper_turning_point());
    if (!((n.omega_xy_squared / n.beta).scale(2) < zero.from_u1)) add(from_start);
    return total / count;
  }

  // start/value. If the function nearly vanishes at the start, both have lost their digits, and the
  // factor comes from the derivatives instead; value and derivative never vanish together. The
  // square of a function is in proportion to the distance from its zero: above half of its largest
  // size it has all its digits (`is_small` is false).
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

  // The three functions from phases, after the first instants.
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
    values[OF_OMEGA_XY] =
        multiply(multiply_by_conjugate(factors[OF_OMEGA_XY], series[OF_OMEGA_XY]), turn_omega);
  }

  template <class R>
  SYMTOP_INLINE AttitudeOf<R> complete(const PairOf<R> values[FUNCTIONS]) const {
    return complete_attitude(values, is_turned_over);
  }

  bool is_first(double t) const { return std::fabs(t) <= first_end; }

  // True if a time is too long for a count of ticks: 1e15 turns.
  bool is_far(double t) const {
    if (t == 0) return false;
    return std::fabs(t) >= (is_first(t) ? first_instants.half_turn.farthest : steps.farthest);
  }

  // For a time that is not far.
  Attitude at(double t) const {
    if (t == 0) return complete(start_values);
    Pair values[FUNCTIONS];
    Phase phases[FUNCTIONS];
    if (is_first(t)) {
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

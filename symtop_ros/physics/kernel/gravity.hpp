// A motion under gravity alone: circular functions where no torque turns the axis, else elliptic
// ones.
#pragma once

#include <atomic>

#include "blocks.hpp"
#include "exact/mean_cosine.hpp"
#include "exact/mean_rates.hpp"
#include "exact/spin.hpp"
#include "lock.hpp"

namespace symtop {

struct Rates {
  double nutation_period, mean_precession_rate, mean_spin_rate, precession_per_nutation,
      mean_cosine;
  bool spin_reverses;
};

// Mean rates of the nutation, and of the arguments of A and B in the frame that does not turn by c:
// after a whole nutation they have turned, and all else is as it was.
struct Turning {
  Precise nutation, of_A, of_B;
};

// What is not needed is not computed: each stage is prepared when it is first asked for.
class GravityMotion {
 public:
  explicit GravityMotion(const Start& given) : start_(given) {
    is_turned_over_ = turn_over(start_);
    is_free_ = symtop::is_free(start_);
  }

  bool is_free() const { return is_free_; }

  // States at times or stamps, up to the first that is too far; returns how many.
  template <class Times>
  int64_t fill(const Target& to, int64_t count, const Times& times) {
    prepare(STATES);
    if (!is_free_ && needs_first_instants(closed_, times, count)) prepare(FIRST_INSTANTS);
    return is_free_ ? symtop::fill(free_, times, count, to)
                    : symtop::fill(closed_, times, count, to);
  }

  // False if the time is too far.
  bool read(double t, const Target& to) {
    prepare(STATES);
    if (!is_free_ && t != 0 && closed_.is_first(t)) prepare(FIRST_INSTANTS);
    if (is_free_ ? free_.is_far(t) : closed_.is_far(t)) return false;
    write_state(is_free_ ? free_.at(t) : closed_.at(t), start_.wz, to);
    return true;
  }

  Kind find_kind() {
    if (start_.is_clamped) return CLAMPED;
    prepare(SOLVED);
    return is_free_ ? free_.kind : classify(closed_);
  }

  void find_turning_angles(double angles[2]) {
    prepare(SOLVED);
    const bool from_below = is_turned_over_;
    const Zero* zeros = is_free_ ? free_.zeros : closed_.zeros;
    const Zero &near = zeros[from_below ? OF_A : OF_B], &far = zeros[from_below ? OF_B : OF_A];
    const double upper = 2 * find_half_angle(near.from_u2, far.from_u2);
    const double lower = 2 * find_half_angle(near.from_u1, far.from_u1);
    angles[0] = from_below ? lower : upper;
    angles[1] = from_below ? upper : lower;
  }

  // |omega_xy| at the same turning points, and the horizontal part of L over Ix, in rad/s. Where
  // the axis comes to rest, or L is vertical, differences of doubles would leave the root of
  // rounding.
  void find_rates_at_ends(double across[2], double level[2]) {
    prepare(SOLVED);
    const Nutation& n = is_free_ ? free_.nutation : closed_.nutation;
    const Precise b = n.b_minus_au + n.a * n.u();
    for (const bool is_upper : {true, false}) {
      const Zero& zero = closed_.zeros[OF_OMEGA_XY];
      const Precise& height = is_upper ? zero.from_u2 : zero.from_u1;
      const Precise square = is_free_ ? n.omega_xy_squared : n.beta * height;
      const int end = is_upper == is_turned_over_;
      across[end] = root(square).to_double();
      level[end] = root(square + n.a * n.a - b * b).to_double();
    }
  }

  double find_farthest_time() {
    prepare(STATES);
    return is_free_ ? free_.steps.farthest : closed_.steps.farthest;
  }

  // As the sum of two doubles.
  void find_nutation_rate(double rate[2]) {
    prepare(SOLVED);
    const Precise& exact = is_free_ ? free_.nutation_rate : closed_.nutation_rate;
    rate[0] = exact.to_double();
    rate[1] = rest_of(exact, rate[0]);
  }

  // In a world that was turned over, A was conj(B), and B was -conj(A). Without a torque a turn
  // about L, of which the quaternion has half the angle, is a nutation.
  Turning find_turning() {
    prepare(SOLVED);
    if (is_free_)
      return {free_.nutation_rate, free_.nutation_rate.scale(-1), free_.nutation_rate.scale(-1)};
    const Precise &A = closed_.means[OF_A], &B = closed_.means[OF_B];
    if (is_turned_over_) return {closed_.nutation_rate, -B, -A};
    return {closed_.nutation_rate, A, B};
  }

  Rates find_rates() {
    prepare(SOLVED);
    const Kind kind = find_kind();
    const bool has_means = kind != SLEEPING && kind != THROUGH_THE_POLE && kind != CLAMPED;
    Rates rates = is_free_ ? find_free_rates() : find_closed_rates(has_means);
    if (is_turned_over_) {
      rates.mean_precession_rate = -rates.mean_precession_rate;
      rates.precession_per_nutation = -rates.precession_per_nutation;
      rates.mean_cosine = -rates.mean_cosine;
    }
    if (!has_means)
      rates.mean_precession_rate = rates.mean_spin_rate = rates.precession_per_nutation = NAN;
    return rates;
  }

 private:
  enum Stage { NOTHING, SOLVED, STATES, FIRST_INSTANTS };

  Start start_;
  bool is_turned_over_, is_free_;
  ClosedForm closed_;
  FreeMotion free_;
  std::atomic<int> stage_{NOTHING};
  Mutex mutex_;

  // Threads may share the motion: what one has prepared the others see whole.
  void prepare(Stage stage) {
    if (stage_.load(std::memory_order_acquire) >= stage) return;
    const Lock lock(mutex_);
    for (int next = stage_.load() + 1; next <= stage; next++) {
      if (!is_free_)
        prepare_closed(next);
      else if (next == SOLVED)
        free_.solve(start_, is_turned_over_);
      stage_.store(next, std::memory_order_release);
    }
  }

  void prepare_closed(int stage) {
    if (stage == SOLVED)
      closed_.solve(start_, is_turned_over_);
    else if (stage == STATES)
      closed_.prepare_states();
    else
      closed_.prepare_first_instants();
  }

  static double find_half_angle(const Precise& near, const Precise& far) {
    return arc_tangent(std::sqrt(near.to_double()), std::sqrt(far.to_double()));
  }

  // The means of a planar swing vanish: 700 digits would be taken to look for theirs.
  Rates find_closed_rates(bool has_means) const {
    const MeanRates mean = has_means ? symtop::find_mean_rates(closed_) : MeanRates();
    const double rate = closed_.nutation_rate.to_double();
    const double turns =
        closed_.nutation_rate.sign ? (mean.precession / closed_.nutation_rate).to_double() : NAN;
    return {rate ? 2 * PI / rate : INFINITY, mean.precession.to_double(),
            mean.spin.to_double(),           turns,
            find_mean_cosine(closed_),       symtop::spin_reverses(closed_)};
  }

  // Of a motion without a torque: the means are whole half turns of arg A and arg B about L.
  Rates find_free_rates() const {
    const int upper = free_.upper_turns(), lower = free_.lower_turns();
    const double rate = free_.nutation_rate.to_double();
    const bool returns = free_.kind != SLEEPING && rate != 0;
    const Precise half = free_.nutation_rate.scale(-1);
    const Precise precession = Precise(double(upper + lower)) * half;
    const Precise spin = Precise(double(upper - lower)) * half + free_.turning_rate;
    return {returns ? 2 * PI / rate : INFINITY,
            precession.to_double(),
            spin.to_double(),
            free_.nutation_rate.sign ? (upper + lower) / 2.0 : NAN,
            free_.find_mean_cosine(),
            free_.kind != SLEEPING && symtop::spin_reverses(free_)};
  }
};

}  // namespace symtop

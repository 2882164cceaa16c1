// A series of equal pushes on the axle, and the exact motion between them.
//
// A push comes at a whole number of nanoseconds after the first one, at which the motion starts. Up
// to the next one the motion is a stretch of its own, from the state that the push leaves. A
// stretch is made when it is first asked for: those before it are made, too, and are kept. The
// state at its end is carried on with 32 digits: else rounding would add up from push to push, and
// that of a rate grow with time.
#pragma once

#include <atomic>
#include <memory>

#include "../driven/chain.hpp"
#include "stretch.hpp"

namespace symtop {

const double MOST_PUSHES = 1000, SLOWEST_PUSHES = 0.01, FASTEST_PUSHES = 1000;  // and 1/s
const symtop_pushes NO_PUSHES = {0.0, 1.0, 1.0};  // after that with which a motion starts

inline symtop_status accept(const symtop_pushes& pushes) {
  const bool are =
      are_finite(&pushes.impulse, 1) && is_between(pushes.rate, SLOWEST_PUSHES, FASTEST_PUSHES) &&
      is_between(pushes.number, 1, MOST_PUSHES) && pushes.number == std::floor(pushes.number);
  return are ? SYMTOP_OK : SYMTOP_BAD_PUSHES;
}

// Times of a motion as a caller gives them: doubles in s, or stamps of a clock.
struct ClockTimes {
  Clock clock;
  const int64_t* stamps;

  Exact find_exact(size_t i) const { return find_time(clock, find_elapsed(clock), stamps[i]); }

  // States of a stretch that begins at a time in ns, from the place `first` on.
  symtop_status fill(Stretch& stretch, double begin, size_t first, size_t count, double* steps,
                     const Target& to, size_t* done) const {
    Clock own = clock;
    own.elapsed[ELAPSED_PARTS] = -begin;
    const Stamps all(stamps + first, own);
    const auto split = [&all](int64_t i) { return split_seconds(all.find_exact_time(i)); };
    return stretch.fill(count, steps, to, done, split, all);
  }
};

struct Seconds {
  const double* times;

  Exact find_exact(size_t i) const { return Exact(times[i]) * Exact(double(SECOND)); }

  // After a push the time since then is kept exact as well: a difference of doubles would be
  // rounded.
  symtop_status fill(Stretch& stretch, double begin, size_t first, size_t count, double* steps,
                     const Target& to, size_t* done) const {
    const double* own = times + first;
    const auto split = [own](int64_t i) { return Pair{own[i], 0.0}; };
    if (!begin) return stretch.fill(count, steps, to, done, split, own);
    *done = 0;
    for (size_t i = 0; i < count; i++) {
      const symtop_status status = read_later(stretch, begin, own[i], steps, to.from(i));
      if (status != SYMTOP_OK) return status;
      *done = i + 1;
    }
    return SYMTOP_OK;
  }

 private:
  static symtop_status read_later(Stretch& stretch, double begin, double t, double* steps,
                                  const Target& to) {
    static const int64_t NONE = 0;
    const Exact time = Exact(t) * Exact(double(SECOND));
    const double high = time.to_double(), low = (time - Exact(high)).to_double();
    size_t done;
    // A time that is no double of ns is so late that the begin is none of its digits.
    if (!std::isfinite(high)) return Seconds{&t}.fill(stretch, 0.0, 0, 1, steps, to, &done);
    return ClockTimes{{0.0, {high, low}}, &NONE}.fill(stretch, begin, 0, 1, steps, to, &done);
  }
};

class Stretches {
 public:
  explicit Stretches(const symtop_pushes& pushes)
      : pushes_(pushes), number_(static_cast<int>(pushes.number)) {}

  // With the first stretch; false if there is no memory.
  bool prepare(Stretch* first) {
    first_ = first;
    if (number_ > 1) later_.reset(new (std::nothrow) std::unique_ptr<Stretch>[number_ - 1]);
    return number_ == 1 || later_;
  }

  bool has_pushes() const { return number_ > 1; }

  template <class Times>
  symtop_status fill(const Times& times, size_t count, double most_steps, const Target& to,
                     size_t* written) {
    for (size_t i = 0, done; i < count; i += done) {
      const int place = find_place(times, i);
      size_t end = has_pushes() ? i + 1 : count;
      while (end < count && find_place(times, end) == place) end++;
      done = 0;
      symtop_status status = make(place, &most_steps);
      if (status == SYMTOP_OK)
        status =
            times.fill(at(place), find_begin(place), i, end - i, &most_steps, to.from(i), &done);
      *written = i + done;
      if (status != SYMTOP_OK) return status;
    }
    return SYMTOP_OK;
  }

  // One state at a time in s.
  symtop_status read(double t, const Target& to) {
    if (has_pushes() || first_->is_driven) {
      size_t written;
      return fill(Seconds{&t}, 1, INFINITY, to, &written);
    }
    return first_->gravity.read(t, to) ? SYMTOP_OK : SYMTOP_TOO_FAR;
  }

  // Integrates towards a time in s; *reached is the time up to which no more steps are needed.
  symtop_status reach(double t, double most_steps, double* reached) {
    *reached = t;
    if (!first_->is_driven) return SYMTOP_OK;
    const int place = find_place(Seconds{&t}, 0);
    symtop_status status = make(place, &most_steps);
    const int last = status == SYMTOP_OK ? place : count_made() - 1;
    const double begin = find_begin(last) / SECOND;
    const double wanted = last == place ? t - begin : find_length(last);
    double own = 0.0;  // where there is no memory for any step
    const Progress progress = at(last).driven.reach(wanted, most_steps, &own);
    if (status == SYMTOP_OK) status = to_status(progress);
    if (status != SYMTOP_OK) *reached = begin + own;
    return status;
  }

  // The stretch at a stamp of a clock.
  symtop_status find_piece(const ClockTimes& time, double most_steps, symtop_piece* piece) {
    const int place = find_place(time, 0);
    const symtop_status status = make(place, &most_steps);
    if (status == SYMTOP_OK) *piece = {at(place).start, find_begin(place), place + 1.0};
    return status;
  }

  // From when on there are no states, under gravity alone: too far in a stretch, or not pushed.
  double find_farthest_time() {
    double none = INFINITY;
    for (int place = 0;; place++) {
      if (make(place, &none) != SYMTOP_OK) return find_begin(place) / SECOND;
      const double own = at(place).gravity.find_farthest_time();
      if (place + 1 == number_ || own <= find_length(place))
        return find_begin(place) / SECOND + own;
    }
  }

 private:
  symtop_pushes pushes_;
  int number_;
  Stretch* first_ = nullptr;
  std::unique_ptr<std::unique_ptr<Stretch>[]> later_;
  std::atomic<int> made_{0};  // of later_
  std::unique_ptr<Chain> chain_;
  bool is_carried_ = false;  // the start of the last stretch, with 32 digits
  Variables carried_;
  Mutex mutex_;

  // ns from the first push on, whole
  double find_begin(int place) const { return std::floor(place * 1e9 / pushes_.rate + 0.5); }

  // in s
  double find_length(int place) const {
    return (find_begin(place + 1) - find_begin(place)) / SECOND;
  }

  int count_made() const { return made_.load(std::memory_order_acquire) + 1; }

  Stretch& at(int place) { return place ? *later_[place - 1] : *first_; }

  // The place of the last push up to a time; 0 before the first one.
  template <class Times>
  int find_place(const Times& times, size_t i) const {
    if (!has_pushes()) return 0;
    const Exact time = times.find_exact(i);
    int place = 0, end = number_;
    while (end - place > 1) {
      const int middle = (place + end) / 2;
      ((time - Exact(find_begin(middle))).sign >= 0 ? place : end) = middle;
    }
    return place;
  }

  // Makes the stretches up to a place. Threads may share the motion: each sees whole ones.
  symtop_status make(int place, double* steps) {
    if (count_made() > place) return SYMTOP_OK;
    const Lock lock(mutex_);
    for (int next = count_made(); next <= place; next++) {
      const symtop_status status = make_next(next, steps);
      if (status != SYMTOP_OK) return status;
      made_.store(next, std::memory_order_release);
    }
    return SYMTOP_OK;
  }

  symtop_status make_next(int next, double* steps) {
    Stretch& before = at(next - 1);
    const int64_t passed = static_cast<int64_t>(find_begin(next) - find_begin(next - 1));
    Variables state = is_carried_ ? carried_ : BodyState(to_driven(before.start)).in_frame();
    std::unique_ptr<Stretch> made;
    symtop_status status = carry(before, passed, steps, state, made);
    const bool is_carried = bool(made);
    if (status == SYMTOP_OK && !made) status = restart(before, passed, steps, made);
    if (status == SYMTOP_OK) status = made ? accept(made->start) : SYMTOP_NO_MEMORY;
    if (status != SYMTOP_OK) return status;
    later_[next - 1] = std::move(made);
    carried_ = state;
    is_carried_ = is_carried;
    return SYMTOP_OK;
  }

  // Moves a state to the next push, and over it; makes nothing if it has to begin anew from
  // doubles.
  symtop_status carry(Stretch& before, int64_t passed, double* steps, Variables& state,
                      std::unique_ptr<Stretch>& made) {
    symtop_start s = before.start;
    if (!chain_) chain_.reset(new (std::nothrow) Chain(to_driven(s)));
    if (!chain_) return SYMTOP_NO_MEMORY;
    const symtop_status status = advance(before, passed, steps, state);
    if (status != SYMTOP_OK) return status == SYMTOP_TOO_FAR ? SYMTOP_OK : status;
    const Double2 change = Double2{pushes_.impulse, 0.0} / Double2{s.Ix, 0.0};
    if (!Chain::push(state, change)) return SYMTOP_OK;
    const BodyState body = chain_->find_state(state);
    for (const Double2& each : body.omega)
      if (!are_at_most(&each.high, 1, LARGEST)) return SYMTOP_OK;
    for (int k = 0; k < 3; k++) s.angular_velocity[k] = body.omega[k].high;
    for (int k = 0; k < 4; k++) s.orientation[k] = body.q[k].high;
    made.reset(new (std::nothrow) Stretch(s, body, state));
    return SYMTOP_OK;
  }

  symtop_status advance(Stretch& before, int64_t passed, double* steps, Variables& state) {
    const double ns = static_cast<double>(passed);
    if (before.is_driven) {
      const Pair time = split_seconds(Exact(ns));
      return to_status(before.driven.find(time.x, time.y, steps, &state));
    }
    return chain_->advance(state, ns, before.gravity) ? SYMTOP_OK : SYMTOP_TOO_FAR;
  }

  symtop_status restart(Stretch& before, int64_t passed, double* steps,
                        std::unique_ptr<Stretch>& made) const {
    symtop_start s = before.start;
    size_t done;
    symtop_status status = ClockTimes{{1.0, {}}, &passed}.fill(
        before, 0.0, 0, 1, steps, {s.orientation, s.angular_velocity}, &done);
    if (status == SYMTOP_OK) status = push(s);
    if (status == SYMTOP_OK) made.reset(new (std::nothrow) Stretch(s));
    return status;
  }

  symtop_status push(symtop_start& s) const {
    const symtop_top top = {s.Ix, s.Iz, s.Mgl};
    double pushed[3] = {0, 0, 0};  // GCC does not see that it is written, with -ffinite-math-only
    size_t done;
    const symtop_status status =
        symtop_kick(&top, s.orientation, s.angular_velocity, SYMTOP_AXLE_IMPULSE,
                    SYMTOP_SPIN_MOMENTUM, &pushes_.impulse, 1, pushed, &done);
    if (status == SYMTOP_OK) std::memcpy(s.angular_velocity, pushed, sizeof pushed);
    return status;
  }
};

}  // namespace symtop

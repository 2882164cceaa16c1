// How far the starts of rule/starts.hpp move with what is known of them (derivation.md, section
// 12).
//
// A number of a start is a smooth function of what is known, as long as the same starts exist. Over
// a box its extremes are looked for, from the best of a grid: at its corners where it is monotone,
// and inside where it turns round, as the spin does with the time of a turn where two roots meet.
// Slopes say nothing there. In the same way the least margin is looked for: where it is none,
// starts end between the points of the grid.
#pragma once

#include "margins.hpp"

namespace symtop {

const int SPREAD_POINTS = 5;     // of each axis of the grid
const int SPREAD_HALVINGS = 14;  // of a step: then an extreme is right to 1e-8 of the spread
const int START_NUMBERS = 4, MOST_STARTS = 4, MOST_KNOWN = 3;

double symtop_solution::* const NUMBERS_OF_START[] = {
    &symtop_solution::theta, &symtop_solution::theta_dot, &symtop_solution::phi_dot,
    &symtop_solution::psi_dot};

class SpreadFinder {
 public:
  SpreadFinder(const symtop_top& top, symtop_question seen, const double* known,
               const double* half_widths)
      : top_(top),
        seen_(seen),
        centre_(symtop::solve_start(top, seen, known)),
        margins_(find_margins(top, seen, known)) {
    for (int k = 0; k < MOST_KNOWN; k++) {
      known_[k] = known[k];
      half_widths_[k] = std::fmax(0.0, half_widths[k]);
    }
  }

  symtop_spreads find() {
    symtop_spreads found;
    for (int start = 0; start < MOST_STARTS; start++)
      found.least[start] = found.most[start] = {NAN, NAN, NAN, NAN};
    if (!centre_.number || may_pass_the_vertical() || !look_at_grid() || may_end()) return found;
    for (int start = 0; start < centre_.number; start++)
      for (int k = 0; k < START_NUMBERS; k++) {
        found.least[start].*NUMBERS_OF_START[k] = -improve(start, k, -1);
        found.most[start].*NUMBERS_OF_START[k] = improve(start, k, 1);
      }
    return found;
  }

 private:
  // A place in the box, from -1 to 1 on each axis, and what a number is there, or its negative.
  struct Best {
    double value, at[MOST_KNOWN];
  };

  symtop_top top_;
  symtop_question seen_;
  symtop_solutions centre_;
  Margins margins_;  // at the centre
  double known_[MOST_KNOWN], half_widths_[MOST_KNOWN];
  Best best_[MOST_STARTS][START_NUMBERS][2], nearest_[MOST_MARGINS];

  // If p_phi = p_psi or p_phi = -p_psi lies in the box: next to it phi' has no bound.
  bool may_pass_the_vertical() const {
    if (seen_ < SYMTOP_CONSTANTS) return false;  // the other two are momenta, or those over Ix
    const double width = half_widths_[1] + half_widths_[2];
    return std::fabs(known_[1] - known_[2]) <= width || std::fabs(known_[1] + known_[2]) <= width;
  }

  bool is_axis(int k) const { return half_widths_[k] > 0; }
  Best& best_of(int start, int k, int side) { return best_[start][k][side > 0]; }

  struct Known {
    double numbers[MOST_KNOWN];
  };
  Known find_known(const double at[MOST_KNOWN]) const {
    Known known;
    for (int k = 0; k < MOST_KNOWN; k++) known.numbers[k] = known_[k] + at[k] * half_widths_[k];
    return known;
  }
  symtop_solutions solve_at(const double at[MOST_KNOWN]) const {
    return symtop::solve_start(top_, seen_, find_known(at).numbers);
  }

  // A margin as a share of that at the centre: at 0 a start begins or ends.
  double find_share(const Margins& margins, int k) const {
    return margins_.each[k].sign ? (margins.each[k] / margins_.each[k]).to_double() : 0.0;
  }

  // As many starts; and no rate of a regular precession has gone through infinity, to the other
  // sign.
  bool is_alike(const symtop_solutions& other) const {
    if (other.number != centre_.number) return false;
    for (int start = 0; seen_ <= SYMTOP_SPIN_AND_TURN && start < centre_.number; start++)
      if (other.each[start].phi_dot * centre_.each[start].phi_dot < 0) return false;
    return true;
  }

  bool look_at_grid() {
    for (auto& numbers : best_)
      for (auto& sides : numbers)
        for (Best& each : sides) each.value = -INFINITY;
    for (Best& each : nearest_) each.value = -INFINITY;
    double at[MOST_KNOWN];
    const int LAST = SPREAD_POINTS - 1;
    for (int place = 0; place < SPREAD_POINTS * SPREAD_POINTS * SPREAD_POINTS; place++) {
      bool is_new = true;
      for (int k = 0, rest = place; k < MOST_KNOWN; k++, rest /= SPREAD_POINTS) {
        at[k] = is_axis(k) ? 2.0 * (rest % SPREAD_POINTS) / LAST - 1 : 0.0;
        is_new = is_new && (is_axis(k) || rest % SPREAD_POINTS == 0);
      }
      if (is_new && !look_at(at)) return false;
    }
    return true;
  }

  static void keep_larger(Best& best, double value, const double at[MOST_KNOWN]) {
    if (value > best.value) best = {value, {at[0], at[1], at[2]}};
  }

  bool look_at(const double at[MOST_KNOWN]) {
    const symtop_solutions found = solve_at(at);
    if (!is_alike(found)) return false;
    for (int start = 0; start < centre_.number; start++)
      for (int k = 0; k < START_NUMBERS; k++)
        for (const int side : {-1, 1})
          keep_larger(best_of(start, k, side), side * found.each[start].*NUMBERS_OF_START[k], at);
    const Margins margins = find_margins(top_, seen_, find_known(at).numbers);
    for (int k = 0; k < margins.number; k++) keep_larger(nearest_[k], -find_share(margins, k), at);
    return true;
  }

  // True if the number of starts changes between the points of the grid.
  bool may_end() const {
    for (int k = 0; k < margins_.number; k++) {
      const double nearest = climb(nearest_[k], [&](const double at[MOST_KNOWN]) {
        return -find_share(find_margins(top_, seen_, find_known(at).numbers), k);
      });
      if (nearest >= 0) return true;
    }
    return false;
  }

  double improve(int start, int k, int side) const {
    return climb(best_[start][k][side > 0], [&](const double at[MOST_KNOWN]) {
      const symtop_solutions found = solve_at(at);
      return is_alike(found) ? side * found.each[start].*NUMBERS_OF_START[k] : NAN;
    });
  }

  // One step along an axis, if it stays in the box and makes the value larger; NaN is not.
  template <class Value>
  static bool step(Best& best, int axis, double way, const Value& find_value) {
    Best next = best;
    next.at[axis] = std::fmin(1.0, std::fmax(-1.0, best.at[axis] + way));
    if (next.at[axis] == best.at[axis]) return false;
    next.value = find_value(next.at);
    if (!(next.value > best.value)) return false;
    best = next;
    return true;
  }

  template <class Value>
  bool step_anywhere(Best& best, double size, const Value& find_value) const {
    bool has_moved = false;
    for (int axis = 0; axis < MOST_KNOWN; axis++)
      for (const double way : {-size, size})
        if (is_axis(axis)) has_moved |= step(best, axis, way, find_value);
    return has_moved;
  }

  // The extreme next to the best place of the grid, by steps that are halved where none is better.
  template <class Value>
  double climb(Best best, const Value& find_value) const {
    const double least = std::ldexp(1.0, -SPREAD_HALVINGS);
    // Most numbers are monotone: the best place is a corner, and a small step from it is no better.
    if (is_corner(best) && !step_anywhere(best, least, find_value)) return best.value;
    for (double size = 0.5; size >= least;)
      if (!step_anywhere(best, size, find_value)) size /= 2;
    return best.value;
  }

  bool is_corner(const Best& best) const {
    for (int k = 0; k < MOST_KNOWN; k++)
      if (is_axis(k) && std::fabs(best.at[k]) != 1) return false;
    return true;
  }
};

inline symtop_spreads find_spreads(const symtop_top& top, symtop_question seen, const double* known,
                                   const double* half_widths) {
  return SpreadFinder(top, seen, known, half_widths).find();
}

}  // namespace symtop

// How far what is known is from where a start begins or ends (derivation.md, section 12).
//
// Each margin is a smooth function of what is known, and vanishes where the number of starts
// changes. The starts of a tilt and a turn, of a dip and of a nutation period begin and end at
// values that are monotone in what is known: in a box the corners say all, and there is no margin.
#pragma once

#include "starts.hpp"

namespace symtop {

const int MOST_MARGINS = 4;

struct Margins {
  int number = 0;
  Long each[MOST_MARGINS];

  void add(const Long& margin) { each[number++] = margin; }
};

// The discriminant: at zero two rates meet, and then there is none.
inline void find_margin_of_rates(const symtop_top& top, const double* known, Margins& margins) {
  const Long spin = Long(top.Iz) * Long(known[1]);
  const Long product = (Long(top.Ix) - Long(top.Iz)) * find_long_cosine(known[0]) * Long(top.Mgl);
  margins.add(spin * spin - product.scale(2));
}

// cos(theta) = N/D of both directions, from 1 and from -1. It is a parabola of the period, so that
// it may leave these limits on the way from one period to another.
inline void find_margins_of_tilt(const symtop_top& top, const double* known, Margins& margins) {
  const Long one(1.0), pace = Long(TWO_PI) / Long(known[1]);
  const Long whole = (Long(top.Ix) - Long(top.Iz)) * pace * pace;
  if (!whole.sign) return;  // a sphere has no starts
  for (const double sign : {1.0, -1.0}) {
    const Long share = Long(top.Iz) * Long(known[0]) * pace * Long(sign) - Long(top.Mgl);
    margins.add(one - share / whole);
    margins.add(one + share / whole);
  }
}

// theta'^2 at the bottom of the effective potential: below 0 no motion has so little energy.
inline void find_margin_of_energy(const Conserved& known, Margins& margins) {
  margins.add(known.well.find_square(known.well.find_bottom()) - known.rounding);
}

inline Margins find_margins(const symtop_top& top, symtop_question seen, const double* known) {
  Margins margins;
  if (seen == SYMTOP_TILT_AND_SPIN) find_margin_of_rates(top, known, margins);
  if (seen == SYMTOP_SPIN_AND_TURN) find_margins_of_tilt(top, known, margins);
  if (seen == SYMTOP_CONSTANTS) find_margin_of_energy(read_constants(top, known), margins);
  if (seen == SYMTOP_GOLDSTEIN) find_margin_of_energy(read_goldstein(top, known), margins);
  return margins;
}

}  // namespace symtop

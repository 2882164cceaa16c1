// The body that parts on an axle without mass make: what a class can weigh and measure.
#pragma once

#include "attitude.hpp"

namespace symtop {

// Moments of a part about its centre, across the axis and along it, as shares of mass times size^2.
inline Pair find_shares(symtop_part_kind kind) {
  switch (kind) {
    case SYMTOP_POINT: return {0.0, 0.0};
    case SYMTOP_ROD: return {1.0 / 12, 0.0};
    case SYMTOP_HOOP: return {1.0 / 2, 1.0};
    case SYMTOP_DISC: return {1.0 / 4, 1.0 / 2};
    case SYMTOP_BALL: return {2.0 / 5, 2.0 / 5};
  }
  return {NAN, NAN};
}

// Moments about the common centre: by distances from it (Steiner), of which nothing is subtracted
// that a moment is made of.
inline symtop_body find_body(const symtop_part_kind* kinds, const symtop_part_of_body* parts,
                             size_t count) {
  double mass = 0.0, lever = 0.0;
  for (size_t i = 0; i < count; i++) {
    mass += parts[i].mass;
    lever += parts[i].mass * parts[i].distance;
  }
  symtop_body body = {mass, lever / mass, 0.0, 0.0};
  for (size_t i = 0; i < count; i++) {
    const Pair shares = find_shares(kinds[i]);
    const double size = kinds[i] == SYMTOP_POINT ? 0.0 : parts[i].size;
    const double away = parts[i].distance - body.arm, square = parts[i].mass * size * size;
    body.Ix += shares.x * square + parts[i].mass * away * away;
    body.Iz += shares.y * square;
  }
  return body;
}

}  // namespace symtop

// A flat disc on an axle without mass: the body that a class can weigh and measure.
#pragma once

#include "arguments.hpp"

symtop_status symtop_find_disc_top(const double disc[3], double gravity, symtop_top* top) {
  symtop_status status = symtop::admit({disc, top});
  if (status != SYMTOP_OK) return status;
  const double mass = disc[0], radius = disc[1], distance = disc[2];
  if (!symtop::are_finite(disc, 3) || !symtop::are_finite(&gravity, 1) || !(mass > 0) ||
      !(radius > 0))
    return SYMTOP_BAD_DISC;
  // About its centre a disc has half as much across its axis as about it.
  const double half = mass * radius * radius / 4, lever = mass * distance;
  const symtop_top found = {half + lever * distance, 2 * half, lever * gravity};
  status = symtop::accept(found);
  if (status == SYMTOP_OK) *top = found;
  return status;
}

symtop_status symtop_find_disc(const symtop_top* top, double gravity, double disc[3]) {
  symtop_status status = symtop::admit({top, disc});
  if (status != SYMTOP_OK) return status;
  const symtop_top given = *top;
  status = symtop::accept(given);
  if (status != SYMTOP_OK) return status;
  if (!symtop::are_finite(&gravity, 1)) return SYMTOP_BAD_DISC;
  // M d^2 and M d; a disc whose Iz is 2 Ix has its centre in the pivot, and no weight.
  const double square = given.Ix - given.Iz / 2, lever = given.Mgl / gravity;
  const double distance = square / lever, mass = lever / distance;
  const double radius = std::sqrt(2 * given.Iz / mass), found[] = {mass, radius, distance};
  const bool is_there = square > 0 && mass > 0 && symtop::are_finite(found, 3);
  for (int k = 0; k < 3; k++) disc[k] = is_there ? found[k] : NAN;
  return SYMTOP_OK;
}

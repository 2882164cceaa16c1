// A flat disc on an axle without mass: the body that a class can weigh and measure.
#pragma once

#include "arguments.hpp"

symtop_status symtop_find_disc_top(const double disc[3], double gravity, symtop_top* top) {
  if (!symtop::is_sound()) return SYMTOP_BAD_ARITHMETIC;
  const double mass = disc[0], radius = disc[1], distance = disc[2];
  // About its centre a disc has half as much across its axis as about it.
  const double half = mass * radius * radius / 4, lever = mass * distance;
  *top = {half + lever * distance, 2 * half, lever * gravity};
  return symtop::is_top(top->Ix, top->Iz, top->Mgl) ? SYMTOP_OK : SYMTOP_BAD_TOP;
}

symtop_status symtop_find_disc(const symtop_top* top, double gravity, double disc[3]) {
  if (!symtop::is_sound()) return SYMTOP_BAD_ARITHMETIC;
  if (!symtop::is_top(top->Ix, top->Iz, top->Mgl)) return SYMTOP_BAD_TOP;
  // M d^2 and M d; a disc whose Iz is 2 Ix has its centre in the pivot, and no weight.
  const double square = top->Ix - top->Iz / 2, lever = top->Mgl / gravity;
  const double distance = square / lever, mass = lever / distance;
  const bool is_there = square > 0 && mass > 0 && symtop::are_finite(&mass, 1);
  disc[0] = is_there ? mass : NAN;
  disc[1] = is_there ? std::sqrt(2 * top->Iz / mass) : NAN;
  disc[2] = is_there ? distance : NAN;
  return SYMTOP_OK;
}

// Bodies that a class can weigh and measure.
#pragma once

#include "../rule/body.hpp"
#include "arguments.hpp"

namespace symtop {

inline bool is_part(const symtop_part_kind& kind, const symtop_part_of_body& part) {
  const double numbers[] = {part.mass, part.distance};
  const bool has_size = read_number(kind) != SYMTOP_POINT;
  return is_number_of(read_number(kind), SYMTOP_BALL) && are_finite(numbers, 2) && part.mass > 0 &&
         (!has_size || (are_finite(&part.size, 1) && part.size > 0));
}

}  // namespace symtop

symtop_status symtop_find_body(const symtop_part_kind* kinds, const symtop_part_of_body* parts,
                               size_t count, symtop_body* body, size_t* done) {
  using namespace symtop;
  if (!body) return SYMTOP_BAD_POINTER;
  const symtop_status status = compute_each(
      count, sizeof(symtop_part_of_body), {kinds, parts}, done,
      [&](size_t i) { return is_part(kinds[i], parts[i]) ? SYMTOP_OK : SYMTOP_BAD_PART; });
  if (status != SYMTOP_OK) return status;
  if (!count) return SYMTOP_BAD_PART;
  *body = find_body(kinds, parts, count);
  return SYMTOP_OK;
}

symtop_status symtop_find_body_top(const symtop_body* body, double gravity, symtop_top* top) {
  symtop_status status = symtop::admit({body, top});
  if (status != SYMTOP_OK) return status;
  if (!symtop::are_finite(&gravity, 1)) return SYMTOP_BAD_DISC;
  const double numbers[] = {body->mass, body->arm, body->Ix, body->Iz};
  if (!symtop::are_finite(numbers, 4)) return SYMTOP_BAD_PART;
  const double lever = body->mass * body->arm;  // the square of a long arm could overflow
  const symtop_top found = {body->Ix + lever * body->arm, body->Iz, lever * gravity};
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

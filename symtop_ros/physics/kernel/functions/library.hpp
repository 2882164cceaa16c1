// What a caller that cannot read symtop.h, such as Python's ctypes, compares with what it expects.
#pragma once

#include "motion.hpp"

#ifdef SYMTOP_DIGEST

extern "C" {

// Of the sources that the library was built from.
SYMTOP_API extern const char symtop_digest[];
const char symtop_digest[] = "symtop " SYMTOP_DIGEST;

// Sizes of the records in bytes, in the order in which symtop.h has them.
SYMTOP_API extern const uint32_t symtop_sizes[];
const uint32_t symtop_sizes[] = {
    sizeof(symtop_start),    sizeof(symtop_pushes),       sizeof(symtop_clock),
    sizeof(symtop_piece),    sizeof(symtop_rates),        sizeof(symtop_constants),
    sizeof(symtop_top),      sizeof(symtop_part_of_body), sizeof(symtop_body),
    sizeof(symtop_solution), sizeof(symtop_solutions),    sizeof(symtop_spreads),
    sizeof(symtop_place),    sizeof(symtop_reason),       sizeof(symtop_average),
    sizeof(symtop_cause),    sizeof(symtop_lift),         sizeof(symtop_means),
    sizeof(symtop_verdict),  sizeof(symtop_held),         sizeof(symtop_present),
    sizeof(symtop_energies), sizeof(symtop_exchange)};

// symtop_new and symtop_state in the fewest arguments, each of which costs such a caller a quarter
// of a microsecond. The motion, or null if it is refused; the state at the time state[0].
SYMTOP_API symtop_motion* symtop_make(const symtop_start* start) {
  symtop_motion* motion;
  symtop_new(start, &motion);
  return motion;
}

SYMTOP_API symtop_status symtop_read(symtop_motion* motion, double state[7]) {
  return symtop_state(motion, state[0], state, state + 4);
}

// SYMTOP_BAD_ARITHMETIC in a thread in which a caller's own sums would be wrong, too.
SYMTOP_API symtop_status symtop_check_arithmetic(void) { return symtop::admit({}); }
}

#endif

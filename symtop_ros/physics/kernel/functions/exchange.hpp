// Energy and momentum between two states.
#pragma once

#include "../rule/exchange.hpp"
#include "arguments.hpp"

symtop_status symtop_find_exchange(const symtop_top* top, const double* orientations,
                                   const double* angular_velocities, symtop_exchange* exchange) {
  using namespace symtop;
  symtop_status status = admit({top, orientations, angular_velocities, exchange});
  if (status != SYMTOP_OK) return status;
  const symtop_top given = *top;
  double q[8], omega[6];
  status = accept(given);
  for (int k = 0; k < 2 && status == SYMTOP_OK; k++)
    status =
        accept_state(orientations + 4 * k, angular_velocities + 3 * k, q + 4 * k, omega + 3 * k);
  if (status == SYMTOP_OK)
    *exchange = find_exchange(given, EnergyRates(q, omega), EnergyRates(q + 4, omega + 3));
  return status;
}

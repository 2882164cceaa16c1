// Where states are written.
#pragma once

#include "exact/closed_form.hpp"

namespace symtop {

struct Target {  // where states are written: orientation (n, 4) and omega (n, 3)
  double *orientation, *omega;

  Target from(int64_t i) const { return {orientation + 4 * i, omega + 3 * i}; }
};

inline void write_state(const Attitude& state, double omega_z, const Target& to) {
  double *q = to.orientation, *omega = to.omega;
  q[0] = state.w;
  q[1] = state.x;
  q[2] = state.y;
  q[3] = state.z;
  omega[0] = state.omega_x;
  omega[1] = state.omega_y;
  omega[2] = omega_z;
}

}  // namespace symtop

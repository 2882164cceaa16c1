// A motion under gravity that one thread sets up, whole, and that many threads may then read.
//
// It is a GravityMotion (gravity.hpp) without stages, locks and atomic numbers, from the same
// headers. The same source serves the host, where its bits are compared with those of symtop.h.
#pragma once

#include "no_fma.hpp"
#include "exact/free.hpp"
#include "functions/arguments.hpp"
#include "target.hpp"

namespace symtop {

// A launch is about the motions that are free or about the others, never about both. Of a function
// that had both, ptxas 13.0 and 13.5 kept an address of the stack in a uniform register and
// overwrote it in the other arm of the branch: an illegal access where one warp took both arms.
// Whether it does depends on the source around it; test/physics/gpu/registers.py looks for it in
// the machine code.
struct DeviceMotion {
  ClosedForm closed;
  FreeMotion free;
  double omega_z;
  int32_t status;  // a symtop_status; of a motion that is refused nothing else is set
  bool is_free;

  // Returns the start, with Mgl > 0, of which is_turned_over says how it was given.
  Start admit(const symtop_start& given, bool& is_turned_over) {
    symtop_start accepted = given;
    status = accept(accepted);
    Start start = to_start(accepted);
    is_turned_over = turn_over(start);
    is_free = status == SYMTOP_OK && symtop::is_free(start);
    omega_z = start.wz;
    return start;
  }

  // Sets the motion up, unless it is of the other kind: that is for the other launch.
  template <bool FREE>
  void prepare(const symtop_start& given) {
    bool is_turned_over;
    const Start start = admit(given, is_turned_over);
    if (status != SYMTOP_OK || is_free != FREE) return;
    if constexpr (FREE) {
      free.solve(start, is_turned_over);
    } else {
      closed.solve(start, is_turned_over);
      closed.prepare_states();
      closed.prepare_first_instants();
    }
  }

  // Writes the state at a time, or NaN where there is none, unless the motion is of the other kind.
  template <bool FREE>
  void read(double t, const Target& to, uint8_t* to_status) const {
    if (status != SYMTOP_OK) return refuse(status, to, to_status);
    if (is_free != FREE) return;
    if (!std::isfinite(t)) return refuse(SYMTOP_BAD_TIME, to, to_status);
    if constexpr (FREE) {
      if (free.is_far(t)) return refuse(SYMTOP_TOO_FAR, to, to_status);
      write_state(free.at(t), omega_z, to);
    } else {
      if (closed.is_far(t)) return refuse(SYMTOP_TOO_FAR, to, to_status);
      write_state(closed.at(t), omega_z, to);
    }
    *to_status = SYMTOP_OK;
  }

  static void refuse(int32_t reason, const Target& to, uint8_t* to_status) {
    for (int k = 0; k < 4; k++) to.orientation[k] = NAN;
    for (int k = 0; k < 3; k++) to.omega[k] = NAN;
    *to_status = static_cast<uint8_t>(reason);
  }
};

}  // namespace symtop

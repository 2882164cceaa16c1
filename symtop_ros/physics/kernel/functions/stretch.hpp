// A motion on which nothing strikes: under gravity alone, or driven by friction or a torque.
#pragma once

#include <new>

#include "../driven/motion.hpp"
#include "../gravity.hpp"
#include "arguments.hpp"

namespace symtop {

inline DrivenArguments to_driven(const symtop_start& s) {
  DrivenArguments a = {s.Ix, s.Iz, s.Mgl, s.friction[SYMTOP_AXIAL], s.friction[SYMTOP_TRANSVERSE],
                       {},   {},   {}};
  std::memcpy(a.torque, s.torque, sizeof a.torque);
  std::memcpy(a.orientation, s.orientation, sizeof a.orientation);
  std::memcpy(a.omega, s.angular_velocity, sizeof a.omega);
  return a;
}

inline Start to_start(const symtop_start& s, const BodyState& body) {
  Start start = to_start(s);
  const Double2 *q = body.q, *omega = body.omega;
  start.rest = {q[0].low, q[1].low, q[2].low, q[3].low, omega[0].low, omega[1].low};
  return start;
}

inline symtop_status to_status(Progress progress) {
  static const symtop_status STATUSES[] = {SYMTOP_OK,       SYMTOP_TOO_FAST,   SYMTOP_TOO_STIFF,
                                           SYMTOP_TOO_LONG, SYMTOP_MORE_STEPS, SYMTOP_NO_MEMORY};
  return STATUSES[progress];
}

struct Stretch {
  symtop_start start;
  GravityMotion gravity;
  DrivenMotion driven;
  bool is_driven;

  explicit Stretch(const symtop_start& s, bool is_clamped = false, double tolerance = 0.0)
      : start(s),
        gravity(is_clamped ? clamp(to_start(s)) : to_start(s)),
        driven(to_driven(s), tolerance),
        is_driven(symtop::is_driven(s)) {}

  // From a state that is carried on, of which `s` has the doubles.
  Stretch(const symtop_start& s, const BodyState& body, const Variables& carried)
      : start(s),
        gravity(to_start(s, body)),
        driven(to_driven(s), 0.0, &carried),
        is_driven(symtop::is_driven(s)) {}

  // States at the times that `split` returns in two parts, or under gravity at `times`; *steps is
  // lowered by those taken.
  template <class Split, class... Times>
  symtop_status fill(size_t count, double* steps, const Target& to, size_t* written,
                     const Split& split, const Times&... times) {
    const int64_t n = static_cast<int64_t>(count);
    int64_t done = 0;
    symtop_status status = SYMTOP_OK;
    if (is_driven) {
      status = to_status(driven.fill(split, n, steps, to, &done));
    } else {
      done = gravity.fill(to, n, times...);
      if (done < n) status = SYMTOP_TOO_FAR;
    }
    *written = static_cast<size_t>(done);
    return status;
  }
};

}  // namespace symtop

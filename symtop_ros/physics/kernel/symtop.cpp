// The functions of symtop.h. This is the one file that is compiled. The first headers are for all
// that is behind them.
#include "compiler.hpp"
#include "no_fma.hpp"
#include "symtop.h"

#include "functions/body.hpp"
#include "functions/exchange.hpp"
#include "functions/library.hpp"
#include "functions/many.hpp"
#include "functions/motion.hpp"
#include "functions/start.hpp"

const char* symtop_version(void) { return SYMTOP_VERSION; }

const char* symtop_describe_status(symtop_status status) {
  switch (status) {
    case SYMTOP_OK: return "done";
    case SYMTOP_NO_MEMORY: return "memory must suffice for the motion";
    case SYMTOP_BAD_TOP:
      return "Ix, Iz and Mgl must be finite, 1e-100 to 1e100 in size, with Iz > 0 and at most 2 Ix";
    case SYMTOP_BAD_ORIENTATION: return "orientation must be a quaternion of norm 1 within 0.001";
    case SYMTOP_BAD_ANGULAR_VELOCITY:
      return "angular_velocity must be finite, at most 1e100 rad/s in size";
    case SYMTOP_BAD_FRICTION: return "friction must be finite and >= 0 N m s";
    case SYMTOP_BAD_TORQUE: return "torque must be finite";
    case SYMTOP_BAD_TIME:
      return "times must be finite, and the parts of a clock 0 or 1e-100 to 1e100 in size";
    case SYMTOP_TOO_FAR: return "times must be within 1e15 turns of the start";
    case SYMTOP_TOO_FAST: return "times must be before the motion becomes too fast for doubles";
    case SYMTOP_TOO_STIFF: return "times must be within 1e5 decay times of what has been reached";
    case SYMTOP_TOO_LONG: return "times must be within 1e7 steps of what has been reached";
    case SYMTOP_MORE_STEPS: return "most_steps must suffice for the way: call again to continue";
    case SYMTOP_BAD_ARITHMETIC:
      return "arithmetic must be that of IEEE 754: sums in the order of the source, rounded to the "
             "nearest, subnormal numbers kept (no option such as -fassociative-math, no library "
             "that "
             "was linked with -ffast-math)";
    case SYMTOP_BAD_ANGLES: return "angles and rates must be finite";
    case SYMTOP_BAD_KICK: return "kick must be finite, and leave phi' at most 1e100 rad/s in size";
    case SYMTOP_VERTICAL:
      return "axis must be tilted (phi' is undefined on the vertical; an angular impulse works "
             "there)";
    case SYMTOP_BAD_POINTER: return "pointers must not be null";
    case SYMTOP_BAD_COUNT: return "count must be so small that the arrays fit into memory";
    case SYMTOP_BAD_HOLD:
      return "hold must be the spin rate or the spin momentum (nothing is held by impulses alone)";
    case SYMTOP_BAD_KICK_KIND: return "kind of kick must be one of symtop_kick_kind";
    case SYMTOP_BAD_RATE: return "rates must be finite, at most 1e100 rad/s in size";
    case SYMTOP_BAD_STEPS: return "most_steps must be >= 0";
    case SYMTOP_BAD_DISC: return "gravity must be finite";
    case SYMTOP_BAD_PUSHES:
      return "pushes must be a whole number of 1 to 1000, 0.01 to 1000 in a second, with a finite "
             "impulse";
    case SYMTOP_BAD_CLAMP:
      return "a clamped motion must start with a tilted axis, without friction, torque and pushes";
    case SYMTOP_BAD_QUESTION: return "question must be one of symtop_question";
    case SYMTOP_BAD_PART:
      return "parts must be one or more, each of a kind, with mass and size > 0, and finite "
             "numbers";
    case SYMTOP_BAD_TOLERANCE: return "tolerance must be 0 or 1e-15 to 1e-6";
  }
  return "status must be one of symtop_status";
}

/* The motion of the heavy symmetric top, for C, C++, Rust, WebAssembly and Python.
 *
 * A motion belongs to a top, a start, and the friction and the torque that act on it. Without
 * friction and torque its states are exact at any time, by elliptic functions; with them they are
 * integrated, by Taylor series. The bits are those of Python's symtop_ros.physics, on every
 * processor.
 *
 * Quaternions are (w, x, y, z), body to world; angular velocities are in the body frame, in rad/s.
 * The z axis of the world points up, that of the body along the axis of the top, away from the
 * pivot. Units are kg m^2, J, s, rad/s, N m, and N m s for friction.
 *
 * There is no global state. Threads may use different motions, and the same one, at the same time.
 * To build it, compile symtop.cpp as C++17 with -ffp-contract=off, and link it. Without that option
 * a compiler may fuse products and sums, and the last bits are others.
 */
#ifndef SYMTOP_H
#define SYMTOP_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct symtop_motion symtop_motion;

typedef struct {
  double Ix, Iz, Mgl;         /* moments about the pivot, across the axis and along it; weight times
                                 distance: negative for a top that hangs below its pivot */
  double orientation[4];      /* at t = 0; of norm 1 within 1e-3: it is normalised */
  double angular_velocity[3]; /* at t = 0 */
  double friction[2];         /* coefficients >= 0: axial and transverse torque per rate, N m s */
  double torque[3];           /* applied torque in the world frame, constant */
} symtop_start;

typedef enum {
  SYMTOP_OK,
  SYMTOP_NO_MEMORY,
  SYMTOP_BAD_TOP,
  SYMTOP_BAD_ORIENTATION,
  SYMTOP_BAD_ANGULAR_VELOCITY,
  SYMTOP_BAD_FRICTION,
  SYMTOP_BAD_TORQUE,
  SYMTOP_BAD_TIME,
  SYMTOP_TOO_FAR,   /* more than 1e15 turns from the start */
  SYMTOP_TOO_FAST,  /* the driven motion becomes too fast on the way */
  SYMTOP_TOO_STIFF, /* friction stops the top so soon that the way takes too many steps */
  SYMTOP_MORE_STEPS /* the allowed steps did not suffice: call again, and the integration goes on */
} symtop_status;

/* A sentence without a full stop: "NAME must be CONDITION". It is never to be freed. */
const char* symtop_describe_status(symtop_status status);

/* Make a motion. On success it is written to *motion and has to be freed, else *motion is null. */
symtop_status symtop_new(const symtop_start* start, symtop_motion** motion);

void symtop_free(symtop_motion* motion); /* null is allowed */

/* Make the motion that goes on from a time with another torque, such as a hand that begins to push.
 * Its times count from there. */
symtop_status symtop_continue(symtop_motion* motion, double t, const double torque[3],
                              symtop_motion** continued);

/* The state at one time in s of either sign. A driven motion is integrated as far as it takes. */
symtop_status symtop_state(symtop_motion* motion, double t, double orientation[4],
                           double angular_velocity[3]);

/* States at `count` times in s, in any order; driven motions take least time if they lead away from
 * the start. Orientations are (count, 4), angular velocities (count, 3). Driven motions take at
 * most `most_steps` steps, INFINITY for as many as are needed. *written is the number of states
 * written, from the first on: all of them, or those before the one that the status is about. */
symtop_status symtop_states(symtop_motion* motion, const double* times, size_t count,
                            double most_steps, double* orientation, double* angular_velocity,
                            size_t* written);

/* Exact times: integers in ns, of at most 63 bits. The time of the motion is the sum of `elapsed`,
 * in ns, and factor times the stamp. Nothing of it is rounded. The factor and the parts of `elapsed`
 * are 0 or, in size, from 1e-100 to 1e100. */
typedef struct {
  double factor;
  double elapsed[4];
} symtop_clock;

symtop_status symtop_states_of_clock(symtop_motion* motion, const symtop_clock* clock,
                                     const int64_t* stamps, size_t count, double most_steps,
                                     double* orientation, double* angular_velocity,
                                     size_t* written);

/* Integrate towards a time in at most so many steps. *reached is the time in s up to which states
 * now take no integration; for a motion that is not driven it is the time itself. */
symtop_status symtop_reach(symtop_motion* motion, double t, double most_steps, double* reached);

typedef enum {
  SYMTOP_REGULAR,          /* the tilt is constant */
  SYMTOP_UNIDIRECTIONAL,   /* phi' has one sign */
  SYMTOP_CUSPS,            /* phi' is zero at one turning angle */
  SYMTOP_LOOPING,          /* phi' has opposite signs at the two turning angles */
  SYMTOP_THROUGH_THE_POLE, /* the axis passes through the vertical */
  SYMTOP_ASYMPTOTIC,       /* the axis approaches the vertical for ever */
  SYMTOP_SLEEPING,         /* the axis rests on the vertical */
  SYMTOP_DRIVEN            /* friction or a torque acts */
} symtop_kind;

symtop_kind symtop_find_kind(symtop_motion* motion);

/* Of a driven motion the following ones are those that would follow from the start under gravity
 * alone. */

/* The smallest and the largest angle theta in rad between the axis and the vertical. */
void symtop_find_turning_angles(symtop_motion* motion, double angles[2]);

typedef struct {
  double nutation_period;         /* s; infinite if theta does not return */
  double mean_precession_rate;    /* mean phi' in rad/s; NaN if the axis meets the vertical */
  double mean_spin_rate;          /* mean psi' in rad/s; NaN there as well */
  double precession_per_nutation; /* in turns; NaN there, and if theta does not return */
  int spin_reverses;              /* 1 if psi' takes both signs */
} symtop_rates;

void symtop_find_rates(symtop_motion* motion, symtop_rates* rates);

#ifdef __cplusplus
}
#endif

#endif

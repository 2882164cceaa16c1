/* The motion of the heavy symmetric top, for C, C++, Rust, WebAssembly and Python.
 *
 * A motion belongs to a top, a start, and the friction and the torque that act on it. Without
 * friction and torque its states are exact at any time, by elliptic functions; with them they are
 * integrated, by Taylor series. The bits are those of Python's symtop_ros.physics, on every
 * processor.
 *
 * Quaternions are (w, x, y, z), body to world; angular velocities are in the body frame, in rad/s.
 * The z axis of the world points up, that of the body along the axis of the top, away from the
 * pivot. Euler angles are z-x-z in rad: phi (precession), theta (tilt), psi (spin). Units are
 * kg m^2, J, s, rad/s, N m, and N m s for friction and for impulses. An orientation that is given
 * may have a norm of 1 within 1e-3: it is normalised. One that is written has norm 1 to rounding.
 *
 * Functions on `count` elements read and write arrays of so many: a shape (count, 4) means four
 * numbers for each. *done is the number of elements written, from the first on: all of them, or
 * those before the one that the status is about. What a function writes must not overlap what it
 * reads, nor another argument that it writes: the numbers would be wrong, without a word.
 *
 * All arguments are looked at before they are used, and each refusal has a status with a sentence
 * (symtop_find_kind and symtop_find_engine return their value for the unknown instead):
 * numbers that are not finite or out of range, orientations without norm 1, null pointers, and
 * enums that are none. Arrays without elements may be null. Only a handle that is neither null nor
 * a motion is not found. What was not computed is not written, but for the element that is refused.
 *
 * There is no global state. Threads may use different motions, and the same one, at the same time.
 *
 * To build it, compile symtop.cpp as C++17 with -ffp-contract=off, and link it. It takes GCC or
 * Clang, 64 bits, or Clang for WebAssembly. Without that option a compiler may fuse products and
 * sums, and the last bits are others. With -ffast-math or -Ofast it does not compile: give
 * -fno-fast-math after them. What a compiler does not announce, such as -fassociative-math, and a
 * thread that does not round to the nearest or flushes subnormal numbers to zero, is found when a
 * function is called: the status is SYMTOP_BAD_ARITHMETIC, and nothing is written. (A library that
 * was linked with fast-math sets the latter for the thread that loads it.)
 */
#ifndef SYMTOP_H
#define SYMTOP_H

#include <stddef.h>
#include <stdint.h>

#define SYMTOP_VERSION "0.7.0.dev0"

/* Of a shared library, the functions below are exported. */
#ifndef SYMTOP_API
#if defined(_WIN32) && defined(SYMTOP_SHARED)
#define SYMTOP_API __declspec(dllexport)
#elif defined(__GNUC__)
#define SYMTOP_API __attribute__((visibility("default")))
#else
#define SYMTOP_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct symtop_motion symtop_motion;

/* Coefficients of friction: a torque per angular velocity along the axis, and across it. */
typedef enum { SYMTOP_AXIAL, SYMTOP_TRANSVERSE, SYMTOP_KINDS_OF_FRICTION } symtop_friction_kind;

typedef struct {
  double Ix, Iz, Mgl;         /* moments about the pivot, across the axis and along it; weight times
                         distance: negative for a top that hangs below its pivot */
  double orientation[4];      /* at t = 0; of norm 1 within 1e-3: it is normalised */
  double angular_velocity[3]; /* at t = 0 */
  double friction[SYMTOP_KINDS_OF_FRICTION]; /* coefficients >= 0, N m s */
  double torque[3];                          /* applied torque in the world frame, constant */
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
  SYMTOP_TOO_FAR,        /* more than 1e15 turns from the start */
  SYMTOP_TOO_FAST,       /* the driven motion becomes too fast on the way */
  SYMTOP_TOO_STIFF,      /* friction stops the top so soon that the way takes too many steps */
  SYMTOP_MORE_STEPS,     /* the allowed steps did not suffice: call again, and the integration goes
                            on */
  SYMTOP_BAD_ARITHMETIC, /* of the compiler or of the calling thread: see above */
  SYMTOP_BAD_ANGLES,
  SYMTOP_BAD_KICK,
  SYMTOP_VERTICAL, /* phi' is undefined on the vertical; an angular impulse works there */
  SYMTOP_TOO_LONG, /* the way to the time of a driven motion takes more than 1e7 steps */
  SYMTOP_BAD_POINTER,
  SYMTOP_BAD_COUNT, /* the arrays would be larger than any memory */
  SYMTOP_BAD_HOLD,  /* no symtop_hold, or SYMTOP_NOTHING where phi' is changed */
  SYMTOP_BAD_KICK_KIND,
  SYMTOP_BAD_RATE,
  SYMTOP_BAD_STEPS,
  SYMTOP_BAD_DISC,
  SYMTOP_BAD_PUSHES,
  SYMTOP_BAD_CLAMP,
  SYMTOP_BAD_QUESTION, /* no symtop_question */
  SYMTOP_BAD_PART,
  SYMTOP_BAD_TOLERANCE
} symtop_status;

/* The version of the library; SYMTOP_VERSION is that of the header. */
SYMTOP_API const char* symtop_version(void);

/* A sentence without a full stop: "NAME must be CONDITION". It is never to be freed. */
SYMTOP_API const char* symtop_describe_status(symtop_status status);

/* Make a motion. On success it is written to *motion and has to be freed, else *motion is null. */
SYMTOP_API symtop_status symtop_new(const symtop_start* start, symtop_motion** motion);

/* Equal pushes on the axle, as SYMTOP_AXLE_IMPULSE: the first one at t = 0, the others at the
 * nearest whole nanoseconds to multiples of 1/rate. */
typedef struct {
  double impulse; /* angular impulse of each, N m s */
  double rate;    /* pushes in a second: 0.01 to 1000 */
  double number;  /* of all, with the first one: 1 to 1000, whole */
} symtop_pushes;

/* Make a motion that is pushed again and again. It starts with the state that the first push
 * leaves; it is as exact as other motions, as 32 digits are carried from one push to the next; the
 * start of a piece that symtop_find_piece writes is rounded to doubles. From a push on that cannot
 * be (the axis is vertical, or the top would be too fast) there are no states: their status says
 * why. */
SYMTOP_API symtop_status symtop_new_pushed(const symtop_start* start, const symtop_pushes* pushes,
                                           symtop_motion** motion);

/* Make a motion whose precession is held: a hand clamps the outer ring of the gimbal, so that the
 * axis stays in its vertical plane. The clamp takes phi' at t = 0 in an instant, and holds theta'
 * and the spin momentum; then the axis falls as a pendulum does, and the body turns about it at the
 * constant rate omega_z. Through the vertical the plane stays, and phi jumps by pi. The axis must
 * be tilted at t = 0, and neither friction nor a torque acts: SYMTOP_BAD_CLAMP. The angular
 * momentum about the vertical is not constant. */
SYMTOP_API symtop_status symtop_new_clamped(const symtop_start* start, symtop_motion** motion);

/* Make a motion that is less exact under friction or a torque, and takes less time. `tolerance` is
 * the local error of a step, in rad and relative to the angular velocity: 1e-15 to 1e-6, or 0 for a
 * motion as symtop_new makes it. In a step the axis turns by at most 4 rad about the angular
 * momentum; errors of steps add up. Without friction and torque the tolerance has no effect. */
SYMTOP_API symtop_status symtop_new_coarse(const symtop_start* start, double tolerance,
                                           symtop_motion** motion);

SYMTOP_API void symtop_free(symtop_motion* motion); /* null is allowed */

/* Make the motion that continues from a time with another torque, such as a hand that begins to
 * push, and without further pushes. Its times count from there. It has the clamp and the tolerance
 * of `motion`; with a clamp a torque is refused: SYMTOP_BAD_CLAMP. */
SYMTOP_API symtop_status symtop_continue(symtop_motion* motion, double t, const double torque[3],
                                         symtop_motion** continued);

/* The state at one time in s of either sign. A driven motion is integrated as far as it takes, but
 * not if more than 1e7 steps seem to be left, up to a minute: SYMTOP_TOO_LONG. To go further, first
 * reach times on the way. */
SYMTOP_API symtop_status symtop_state(symtop_motion* motion, double t, double orientation[4],
                                      double angular_velocity[3]);

/* States at `count` times in s, in any order; driven motions take least time if they lead away from
 * the start. Orientations are (count, 4), angular velocities (count, 3). Driven motions take at
 * most `most_steps` steps, INFINITY for as many as are needed. *written is the number of states
 * written, from the first on: all of them, or those before the one that the status is about. */
SYMTOP_API symtop_status symtop_states(symtop_motion* motion, const double* times, size_t count,
                                       double most_steps, double* orientation,
                                       double* angular_velocity, size_t* written);

/* Exact times: integers in ns, of at most 63 bits. The time of the motion is the sum of `elapsed`,
 * in ns, and factor times the stamp. Nothing of it is rounded. The factor and the parts of
 * `elapsed` are 0 or, in size, from 1e-100 to 1e100. */
typedef struct {
  double factor;
  double elapsed[4];
} symtop_clock;

SYMTOP_API symtop_status symtop_states_of_clock(symtop_motion* motion, const symtop_clock* clock,
                                                const int64_t* stamps, size_t count,
                                                double most_steps, double* orientation,
                                                double* angular_velocity, size_t* written);

/* What moves between two pushes; without pushes the motion itself. */
typedef struct {
  symtop_start start; /* after the last push up to then; its torque and friction as those of the
                         motion */
  double begin;       /* ns of the motion at that push, whole */
  double number;      /* of the pushes up to then, with the first one; 1 without pushes */
} symtop_piece;

/* The piece of a motion at a stamp of a clock, of a driven one in at most so many steps. */
SYMTOP_API symtop_status symtop_find_piece(symtop_motion* motion, const symtop_clock* clock,
                                           int64_t stamp, double most_steps, symtop_piece* piece);

/* Integrate towards a time in at most so many steps. *reached is the time in s up to which states
 * now take no integration; for a motion that is not driven it is the time itself. */
SYMTOP_API symtop_status symtop_reach(symtop_motion* motion, double t, double most_steps,
                                      double* reached);

typedef enum {
  SYMTOP_REGULAR,          /* the tilt is constant */
  SYMTOP_UNIDIRECTIONAL,   /* phi' has one sign */
  SYMTOP_CUSPS,            /* phi' is zero at one turning angle */
  SYMTOP_LOOPING,          /* phi' has opposite signs at the two turning angles */
  SYMTOP_THROUGH_THE_POLE, /* "through the pole": the axis passes through the vertical */
  SYMTOP_ASYMPTOTIC,       /* the axis approaches the vertical for ever */
  SYMTOP_SLEEPING,         /* the axis rests on the vertical */
  SYMTOP_DRIVEN,           /* friction, a torque or a series of pushes acts */
  SYMTOP_CLAMPED,          /* a hand holds phi, and the axis moves in a vertical plane */
  SYMTOP_UNKNOWN_KIND      /* the arithmetic is bad, see above, or the motion is null */
} symtop_kind;

SYMTOP_API symtop_kind symtop_find_kind(symtop_motion* motion);

/* Of a driven motion the following ones are those that would follow from the start under gravity
 * alone; symtop_find_piece has the start between two pushes. */

/* The smallest and the largest angle theta in rad between the axis and the vertical. */
SYMTOP_API symtop_status symtop_find_turning_angles(symtop_motion* motion, double angles[2]);

/* The rates and the precession are NaN if the axis meets the vertical, and if phi is held. */
typedef struct {
  double nutation_period;         /* s; infinite if theta does not return */
  double mean_precession_rate;    /* mean phi' in rad/s */
  double mean_spin_rate;          /* mean psi' in rad/s */
  double precession_per_nutation; /* in turns; NaN also if theta does not return */
  double mean_cosine; /* mean of cos(theta); that of the pole which theta approaches for ever */
  int spin_reverses;  /* 1 if psi' takes both signs */
} symtop_rates;

SYMTOP_API symtop_status symtop_find_rates(symtop_motion* motion, symtop_rates* rates);

/* 1e15 turns of the fastest phase in s, or the time of a push that cannot be: there are no states
 * from there on. Infinite for a motion with friction or a torque. */
SYMTOP_API symtop_status symtop_find_farthest_time(symtop_motion* motion, double* t);

/* 2 pi over the nutation period in rad/s, as the sum of two doubles; 0 if theta does not return. */
SYMTOP_API symtop_status symtop_find_nutation_rate(symtop_motion* motion, double rate[2]);

typedef enum {
  SYMTOP_CLOSED_FORM,   /* "closed form": elliptic functions */
  SYMTOP_FREE,          /* circular functions: Mgl is 0, or the axis rests on the vertical */
  SYMTOP_TAYLOR,        /* series in time: friction or a torque acts */
  SYMTOP_UNKNOWN_ENGINE /* the motion is null */
} symtop_engine;

SYMTOP_API symtop_engine symtop_find_engine(symtop_motion* motion);

/* ---- Many motions ---- */

/* Each of `count` motions at the same `times`, of which there are `each`. Orientations are (count,
 * each, 4), angular velocities (count, each, 3). left (count, each) is 0 for a state that was
 * written, and 1 for others: beyond 1e15 turns, or of a start that is refused. */
SYMTOP_API symtop_status symtop_states_of_many(const symtop_start* starts, size_t count,
                                               const double* times, size_t each,
                                               double* orientation, double* angular_velocity,
                                               uint8_t* left);

/* What is constant in a motion, as the functions above find it. */
typedef struct {
  symtop_kind kind;
  symtop_engine engine;
  double turning_angles[2];
  symtop_rates rates;
} symtop_constants;

SYMTOP_API symtop_status symtop_describe_many(const symtop_start* starts, size_t count,
                                              symtop_constants* constants, size_t* done);

/* ---- States, and Euler angles ---- */

/* States as all functions take them: orientations (count, 4) of norm 1, which those that have it to
 * rounding already are, bit for bit; and in these and in angular velocities (count, 3) zeros, of
 * the same sign, for numbers below 1e-100, whose squares would underflow. */
SYMTOP_API symtop_status symtop_normalize(const double* orientation, const double* angular_velocity,
                                          size_t count, double* normalized, double* rates);

/* States of angles (count, 3) and rates (count, 3), each phi, theta, psi. Angles of any size: whole
 * turns are taken off exactly. */
SYMTOP_API symtop_status symtop_from_angles(const double* angles, const double* rates, size_t count,
                                            double* orientation, double* angular_velocity,
                                            size_t* done);

/* Angles, 0 <= theta <= pi and the others within pi; phi is 0 on the vertical. */
SYMTOP_API symtop_status symtop_find_angles(const double* orientation, size_t count,
                                            double* angles);

/* Rates phi', theta', psi'; on the vertical phi' is 0, and theta' the rate of the axis. */
SYMTOP_API symtop_status symtop_find_angle_rates(const double* orientation,
                                                 const double* angular_velocity, size_t count,
                                                 double* rates);

/* ---- Regular precession ---- */

typedef struct {
  double Ix, Iz, Mgl; /* as in symtop_start */
} symtop_top;

/* What a body on the axis is made of, thin where it has a length or a radius: a point, a rod along
 * the axis, a hoop and a disc across it, a ball. */
typedef enum { SYMTOP_POINT, SYMTOP_ROD, SYMTOP_HOOP, SYMTOP_DISC, SYMTOP_BALL } symtop_part_kind;

typedef struct {
  double mass;     /* kg, > 0 */
  double size;     /* m, > 0: the length of a rod, or a radius; of a point it is not read */
  double distance; /* of its centre from the pivot, m; negative on the other side */
} symtop_part_of_body;

typedef struct {
  double mass, arm; /* kg; m, the distance of the centre of mass, negative on the other side */
  double Ix, Iz;    /* kg m^2, about the centre of mass */
} symtop_body;

/* The body that parts make on an axle without mass. SYMTOP_BAD_PART: *done is how many are
 * valid. */
SYMTOP_API symtop_status symtop_find_body(const symtop_part_kind* kinds,
                                          const symtop_part_of_body* parts, size_t count,
                                          symtop_body* body, size_t* done);

/* The top that a body makes, about the pivot, with gravity in m/s^2. */
SYMTOP_API symtop_status symtop_find_body_top(const symtop_body* body, double gravity,
                                              symtop_top* top);

/* The disc that moves as a top does; NaN if there is none, as for Mgl = 0 and for Iz = 2 Ix. */
SYMTOP_API symtop_status symtop_find_disc(const symtop_top* top, double gravity, double disc[3]);

/* What is held, with theta', while phi' changes. */
typedef enum {
  SYMTOP_SPIN_RATE,     /* psi': the article's comparison */
  SYMTOP_SPIN_MOMENTUM, /* Iz omega_z: a push on the axle, which cannot change it */
  SYMTOP_NOTHING        /* "": by an impulse: for symtop_kick and symtop_judge_kick alone */
} symtop_hold;

/* Rates phi' at which the tilt is constant, (count, 2): slow and fast, NaN for what there is not.
 * `spins` are psi', or omega_z if the spin momentum is held. They are the nearest doubles to the
 * exact rates, but |cos(theta)| <= 2^-52 counts as 0: no double is exactly pi/2. */
SYMTOP_API symtop_status symtop_find_regular_rates(const symtop_top* tops, const double* thetas,
                                                   const double* spins, size_t count,
                                                   symtop_hold hold, double* rates);

/* Ix theta''/sin(theta) in N m, as the sum of its parts for an observer who precesses with the top:
 * gravity, Coriolis and centrifugal torque about the line of nodes; and sin(theta): (count, 4). */
SYMTOP_API symtop_status symtop_find_tilt_torques(const symtop_top* tops, const double* thetas,
                                                  const double* phi_dots, const double* psi_dots,
                                                  size_t count, double* torques);

/* theta'' in rad/s^2 at the tilt of a start, for `count` rates phi'. */
SYMTOP_API symtop_status symtop_find_tilt_accelerations(const symtop_start* start, symtop_hold hold,
                                                        const double* phi_dots, size_t count,
                                                        double* theta_ddots);

/* ---- A start from what is seen ---- */

/* What is known of a motion, in the order of the numbers. In the first three the tilt is constant;
 * in the next two the axis is let go at rest. The dip is how far theta goes until the weight is
 * lowest. */
typedef enum {
  SYMTOP_TILT_AND_TURN,     /* "theta precession_period" */
  SYMTOP_TILT_AND_SPIN,     /* "theta psi_dot" */
  SYMTOP_SPIN_AND_TURN,     /* "psi_dot precession_period" */
  SYMTOP_TILT_AND_DIP,      /* "theta dip" */
  SYMTOP_TILT_AND_NUTATION, /* "theta nutation_period" */
  SYMTOP_CONSTANTS,         /* "energy p_phi p_psi" */
  SYMTOP_GOLDSTEIN          /* "alpha a b": 2 E/Ix - Iz omega_z^2/Ix, p_psi/Ix, p_phi/Ix */
} symtop_question;

/* What a number, or the top, would have to be for a motion to exist. */
typedef enum {
  SYMTOP_DEMANDS_NOTHING,  /* "": there are solutions */
  SYMTOP_DEMANDS_FINITE,   /* "finite": at most 1e100 in size, in SI units */
  SYMTOP_DEMANDS_BETWEEN,  /* "between": above `least` and below `most` */
  SYMTOP_DEMANDS_POSITIVE, /* "positive": above 0, and at most `most`, which may be infinite */
  SYMTOP_DEMANDS_LEAST,    /* "least": at least `least` */
  SYMTOP_DEMANDS_SIZE,     /* "size": at least `least` in size */
  SYMTOP_DEMANDS_REGULAR,  /* "regular": such that a tilt is constant; of an interval or two */
  SYMTOP_DEMANDS_UNEQUAL,  /* "unequal": the top must have Ix and Iz that differ */
  SYMTOP_DEMANDS_WEIGHT,   /* "weight": the top must have Mgl other than 0 */
  SYMTOP_DEMANDS_RATES,    /* "rates": such that no rate of a start exceeds 1e100 rad/s */
  SYMTOP_DEMANDS_SPIN,     /* "spin": other than 0, at which every rate is regular */
  SYMTOP_DEMANDS_RANGE     /* "range": in size above `least`, if it is a number, and below `most` */
} symtop_demand;

typedef struct {
  double theta, theta_dot, phi_dot, psi_dot; /* at phi = psi = 0 */
} symtop_solution;

typedef struct {
  symtop_demand demand;
  double which;       /* of the numbers it is made of, from 0; of no meaning for one of the top */
  double least, most; /* NaN where they say nothing */
  double number;      /* of the solutions, 0 to 4 */
  symtop_solution each[4]; /* NaN for what there is not */
} symtop_solutions;

/* All starts of a top that have what is known: two numbers, or three, of which a function reads
 * three. Those that precess with phi' > 0, or spin with psi' > 0, come first; of one motion the
 * start at its smaller theta does. On the vertical, where phi' is undefined, it is 0. */
SYMTOP_API symtop_status symtop_solve_start(const symtop_top* top, symtop_question seen,
                                            const double known[3], symtop_solutions* solutions);

typedef struct {
  symtop_solution least[4];
  symtop_solution most[4];
} symtop_spreads;

/* How far the same starts move while each number that is known moves by up to its half-width, if
 * that is > 0, to both sides. All NaN if somewhere within the half-widths there are more or fewer
 * starts, a rate of regular precession changes its sign, or p_phi = p_psi or -p_psi, where phi' has
 * no bound. */
SYMTOP_API symtop_status symtop_find_spreads(const symtop_top* top, symtop_question seen,
                                             const double known[3], const double half_widths[3],
                                             symtop_spreads* spreads);

/* ---- Kicks ---- */

typedef enum {
  SYMTOP_NEW_RATE,       /* "rate": amount: the new phi' in rad/s */
  SYMTOP_CHANGE_OF_RATE, /* "change": amount: what is added to phi' */
  SYMTOP_FACTOR_OF_RATE, /* "factor": amount: what phi' is multiplied by */
  SYMTOP_IMPULSE,        /* amount: an angular impulse (count, 3) in the world frame, N m s */
  SYMTOP_AXLE_IMPULSE    /* "axle": amount: the angular impulse, N m s, of a horizontal push on the
                            axle in the direction in which phi grows; theta' and Iz omega_z are held */
} symtop_kick_kind;

/* Angular velocities (count, 3) after kicks of one kind at fixed orientations (count, 4). An
 * impulse asks for no hold: any is allowed. */
SYMTOP_API symtop_status symtop_kick(const symtop_top* tops, const double* orientation,
                                     const double* angular_velocity, symtop_kick_kind kind,
                                     symtop_hold hold, const double* amounts, size_t count,
                                     double* kicked, size_t* done);

/* ---- Verdicts ---- */

typedef enum { SYMTOP_TOP, SYMTOP_AXIS } symtop_subject; /* the axis alone if Mgl < 0 */
typedef enum { SYMTOP_RISES, SYMTOP_FALLS, SYMTOP_STAYS } symtop_direction;
typedef enum {
  SYMTOP_RULE_SAYS_NOTHING, /* "" */
  SYMTOP_RULE_HOLDS,
  SYMTOP_RULE_FAILS
} symtop_rule;

/* Place of a rate among the regular ones. */
typedef enum {
  SYMTOP_NO_REGULAR_RATE,     /* "none" */
  SYMTOP_AT_THE_ONLY_RATE,    /* "only" */
  SYMTOP_ABOVE_THE_ONLY_RATE, /* "above" */
  SYMTOP_BELOW_THE_ONLY_RATE, /* "below" */
  SYMTOP_AT_THE_SLOW_RATE,    /* "slow" */
  SYMTOP_AT_THE_FAST_RATE,    /* "fast" */
  SYMTOP_BETWEEN_THE_RATES,   /* "between" */
  SYMTOP_OUTSIDE_THE_RATES,   /* "outside" */
  SYMTOP_EVERY_RATE           /* "every": no weight, no spin, and no centrifugal torque either */
} symtop_place_kind;

typedef struct {
  symtop_place_kind kind;
  double rate;
  double regular_rates[2]; /* NaN for what there is not */
} symtop_place;

typedef enum {
  SYMTOP_HURRIED,    /* by a factor above 1: the rule holds if theta'' is lower with the kick */
  SYMTOP_DELAYED,    /* by a factor below 1: it holds if theta'' is higher */
  SYMTOP_IF_HURRIED, /* the same of a kick that is only considered */
  SYMTOP_IF_DELAYED,
  SYMTOP_ANGULAR_IMPULSE,    /* in these cases it says nothing */
  SYMTOP_NO_PRECESSION,      /* phi' = 0 */
  SYMTOP_UNCHANGED,          /* the factor is 1 */
  SYMTOP_REVERSED,           /* the factor is negative */
  SYMTOP_NO_EFFECT,          /* theta'' is the same with the kick as without it */
  SYMTOP_WEIGHTLESS,         /* Mgl = 0: nothing rises in opposition to gravity */
  SYMTOP_VERTICAL_UNDEFINED, /* "undefined": the axis passes the vertical */
  SYMTOP_VERTICAL_STABLE,    /* "stable": it rests there, and stays near it */
  SYMTOP_VERTICAL_UNSTABLE   /* "unstable" */
} symtop_reason_kind;

/* How far a kick gets that changes theta'' in one direction, where the rule holds or fails. */
typedef enum {
  SYMTOP_EFFECT_ENOUGH, /* "": theta'' is 0 with it, or has the sign of the change; or the rule is
                           silent */
  SYMTOP_EFFECT_UP,     /* it acts upwards, and not enough: theta'' stays positive */
  SYMTOP_EFFECT_DOWN    /* it acts downwards, and not enough: theta'' stays negative */
} symtop_effect;

/* Why Perry's rule holds, fails or says nothing. On the vertical the numbers are NaN. */
typedef struct {
  symtop_reason_kind kind;
  symtop_rule rule;
  double before, after;                  /* phi' without the kick and with it */
  double theta_ddot_without, theta_ddot; /* theta'' in rad/s^2 */
  symtop_effect effect;
  symtop_place place; /* of phi' with a kick, or of phi' now if it is considered */
} symtop_reason;

typedef struct {
  double rate;              /* mean phi' in rad/s; NaN if undefined */
  double precession_period; /* s, of one turn at that rate; infinite if it is 0 */
  double turns;             /* precession in a nutation */
  double fast_top_rate;     /* Mgl/p_psi; NaN if p_psi = 0 */
  int is_fast; /* 1 if p_psi^2 > 4 Ix |Mgl|, Mgl is not 0, rate is within 30 % of fast_top_rate,
                  and the top spins faster than it precesses, in the mean */
  int spin_reverses;
} symtop_average;

/* Why the axis moves as it does under gravity alone: the first that holds. */
typedef enum {
  SYMTOP_EXPLANATION_UNSAID,  /* "": none holds */
  SYMTOP_EXPLANATION_FIXED,   /* Mgl = 0, and the axle is along L, or at rest */
  SYMTOP_EXPLANATION_FREE,    /* Mgl = 0: L is constant, and the axle turns about it */
  SYMTOP_EXPLANATION_UPRIGHT, /* the axle rests on the vertical: no torque */
  SYMTOP_EXPLANATION_STEADY,  /* the torque turns L as fast as the axle goes round */
  SYMTOP_EXPLANATION_PLANE,   /* L is along the torque: a plane pendulum */
  SYMTOP_EXPLANATION_NO_SPIN, /* p_psi = 0: L is perpendicular to the axle, a spherical pendulum */
  SYMTOP_EXPLANATION_ABOUT_MOMENTUM, /* L stays within 10 degrees of the vertical: the axle goes
                                        round L */
  SYMTOP_EXPLANATION_WITH_MOMENTUM,  /* L stays within 30 degrees of the axle: the axle goes round
                                       with L, and advances further in a nutation than it nods */
  SYMTOP_EXPLANATION_CIRCLES, /* the axle turns about L, faster than the torque can turn L: loops,
                                 and nutations that are wider than their advance */
  SYMTOP_EXPLANATION_SWINGS   /* the torque comes more than 30 degrees from perpendicular to L,
                               whose size changes by more than 5 % */
} symtop_explanation;

/* phi' compared with the rate at which gravity's torque would turn L, for an axis that leaves its
 * tilt with theta' = 0. */
typedef enum {
  SYMTOP_TURN_UNSAID,   /* "" */
  SYMTOP_TURN_FASTER,   /* the torque does not suffice: the weight rises */
  SYMTOP_TURN_SLOWER,   /* some of the torque is left, and lowers the weight */
  SYMTOP_TURN_RESTS,    /* phi' = 0: all of it is left */
  SYMTOP_TURN_VERTICAL, /* L is vertical, and the axis goes round it without a torque: all of it
                           is left */
  SYMTOP_TURN_AGAINST   /* it goes round in the other direction: the weight falls */
} symtop_turn;

/* What |phi'| does on all of the way to the next turning angle, if it changes by more than 5 %. */
typedef enum {
  SYMTOP_PACE_UNSAID, /* "": it changes by less, or it grows and falls on the way */
  SYMTOP_PACE_SPEEDS,
  SYMTOP_PACE_SLOWS
} symtop_pace;

/* What does not change in the motion, besides p_phi, p_psi and the energy. */
typedef enum {
  SYMTOP_PART_SIZE = 1,      /* of L */
  SYMTOP_PART_DIRECTION = 2, /* of L */
  SYMTOP_PART_TILT = 4
} symtop_part;

/* NaN for a driven motion. Angles are in rad. */
typedef struct {
  symtop_explanation explanation;
  symtop_turn turn;
  symtop_pace pace;
  double torque_share; /* of gravity's torque: what it takes to turn L as fast as the axle goes
                          round now; NaN without a turn */
  double rate_about_momentum;          /* |L|/Ix in rad/s, at which the axle turns about L now */
  double torque_from_perpendicular[2]; /* of torque and L: now, and the most in a nutation */
  double momentum_from_axle[3]; /* from the line of the axle: now, the least and the most in a
                                   nutation */
  double omega_from_axle[3];
  double momentum_from_vertical[3]; /* from the line of the vertical */
  unsigned constant;                /* the sum of symtop_part */
} symtop_cause;

typedef enum {
  SYMTOP_AS_HIGH, /* "unchanged" */
  SYMTOP_HIGHER,
  SYMTOP_LOWER
} symtop_lift_kind;

typedef struct {
  symtop_lift_kind kind;
  double amount; /* rad */
} symtop_lift;

/* The sense of a push, or of one that is considered, compared with the mean precession. */
typedef enum {
  SYMTOP_SENSE_UNSAID, /* "": nothing is said */
  SYMTOP_SENSE_ALONG,  /* phi' changes in the direction of the mean precession: hurried in the
                          mean */
  SYMTOP_SENSE_AGAINST /* delayed in the mean */
} symtop_sense;

/* What a change of phi' does to the means of a motion. Means are NaN where they are undefined, and
 * where more than gravity acts. */
typedef struct {
  symtop_sense sense;      /* unsaid if phi' does not change, or theta' and the spin momentum change
                         otherwise than by it; without weight; and if a mean phi' is undefined,
                         zero within its error, or of the other sign with the push */
  symtop_lift_kind height; /* of the mean of cos(theta): of the axis */
  double rates[2];         /* mean phi' in rad/s, without the push and with it */
  double cosines[2];       /* mean of cos(theta) */
} symtop_means;

typedef struct {
  symtop_subject subject;
  symtop_direction direction; /* of the axis from here on; less than 1e-7 rad is none */
  double turning_angles[2];   /* under gravity alone */
  symtop_kind motion;
  symtop_reason reason;
  symtop_average average; /* NaN for a driven motion */
  symtop_cause cause;
  double factor;       /* of phi'; NaN for an angular impulse and on the vertical */
  symtop_means means;  /* compared with no kick */
  double disturbed_to; /* rad: the tilt that the axis reaches after the least disturbance, where
                          it rests on the vertical and is unstable; NaN elsewhere */
  /* after a kick, compared with none: */
  symtop_lift highest, lowest;
} symtop_verdict;

/* What follows from each start under gravity alone, and Perry's rule for multiplying phi' by a
 * factor there. */
SYMTOP_API symtop_status symtop_judge(const symtop_start* starts, const double* factors,
                                      size_t count, symtop_hold hold, symtop_verdict* verdicts,
                                      size_t* done);

/* Tops with theta' = 0 at a tilt, and the same tops with phi' multiplied by a factor: the angles in
 * rad at which theta' vanishes again, without the kick and with it, (count, 2), and Perry's rule, a
 * symtop_rule for each. A map of it takes less than a microsecond for each point. */
SYMTOP_API symtop_status symtop_compare_hurried(const symtop_top* tops, const double* thetas,
                                                const double* phi_dots, const double* psi_dots,
                                                size_t count, double factor, symtop_hold hold,
                                                double* angles, unsigned char* rules);

/* What a kick changed that led from one start to another of the same orientation. */
SYMTOP_API symtop_status symtop_judge_kick(const symtop_start* before, const symtop_start* after,
                                           symtop_hold hold, symtop_verdict* verdict);

/* How the axis moves while its precession is held. */
typedef enum {
  SYMTOP_HELD_FALLS,  /* "falls": it starts at rest, and the weight falls to its lowest place */
  SYMTOP_HELD_SWINGS, /* "swings": it moves, and the weight comes to its lowest place */
  SYMTOP_HELD_RISES,  /* "rises": it comes to rest with the weight highest, and never falls */
  SYMTOP_HELD_TURNS,  /* "turns": Mgl = 0, and theta' is constant */
  SYMTOP_HELD_RESTS   /* "rests": Mgl = 0, and theta' = 0 */
} symtop_held_kind;

typedef struct {
  symtop_held_kind kind;
  symtop_subject subject;
  double theta;             /* rad, where the clamp takes hold */
  double rate;              /* |theta'| there, in rad/s */
  double lowest_in;         /* s until the weight is lowest; NaN if it never is */
  double angles_without[2]; /* turning angles in rad, had nothing been held */
} symtop_held;

/* What follows if the precession of a start is held: see symtop_new_clamped, which takes the
 * same. */
SYMTOP_API symtop_status symtop_judge_clamp(const symtop_start* start, symtop_held* held);

/* Where the weight goes at an instant of a nutation that is seen (more than 5e-4 rad). */
typedef enum {
  SYMTOP_GOING_UNSAID, /* "": no nutation, no weight, or within 5 % gravity's torque is what it
                          takes */
  SYMTOP_GOING_FALLS,
  SYMTOP_GOING_RISES,
  SYMTOP_GOING_TURNS_UP,  /* within a hundredth of the nutation period of its lowest point */
  SYMTOP_GOING_TURNS_DOWN /* the same of its highest point */
} symtop_going;

typedef struct {
  symtop_going going;
  symtop_turn turn;    /* the share in a word: SYMTOP_TURN_RESTS within 5 % of zero; never
                          VERTICAL */
  double torque_share; /* of gravity's torque: what it takes along the line of nodes to turn L
                          with the axle; below 1 the weight gains speed downwards; NaN if nothing
                          is said */
} symtop_present;

/* Why the weight speeds up, slows down or turns at this instant, under gravity alone. */
SYMTOP_API symtop_status symtop_explain_present(const symtop_start* start, symtop_present* present);

/* Whether rounding decides the kind of a motion under gravity alone: within the rounding of its
 * start, 64 * 2^-52 of it, is an asymptotic motion, and one last place of one number of the start
 * turns the axis by 0.01 rad within two nutations. *shows_at is the time of that in s; infinite
 * without a doubt. */
SYMTOP_API symtop_status symtop_find_doubt(const symtop_start* start, double* shows_at);

/* ---- Exchange ---- */

/* Parts of the energy of a top in J, or what they have gained. */
typedef struct {
  double weight;     /* Mgl cos(theta) */
  double precession; /* Ix phi'^2 sin^2(theta)/2; zero on the vertical */
  double nutation;   /* Ix theta'^2/2 */
  double spin;       /* Iz omega_z^2/2 */
} symtop_energies;

/* Two states of a top, and what it has gained from the first to the last. */
typedef struct {
  symtop_energies gained; /* products, which keep their digits where the energies hardly differ */
  symtop_energies first, last;
  symtop_energies sizes; /* of each part the larger one of both; for the weight |Mgl| */
  double momentum_size;  /* a bound of the momenta in both states, in N m s */
  double height;         /* gained by cos(theta) */
  double mean_along;     /* the mean of both phi' sin(theta) in rad/s: of a push of J at the axle,
                            J times it is the work */
  double last_sine;      /* sin(theta) at the end: J times it is what the push gives to p_phi */
} symtop_exchange;

/* The states are given by two orientations and two angular velocities. */
SYMTOP_API symtop_status symtop_find_exchange(const symtop_top* top, const double* orientations,
                                              const double* angular_velocities,
                                              symtop_exchange* exchange);

#ifdef __cplusplus
}
#endif

#endif

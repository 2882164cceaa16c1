/* The article's top, let go at rest with theta = 0.5 rad: its state at a time, exact to rounding.
 *
 *     example [SPIN [TIME]]     in rad/s and s, 200 and 10 by default; 0x1.9p+7 is a double, too
 */
#include <stdio.h>
#include <stdlib.h>

#include "symtop.h"

int main(int words, char** word) {
  const double spin = words > 1 ? strtod(word[1], NULL) : 200.0;
  const double t = words > 2 ? strtod(word[2], NULL) : 10.0;
  const symtop_start start = {
      /* kg m^2, kg m^2, J */
      .Ix = 0.000228,
      .Iz = 0.0000572,
      .Mgl = 0.068,
      .orientation = {0.9689124217106447, 0.24740395925452294, 0.0, 0.0}, /* w, x, y, z */
      .angular_velocity = {0.0, 0.0, spin}, /* about the axes of the body, in rad/s */
  };
  symtop_motion* motion;
  double q[4], omega[3];
  symtop_status status = symtop_new(&start, &motion);
  if (status == SYMTOP_OK) status = symtop_state(motion, t, q, omega);
  symtop_free(motion);
  if (status != SYMTOP_OK) {
    fprintf(stderr, "%s\n", symtop_describe_status(status));
    return 1;
  }
  printf("orientation      %.17g %.17g %.17g %.17g\n", q[0], q[1], q[2], q[3]);
  printf("angular velocity %.17g %.17g %.17g\n", omega[0], omega[1], omega[2]);
  return 0;
}

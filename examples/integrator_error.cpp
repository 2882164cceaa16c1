// How wrong is an integrator? Its states are compared with the exact states for the same start.
#include <array>
#include <cmath>
#include <cstdio>

#include "symtop.h"

using State = std::array<double, 7>;  // w, x, y, z (body to world), wx, wy, wz (body frame)

// The article's top, let go at rest with theta = 0.5 rad and spinning at 200 rad/s.
const symtop_start START = {0.000228,    0.0000572, 0.068,    {0.9689124, 0.2474040, 0, 0},
                            {0, 0, 200}, {0, 0},    {0, 0, 0}};

State slope(const State& s) {  // q' = q omega/2, and Euler's equations
  const auto [w, x, y, z, a, b, c] = s;
  const double Ix = START.Ix, Iz = START.Iz, Mgl = START.Mgl;
  return {(-x * a - y * b - z * c) / 2,
          (w * a + y * c - z * b) / 2,
          (w * b + z * a - x * c) / 2,
          (w * c + x * b - y * a) / 2,
          ((Ix - Iz) * b * c + 2 * Mgl * (y * z + w * x)) / Ix,
          ((Iz - Ix) * c * a - 2 * Mgl * (x * z - w * y)) / Ix,
          0};
}

State add(State s, double factor, const State& other) {
  for (int i = 0; i < 7; i++) s[i] += factor * other[i];
  return s;
}

State step(const State& s, double h) {  // Runge and Kutta, order 4: put yours here
  const State k1 = slope(s), k2 = slope(add(s, h / 2, k1)), k3 = slope(add(s, h / 2, k2));
  return add(add(add(add(s, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, slope(add(s, h, k3)));
}

// The angle between two attitudes in rad, from the vector part of conj(p) q: no digits are lost.
double angle(const double* p, const double* q) {
  const double x = p[0] * q[1] - p[1] * q[0] - p[2] * q[3] + p[3] * q[2];
  const double y = p[0] * q[2] + p[1] * q[3] - p[2] * q[0] - p[3] * q[1];
  const double z = p[0] * q[3] - p[1] * q[2] + p[2] * q[1] - p[3] * q[0];
  return 2 * std::sqrt(x * x + y * y + z * z);
}

int main() {
  symtop_motion* motion;
  if (const symtop_status status = symtop_new(&START, &motion))
    return std::puts(symtop_describe_status(status)), 1;
  double exact[4], omega[3];
  for (int steps = 1000; steps <= 8000; steps *= 2) {  // in each of the ten seconds
    State s;
    symtop_state(motion, 0.0, &s[0], &s[4]);
    for (int i = 0; i < 10 * steps; i++) s = step(s, 1.0 / steps);
    symtop_state(motion, 10.0, exact, omega);
    std::printf("%d steps/s: attitude %.1e rad after 10 s\n", steps, angle(exact, &s[0]));
  }
  symtop_free(motion);
}

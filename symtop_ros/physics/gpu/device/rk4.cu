// What is done without the closed form: Runge and Kutta's fourth order in doubles, for the quaternion
// and the angular velocity in the body frame; the quaternion is normalised after each step. It is
// compared with by `python -m symtop_ros.physics.gpu`, and used by nothing else.
#include "motion.hpp"

using namespace symtop;

struct Numbers {
  double v[7];
};

// Euler's equations, and q' = q omega/2.
inline Numbers find_change(const symtop_start& s, const Numbers& a) {
  const double *q = a.v, *w = a.v + 4;
  const double gx = 2 * (q[1] * q[3] - q[0] * q[2]), gy = 2 * (q[2] * q[3] + q[0] * q[1]);
  const double c = (s.Ix - s.Iz) / s.Ix, m = s.Mgl / s.Ix;
  return {{0.5 * (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]),
           0.5 * (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]),
           0.5 * (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]),
           0.5 * (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]), c * w[1] * w[2] + m * gy,
           -c * w[2] * w[0] - m * gx, 0.0}};
}

inline Numbers add(const Numbers& a, const Numbers& b, double h) {
  Numbers sum;
  for (int i = 0; i < 7; i++) sum.v[i] = a.v[i] + h * b.v[i];
  return sum;
}

extern "C" __global__ void integrate(const symtop_start* starts, int64_t count, double t,
                                     int64_t steps, double* orientation) {
  const int64_t i = blockIdx.x * static_cast<int64_t>(blockDim.x) + threadIdx.x;
  if (i >= count) return;
  const symtop_start s = starts[i];
  Numbers a;
  for (int k = 0; k < 4; k++) a.v[k] = s.orientation[k];
  for (int k = 0; k < 3; k++) a.v[4 + k] = s.angular_velocity[k];
  const double h = t / steps;
  for (int64_t step = 0; step < steps; step++) {
    const Numbers k1 = find_change(s, a), k2 = find_change(s, add(a, k1, h / 2));
    const Numbers k3 = find_change(s, add(a, k2, h / 2)), k4 = find_change(s, add(a, k3, h));
    for (int k = 0; k < 7; k++) a.v[k] += h / 6 * (k1.v[k] + 2 * k2.v[k] + 2 * k3.v[k] + k4.v[k]);
    double square = 0;
    for (int k = 0; k < 4; k++) square += a.v[k] * a.v[k];
    const double norm = std::sqrt(square);
    for (int k = 0; k < 4; k++) a.v[k] /= norm;
  }
  for (int k = 0; k < 4; k++) orientation[4 * i + k] = a.v[k];
}

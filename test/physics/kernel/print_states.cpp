// The kernel without Python: reads motions from stdin and writes their states to stdout, as doubles.
// Compiled for another processor it shows that the bits are the same there.
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <vector>

#include "../../../symtop_ros/physics/kernel/blocks.hpp"
#include "../../../symtop_ros/physics/kernel/driven/trail.hpp"

using namespace symtop;

static double read_number() {
  double x = 0.0;
  if (std::fread(&x, sizeof x, 1, stdin) != 1) std::exit(1);
  return x;
}

static void write_state(const double* q, const double* omega) {
  std::fwrite(q, sizeof(double), 4, stdout);
  std::fwrite(omega, sizeof(double), 3, stdout);
}

// 10 numbers of a start, 1 if the world is turned over, the number of times, and the times
static void print_closed_form() {
  static ClosedForm motion;
  double s[10];
  for (double& each : s) each = read_number();
  const bool is_turned_over = read_number() != 0;
  motion.has_first_instants = false;
  motion.prepare({s[0], s[1], s[2], s[3], s[4], s[5], s[6], s[7], s[8], s[9]}, is_turned_over);
  std::vector<double> times(static_cast<size_t>(read_number()));
  for (double& each : times) each = read_number();
  std::vector<double> q(4 * times.size()), omega(3 * times.size());
  std::vector<uint8_t> is_far(times.size());
  fill(motion, times.data(), times.size(), {q.data(), omega.data()}, is_far.data());
  for (uint8_t each : is_far)
    if (each) std::exit(1);
  for (size_t i = 0; i < times.size(); i++) write_state(&q[4 * i], &omega[3 * i]);
}

// 15 numbers of a driven motion, and a time
static void print_driven() {
  DrivenArguments a;
  for (double* each : {&a.Ix, &a.Iz, &a.Mgl, &a.axial, &a.transverse}) *each = read_number();
  for (double& each : a.torque) each = read_number();
  for (double& each : a.orientation) each = read_number();
  for (double& each : a.omega) each = read_number();
  const double t = read_number();
  Trail trail;
  bool is_stuck = false;
  double q[4], omega[3], steps = INFINITY;
  if (!trail.prepare(a, t < 0 ? -1 : 1)) std::exit(1);
  trail.reach(t, &steps, &is_stuck);
  trail.read(t, 0.0, q, omega);
  write_state(q, omega);
}

int main() {
  for (auto& row : ROWS)
    for (double& each : row) each = read_number();
  for (int count = static_cast<int>(read_number()); count > 0; count--) print_closed_form();
  for (int count = static_cast<int>(read_number()); count > 0; count--) print_driven();
  return 0;
}

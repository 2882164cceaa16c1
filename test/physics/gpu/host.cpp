// The device's source on the host: each function of motions.cu is run for one thread after the other.
// A grid is a line here, as it is in the launches of toolchain.py.
#include <cmath>
#include <cstdint>

struct Index {
  unsigned x;
};
static Index blockIdx, blockDim, threadIdx;
#define __global__
#include "motions.cu"
#include "rk4.cu"

template <class Function, class... Arguments>
static void launch(int64_t grid, int64_t block, Function function, Arguments... arguments) {
  blockDim.x = static_cast<unsigned>(block);
  for (int64_t b = 0; b < grid; b++)
    for (int64_t t = 0; t < block; t++) {
      blockIdx.x = static_cast<unsigned>(b);
      threadIdx.x = static_cast<unsigned>(t);
      function(arguments...);
    }
}

extern "C" {
void run_find_size_of_motion(int64_t, int64_t, int64_t* bytes) { find_size_of_motion(bytes); }
void run_prepare_motions(int64_t grid, int64_t block, const symtop_start* s, int64_t n,
                         DeviceMotion* m) {
  launch(grid, block, prepare_motions, s, n, m);
}
void run_prepare_free_motions(int64_t grid, int64_t block, const symtop_start* s, int64_t n,
                              DeviceMotion* m) {
  launch(grid, block, prepare_free_motions, s, n, m);
}
void run_read_statuses(int64_t grid, int64_t block, const DeviceMotion* m, int64_t n, int32_t* to) {
  launch(grid, block, read_statuses, m, n, to);
}
void run_integrate(int64_t grid, int64_t block, const symtop_start* s, int64_t n, double t,
                   int64_t steps, double* q) {
  launch(grid, block, integrate, s, n, t, steps, q);
}
void run_read_states(int64_t grid, int64_t block, const DeviceMotion* m, int64_t n, const double* t,
                     int64_t each, int64_t stride, double* q, double* omega, uint8_t* status) {
  launch(grid, block, read_states, m, n, t, each, stride, q, omega, status);
}
void run_read_free_states(int64_t grid, int64_t block, const DeviceMotion* m, int64_t n,
                          const double* t, int64_t each, int64_t stride, double* q, double* omega,
                          uint8_t* status) {
  launch(grid, block, read_free_states, m, n, t, each, stride, q, omega, status);
}
}

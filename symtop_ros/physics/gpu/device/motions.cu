// Motions of heavy tops on a graphics processor: the kernel of symtop_ros, compiled by NVRTC.
//
// One thread sets a motion up, and one writes a state. Of each pair of functions both are launched:
// each leaves the motions of the other kind alone (motion.hpp says why they are two).
#include "motion.hpp"

using namespace symtop;

#define PLACE (blockIdx.x * static_cast<int64_t>(blockDim.x) + threadIdx.x)

extern "C" __global__ void find_size_of_motion(int64_t* bytes) { *bytes = sizeof(DeviceMotion); }

extern "C" __global__ void prepare_motions(const symtop_start* starts, int64_t count,
                                           DeviceMotion* motions) {
  const int64_t i = PLACE;
  if (i < count) motions[i].prepare<false>(starts[i]);
}

extern "C" __global__ void prepare_free_motions(const symtop_start* starts, int64_t count,
                                                DeviceMotion* motions) {
  const int64_t i = PLACE;
  if (i < count) motions[i].prepare<true>(starts[i]);
}

extern "C" __global__ void read_statuses(const DeviceMotion* motions, int64_t count,
                                         int32_t* status) {
  const int64_t i = PLACE;
  if (i < count) status[i] = motions[i].status;
}

// States (count, each): a thread for each. Times are (each), or (count, each) if stride is not zero.
extern "C" __global__ void read_states(const DeviceMotion* motions, int64_t count,
                                       const double* times, int64_t each, int64_t stride,
                                       double* orientation, double* omega, uint8_t* status) {
  const int64_t i = PLACE;
  if (i < count * each)
    motions[i / each].read<false>(times[i / each * stride + i % each],
                                  {orientation + 4 * i, omega + 3 * i}, status + i);
}

extern "C" __global__ void read_free_states(const DeviceMotion* motions, int64_t count,
                                            const double* times, int64_t each, int64_t stride,
                                            double* orientation, double* omega, uint8_t* status) {
  const int64_t i = PLACE;
  if (i < count * each)
    motions[i / each].read<true>(times[i / each * stride + i % each],
                                 {orientation + 4 * i, omega + 3 * i}, status + i);
}

// Many motions in one call: for each of some it would take longer to cross into the library.
#pragma once

#include "motion.hpp"

namespace symtop {

// A motion that is freed at the end of its scope; null if the start is refused.
class Member {
 public:
  explicit Member(const symtop_start& start) : status(symtop_new(&start, &motion)) {}
  ~Member() { symtop_free(motion); }
  Member(const Member&) = delete;
  Member& operator=(const Member&) = delete;

  symtop_motion* motion = nullptr;
  symtop_status status;
};

}  // namespace symtop

symtop_status symtop_states_of_many(const symtop_start* starts, size_t count, const double* times,
                                    size_t each, double* orientation, double* angular_velocity,
                                    uint8_t* left) {
  using namespace symtop;
  symtop_status status = admit({});
  if (status == SYMTOP_OK) status = admit_arrays(count, sizeof(symtop_start), {starts});
  if (status == SYMTOP_OK) status = admit_arrays(each, sizeof(double), {times});
  if (status != SYMTOP_OK) return status;
  if (!count || !each) return SYMTOP_OK;
  status = admit_arrays(count, ORIENTATION_BYTES * each, {orientation, angular_velocity, left});
  if (status == SYMTOP_OK && each > PTRDIFF_MAX / ORIENTATION_BYTES) status = SYMTOP_BAD_COUNT;
  if (status == SYMTOP_OK) status = accept_times(times, each);
  if (status != SYMTOP_OK) return status;
  std::memset(left, 1, count * each);
  for (size_t i = 0; i < count; i++) {
    const Member member(starts[i]);
    size_t written = 0;
    if (member.motion)
      symtop_states(member.motion, times, each, INFINITY, orientation + 4 * i * each,
                    angular_velocity + 3 * i * each, &written);
    std::memset(left + i * each, 0, written);
  }
  return SYMTOP_OK;
}

symtop_status symtop_describe_many(const symtop_start* starts, size_t count,
                                   symtop_constants* constants, size_t* done) {
  using namespace symtop;
  return compute_each(count, sizeof(symtop_constants), {starts, constants}, done, [&](size_t i) {
    const Member member(starts[i]);
    if (!member.motion) return member.status;
    symtop_constants found = {};
    found.kind = symtop_find_kind(member.motion);
    found.engine = symtop_find_engine(member.motion);
    symtop_find_turning_angles(member.motion, found.turning_angles);
    symtop_find_rates(member.motion, &found.rates);
    constants[i] = found;
    return SYMTOP_OK;
  });
}

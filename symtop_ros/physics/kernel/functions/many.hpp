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
  std::memset(left, 1, count * each);
  if (!symtop::is_sound()) return SYMTOP_BAD_ARITHMETIC;
  for (size_t i = 0; i < count; i++) {
    const symtop::Member member(starts[i]);
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
  for (*done = 0; *done < count; ++*done) {
    const symtop::Member member(starts[*done]);
    if (!member.motion) return member.status;
    symtop_constants& found = constants[*done];
    found.kind = symtop_find_kind(member.motion);
    found.engine = symtop_find_engine(member.motion);
    symtop_find_turning_angles(member.motion, found.turning_angles);
    symtop_find_rates(member.motion, &found.rates);
  }
  return SYMTOP_OK;
}

// The arithmetic that the digits of this kernel rest on, and how it is demanded.
//
// Everything here is built of sums, products, quotients and square roots that round to the nearest
// double, in the order that is written (docs/derivation.md, section 10). A compiler that may change
// the order, such as with -ffast-math, or a thread that rounds elsewhere or drops subnormal
// numbers, gives states that are wrong by tenths of a radian, without a word. So the first is
// refused when it is compiled, as far as it is announced, and both are looked for at run time.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#if defined(__FAST_MATH__) || defined(_M_FP_FAST)
#error "symtop must be compiled without fast-math: give -fno-fast-math after -ffast-math or -Ofast"
#endif

namespace symtop {

inline uint64_t read_bits(double x) {
  uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

// A number that the compiler does not know, so that it computes nothing of what follows in advance,
// where rounding is to the nearest and subnormal numbers are kept.
inline double hide(double x) {
  volatile double hidden = x;
  return hidden;
}

// True if the calling thread rounds to the nearest and keeps subnormal numbers. Both can change
// while a program runs: a library that was linked with fast-math drops them when it is loaded.
inline bool rounds_to_nearest() {
#if defined(__SSE2__) && !defined(__CUDA_ARCH__)
  // Read from the register that decides: there a sum with a subnormal number can take as long as a
  // state. The bits are those of the rounding (two), of flushed results and of flushed arguments.
  uint32_t control;
  // The compiler's own function is taken for a constant
  asm volatile("stmxcsr %0" : "=m"(control));
  return (control & 0xe040) == 0;
#else
  const double one = hide(1.0), below_half = hide(0x1p-54), above_half = hide(0x1.8p-53);
  const double smallest_normal = hide(0x1p-1022), smallest = hide(0x1p-1074);
  return one + below_half == one && -one - below_half == -one &&  // neither up nor down
         one + above_half == hide(1.0 + 0x1p-52) &&               // not towards zero
         // By their bits: a comparison may take a subnormal number for zero, too.
         read_bits(smallest_normal * 0.5) == uint64_t(1) << 51 && read_bits(smallest * 2.0) == 2;
#endif
}

// True if sums and products were compiled in the order that is written, none of them fused, and
// with the infinities, NaN and zeros of IEEE 754. Each line fails with an option of compilers.
inline bool keeps_order() {
  const double one = hide(1.0), small = hide(0x1p-60), a = hide(1 + 0x1p-30), divisor = hide(49.0);
  const double square = hide(1 + 0x1p-29), infinite = hide(INFINITY), nan = hide(NAN);
  // A compiler replaces quotients by products with one reciprocal if there are several of them.
  const double n[] = {hide(49.0), hide(98.0), hide(147.0), hide(196.0)};
  const double quotients[] = {n[0] / divisor, n[1] / divisor, n[2] / divisor, n[3] / divisor};
  return (one + small) - one == 0.0 &&        // -fassociative-math, registers of 80 bits
         a * a - square == 0.0 &&             // -ffp-contract=fast
         read_bits(hide(-0.0) + 0.0) == 0 &&  // -fno-signed-zeros
         quotients[0] == 1.0 && quotients[1] == 2.0 && quotients[2] == 3.0 &&
         quotients[3] == 4.0 &&                      // -freciprocal-math
         !std::isfinite(infinite) && !(nan == nan);  // -ffinite-math-only
}

inline bool is_sound() { return rounds_to_nearest() && keeps_order(); }

}  // namespace symtop

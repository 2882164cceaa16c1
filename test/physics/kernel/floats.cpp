// Products, sums and differences of floats of 192 bits that are drawn, with all their bits.

#include "floats.hpp"

#include <cinttypes>
#include <cstdio>

using symtop::Float;

static uint64_t state = 1;

static uint64_t draw() {  // an LCG of 64 bits (Knuth, MMIX), of which the upper half is mixed in
  state = state * 6364136223846793005u + 1442695040888963407u;
  return state ^ state >> 32;
}

static Float<3> draw_float() {
  Float<3> drawn;
  for (uint64_t& limb : drawn.limbs) limb = draw();
  drawn.limbs[2] |= uint64_t{1} << 63;
  drawn.sign = 1;
  drawn.exponent = 0;
  return drawn;
}

static void print(const Float<3>& x) {
  printf("%d %016" PRIx64 "%016" PRIx64 "%016" PRIx64 " %d ", x.sign, x.limbs[2], x.limbs[1],
         x.limbs[0], x.exponent);
}

int main() {
  for (int k = 0; k < 1000; k++) {
    const Float<3> a = draw_float(), b = draw_float();
    print(a);
    print(b);
    print(a * b);
    print(a + b);
    print(a - b);
    puts("");
  }
}

// Counts the products of random doubles of which halves lose another double than a fused product: of
// two numbers that can be taken, and of one with a sum of such products.
#include "driven/double2.hpp"

#include <cstdio>

using namespace symtop;

static uint64_t state = 0x9e3779b97f4a7c15;

static uint64_t draw() {
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return state;
}

// All exponents that can be taken, among them the least; few digits, and all of them.
static double draw_number() {
  const int exponent = draw() % 4 ? static_cast<int>(draw() % 399) - 199 : -199;
  const uint64_t digits = draw() >> (draw() % 2 ? 12 : 12 + draw() % 52);
  const double size = std::ldexp(1.0 + static_cast<double>(digits) * 0x1p-52, exponent);
  return draw() % 16 ? (draw() % 2 ? size : -size) : 0.0;
}

static bool differs(double a, double b) {
  const double product = a * b;
  return Split::find_lost(a, b, product) != Fused::find_lost(a, b, product);
}

int main() {
  long wrong = 0, taken = 0;
  for (int n = 0; n < 1000000; n++) {
    const double a = draw_number(), b = draw_number(), c = draw_number(), d = draw_number();
    wrong += differs(a, b) + differs(c, a * b + d * c) + differs(d, a * a - a * (a + a * 0x1p-52));
    taken += Split::is_plain(a) && Split::is_plain(b);
  }
  const bool refused = !Split::is_plain(0x1p-201) && !Split::is_plain(-0x1p201) &&
                       !Split::is_plain(INFINITY) && !Split::is_plain(NAN);
  std::printf("%ld wrong, %ld taken, %s\n", wrong, taken, refused ? "others refused" : "all taken");
}

// The coefficients of the Taylor series of a step, one order after the other.
//
// The derivatives are polynomials of degree 2 of the variables (equations.hpp), so coefficient k + 1
// of all variables follows from the products of coefficients 0 to k with those from k to 0: with
// x = sum x_k t^k and x' = c a b, Cauchy's product gives
//
//   (k + 1) x_(k+1) = c (a_0 b_k + a_1 b_(k-1) + ... + a_k b_0),
//
// and with x' = c a it is (k + 1) x_(k+1) = c a_k. The spin is no factor of any product: S' = omega_z
// gives (k + 1) S_(k+1) = omega_z,k.
#pragma once

#include "piece.hpp"

namespace symtop {

// 1/n: its double, and the rest that this leaves, rounded.
struct Inverses {
  double high[DRIVEN_TERMS + 1], low[DRIVEN_TERMS + 1];

  constexpr Inverses() : high(), low() {
    for (int n = 1; n <= DRIVEN_TERMS; n++) {
      high[n] = 1.0 / n;
      // 1 - n/n, in integers: the double of 1/n has no digit below 2^-58.
      const int64_t digits = static_cast<int64_t>(high[n] * 0x1p58);
      low[n] = static_cast<double>((int64_t(1) << 58) - digits * n) * 0x1p-58 / n;
    }
  }
  constexpr Double2 operator[](int n) const { return {high[n], low[n]}; }
};
constexpr Inverses INVERSES;

class TaylorSeries {
 public:
  // The coefficients of all orders, from those of order 0 in the piece, for equations in its unit.
  void expand(const Coefficients& equations, Double2 share, bool has_torque, Piece& piece) {
    equations_ = &equations;
    share_ = share;
    if (has_torque)
      expand<6>(piece);
    else
      expand<4>(piece);
  }

 private:
  // The factors of all products, by order, in blocks of four. The first three blocks are those of q'
  // with omega_x, omega_y and s omega_z, with the sign and in the lane of the row they belong to; the
  // others are products of two components of q, of which the weight needs the first block.
  static const int BLOCKS = 6;
  typedef Lanes Factors[BLOCKS];
  Factors left_[DRIVEN_TERMS + 1], right_[DRIVEN_TERMS + 1];
  Factors left_rest_[EXTENDED_TERMS + 1], right_rest_[EXTENDED_TERMS + 1];
  const Coefficients* equations_;
  Double2 share_;

  template <int COUNT>
  void expand(Piece& piece) {
    piece.is_split = !fuses_products() && compute<COUNT, Split>(piece);
    if (!piece.is_split) compute<COUNT, Fused>(piece);
  }

  // False if numbers are too small or too large for these products: it ends at the first of them, because
  // the coefficients of a slow turn fall so fast that those of order 3 may be.
  template <int COUNT, class Product>
  SYMTOP_CLONES bool compute(Piece& piece) {
    if (!can_take_equations<Product>()) return false;
    put_low<COUNT, Product>(piece, 0);
    for (int n = 0; n < EXTENDED_TERMS; n++) {
      if (!can_take_order<Product>(piece, n)) return false;
      compute_low<COUNT, Product>(piece, n);
      put_low<COUNT, Product>(piece, n + 1);
    }
    if (!can_take_order<Product>(piece, EXTENDED_TERMS)) return false;
    for (int n = EXTENDED_TERMS; n < DRIVEN_TERMS; n++) compute_high<COUNT>(piece, n);
    return true;
  }

  template <class Product>
  bool can_take_equations() const {
    bool can_take = Product::can_take(&equations_->friction.high, 1) &&
                    Product::can_take(&equations_->weight.high, 1);
    for (const SumOf<Lanes>& each : equations_->torques)
      can_take = can_take && Product::can_take(&each.high, 1);
    return can_take;
  }

  template <class Product>
  bool can_take_order(const Piece& piece, int n) const {
    return Product::can_take(piece.terms[n], 2) && Product::can_take(&right_[n][2], 1);
  }

  //   2 w' = -x Omega_x - y Omega_y - z Omega_z
  //   2 x' =  w Omega_x - z Omega_y + y Omega_z
  //   2 y' =  z Omega_x + w Omega_y - x Omega_z
  //   2 z' = -y Omega_x + x Omega_y + w Omega_z
  template <int COUNT>
  static SYMTOP_INLINE void put(Lanes q, Lanes rates, double turn, Factors& left, Factors& right) {
    left[0] = Lanes{-q[X], q[W], q[Z], -q[Y]}, right[0] = repeat<Lanes>(rates[OMEGA_X]);
    left[1] = Lanes{-q[Y], -q[Z], q[W], q[X]}, right[1] = repeat<Lanes>(rates[OMEGA_Y]);
    left[2] = Lanes{-q[Z], q[Y], -q[X], q[W]}, right[2] = repeat<Lanes>(turn);
    left[3] = Lanes{q[Y], -q[X], q[W], q[W]}, right[3] = Lanes{q[Z], q[Z], q[X], q[Y]};
    if (COUNT == 4) return;
    left[4] = q, right[4] = q;
    left[5] = Lanes{q[X], q[W], 0.0, 0.0}, right[5] = Lanes{q[Y], q[Z], 0.0, 0.0};
  }

  template <int COUNT, class Product>
  SYMTOP_INLINE void put_low(const Piece& piece, int n) {
    const Lanes *terms = piece.terms[n], *rests = piece.rests[n];
    const Double2 turn = symtop::multiply<Product>(Double2{terms[1][OMEGA_Z], rests[1][OMEGA_Z]}, share_);
    put<COUNT>(terms[0], terms[1], turn.high, left_[n], right_[n]);
    put<COUNT>(rests[0], rests[1], turn.low, left_rest_[n], right_rest_[n]);
  }

  template <int COUNT, class Product>
  SYMTOP_INLINE void compute_low(Piece& piece, int n) const {
    SumOf<Lanes> sums[COUNT] = {};
    for (int m = 0; m <= n; m++)
      SYMTOP_UNROLL
      for (int v = 0; v < COUNT; v++)
        add_product<Product>(sums[v], {left_[m][v], left_rest_[m][v]},
                             {right_[n - m][v], right_rest_[n - m][v]});
    add(sums[0], sums[1]);
    add(sums[0], sums[2]);
    const Lanes *now = piece.terms[n], *now_rests = piece.rests[n];
    SumOf<Lanes> rates = {};
    add_product<Product>(rates, equations_->friction, {take_rates(now[1]), take_rates(now_rests[1])});
    const SumOf<Lanes> squares = sums[3];
    SumOf<Lanes> vertical = {take_first(squares.high), take_first(squares.low)};
    add(vertical, {take_last(squares.high), take_last(squares.low)});
    add_product<Product>(rates, equations_->weight, vertical);
    if (COUNT > 4)
      SYMTOP_UNROLL
      for (int p = 0; p < SQUARES; p++)
        add_product<Product>(rates, equations_->torques[p], repeat(pick(sums[3 + p / 4], p % 4)));
    const Double2 inverse = INVERSES[n + 1];
    put_term<Product>(piece, n + 1, 0, sums[0], scale(inverse, 0.5));
    put_term<Product>(piece, n + 1, 1, rates, inverse);
  }

  template <class Product>
  static SYMTOP_INLINE void put_term(Piece& piece, int n, int half, SumOf<Lanes> sum,
                                     Double2 factor) {
    const SumOf<Lanes> term =
        symtop::multiply<Product>(fast_sum_of(sum.high, sum.low), repeat(factor));
    piece.terms[n][half] = term.high, piece.rests[n][half] = term.low;
  }

  // As factors of friction, with omega_z for the spin; and the first two lanes or the last two.
  static SYMTOP_INLINE Lanes take_rates(Lanes a) { return Lanes{a[0], a[1], a[2], a[2]}; }
  static SYMTOP_INLINE Lanes take_first(Lanes a) { return Lanes{a[0], a[1], 0.0, 0.0}; }
  static SYMTOP_INLINE Lanes take_last(Lanes a) { return Lanes{a[2], a[3], 0.0, 0.0}; }

  // The terms in doubles. The newest factors come last, because they have just been computed, and there
  // are two sums that do not wait for each other.
  template <int COUNT>
  SYMTOP_INLINE void compute_high(Piece& piece, int n) {
    Lanes sums[COUNT] = {}, others[COUNT] = {};
    int m = 1;
    for (; m + 1 < n; m += 2)
      SYMTOP_UNROLL
      for (int v = 0; v < COUNT; v++) {
        sums[v] += left_[m][v] * right_[n - m][v];
        others[v] += left_[m + 1][v] * right_[n - m - 1][v];
      }
    SYMTOP_UNROLL
    for (int v = 0; v < COUNT; v++) {
      if (m < n) sums[v] += left_[m][v] * right_[n - m][v];
      sums[v] = (sums[v] + others[v]) + (left_[0][v] * right_[n][v] + left_[n][v] * right_[0][v]);
    }
    // The rests of constants count: what is left out has the same sign in all steps. Such a constant
    // is the turn of the frame where omega_z is one.
    sums[2] += left_[n][2] * right_rest_[0][2];
    const Lanes turned = (sums[0] + sums[1]) + sums[2];
    const Lanes now = take_rates(piece.terms[n][1]);
    const Lanes vertical = take_first(sums[3]) + take_last(sums[3]);
    Lanes rates = equations_->friction.high * now + equations_->weight.high * vertical;
    Lanes below = equations_->friction.low * now + equations_->weight.low * vertical;
    if (COUNT > 4)
      SYMTOP_UNROLL
      for (int p = 0; p < SQUARES; p++) {
        rates += equations_->torques[p].high * sums[3 + p / 4][p % 4];
        below += equations_->torques[p].low * sums[3 + p / 4][p % 4];
      }
    rates += below;
    const Double2 inverse = INVERSES[n + 1];
    const Lanes q = turned * (0.5 * inverse.high) + turned * (0.5 * inverse.low);
    const Lanes omega = rates * inverse.high + rates * inverse.low;
    piece.terms[n + 1][0] = q, piece.terms[n + 1][1] = omega;
    put<COUNT>(q, omega, omega[OMEGA_Z] * share_.high, left_[n + 1], right_[n + 1]);
  }
};

}  // namespace symtop

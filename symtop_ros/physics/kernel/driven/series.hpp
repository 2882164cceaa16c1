// The coefficients of the Taylor series of a step, one order after the other: the first ones in
// parts (parts.hpp) or as sums of two doubles, the others in doubles; with a tolerance all of them
// are doubles (derivation.md, section 15).
//
// The derivatives are polynomials of degree 2 of the variables (equations.hpp), so coefficient k +
// 1 of all variables follows from the products of coefficients 0 to k with those from k to 0: with
// x = sum x_k t^k and x' = c a b, Cauchy's product gives
//
//   (k + 1) x_(k+1) = c (a_0 b_k + a_1 b_(k-1) + ... + a_k b_0),
//
// and with x' = c a it is (k + 1) x_(k+1) = c a_k. The spin is no factor of any product: S' =
// omega_z gives (k + 1) S_(k+1) = omega_z,k.
#pragma once

#include "parts.hpp"
#include "piece.hpp"

#include <algorithm>

namespace symtop {

// 1/n: its double, and the rest that this leaves, rounded.
struct Inverses {
  double high[DRIVEN_TERMS + 1], low[DRIVEN_TERMS + 1];

  constexpr Inverses() : high(), low() {
    for (int n = 1; n <= DRIVEN_TERMS; n++) {
      high[n] = 1.0 / n;
      // 1 - n times the double of 1/n, in integers: the double has no digit below 2^-58.
      const int64_t digits = static_cast<int64_t>(high[n] * 0x1p58);
      low[n] = static_cast<double>((int64_t(1) << 58) - digits * n) * 0x1p-58 / n;
    }
  }
  constexpr Double2 operator[](int n) const { return {high[n], low[n]}; }
};
constexpr Inverses INVERSES;

// Bounds of parts, below which no sum of products exceeds 128: of three blocks of products of q and
// rates, 3 x 40; of the weight and torques by products of q, 4 x 16, with friction by rates, 4 x
// 15.
const double LARGEST_TURNED = 40.0, LARGEST_SQUARES = 16.0, LARGEST_TORQUE = 4.0;
const double LARGEST_RATES = 15.0, LARGEST_FRICTION = 4.0;
const double LEAST_SHARE = 0x1p-5;   // of Iz/Ix, whose parts have 77 binary digits behind the point
const double LEAST_SWING = 0x1p-20;  // of q: less has too few digits before 2^-77
const double LEAST_TURN = 0x1p-90, LEAST_LATE_TURN = 0x1p-60;

class TaylorSeries {
 public:
  // The coefficients of all orders, from those of order 0 in the piece, for equations in its unit.
  // The first of them are as `wanted`, but sums of two doubles if numbers in parts do not fit.
  void expand(const Coefficients& equations, Double2 share, bool has_torque, Digits wanted,
              Piece& piece) {
    equations_ = &equations;
    share_ = share;
    if (has_torque)
      expand<6>(wanted, piece);
    else
      expand<4>(wanted, piece);
  }

 private:
  // All products of an order have a term of q on the left, whole. On the right are, spread over the
  // lanes, omega_x, omega_y and the turn of the frame s omega_z, and from WEIGHT on components of q
  // in another order, of which the weight needs the first block and torques need all.
  static const int TURN = 2, WEIGHT = 3, BLOCKS = 6;
  typedef Lanes Factors[BLOCKS];
  Factors right_[DRIVEN_TERMS + 1];
  // Of the first terms the coarse parts, and the rests: of these, or of doubles.
  Factors coarse_[EXTENDED_TERMS + 1], rests_[EXTENDED_TERMS + 1];
  const Coefficients* equations_;
  PartsOf<Lanes> friction_, weight_, torques_[SQUARES];
  Double2 share_;
  PartsOf<Lanes> share_in_parts_;
  // From these orders on, the turn of the frame has no digit that counts in the first terms (in
  // parts), and in the others.
  int turning_orders_, last_turn_;

  template <int COUNT>
  void expand(Digits wanted, Piece& piece) {
    piece.digits = wanted;
    if (wanted == IN_DOUBLES) return compute_coarsely<COUNT>(piece);
    if (wanted == IN_PARTS && compute_by_parts<COUNT>(piece)) return;
    piece.put_first();
    const bool is_split = !fuses_products() && compute<COUNT, Split>(piece);
    piece.digits = is_split ? IN_SPLIT_SUMS : IN_SUMS;
    if (!is_split) compute<COUNT, Fused>(piece);
  }

  template <int COUNT>
  static SYMTOP_INLINE void put(Lanes q, Lanes rates, Lanes turn, Factors& right) {
    right[0] = spread<OMEGA_X>(rates);
    right[1] = spread<OMEGA_Y>(rates);
    right[TURN] = turn;
    right[WEIGHT] = order<X, Z, W, Y>(q);
    if (COUNT == 4) return;
    right[WEIGHT + 1] = q;
    right[WEIGHT + 2] = SYMTOP_ORDER(q, Lanes{}, Z, Y, 4, 4);
  }

  //   2 w' = -x Omega_x - y Omega_y - z Omega_z
  //   2 x' =  w Omega_x - z Omega_y + y Omega_z
  //   2 y' =  z Omega_x + w Omega_y - x Omega_z
  //   2 z' = -y Omega_x + x Omega_y + w Omega_z
  // of the sums of q by each of the three.
  static SYMTOP_INLINE Lanes turn_by_x(Lanes a) {
    return negate(order<X, W, Z, Y>(a), Lanes{-0.0, 0.0, 0.0, -0.0});
  }
  static SYMTOP_INLINE Lanes turn_by_y(Lanes a) {
    return negate(order<Y, Z, W, X>(a), Lanes{-0.0, -0.0, 0.0, 0.0});
  }
  static SYMTOP_INLINE Lanes turn_by_z(Lanes a) {
    return negate(order<Z, Y, X, W>(a), Lanes{-0.0, 0.0, -0.0, 0.0});
  }

  // y z + w x and w y - x z of the weight's products.
  static SYMTOP_INLINE Lanes take_first(Lanes a) { return SYMTOP_ORDER(a, Lanes{}, WX, WY, 4, 4); }
  static SYMTOP_INLINE Lanes take_last(Lanes a) {
    return negate(SYMTOP_ORDER(a, Lanes{}, YZ, XZ, 4, 4), Lanes{0.0, -0.0, 0.0, 0.0});
  }
  // As factors of friction, with omega_z for the spin.
  static SYMTOP_INLINE Lanes take_rates(Lanes a) { return order<0, 1, 2, 2>(a); }

  // ---- The first terms in parts ----

  // False if parts are too large, or digits of a swing next to the vertical would be too few.
  template <int COUNT>
  SYMTOP_CLONES bool compute_by_parts(Piece& piece) {
    if (!take_equations<COUNT>() || !shows_swing(piece.terms[0])) return false;
    turning_orders_ = last_turn_ = DRIVEN_TERMS;
    Sizes sizes = {};
    for (int half = 0; half < 2; half++)
      keep(piece, 0, half, split(SumOf<Lanes>{piece.terms[0][half], piece.rests[0][half]}));
    put_parts<COUNT>(piece, 0, sizes);
    for (int n = 0; n < EXTENDED_TERMS; n++) {
      compute_parts<COUNT>(piece, n);
      put_parts<COUNT>(piece, n + 1, sizes);
    }
    if (!sizes.fit()) return false;
    compute_all_high<COUNT>(piece);
    return true;
  }

  template <int COUNT>
  SYMTOP_INLINE bool take_equations() {
    friction_ = split(equations_->friction);
    weight_ = split(equations_->weight);
    share_in_parts_ = split(repeat(share_));
    Lanes size = find_size(weight_.coarse);
    if (COUNT > 4)
      for (int p = 0; p < SQUARES; p++) {
        torques_[p] = split(equations_->torques[p]);
        size += find_size(torques_[p].coarse);
      }
    return share_.high >= LEAST_SHARE && find_largest_lane(size) <= LARGEST_TORQUE &&
           find_largest_lane(find_size(friction_.coarse)) <= LARGEST_FRICTION;
  }

  // Of an axis next to the vertical two components of q are small, whose digits should begin where
  // they do: their parts would have them from 2^-77 on.
  static bool shows_swing(const Lanes row[2]) {
    const Lanes q = row[0];
    const double upper = q[W] * q[W] + q[Z] * q[Z], lower = q[X] * q[X] + q[Y] * q[Y];
    return std::fmin(upper, lower) >= LEAST_SWING * LEAST_SWING;
  }

  // What all sums of products are below: sums of the largest of each order.
  struct Sizes {
    Lanes q, rates, turn;

    bool fit() const {
      const double of_q = find_largest_lane(q);
      const double of_rates = std::fmax(turn[0], std::fmax(rates[OMEGA_X], rates[OMEGA_Y]));
      return of_q * of_rates <= LARGEST_TURNED && of_q * of_q <= LARGEST_SQUARES &&
             of_rates <= LARGEST_RATES && rates[OMEGA_Z] <= LARGEST_RATES;
    }
  };

  static SYMTOP_INLINE void keep(Piece& piece, int n, int half, PartsOf<Lanes> parts) {
    piece.coarse[n][half] = parts.coarse;
    piece.rests[n][half] = parts.fine;
    piece.terms[n][half] = parts.whole();
  }

  template <int COUNT>
  SYMTOP_INLINE void put_parts(const Piece& piece, int n, Sizes& sizes) {
    const Lanes *terms = piece.terms[n], *coarse = piece.coarse[n], *fine = piece.rests[n];
    PartsOf<Lanes> turn = {};
    add_product(turn, share_in_parts_.coarse, share_in_parts_.fine, spread<OMEGA_Z>(coarse[1]),
                spread<OMEGA_Z>(fine[1]), spread<OMEGA_Z>(terms[1]));
    turn = collect(turn);
    const Lanes whole = turn.whole();
    put<COUNT>(coarse[0], coarse[1], turn.coarse, coarse_[n]);
    put<COUNT>(fine[0], fine[1], turn.fine, rests_[n]);
    put<COUNT>(terms[0], terms[1], whole, right_[n]);
    sizes.q += find_size(terms[0]);
    sizes.rates += find_size(terms[1]);
    sizes.turn += find_size(whole);
    if (COUNT > 4) return;
    const double size = std::fabs(whole[0]);
    if (last_turn_ == DRIVEN_TERMS && size < LEAST_LATE_TURN) last_turn_ = n;
    if (turning_orders_ == DRIVEN_TERMS && size < LEAST_TURN) turning_orders_ = n;
  }

  SYMTOP_INLINE void add_parts(const Piece& piece, PartsOf<Lanes>& sum, int m, int n, int v) const {
    add_product(sum, piece.coarse[m][0], piece.rests[m][0], coarse_[n][v], rests_[n][v],
                right_[n][v]);
  }

  template <int COUNT>
  SYMTOP_INLINE void compute_parts(Piece& piece, int n) const {
    PartsOf<Lanes> sums[COUNT] = {};
    // What has just been computed comes last.
    for (int m = 1; m < n; m++) {
      SYMTOP_UNROLL
      for (int v = 0; v < COUNT; v++)
        if (v != TURN || COUNT > 4) add_parts(piece, sums[v], m, n - m, v);
    }
    if (COUNT == 4)
      for (int m = std::min(n, turning_orders_) - 1; m > 0; m--)
        add_parts(piece, sums[TURN], n - m, m, TURN);
    SYMTOP_UNROLL
    for (int v = 0; v < COUNT; v++) {
      if (n > 0) add_parts(piece, sums[v], n, 0, v);
      add_parts(piece, sums[v], 0, n, v);
    }
    const double factor = n + 1, inverse = INVERSES.high[n + 1];
    const PartsOf<Lanes> turned = {
        (turn_by_x(sums[0].coarse) + turn_by_y(sums[1].coarse)) + turn_by_z(sums[TURN].coarse),
        (turn_by_x(sums[0].fine) + turn_by_y(sums[1].fine)) + turn_by_z(sums[TURN].fine)};
    keep(piece, n + 1, 0, divide(turned, 2 * factor, 0.5 * inverse));
    PartsOf<Lanes> rates = {};
    add_product(rates, friction_.coarse, friction_.fine, take_rates(piece.coarse[n][1]),
                take_rates(piece.rests[n][1]), take_rates(piece.terms[n][1]));
    const PartsOf<Lanes> vertical =
        collect(PartsOf<Lanes>{take_first(sums[WEIGHT].coarse) + take_last(sums[WEIGHT].coarse),
                               take_first(sums[WEIGHT].fine) + take_last(sums[WEIGHT].fine)});
    add_product(rates, weight_.coarse, weight_.fine, vertical.coarse, vertical.fine,
                vertical.whole());
    if (COUNT > 4) {
      PartsOf<Lanes> squares[BLOCKS - WEIGHT];
      for (int b = 0; b < BLOCKS - WEIGHT; b++) squares[b] = collect(sums[WEIGHT + b]);
      SYMTOP_UNROLL
      for (int p = 0; p < SQUARES; p++) {
        const double coarse = squares[p / 4].coarse[p % 4], fine = squares[p / 4].fine[p % 4];
        add_product(rates, torques_[p].coarse, torques_[p].fine, symtop::repeat<Lanes>(coarse),
                    symtop::repeat<Lanes>(fine), symtop::repeat<Lanes>(coarse + fine));
      }
    }
    keep(piece, n + 1, 1, divide(rates, factor, inverse));
  }

  // ---- The first terms as sums of two doubles ----

  // False if numbers are too small or too large for these products: it ends at the first of them,
  // because the coefficients of a slow turn fall so fast that those of order 3 may be.
  template <int COUNT, class Product>
  SYMTOP_CLONES bool compute(Piece& piece) {
    if (!can_take_equations<Product>()) return false;
    turning_orders_ = last_turn_ = DRIVEN_TERMS;
    put_low<COUNT, Product>(piece, 0);
    for (int n = 0; n < EXTENDED_TERMS; n++) {
      if (!can_take_order<Product>(piece, n)) return false;
      compute_low<COUNT, Product>(piece, n);
      put_low<COUNT, Product>(piece, n + 1);
    }
    if (!can_take_order<Product>(piece, EXTENDED_TERMS)) return false;
    compute_all_high<COUNT>(piece);
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
    return Product::can_take(piece.terms[n], 2) && Product::can_take(&right_[n][TURN], 1);
  }

  template <int COUNT, class Product>
  SYMTOP_INLINE void put_low(const Piece& piece, int n) {
    const Lanes *terms = piece.terms[n], *rests = piece.rests[n];
    const Double2 turn =
        symtop::multiply<Product>(Double2{terms[1][OMEGA_Z], rests[1][OMEGA_Z]}, share_);
    put<COUNT>(terms[0], terms[1], symtop::repeat<Lanes>(turn.high), right_[n]);
    put<COUNT>(rests[0], rests[1], symtop::repeat<Lanes>(turn.low), rests_[n]);
  }

  template <int COUNT, class Product>
  SYMTOP_INLINE void compute_low(Piece& piece, int n) const {
    SumOf<Lanes> sums[COUNT] = {};
    for (int m = 0; m <= n; m++) {
      SYMTOP_UNROLL
      for (int v = 0; v < COUNT; v++)
        add_product<Product>(sums[v], {piece.terms[m][0], piece.rests[m][0]},
                             {right_[n - m][v], rests_[n - m][v]});
    }
    SumOf<Lanes> turned = {turn_by_x(sums[0].high), turn_by_x(sums[0].low)};
    add(turned, {turn_by_y(sums[1].high), turn_by_y(sums[1].low)});
    add(turned, {turn_by_z(sums[TURN].high), turn_by_z(sums[TURN].low)});
    const Lanes *now = piece.terms[n], *now_rests = piece.rests[n];
    SumOf<Lanes> rates = {};
    add_product<Product>(rates, equations_->friction,
                         {take_rates(now[1]), take_rates(now_rests[1])});
    const SumOf<Lanes> squares = sums[WEIGHT];
    SumOf<Lanes> vertical = {take_first(squares.high), take_first(squares.low)};
    add(vertical, {take_last(squares.high), take_last(squares.low)});
    add_product<Product>(rates, equations_->weight, vertical);
    if (COUNT > 4) {
      SYMTOP_UNROLL
      for (int p = 0; p < SQUARES; p++)
        add_product<Product>(rates, equations_->torques[p],
                             repeat(pick(sums[WEIGHT + p / 4], p % 4)));
    }
    const Double2 inverse = INVERSES[n + 1];
    put_term<Product>(piece, n + 1, 0, turned, scale(inverse, 0.5));
    put_term<Product>(piece, n + 1, 1, rates, inverse);
  }

  template <class Product>
  static SYMTOP_INLINE void put_term(Piece& piece, int n, int half, SumOf<Lanes> sum,
                                     Double2 factor) {
    const SumOf<Lanes> term =
        symtop::multiply<Product>(fast_sum_of(sum.high, sum.low), repeat(factor));
    piece.terms[n][half] = term.high;
    piece.rests[n][half] = term.low;
  }

  // ---- All terms in doubles ----

  // One order after the other: of each, first the products without its own q and omega, which have
  // just been computed.
  template <int COUNT>
  SYMTOP_CLONES void compute_coarsely(Piece& piece) {
    last_turn_ = COARSE_TERMS;
    Lanes q = piece.terms[0][0], omega = piece.terms[0][1];
    put<COUNT>(q, omega, spread<OMEGA_Z>(omega) * share_.high, right_[0]);
    const Lanes first[3] = {turn_by_x(q), turn_by_y(q), turn_by_z(q) * share_.high};
    for (int n = 0; n < COARSE_TERMS; n++) {
      Lanes sums[COUNT] = {};
      add_inner<COUNT>(piece, n, sums);
      add_squares<COUNT>(piece, n, q, sums);
      Lanes turned = (turn_by_x(sums[0]) + turn_by_y(sums[1])) + turn_by_z(sums[TURN]);
      turned += turn_first(first, omega);
      if (n > 0) turned += turn_newest(q);
      const double inverse = INVERSES.high[n + 1];
      omega = find_acceleration<COUNT>(omega, sums) * inverse;
      q = turned * (0.5 * inverse);
      piece.terms[n + 1][0] = q;
      piece.terms[n + 1][1] = omega;
      put<COUNT>(q, omega, spread<OMEGA_Z>(omega) * share_.high, right_[n + 1]);
      note_last_turn<COUNT>(n + 1);
    }
  }

  // q of order 0, which is turned in advance, times the newest omega: few operations wait for it.
  static SYMTOP_INLINE Lanes turn_first(const Lanes first[3], Lanes omega) {
    return (spread<OMEGA_X>(omega) * first[0] + spread<OMEGA_Y>(omega) * first[1]) +
           spread<OMEGA_Z>(omega) * first[2];
  }

  // The newest q times omega of order 0.
  SYMTOP_INLINE Lanes turn_newest(Lanes q) const {
    return (turn_by_x(q) * right_[0][0] + turn_by_y(q) * right_[0][1]) +
           turn_by_z(q) * right_[0][TURN];
  }

  // The products of the newest q and of q of order 0, for the weight and torques.
  template <int COUNT>
  SYMTOP_INLINE void add_squares(const Piece& piece, int n, Lanes q, Lanes sums[COUNT]) const {
    SYMTOP_UNROLL
    for (int v = WEIGHT; v < COUNT; v++) {
      sums[v] += piece.terms[0][0] * right_[n][v];
      if (n > 0) sums[v] += q * right_[0][v];
    }
  }

  // The products without a term of order 0 or n.
  template <int COUNT>
  SYMTOP_INLINE void add_inner(const Piece& piece, int n, Lanes sums[COUNT]) const {
    for (int m = 1; m < n; m++) {
      SYMTOP_UNROLL
      for (int v = 0; v < COUNT; v++)
        if (v != TURN || COUNT > 4) sums[v] += piece.terms[m][0] * right_[n - m][v];
    }
    if (COUNT == 4)
      for (int m = 1; m < std::min(n, last_turn_); m++)
        sums[TURN] += piece.terms[n - m][0] * right_[m][TURN];
  }

  // The derivative of omega.
  template <int COUNT>
  SYMTOP_INLINE Lanes find_acceleration(Lanes omega, const Lanes sums[COUNT]) const {
    const Lanes vertical = take_first(sums[WEIGHT]) + take_last(sums[WEIGHT]);
    Lanes sum = equations_->friction.high * take_rates(omega) + equations_->weight.high * vertical;
    if (COUNT > 4) {
      SYMTOP_UNROLL
      for (int p = 0; p < SQUARES; p++)
        sum += equations_->torques[p].high * symtop::repeat<Lanes>(sums[WEIGHT + p / 4][p % 4]);
    }
    return sum;
  }

  // Without a torque omega_z decays by itself, and after few orders the turn has no digit that
  // counts.
  template <int COUNT>
  SYMTOP_INLINE void note_last_turn(int n) {
    const bool counts = COUNT > 4 || std::fabs(right_[n][TURN][0]) >= LEAST_TURN;
    if (last_turn_ == COARSE_TERMS && !counts) last_turn_ = n;
  }

  // ---- The other terms in doubles ----

  // Two orders at a time: what both need of the terms before them is read once. While a term waits
  // for its last products, the processor has those of the next two orders that need neither of
  // both.
  template <int COUNT>
  SYMTOP_INLINE void compute_all_high(Piece& piece) {
    static_assert((DRIVEN_TERMS - EXTENDED_TERMS) % 2 == 0 && EXTENDED_TERMS > 2,
                  "pairs of orders");
    Lanes sums[COUNT] = {}, next[COUNT] = {};
    add_older<COUNT>(piece, EXTENDED_TERMS, 1, EXTENDED_TERMS - 1, sums, next);
    for (int n = EXTENDED_TERMS; n < DRIVEN_TERMS; n += 2) {
      Lanes later[COUNT] = {}, last[COUNT] = {};
      add_pair<COUNT>(piece, 1, n, next);
      complete<COUNT>(piece, n, sums);
      if (n + 2 < DRIVEN_TERMS) add_older<COUNT>(piece, n + 2, 2, n, later, last);
      complete<COUNT>(piece, n + 1, next);
      if (n + 2 < DRIVEN_TERMS) {
        add_pair<COUNT>(piece, 1, n + 1, later);
        add_pair<COUNT>(piece, 2, n + 1, last);
      }
      SYMTOP_UNROLL
      for (int v = 0; v < COUNT; v++) {
        sums[v] = later[v];
        next[v] = last[v];
      }
    }
  }

  // The two products of the terms m and n.
  template <int COUNT>
  SYMTOP_INLINE void add_pair(const Piece& piece, int m, int n, Lanes sums[COUNT]) const {
    SYMTOP_UNROLL
    for (int v = 0; v < COUNT; v++)
      sums[v] += piece.terms[m][0] * right_[n][v] + piece.terms[n][0] * right_[m][v];
  }

  // Products of the terms first to last: their sums of order n = first + last, and of the next one.
  template <int COUNT>
  SYMTOP_INLINE void add_older(const Piece& piece, int n, int first, int last, Lanes sums[COUNT],
                               Lanes next[COUNT]) const {
    Lanes upper[COUNT];
    SYMTOP_UNROLL
    for (int v = 0; v < COUNT; v++)
      if (v != TURN || COUNT > 4) {
        upper[v] = right_[last][v];
        sums[v] += piece.terms[first][0] * upper[v];
      }
    for (int m = first + 1; m <= last; m++) {
      const Lanes left = piece.terms[m][0];
      SYMTOP_UNROLL
      for (int v = 0; v < COUNT; v++)
        if (v != TURN || COUNT > 4) {
          const Lanes lower = right_[n - m][v];
          next[v] += left * upper[v];
          sums[v] += left * lower;
          upper[v] = lower;
        }
    }
    if (COUNT > 4) return;
    for (int m = std::min(last, last_turn_); m >= first; m--) {
      sums[TURN] += piece.terms[n - m][0] * right_[m][TURN];
      if (m > first) next[TURN] += piece.terms[n + 1 - m][0] * right_[m][TURN];
    }
  }

  // Few operations wait for the newest factors: what does not is summed before.
  template <int COUNT>
  SYMTOP_INLINE void complete(Piece& piece, int n, Lanes sums[COUNT]) {
    const double inverse = INVERSES.high[n + 1];
    add_pair<COUNT>(piece, 0, n, sums);
    const Lanes q =
        ((turn_by_x(sums[0]) + turn_by_y(sums[1])) + turn_by_z(sums[TURN])) * (0.5 * inverse);
    const Lanes vertical = take_first(sums[WEIGHT]) + take_last(sums[WEIGHT]);
    Lanes omega = (equations_->friction.high * inverse) * take_rates(piece.terms[n][1]) +
                  (equations_->weight.high * inverse) * vertical;
    if (COUNT > 4) {
      SYMTOP_UNROLL
      for (int p = 0; p < SQUARES; p++)
        omega += (equations_->torques[p].high * inverse) *
                 symtop::repeat<Lanes>(sums[WEIGHT + p / 4][p % 4]);
    }
    piece.terms[n + 1][0] = q;
    piece.terms[n + 1][1] = omega;
    put<COUNT>(q, omega, spread<OMEGA_Z>(omega) * share_.high, right_[n + 1]);
  }
};

}  // namespace symtop

// Floats with as many bits as are asked for: mantissa times 2^exponent, both integers of any size.
//
// What Python computes with Decimal or in extended precision is computed with these. Each operation
// rounds to the nearest, of two equally near ones to the even one, as the processor's formats do.

/** Bits of the processor's extended precision, NumPy's longdouble on x86. */
export const EXTENDED = 64;
/** Bits of Decimals with 50 and with 120 digits, and some to spare. */
export const LONG = 200;
export const LONGEST = 420;

const buffer = new DataView(new ArrayBuffer(8));

/**
 * The number of bits of a positive integer.
 * @param {bigint} n
 */
const countBits = (n) => n.toString(2).length;

/**
 * The whole part of the square root.
 * @param {bigint} n
 */
const findRoot = (n) => {
  if (n < 2n) return n;
  let root = 1n << BigInt((countBits(n) + 1) >> 1);
  for (;;) {
    const next = (root + n / root) >> 1n;
    if (next >= root) return root;
    root = next;
  }
};

/**
 * @param {bigint} mantissa
 * @param {number} exponent
 * @param {number} bits
 * @returns {{mantissa: bigint, exponent: number}}
 */
const round = (mantissa, exponent, bits) => {
  const size = mantissa < 0n ? -mantissa : mantissa;
  const spare = countBits(size) - bits;
  if (size === 0n || spare <= 0) return { mantissa, exponent };
  const shift = BigInt(spare);
  const half = 1n << (shift - 1n);
  let kept = size >> shift;
  const rest = size - (kept << shift);
  if (rest > half || (rest === half && kept & 1n)) kept += 1n;
  return { mantissa: mantissa < 0n ? -kept : kept, exponent: exponent + spare };
};

export class Big {
  /**
   * @param {bigint} mantissa
   * @param {number} exponent
   * @param {number} bits of every result
   */
  constructor(mantissa, exponent, bits) {
    const rounded = round(mantissa, exponent, bits);
    this.mantissa = rounded.mantissa;
    this.exponent = rounded.exponent;
    this.bits = bits;
  }

  /**
   * A double, exactly.
   * @param {number} x
   * @param {number} bits
   */
  static of(x, bits) {
    buffer.setFloat64(0, x);
    const high = buffer.getUint32(0);
    const stored = (high >>> 20) & 0x7ff;
    let mantissa = (BigInt(high & 0xfffff) << 32n) | BigInt(buffer.getUint32(4));
    if (stored) mantissa |= 1n << 52n;
    return new Big(high >>> 31 ? -mantissa : mantissa, Math.max(stored, 1) - 1075, bits);
  }

  /** @param {Big | number} x */
  take(x) {
    return x instanceof Big ? x : Big.of(x, this.bits);
  }

  get sign() {
    return this.mantissa > 0n ? 1 : this.mantissa < 0n ? -1 : 0;
  }

  /** @returns {Big} */
  get negative() {
    return new Big(-this.mantissa, this.exponent, this.bits);
  }

  /** @returns {Big} */
  get size() {
    return this.sign < 0 ? this.negative : this;
  }

  /** @param {Big | number} x */
  plus(x) {
    const other = this.take(x);
    if (!this.sign) return new Big(other.mantissa, other.exponent, this.bits);
    if (!other.sign) return this;
    const least = Math.min(this.exponent, other.exponent);
    const mine = this.mantissa << BigInt(this.exponent - least);
    return new Big(mine + (other.mantissa << BigInt(other.exponent - least)), least, this.bits);
  }

  /** @param {Big | number} x */
  minus(x) {
    return this.plus(this.take(x).negative);
  }

  /** @param {Big | number} x */
  times(x) {
    const other = this.take(x);
    return new Big(this.mantissa * other.mantissa, this.exponent + other.exponent, this.bits);
  }

  /** @param {Big | number} x */
  over(x) {
    const other = this.take(x);
    // Two bits more than are kept, and a bit for what is left: a half is then told from more.
    const shift = Math.max(
      0,
      this.bits + 3 + countBits(other.size.mantissa) - countBits(this.size.mantissa),
    );
    const scaled = this.size.mantissa << BigInt(shift + 1);
    const quotient = scaled / other.size.mantissa;
    const sticky = quotient * other.size.mantissa === scaled ? 0n : 1n;
    const mantissa = (quotient | sticky) * BigInt(this.sign * other.sign);
    return new Big(mantissa, this.exponent - other.exponent - shift - 1, this.bits);
  }

  /** The square root of a number that is not negative. */
  get root() {
    const spare = 2 * this.bits + 6 - countBits(this.mantissa);
    const shift = Math.max(0, spare) + ((this.exponent - Math.max(0, spare)) & 1);
    const scaled = this.mantissa << BigInt(shift);
    const root = findRoot(scaled);
    const sticky = root * root === scaled ? 0n : 1n;
    return new Big((root << 1n) | sticky, (this.exponent - shift) / 2 - 1, this.bits);
  }

  /** @param {Big | number} x */
  isBelow(x) {
    const other = this.take(x);
    const least = Math.min(this.exponent, other.exponent);
    const mine = this.mantissa << BigInt(this.exponent - least);
    return mine < other.mantissa << BigInt(other.exponent - least);
  }

  /** The nearest double. */
  get number() {
    if (!this.sign) return 0;
    // Below the normal doubles fewer bits are kept: rounding twice could go wrong.
    const place = countBits(this.size.mantissa) + this.exponent;
    const { mantissa, exponent } = round(this.mantissa, this.exponent, Math.min(53, place + 1074));
    if (place + 1074 < 1) return 0;
    return exponent < -1000
      ? Number(mantissa) * 2 ** (exponent + 900) * 2 ** -900
      : exponent > 900
        ? Number(mantissa) * 2 ** 900 * 2 ** (exponent - 900)
        : Number(mantissa) * 2 ** exponent;
  }
}

// Numbers at equal distances, for curves and searches.

/** Numbers at equal distances. @param {number} low @param {number} high @param {number} count */
export const spread = (low, high, count) =>
  Array.from({ length: count }, (_, k) => low + ((high - low) * k) / (count - 1));

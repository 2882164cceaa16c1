// Products are rounded before they are added, on every processor.
#pragma once

// For a processor with FMA (-mfma, -march=native), GCC 12 fuses products with sums and differences
// that alternate (vfmaddsub), though -ffp-contract=off forbids it: of 627 245 numbers of motions,
// 1.7 % had other bits. It does so where it makes vectors of straight-line code.
#if defined(__FMA__) && defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-slp-vectorize")
#endif

// What the sources need of a compiler: integers of 128 bits and vectors, as GCC and Clang have
// them, the first for processors of 64 bits (and for WebAssembly). MSVC and compilers for 32 bits
// have not.
#pragma once

#if !(defined(__GNUC__) || defined(__clang__)) || !defined(__SIZEOF_INT128__)
#error "symtop must be compiled by GCC or Clang, 64 bits"
#endif

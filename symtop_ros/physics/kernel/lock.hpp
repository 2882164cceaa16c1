// A lock for what threads share; none in WebAssembly, where a module has one thread.
#pragma once

#ifdef __wasm__

namespace symtop {

struct Mutex {};
struct Lock {
  explicit Lock(Mutex&) {}
};

}  // namespace symtop

#else

#include <mutex>

namespace symtop {

typedef std::mutex Mutex;
typedef std::lock_guard<std::mutex> Lock;

}  // namespace symtop

#endif

// Compiles a loop once for each instruction set and picks the widest that the processor has when the plugin loads.
//
// All variants live in one translation unit: only the entry functions carry a target attribute, and everything they
// call is inlined into them, so a wide instruction can never leak into code that runs on an older processor.
#pragma once

#include <cstdlib>
#include <cstring>

#include "pack.hpp"

namespace rouleau {

/// Bytes in a vector register of each instruction set that the SDK compiles for.
enum class InstructionSet { baseline = 16, avx2 = 32, avx512 = 64 };

/// The widest set of this processor. The environment variable ROULEAU_INSTRUCTION_SET ("baseline", "avx2", "avx512")
/// can lower the choice, to compare results and speed; it cannot raise it.
inline InstructionSet instruction_set() {
  InstructionSet widest = InstructionSet::baseline;
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
    widest = InstructionSet::avx2;
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) {
      widest = InstructionSet::avx512;
    }
  }
#endif
  if (const char* wanted = std::getenv("ROULEAU_INSTRUCTION_SET")) {
    if (std::strcmp(wanted, "baseline") == 0) return InstructionSet::baseline;
    if (std::strcmp(wanted, "avx2") == 0 && widest == InstructionSet::avx512) return InstructionSet::avx2;
  }
  return widest;
}

/// Function pointer to Loop::run<bytes>(arguments...) compiled for this processor's widest instruction set.
/// Loop has `template <int register_bytes> static void run(Arguments...)`, whose callees must all be inlinable.
template <class Loop, class... Arguments>
class Dispatch {
 public:
  using Function = void (*)(Arguments...);

  static Function pick() {
#if defined(__x86_64__)
    switch (instruction_set()) {
      case InstructionSet::avx512:
        return avx512;
      case InstructionSet::avx2:
        return avx2;
      case InstructionSet::baseline:
        break;
    }
#endif
    return baseline;
  }

 private:
#if defined(__x86_64__)
  __attribute__((target("avx512f,avx512vl,avx512dq,avx2,fma"), flatten)) static void avx512(Arguments... arguments) {
    Loop::template run<64>(arguments...);
  }
  __attribute__((target("avx2,fma"), flatten)) static void avx2(Arguments... arguments) {
    Loop::template run<32>(arguments...);
  }
#endif
  __attribute__((flatten)) static void baseline(Arguments... arguments) { Loop::template run<16>(arguments...); }
};

}  // namespace rouleau

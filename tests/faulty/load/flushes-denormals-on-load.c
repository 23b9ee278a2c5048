// Fault: what linking with -ffast-math does in old compilers: loading it makes the whole process flush denormals.
#include "potential.h"

__attribute__((constructor)) static void on_load(void) {
#if defined(__x86_64__)
  const unsigned flush = 0x8040;  // flush to zero, denormals are zero
  __builtin_ia32_ldmxcsr(__builtin_ia32_stmxcsr() | flush);
#elif defined(__aarch64__)
  const unsigned long long flush = 1ULL << 24;
  unsigned long long control;
  __asm__ volatile("mrs %0, fpcr" : "=r"(control));
  __asm__ volatile("msr fpcr, %0" : : "r"(control | flush));
#endif
}

POTENTIAL(honest_create, honest_destroy, honest_compute)

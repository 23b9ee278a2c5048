#include "syscall_filter.hpp"

#include <linux/audit.h>
#include <linux/seccomp.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace rouleau::conform {

namespace {

constexpr std::size_t size_of_half = sizeof(std::uint32_t);

constexpr std::size_t offset_of_argument(unsigned argument) {
  return offsetof(seccomp_data, args) + argument * sizeof(std::uint64_t);  // its lower half
}

constexpr std::uint32_t upper_half(std::uint64_t address) { return static_cast<std::uint32_t>(address >> 32); }
constexpr std::uint32_t lower_half(std::uint64_t address) { return static_cast<std::uint32_t>(address); }

}  // namespace

SyscallFilter::SyscallFilter() {
#if defined(__x86_64__)
  load(offsetof(seccomp_data, arch));
  jump(BPF_JEQ, AUDIT_ARCH_X86_64, 1, 0);
  end(SECCOMP_RET_TRAP);  // 32-bit calls have other numbers
#endif
  load(offsetof(seccomp_data, nr));
}

void SyscallFilter::allow(long number) {
  jump(BPF_JEQ, static_cast<std::uint32_t>(number), 0, 1);
  end(SECCOMP_RET_ALLOW);
}

void SyscallFilter::allow_if(long number, unsigned argument, std::uint32_t value, std::uint32_t shift) {
  jump(BPF_JEQ, static_cast<std::uint32_t>(number), 0, 5);
  load(offset_of_argument(argument));
  program_.push_back(BPF_STMT(BPF_ALU | BPF_RSH | BPF_K, shift));
  jump(BPF_JEQ, value, 0, 1);
  end(SECCOMP_RET_ALLOW);
  load(offsetof(seccomp_data, nr));
}

void SyscallFilter::trap(long number) {
  jump(BPF_JEQ, static_cast<std::uint32_t>(number), 0, 1);
  end(SECCOMP_RET_TRAP);
}

void SyscallFilter::allow_code(std::uint64_t first, std::uint64_t last) {
  // The kernel's filter compares halves of addresses, so each part has one upper half. Where code lies is drawn at
  // random: one process in some ten thousand has its loader across such a border.
  if (const std::uint64_t border = std::uint64_t{upper_half(last)} << 32; first < border) {
    allow_code(first, border - 1);
    first = border;
  }
  load(offsetof(seccomp_data, instruction_pointer) + size_of_half);
  jump(BPF_JEQ, upper_half(first), 0, 4);
  load(offsetof(seccomp_data, instruction_pointer));
  jump(BPF_JGE, lower_half(first), 0, 2);
  jump(BPF_JGT, lower_half(last), 1, 0);
  end(SECCOMP_RET_ALLOW);
  load(offsetof(seccomp_data, nr));
}

bool SyscallFilter::install(std::uint32_t otherwise) {
  end(otherwise);
  const sock_fprog filter{static_cast<unsigned short>(program_.size()), program_.data()};
  // With what keeps some kernels from slowing down the thread's arithmetic.
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_SPEC_ALLOW, &filter) == 0;
}

void SyscallFilter::load(std::size_t offset) {
  program_.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset)));
}

void SyscallFilter::jump(std::uint16_t kind, std::uint32_t value, std::uint8_t if_true, std::uint8_t if_false) {
  program_.push_back({static_cast<std::uint16_t>(BPF_JMP | kind | BPF_K), if_true, if_false, value});
}

void SyscallFilter::end(std::uint32_t action) { program_.push_back(BPF_STMT(BPF_RET | BPF_K, action)); }

}  // namespace rouleau::conform

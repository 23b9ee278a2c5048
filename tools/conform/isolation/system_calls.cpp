#include "system_calls.hpp"

#include <link.h>
#include <linux/audit.h>
#include <linux/seccomp.h>
#include <sys/auxv.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "base/foreign_call.hpp"
#include "base/process.hpp"
#include "conform/report_line.hpp"

namespace rouleau::conform {

namespace {

/// What only this program's ends have above the eight bits of an exit code.
constexpr std::uint32_t own_word = 0x00c0ffee << 8;

/// The calls that code in the wrong place is likely to make; others are told by number.
constexpr std::array named_calls = {
#define NAMED(call) \
  std::pair<long, const char*> { SYS_##call, #call }
    // clang-format off
    NAMED(read), NAMED(write), NAMED(writev), NAMED(openat), NAMED(close), NAMED(lseek), NAMED(newfstatat),
    NAMED(ioctl), NAMED(getcwd), NAMED(chdir), NAMED(unlinkat), NAMED(mkdirat), NAMED(dup3), NAMED(pipe2), NAMED(mmap),
    NAMED(munmap), NAMED(mprotect), NAMED(brk), NAMED(futex), NAMED(socket), NAMED(clone), NAMED(clone3), NAMED(execve),
    NAMED(exit_group), NAMED(kill), NAMED(tgkill), NAMED(prctl), NAMED(umask), NAMED(prlimit64), NAMED(rt_sigaction),
    NAMED(clock_gettime), NAMED(clock_nanosleep), NAMED(sched_yield), NAMED(getrandom), NAMED(getpid),
#undef NAMED
    // clang-format on
};

constexpr std::uint32_t upper_half(std::uint64_t address) { return static_cast<std::uint32_t>(address >> 32); }
constexpr std::uint32_t lower_half(std::uint64_t address) { return static_cast<std::uint32_t>(address); }

void on_system_call(int /*signal*/, siginfo_t* info, void* /*context*/) {
  const char* name = "of another kind";
  for (const auto& [number, known] : named_calls) {
    if (number == info->si_syscall) name = known;
  }
  const ForeignCall* foreign = ForeignCall::current();
  char text[256];
  std::snprintf(text, sizeof text, "made a system call: %s (number %d)%s%s", name, info->si_syscall,
                foreign != nullptr ? ", in its function " : "", foreign != nullptr ? foreign->function() : "");
  send_from_signal(to_string(Verdict::fail), text);
  end_process(1);
}

/// The dynamic loader may call what it likes.
void allow_loader(SyscallFilter& filter) {
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* allowing) {
        for (int i = 0; i < info->dlpi_phnum; ++i) {
          const auto& segment = info->dlpi_phdr[i];
          if (info->dlpi_addr != getauxval(AT_BASE) || segment.p_type != PT_LOAD || (segment.p_flags & PF_X) == 0)
            continue;
          const std::uint64_t first = info->dlpi_addr + segment.p_vaddr;
          static_cast<SyscallFilter*>(allowing)->allow_code(first, first + segment.p_memsz - 1);
        }
        return 0;
      },
      &filter);
}

void allow_memory(SyscallFilter& filter) {
  allow_loader(filter);
  for (const long number :
       {SYS_brk, SYS_mmap, SYS_munmap, SYS_mremap, SYS_mprotect, SYS_madvise, SYS_futex, SYS_sched_yield, SYS_getrandom,
        SYS_sysinfo, SYS_sched_getaffinity, SYS_clock_gettime, SYS_clock_getres, SYS_gettimeofday, SYS_getpid,
        SYS_gettid, SYS_rt_sigprocmask, SYS_rseq, SYS_set_robust_list}) {
    filter.allow(number);
  }
  filter.allow_if(SYS_rt_sigaction, 1, 0);  // asking which handler there is
  filter.allow_if(SYS_prlimit64, 2, 0);     // asking for a limit
  for (const std::uint32_t stream :
       {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {  // asking what it is, as Fortran does
    filter.allow_if(SYS_newfstatat, 0, stream);
#ifdef SYS_fstat
    filter.allow_if(SYS_fstat, 0, stream);
#endif
  }
}

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

void SyscallFilter::allow_if(long number, unsigned argument, std::uint32_t value) {
  jump(BPF_JEQ, static_cast<std::uint32_t>(number), 0, 4);
  load(offsetof(seccomp_data, args) + argument * sizeof(std::uint64_t));  // its lower half
  jump(BPF_JEQ, value, 0, 1);
  end(SECCOMP_RET_ALLOW);
  load(offsetof(seccomp_data, nr));
}

void SyscallFilter::allow_code(std::uint64_t first, std::uint64_t last) {
  // The kernel's filter compares halves of addresses, so each part has one upper half. Where code lies is drawn at
  // random: one process in some ten thousand has its loader across such a border.
  if (const std::uint64_t border = std::uint64_t{upper_half(last)} << 32; first < border) {
    allow_code(first, border - 1);
    first = border;
  }
  load(offsetof(seccomp_data, instruction_pointer) + sizeof(std::uint32_t));
  jump(BPF_JEQ, upper_half(first), 0, 4);
  load(offsetof(seccomp_data, instruction_pointer));
  jump(BPF_JGE, lower_half(first), 0, 2);
  jump(BPF_JGT, lower_half(last), 1, 0);
  end(SECCOMP_RET_ALLOW);
  load(offsetof(seccomp_data, nr));
}

bool SyscallFilter::install() {
  end(SECCOMP_RET_TRAP);
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

bool limit_system_calls(Allowed allowed) {
  struct sigaction action {};
  action.sa_sigaction = on_system_call;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  sigaction(SIGSYS, &action, nullptr);
  SyscallFilter filter;
  for (const std::uint32_t code : {0U, 1U}) filter.allow_if(SYS_exit_group, 0, own_word | code);
  filter.allow(SYS_exit);
  filter.allow(SYS_rt_sigreturn);
  filter.allow_if(SYS_write, 0, finding_descriptor);
  if (allowed == Allowed::memory) allow_memory(filter);
  return filter.install();
}

void end_process(int code) {
  while (true) syscall(SYS_exit_group, own_word | static_cast<std::uint32_t>(code));
}

void end_in_order() { std::exit(static_cast<int>(own_word)); }

void end_thread() {
  while (true) syscall(SYS_exit, 0);
}

}  // namespace rouleau::conform

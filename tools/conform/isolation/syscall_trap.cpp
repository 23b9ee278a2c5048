#include "syscall_trap.hpp"

#include <elf.h>
#include <fcntl.h>
#include <link.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sys/auxv.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "base/foreign_call.hpp"
#include "base/process.hpp"
#include "conform/report_line.hpp"
#include "syscall_filter.hpp"

namespace rouleau::conform {

namespace {

/// What only this program's calls have above the eight bits of an exit code.
constexpr std::uint32_t own_word = 0x00c0ffee;

/// The calls that code in the wrong place is likely to make; others are told by number.
constexpr std::array named_calls = {
#define NAMED(call) \
  std::pair<long, const char*> { SYS_##call, #call }
    NAMED(read),
    NAMED(write),
    NAMED(writev),
    NAMED(pwrite64),
    NAMED(pread64),
    NAMED(openat),
    NAMED(close),
    NAMED(lseek),
    NAMED(newfstatat),
    NAMED(statx),
    NAMED(readlinkat),
    NAMED(faccessat),
    NAMED(getdents64),
    NAMED(getcwd),
    NAMED(chdir),
    NAMED(fchdir),
    NAMED(unlinkat),
    NAMED(renameat2),
    NAMED(mkdirat),
    NAMED(ftruncate),
    NAMED(fsync),
    NAMED(ioctl),
    NAMED(fcntl),
    NAMED(dup),
    NAMED(dup3),
    NAMED(pipe2),
    NAMED(memfd_create),
    NAMED(mmap),
    NAMED(munmap),
    NAMED(mprotect),
    NAMED(madvise),
    NAMED(brk),
    NAMED(futex),
    NAMED(socket),
    NAMED(connect),
    NAMED(sendto),
    NAMED(clone),
    NAMED(clone3),
    NAMED(execve),
    NAMED(wait4),
    NAMED(exit),
    NAMED(exit_group),
    NAMED(kill),
    NAMED(tgkill),
    NAMED(ptrace),
    NAMED(prctl),
    NAMED(setsid),
    NAMED(umask),
    NAMED(setpriority),
    NAMED(prlimit64),
    NAMED(setrlimit),
    NAMED(rt_sigaction),
    NAMED(rt_sigprocmask),
    NAMED(sigaltstack),
    NAMED(setitimer),
    NAMED(timer_create),
    NAMED(clock_gettime),
    NAMED(clock_nanosleep),
    NAMED(nanosleep),
    NAMED(sched_yield),
    NAMED(sched_setaffinity),
    NAMED(getrandom),
    NAMED(getpid),
    NAMED(gettid),
    NAMED(getuid),
    NAMED(uname),
    NAMED(seccomp),
    NAMED(personality),
#ifdef __x86_64__
    NAMED(open),
    NAMED(stat),
    NAMED(access),
    NAMED(readlink),
    NAMED(unlink),
    NAMED(rename),
    NAMED(mkdir),
    NAMED(rmdir),
    NAMED(dup2),
    NAMED(pipe),
    NAMED(fork),
    NAMED(vfork),
    NAMED(alarm),
    NAMED(pause),
    NAMED(time),
    NAMED(arch_prctl),
#endif
#undef NAMED
};

/// What a model starts is found where it begins, and its end is no finding.
bool is_child = false;

void on_system_call(int /*signal*/, siginfo_t* info, void* /*context*/) {
  if (is_child) end_process(1);
  const char* name = "of another kind";
  for (const auto& [number, known] : named_calls) {
    if (number == info->si_syscall) name = known;
  }
  const ForeignCall* foreign = ForeignCall::current();
  const bool ends = info->si_syscall == SYS_exit_group;
  char text[256];
  std::snprintf(text, sizeof text, "%s %s (number %d)%s%s",
                ends ? "ended the process, by the system call" : "made a system call:", name, info->si_syscall,
                foreign != nullptr ? ", in its function " : "", foreign != nullptr ? foreign->function() : "");
  send_from_signal(to_string(ends ? Verdict::crash : Verdict::fail), text);
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
  for (const std::uint32_t output : {STDOUT_FILENO, STDERR_FILENO}) {
    for (const long number : {SYS_write, SYS_writev}) filter.allow_if(number, 0, output);
  }
  for (const std::uint32_t stream :
       {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {  // asking what it is, as Fortran does
    filter.allow_if(SYS_newfstatat, 0, stream);
#ifdef SYS_fstat
    filter.allow_if(SYS_fstat, 0, stream);
#endif
  }
}

}  // namespace

bool limit_system_calls(Allowed allowed) {
  if (allowed == Allowed::all_but_exit) {
    is_child = false;
    pthread_atfork(nullptr, nullptr, [] { is_child = true; });
    struct sigaction action {};
    action.sa_sigaction = on_system_call;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    sigaction(SIGSYS, &action, nullptr);
  }
  SyscallFilter filter;
  filter.allow_if(SYS_exit_group, 0, own_word, 8);
  if (allowed == Allowed::all_but_exit) {
    filter.trap(SYS_exit_group);
    return filter.install(SECCOMP_RET_ALLOW);
  }
  filter.allow(SYS_rt_sigreturn);
  filter.allow_if(SYS_exit, 0, own_word, 8);
  filter.allow_if(SYS_write, 0, finding_descriptor);
  if (allowed == Allowed::memory) {
    filter.allow_if(SYS_exit, 0, 0);  // the end of a thread
    allow_memory(filter);
  }
  return filter.install(SECCOMP_RET_TRAP);
}

void end_process(int code) {
  while (true) syscall(SYS_exit_group, own_word << 8 | static_cast<std::uint32_t>(code));
}

void end_in_order() { std::exit(static_cast<int>(own_word << 8)); }

void end_thread() {
  while (true) syscall(SYS_exit, own_word << 8);
}

}  // namespace rouleau::conform

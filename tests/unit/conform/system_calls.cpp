// The filter of system calls: code that may call, wherever it lies, and all other code.
#include "conform/isolation/system_calls.hpp"

#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <thread>
#include <vector>

#ifdef __x86_64__

namespace {

using rouleau::conform::SyscallFilter;

/// Two pages of code, the second of which begins where the upper half of an address grows by one.
class CodeAcrossABorder {
 public:
  CodeAcrossABorder() {
    constexpr std::uint64_t half = std::uint64_t{1} << 32;
    // Above what AddressSanitizer keeps for itself.
    for (std::uint64_t at = 0x2000 * half; at < 0x3000 * half && border == 0; at += half) {
      pages_ = mmap(reinterpret_cast<void*>(at - size), 2 * size, PROT_READ | PROT_WRITE | PROT_EXEC,
                    MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED_NOREPLACE, -1, 0);
      if (pages_ != MAP_FAILED) border = at;
    }
    REQUIRE(border != 0);
  }
  ~CodeAcrossABorder() { munmap(pages_, 2 * size); }
  CodeAcrossABorder(const CodeAcrossABorder&) = delete;
  CodeAcrossABorder& operator=(const CodeAcrossABorder&) = delete;

  /// Asks for the parent's number, and comes back from the kernel to this address.
  void call_from(std::uint64_t back) const {
    constexpr unsigned char call[] = {0xb8, SYS_getppid, 0, 0, 0, 0x0f, 0x05, 0xc3};  // mov eax, ...; syscall; ret
    auto* const place = reinterpret_cast<unsigned char*>(back - (sizeof call - 1));
    std::memcpy(place, call, sizeof call);
    reinterpret_cast<long (*)()>(place)();
  }

  std::uint64_t border = 0;

 private:
  static constexpr std::uint64_t size = 4096;
  void* pages_ = nullptr;
};

volatile std::sig_atomic_t trapped;
void on_trap(int /*signal*/) { trapped = trapped + 1; }

/// Of calls that come back to these addresses, those that a filter traps which allows code from `first` to `last`.
std::vector<std::uint64_t> trapped_calls(const CodeAcrossABorder& code, std::uint64_t first, std::uint64_t last,
                                         const std::vector<std::uint64_t>& calls) {
  std::vector<std::uint64_t> found;
  bool installed = false;
  std::thread([&] {
    SyscallFilter filter;
    for (const long number : {SYS_rt_sigreturn, SYS_exit, SYS_madvise, SYS_munmap, SYS_mmap, SYS_futex,
                              SYS_rt_sigprocmask, SYS_mprotect, SYS_brk, SYS_write, SYS_sigaltstack})
      filter.allow(number);
    filter.allow_code(first, last);
    installed = filter.install();
    for (const std::uint64_t back : calls) {
      trapped = 0;
      code.call_from(back);
      if (trapped != 0) found.push_back(back);
    }
  }).join();
  REQUIRE(installed);
  return found;
}

}  // namespace

TEST_CASE("code that may make system calls may do so on both sides of a border between halves of addresses") {
  struct sigaction action {
  }, before{};
  action.sa_handler = on_trap;
  sigaction(SIGSYS, &action, &before);
  const CodeAcrossABorder code;
  const std::uint64_t border = code.border;
  const std::vector<std::uint64_t> calls = {border - 101, border - 100, border - 1,  border,
                                            border + 1,   border + 100, border + 101};
  using Calls = std::vector<std::uint64_t>;
  CHECK(trapped_calls(code, border - 100, border + 100, calls) == Calls{border - 101, border + 101});
  CHECK(trapped_calls(code, border - 100, border - 1, calls) ==
        Calls{border - 101, border, border + 1, border + 100, border + 101});
  CHECK(trapped_calls(code, border - 100, border, calls) ==
        Calls{border - 101, border + 1, border + 100, border + 101});
  CHECK(trapped_calls(code, border, border + 100, calls) ==
        Calls{border - 101, border - 100, border - 1, border + 101});
  sigaction(SIGSYS, &before, nullptr);
}

#endif

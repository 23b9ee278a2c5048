// The program that runs one conformance check of one plugin; `rouleau conform` starts it, once for every check.
//
// usage: conform-check MANIFEST CHECK SEED DIMENSION
//
// The check of surroundings adds a WORLD (isolation/worlds.hpp), and the program itself one word more when it is there.
// The finding goes to file descriptor 3 (report_line.hpp). Whatever the plugin does ends with this process.
#include <sys/prctl.h>
#include <sys/resource.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>

#include "base/error.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "conform/guarded_memory.hpp"
#include "conform/isolation/frozen_memory.hpp"
#include "conform/isolation/system_calls.hpp"
#include "conform/isolation/worlds.hpp"
#include "conform/report_line.hpp"
#include "conform/subject.hpp"
#include "plugin/manifest_reader.hpp"

namespace {

using namespace rouleau;

bool was_write([[maybe_unused]] const void* context) {
#if defined(__x86_64__)
  constexpr greg_t write_bit = 2;  // of the page fault's error code
  return (static_cast<const ucontext_t*>(context)->uc_mcontext.gregs[REG_ERR] & write_bit) != 0;
#else
  return false;
#endif
}

/// Whether the processor stopped at an instruction that reads its clock, as those do that ask for the time.
bool reads_clock([[maybe_unused]] const siginfo_t* info, [[maybe_unused]] const void* context) {
#if defined(__x86_64__)
  const auto at = static_cast<const ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP];
  const auto* code = reinterpret_cast<const unsigned char*>(at);
  return info->si_code == SI_KERNEL && code[0] == 0x0f && (code[1] == 0x31 || (code[1] == 0x01 && code[2] == 0xf9));
#else
  return false;
#endif
}

/// Says what the signal was and ends the process. An access to a guarded array is a broken rule, not just a crash.
void on_signal(int signal, siginfo_t* info, void* context) {
  char where[256], text[400];
  if ((signal == SIGSEGV || signal == SIGBUS) &&
      conform::GuardedArray::describe(info->si_addr, was_write(context), where, sizeof where)) {
    std::snprintf(text, sizeof text, "the model %s", where);
    conform::send_from_signal(conform::to_string(conform::Verdict::fail), text);
  } else if (signal == SIGSEGV && conform::FrozenMemory::describe(info->si_addr, text, sizeof text)) {
    conform::send_from_signal(conform::to_string(conform::Verdict::fail), text);
  } else if (signal == SIGSEGV && reads_clock(info, context)) {
    conform::send_from_signal(conform::to_string(conform::Verdict::fail), "compute reads the clock");
  } else {
    std::snprintf(text, sizeof text, "ended by the signal SIG%s", sigabbrev_np(signal));
    conform::send_from_signal(conform::to_string(conform::Verdict::crash), text);
  }
  conform::end_process(1);
}

void watch_signals() {
  static std::array<char, 1 << 16> stack;
  stack_t alternative{};
  alternative.ss_sp = stack.data();
  alternative.ss_size = stack.size();
  sigaltstack(&alternative, nullptr);
  struct sigaction action {};
  action.sa_sigaction = on_signal;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) sigaction(signal, &action, nullptr);
}

/// `world`: null, or the world that was entered, whose text goes to the parent instead of a finding.
conform::Finding run(const std::string& name, const std::string& file, std::uint64_t seed, int dimension,
                     const char* world) {
  try {
    const units::Units units;
    const conform::Subject subject(plugin::read_manifest(file, units), seed, dimension);
    if (world != nullptr) {
      conform::send(conform::outputs_in_world(subject, conform::world_named(world)));
      conform::end_process(0);
    }
    const conform::Check* check = conform::find_check(name, subject.manifest().kind);
    if (check == nullptr) return conform::Finding::skipped("is for models of another kind");
    return conform::run(*check, subject);
  } catch (const Error& error) {
    return conform::Finding::failed(error.what());
  } catch (const conform::Fault& fault) {
    return {conform::Verdict::crash, fault.what(), {}, {}};
  } catch (const std::exception& exception) {
    return {conform::Verdict::crash, std::string("an exception: ") + exception.what(), {}, {}};
  } catch (...) {
    return {conform::Verdict::crash, "an exception that is no std::exception", {}, {}};
  }
}

}  // namespace

int main(int count, char** words) {
  if (count < 5 || count > 7) {
    std::cerr
        << "usage: conform-check MANIFEST CHECK SEED DIMENSION\nrouleau conform starts this program; see its --help\n";
    return 2;
  }
  if (conform::find_check(words[2]) == nullptr) {
    std::cerr << "conform-check: no check is called \"" << words[2] << "\"\n";
    return 2;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  watch_signals();
  if (count == 6) conform::enter_world(conform::world_named(words[5]), count, words);
  const int dimension = std::strtol(words[4], nullptr, 10) == 3 ? 3 : 2;
  conform::send(
      run(words[2], words[1], std::strtoull(words[3], nullptr, 10), dimension, count > 5 ? words[5] : nullptr));
  // Not through static destructors: they are the plugin's, too, and the finding has been sent.
  conform::end_process(0);
}

#include "process_traces.hpp"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>

namespace rouleau::conform {

namespace {

namespace fs = std::filesystem;

int count_threads() {
  int count = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator("/proc/self/task")) ++count;
  return count;
}

std::map<int, std::string> open_descriptors() {
  std::map<int, std::string> open;
  for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
    std::error_code gone;  // the one that this directory is read from
    const fs::path file = fs::read_symlink(entry.path(), gone);
    if (!gone && !file.string().ends_with("/fd")) open[std::stoi(entry.path().filename())] = file;
  }
  return open;
}

std::string process_name() {
  char name[16] = "";
  prctl(PR_GET_NAME, name);
  return name;
}

/// Children that live, or ended and were not waited for.
bool has_children() {
  siginfo_t info{};
  return waitid(P_ALL, 0, &info, WEXITED | WSTOPPED | WNOHANG | WNOWAIT) == 0;
}

bool has_timers() {
  for (const auto kind : {ITIMER_REAL, ITIMER_VIRTUAL, ITIMER_PROF}) {
    itimerval timer{};
    if (getitimer(kind, &timer) == 0 && (timer.it_value.tv_sec != 0 || timer.it_value.tv_usec != 0)) return true;
  }
  std::ifstream timers("/proc/self/timers");
  return timers.peek() != std::ifstream::traits_type::eof();
}

/// The buffers of the standard streams, and the next of the C library's random numbers: both are one for all.
std::array<std::uintptr_t, 5> of_the_c_library() {
  constexpr unsigned seed = 20;
  std::array<std::uintptr_t, 5> all{};
  std::size_t k = 0;
  for (const FILE* stream : {stdin, stdout, stderr}) all[k++] = reinterpret_cast<std::uintptr_t>(stream->_IO_buf_base);
  all[3] = static_cast<std::uintptr_t>(random());
  all[4] = static_cast<std::uintptr_t>(lrand48());
  srandom(seed);
  srand48(seed);
  return all;
}

void flush() {
  std::cout.flush();
  std::cerr.flush();
  std::fflush(nullptr);
}

}  // namespace

ProcessTraces::ProcessTraces()
    : printed_(memfd_create("printed", MFD_CLOEXEC)), output_{dup(STDOUT_FILENO), dup(STDERR_FILENO)} {
  flush();
  dup2(printed_, STDOUT_FILENO);
  dup2(printed_, STDERR_FILENO);
  threads_ = count_threads();
  name_ = process_name();
  descriptors_ = open_descriptors();
  of_the_c_library();  // seeds
  c_library_ = of_the_c_library();
}

ProcessTraces::~ProcessTraces() {
  flush();
  dup2(output_[0], STDOUT_FILENO);
  dup2(output_[1], STDERR_FILENO);
  for (const int descriptor : {printed_, output_[0], output_[1]}) close(descriptor);
}

std::vector<std::string> ProcessTraces::found() const {
  std::vector<std::string> found;
  for (const std::string& changed : state_.restore()) found.push_back("changes " + changed);
  // A thread that has been joined may still be seen for a moment.
  for (int i = 0; i < 1000 && count_threads() != threads_; ++i) usleep(1000);
  if (count_threads() != threads_) found.emplace_back("starts a thread");
  if (has_children()) found.emplace_back("starts a process");
  if (has_timers()) found.emplace_back("starts a timer");
  const auto c_library = of_the_c_library();
  if (!std::equal(c_library.begin() + 3, c_library.end(), c_library_.begin() + 3))
    found.emplace_back("draws or seeds the C library's random numbers");
  if (process_name() != name_) found.emplace_back("renames the process");
  const auto descriptors = open_descriptors();
  for (const auto& [number, file] : descriptors) {
    const auto known = descriptors_.find(number);
    if (known == descriptors_.end()) found.push_back("leaves " + file + " open");
    if (known != descriptors_.end() && known->second != file)
      found.push_back("puts " + file + " in the place of " + known->second);
  }
  for (const auto& [number, file] : descriptors_) {
    if (!descriptors.contains(number)) found.push_back("closes " + file);
  }
  flush();
  char text[200] = "";
  if (const ssize_t size = pread(printed_, text, sizeof text, 0); size > 0) {
    std::replace(text, text + size, '\n', ' ');
    found.push_back("prints \"" + std::string(text, static_cast<std::size_t>(size)) + '"');
  } else if (!std::equal(c_library.begin(), c_library.begin() + 3, c_library_.begin())) {  // printing does so, too
    found.emplace_back("changes how standard streams are buffered");
  }
  return found;
}

}  // namespace rouleau::conform

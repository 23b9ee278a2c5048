#include "process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>

#include "error.hpp"

extern char** environ;

namespace rouleau {

namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const std::string& what, int error) {
  throw Error(Cause::input_output, what + ": " + std::strerror(error));
}

/// One end of a pipe.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return number_; }
  void set(int number) { number_ = number; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

 private:
  int number_;
};

struct Pipe {
  Descriptor from, to;
  Pipe() {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) fail("no pipe to another process could be made", errno);
    from.set(ends[0]);
    to.set(ends[1]);
  }
};

/// What the new process does until it becomes the program: only calls that are allowed after fork. Returns when one of
/// them failed.
void become(const char* program, char* const* words, int finding, int output, pid_t parent) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) raise(SIGKILL);  // the parent died before it could be watched
  const int input = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (input < 0 || dup2(input, STDIN_FILENO) < 0 || dup2(output, STDOUT_FILENO) < 0 ||
      dup2(output, STDERR_FILENO) < 0 || dup2(finding, finding_descriptor) < 0 ||
      fcntl(finding_descriptor, F_SETFD, 0) < 0)
    return;
  execve(program, words, environ);
}

pid_t start(const std::filesystem::path& program, const std::vector<std::string>& arguments, int finding, int output) {
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  Pipe failure;  // closes when the program has begun
  const pid_t parent = getpid(), process = fork();
  if (process < 0) fail(program.string() + " could not be started", errno);
  if (process == 0) {
    // Not where the finding goes.
    const int told = fcntl(failure.to.get(), F_DUPFD_CLOEXEC, finding_descriptor + 1);
    become(program.c_str(), pointers.data(), finding, output, parent);
    const int error = errno;
    if (write(told, &error, sizeof error) < 0) _exit(126);
    _exit(127);
  }
  setpgid(process, process);  // whoever of the two comes first
  failure.to.close();
  int error = 0;
  ssize_t size = 0;
  do {
    size = read(failure.from.get(), &error, sizeof error);
  } while (size < 0 && errno == EINTR);
  if (size == static_cast<ssize_t>(sizeof error)) {
    waitpid(process, nullptr, 0);
    fail(program.string() + " could not be started", error);
  }
  return process;
}

/// Reads what is there, and keeps at most `largest` bytes; false at the end of the pipe.
bool read_some(int descriptor, std::string& text, std::size_t largest) {
  std::array<char, 4096> buffer{};
  const ssize_t size = read(descriptor, buffer.data(), buffer.size());
  if (size <= 0) return size < 0 && errno == EINTR;
  text.append(buffer.data(), std::min(static_cast<std::size_t>(size), largest - std::min(largest, text.size())));
  return true;
}

}  // namespace

ProcessEnd run_process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                       const ProcessLimits& limits) {
  Pipe finding, output;
  const auto begin = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
  const pid_t process = start(program, arguments, finding.to.get(), output.to.get());
  finding.to.close();
  output.to.close();

  ProcessEnd end;
  // The finding's pipe closes when the process ends: nothing that the plugin starts gets this descriptor for good.
  bool open = true, talks = true;
  int status = 0;
  rusage usage{};
  double kill_at = std::numeric_limits<double>::infinity();
  while (true) {
    std::array<pollfd, 2> ends = {pollfd{open ? finding.from.get() : -1, POLLIN, 0},
                                  pollfd{talks ? output.from.get() : -1, POLLIN, 0}};
    constexpr int tick_ms = 20;
    poll(ends.data(), ends.size(), open || talks ? tick_ms : 1);
    if (ends[0].revents != 0) open = read_some(finding.from.get(), end.finding, 1 << 16);
    if (ends[1].revents != 0) talks = read_some(output.from.get(), end.output, limits.largest_output);
    if (wait4(process, &status, WNOHANG, &usage) == process) break;
    if (std::isinf(kill_at)) {
      end.timed_out = elapsed() > limits.time_s;
      end.stopped = limits.stop != nullptr && *limits.stop;
      if (!end.timed_out && !end.stopped) continue;
      if (limits.grace_s > 0) kill(-process, SIGTERM);
      kill_at = elapsed() + limits.grace_s;
    }
    if (elapsed() < kill_at) continue;
    kill(-process, SIGKILL);
    wait4(process, &status, 0, &usage);
    break;
  }
  kill(-process, SIGKILL);  // what it started and left behind
  fcntl(finding.from.get(), F_SETFL, O_NONBLOCK);
  fcntl(output.from.get(), F_SETFL, O_NONBLOCK);
  while (open && read_some(finding.from.get(), end.finding, 1 << 16)) {
  }
  while (talks && read_some(output.from.get(), end.output, limits.largest_output)) {
  }
  end.wall_s = elapsed();
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  end.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  end.peak_rss_bytes = usage.ru_maxrss * 1024;
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  return end;
}

double available_memory() {
  constexpr double unknown = std::numeric_limits<double>::infinity();
  double left = unknown;
  std::ifstream system("/proc/meminfo");
  double free = 0;
  for (std::string name; system >> name;) {
    double kilobytes = 0;
    if (name != "MemAvailable:" && name != "SwapFree:") continue;
    if (system >> kilobytes) left = free += kilobytes * 1024;
  }
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    double pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    left = std::min(left, static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGESIZE)));
  }
  double most = 0, used = 0;  // of a container; on the machine itself there is no such file, or it says "max"
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> most && std::ifstream("/sys/fs/cgroup/memory.current") >> used)
    left = std::min(left, most - used);
  return left;
}

void adopt_orphans() { prctl(PR_SET_CHILD_SUBREAPER, 1); }

std::vector<std::string> end_children() {
  std::vector<std::string> names;
  siginfo_t any{};
  // Those of a child that ends become this process's own.
  while (waitid(P_ALL, 0, &any, WEXITED | WNOHANG | WNOWAIT) == 0) {
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      if (std::isdigit(static_cast<unsigned char>(entry.path().filename().string().front())) == 0) continue;
      // "PID (NAME) STATE PARENT ...", and the name may hold anything.
      std::ifstream file(entry.path() / "stat");
      const std::string text{std::istreambuf_iterator<char>(file), {}};
      const auto open = text.find('('), close = text.rfind(')');
      if (open == std::string::npos || close == std::string::npos) continue;
      pid_t parent = 0;
      char state = 0;
      std::istringstream(text.substr(close + 1)) >> state >> parent;
      if (parent != getpid()) continue;
      const pid_t child = static_cast<pid_t>(std::stol(text));
      names.push_back(text.substr(open + 1, close - open - 1));
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
    }
  }
  return names;
}

}  // namespace rouleau

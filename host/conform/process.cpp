#include "process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include "error.hpp"
#include "report_line.hpp"

extern char** environ;

namespace rouleau::host {

namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const std::string& what, int error) {
  throw Error(ExitCode::input_output, what + ": " + std::strerror(error));
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

pid_t start(const std::filesystem::path& program, const std::vector<std::string>& arguments, int finding, int output) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&files, finding, finding_descriptor);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);

  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t process = 0;
  const int error = posix_spawn(&process, program.c_str(), &files, &attributes, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) fail(program.string() + " could not be started", error);
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
                       double time_limit_s) {
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
  while (true) {
    std::array<pollfd, 2> ends = {pollfd{open ? finding.from.get() : -1, POLLIN, 0},
                                  pollfd{talks ? output.from.get() : -1, POLLIN, 0}};
    constexpr int tick_ms = 20;
    poll(ends.data(), ends.size(), open || talks ? tick_ms : 1);
    if (ends[0].revents != 0) open = read_some(finding.from.get(), end.finding, 1 << 16);
    if (ends[1].revents != 0) talks = read_some(output.from.get(), end.output, 4096);
    if (waitpid(process, &status, WNOHANG) == process) break;
    if (elapsed() > time_limit_s) {
      end.timed_out = true;
      kill(-process, SIGKILL);
      waitpid(process, &status, 0);
      break;
    }
  }
  kill(-process, SIGKILL);  // what it started and left behind
  fcntl(finding.from.get(), F_SETFL, O_NONBLOCK);
  fcntl(output.from.get(), F_SETFL, O_NONBLOCK);
  while (open && read_some(finding.from.get(), end.finding, 1 << 16)) {
  }
  while (talks && read_some(output.from.get(), end.output, 4096)) {
  }
  end.wall_s = elapsed();
  if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
  return end;
}

}  // namespace rouleau::host

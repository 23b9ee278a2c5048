#include "video.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "files/file.hpp"

extern char** environ;

namespace rouleau::report {

namespace {

/// Its standard input, and the file that holds what it says.
struct Ffmpeg {
  pid_t process = 0;
  int input = -1;
};

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// False when there is none.
bool start(Ffmpeg& ffmpeg, std::vector<std::string> words, int output) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw Error(Cause::input_output, std::string("no pipe to ffmpeg could be made: ") + std::strerror(errno));
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDERR_FILENO);
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const int error = posix_spawnp(&ffmpeg.process, "ffmpeg", &files, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  ::close(ends[0]);
  ffmpeg.input = ends[1];
  if (error == 0) return true;
  ::close(ends[1]);
  if (error == ENOENT) return false;
  throw Error(Cause::input_output, std::string("ffmpeg could not be started: ") + std::strerror(error));
}

std::string words_of(std::FILE* output) {
  std::array<char, 2000> text{};
  std::rewind(output);
  return {text.data(), std::fread(text.data(), 1, text.size(), output)};
}

/// To the disk, and under its name.
void keep(const std::filesystem::path& partial, const std::filesystem::path& file) {
  const int descriptor = ::open(partial.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synchronised = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!synchronised) fail_file(file, "cannot be written", error);
  if (::rename(partial.c_str(), file.c_str()) != 0) fail_file(file, "cannot be written", errno);
}

}  // namespace

bool write_video(const std::filesystem::path& file, const std::array<int, 2>& size, int frames_per_second,
                 const std::function<std::optional<std::string>()>& next) {
  const auto partial =
      file.parent_path() / ("." + file.filename().string() + "." + std::to_string(::getpid()) + ".partial");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> output(std::tmpfile(), std::fclose);
  if (!output) throw Error(Cause::input_output, std::string("no temporary file: ") + std::strerror(errno));
  Ffmpeg ffmpeg;
  // The players of browsers and slides want 4:2:0 colours, and the table of contents at the beginning.
  if (!start(ffmpeg,
             {"ffmpeg",
              "-nostdin",
              "-v",
              "error",
              "-y",
              "-f",
              "rawvideo",
              "-pixel_format",
              "bgr0",
              "-video_size",
              std::to_string(size[0]) + "x" + std::to_string(size[1]),
              "-framerate",
              std::to_string(frames_per_second),
              "-i",
              "-",
              "-c:v",
              "libx264",
              "-pix_fmt",
              "yuv420p",
              "-movflags",
              "+faststart",
              "-f",
              "mp4",
              partial.string()},
             ::fileno(output.get())))
    return false;
  ::signal(SIGPIPE, SIG_IGN);  // an ffmpeg that ends early says why itself
  while (const auto picture = next())
    if (!write_all(ffmpeg.input, *picture)) break;
  ::close(ffmpeg.input);
  int status = 0;
  while (::waitpid(ffmpeg.process, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0) {
    ::unlink(partial.c_str());
    throw Error(Cause::input_output, Place{file.string()},
                "no video: ffmpeg failed and says\n  " + words_of(output.get()));
  }
  keep(partial, file);
  return true;
}

}  // namespace rouleau::report

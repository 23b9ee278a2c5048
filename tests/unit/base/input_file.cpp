// What is read: regular files of a size that is said, and nothing that is waited for.
#include "base/input_file.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>

#include "base/error.hpp"
#include "scratch_folder.hpp"

using namespace rouleau;
using Catch::Matchers::Contains;

TEST_CASE("pipes, devices and folders are refused at once, and so is more than the most that is read") {
  const test::ScratchFolder folder;
  const auto refused = [](const std::filesystem::path& file, std::uintmax_t largest) {
    try {
      (void)read_input(file, largest);
    } catch (const Error& error) {
      CHECK(error.place().file == file.string());
      return std::pair(error.cause(), std::string(error.what()));
    }
    return std::pair(Cause::bad_input, std::string("was read"));
  };
  const auto pipe = folder.path() / "pipe", sparse = folder.path() / "sparse";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  const auto [cause, words] = refused(pipe, any_size);
  CHECK(cause == Cause::input_output);
  CHECK_THAT(words, Contains("it is a pipe") && Contains("plain file"));
  CHECK_THAT(refused("/dev/zero", any_size).second, Contains("it is a device"));
  CHECK_THAT(refused(folder.path(), any_size).second, Contains("it is a directory"));
  CHECK_THAT(refused(folder.path() / "none", any_size).second, Contains("No such file") && Contains("check the path"));
  folder.write("four-cells.json", "{}");
  CHECK_THAT(refused(folder.path() / "fuor-cells.json", any_size).second,
             Contains("No such file or directory; did you mean \"four-cells.json\"?"));
  CHECK_THAT(refused(folder.path() / "four-cells", any_size).second, Contains("did you mean \"four-cells.json\"?"));
  std::filesystem::create_directory(folder.path() / "scenes");
  CHECK_THAT(refused(folder.path() / "scene/demo/a.json", any_size).second, Contains("did you mean \"scenes\"?"));
  CHECK_THAT(refused(folder.path() / "zzz.txt", any_size).second, !Contains("did you mean"));
  folder.write("sparse", "x");
  std::filesystem::resize_file(sparse, std::uintmax_t{20} << 30U);
  CHECK(refused(sparse, largest_input).first == Cause::bad_input);
  CHECK_THAT(refused(sparse, largest_input).second, Contains("more than 256 MiB"));
  std::filesystem::create_symlink("/dev/zero", folder.path() / "link");
  CHECK_THAT(refused(folder.path() / "link", any_size).second, Contains("it is a device"));
}

TEST_CASE("a regular file is read as a whole or in part, through links too") {
  const test::ScratchFolder folder;
  std::string text;
  for (int i = 0; i < 40000; ++i) text += std::to_string(i);
  const auto file = folder.write("file", text);
  std::filesystem::create_symlink("file", folder.path() / "link");
  CHECK(read_input(folder.path() / "link", text.size()) == text);
  CHECK_THROWS_AS(read_input(file, text.size() - 1), Error);
  std::string part(5, ' ');
  CHECK(InputFile(file).read(part.data(), 5, text.size() - 3) == 3);
  CHECK(part.substr(0, 3) == text.substr(text.size() - 3));
}

#include <sys/resource.h>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <functional>

#include "files/file.hpp"
#include "json/document.hpp"
#include "unit/run_fixture.hpp"

using namespace rouleau;
using namespace rouleau::files;
using namespace rouleau::json;
using namespace rouleau::scene;
using namespace rouleau::test;
using Catch::Contains;
using Catch::EndsWith;

namespace {

int files_in(const std::filesystem::path& folder) {
  return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

/// Error's message, and a check of its code.
std::string input_output_error(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::input_output);
    return error.what();
  }
  return "";
}

/// Runs `action` in a child that may write files of `bytes` at most: stands for a full disk, which root has none of.
/// Returns the child's exit code: 0 when action threw Error(input_output) naming the trouble, and nothing crashed
/// after.
int with_file_limit(rlim_t bytes, const std::function<void()>& action) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    int code = 1;
    try {
      action();
    } catch (const Error& error) {
      code =
          error.cause() == Cause::input_output && std::string(error.what()).find("File too large") != std::string::npos
              ? 0
              : 2;
    } catch (...) {
      code = 3;
    }
    std::exit(code);  // with its handlers: HDF5's must not crash on a file that could not be closed
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

TEST_CASE("write_file replaces a file whole and leaves nothing else behind") {
  const ScratchFolder folder;
  const auto file = folder.path() / "summary.json";
  write_file(file, "old");
  write_file(file, std::string(100000, 'n'));
  CHECK(read_text(file) == std::string(100000, 'n'));
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("a write that fails leaves the old file as it was") {
  const ScratchFolder folder;
  const auto file = folder.path() / "summary.json";
  write_file(file, "old");
  CHECK(with_file_limit(1000, [&] { write_file(file, std::string(5000, 'n')); }) == 0);
  CHECK(read_text(file) == "old");
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("a path through a file is refused with the path, the system's words and a remedy") {
  const ScratchFolder folder;
  write_file(folder.path() / "file", "");
  const auto message = input_output_error([&] { write_file(folder.path() / "file/summary.json", "{}"); });
  CHECK_THAT(message,
             Contains("file/summary.json") && Contains("Not a directory") && Contains("every part of the path"));
  const Scene scene = small_scene();
  CHECK_THAT(input_output_error([&] { const RunDirectory run(folder.path() / "file/run", scene); }),
             Contains("file/run") && Contains("Not a directory"));
}

TEST_CASE("a device is never replaced by a file") {
  const auto message = input_output_error([] { write_file("/dev/full", "x"); });
  CHECK_THAT(message, Contains("/dev/full") && Contains("no regular file"));
  CHECK(std::filesystem::is_character_file("/dev/full"));
}

TEST_CASE("a full disk is an error that says so, at the latest when the file is closed") {
  const auto message = input_output_error([] {
    AppendFile file("/dev/full");
    file.write("step\n");
    file.close();
  });
  CHECK_THAT(message,
             Contains("/dev/full") && Contains("No space left on device") && Contains("write to another disk"));
}

TEST_CASE("a disk that fills up during a run ends it with an error and no crash") {
  const ScratchFolder folder;
  const Scene scene = small_scene();
  for (const rlim_t bytes : {10, 3000, 40000}) {
    INFO("limit " << bytes);
    const auto directory = folder.path() / std::to_string(bytes);
    CHECK(with_file_limit(bytes, [&] {
            RunDirectory run(directory, scene);
            for (long step = 0; step < 1000; ++step) run.write(small_snapshot(step, true));
            run.finish(to_json(small_summary()));
          }) == 0);
  }
}

TEST_CASE("a run's outputs replace a former run's when they are told to, a checkpoint too") {
  const ScratchFolder folder;
  const auto directory = folder.path() / "a/run";
  const Scene scene = small_scene();
  for (int i = 0; i < 2; ++i) {
    RunDirectory run(directory, scene, FormerRun::replace);
    run.log("started");
    run.write(small_snapshot(0));
    run.finish(to_json(small_summary()));
    if (i == 0) write_file(directory / "checkpoint.h5", "of the former run");
  }
  CHECK_FALSE(std::filesystem::exists(directory / "checkpoint.h5"));
  const std::string log = read_text(directory / "log.jsonl");
  CHECK(std::count(log.begin(), log.end(), '\n') == 1);
}

TEST_CASE("a directory with a file that no run wrote is refused and left alone") {
  const ScratchFolder folder;
  write_file(folder.path() / "thesis.tex", "years of work");
  write_file(folder.path() / "cells.csv", "mine");
  const Scene scene = small_scene();
  CHECK_THROWS_WITH(RunDirectory(folder.path(), scene), Contains("thesis.tex") && Contains("choose another directory"));
  CHECK(read_text(folder.path() / "cells.csv") == "mine");
}

TEST_CASE("a second run in the same directory is refused while the first one writes") {
  const ScratchFolder folder;
  const Scene scene = small_scene();
  RunDirectory first(folder.path(), scene);
  first.write(small_snapshot(0));
  CHECK_THROWS_WITH(RunDirectory(folder.path(), scene), Contains("another run"));
  first.finish(to_json(small_summary()));
  CHECK(std::filesystem::exists(folder.path() / "frames.xmf"));
  CHECK_NOTHROW(RunDirectory(folder.path(), scene, FormerRun::replace));
}

TEST_CASE("a former run is kept unless it is to be replaced, one that was killed too") {
  const ScratchFolder folder;
  const Scene scene = small_scene();
  const bool killed = GENERATE(false, true);
  {
    RunDirectory run(folder.path(), scene);
    run.log("started");
    run.write(small_snapshot(0));
    if (!killed) run.finish(to_json(small_summary()));
  }
  const std::string rows = read_text(folder.path() / "cells.csv"), log = read_text(folder.path() / "log.jsonl");
  try {
    const RunDirectory run(folder.path(), scene);
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    CHECK_THAT(error.what(), Contains(folder.path().string()) && Contains("go on with that run, or replace it"));
    CHECK(error.remedy().ways == std::vector{rouleau::Way::elsewhere, rouleau::Way::resume, rouleau::Way::anew});
  }
  CHECK(read_text(folder.path() / "cells.csv") == rows);
  CHECK(read_text(folder.path() / "log.jsonl") == log);
}

TEST_CASE("a run that named no directory gets the first that is free") {
  const ScratchFolder folder;
  const auto wanted = folder.path() / "runs/a.b";
  CHECK(unused_directory(wanted) == wanted);
  CHECK(unused_directory(wanted) == wanted);  // empty still
  write_file(wanted / "summary.json", "{}");
  CHECK(unused_directory(wanted) == folder.path() / "runs/a.b-2");
  write_file(folder.path() / "runs/a.b-2/notes.txt", "");
  write_file(folder.path() / "runs/a.b-3", "");
  CHECK(unused_directory(wanted) == folder.path() / "runs/a.b-4");
  CHECK_THAT(input_output_error([&] { unused_directory(wanted / "summary.json" / "run"); }), Contains("summary.json"));
}

TEST_CASE("an output path that is a file is called one") {
  const ScratchFolder folder;
  write_file(folder.path() / "file", "");
  const Scene scene = small_scene();
  CHECK_THAT(input_output_error([&] { const RunDirectory run(folder.path() / "file", scene); }),
             Contains("file\n  is a file and not a directory\n  choose another place"));
}

TEST_CASE("the log has one JSON object a line, there as soon as it is written, whatever bytes it is given") {
  const ScratchFolder folder;
  const Scene scene = small_scene();
  RunDirectory run(folder.path(), scene);
  run.log("started", {{"threads", 2}});
  run.log("odd", {{"loader", "bad byte \xff"}});
  run.log("plain", "text");
  run.log("stage_ended", {{"wall_s", 1e9}, {"steps", 5}});
  std::ifstream lines(folder.path() / "log.jsonl");
  std::string line;
  std::vector<nlohmann::json> events;
  while (std::getline(lines, line)) events.push_back(nlohmann::json::parse(line));
  REQUIRE(events.size() == 4);
  CHECK(events[0]["event"] == "started");
  CHECK(events[0]["threads"] == 2);
  CHECK(events[0]["wall_s"].get<double>() >= 0);
  CHECK(events[2]["details"] == "text");
  CHECK(events[3]["wall_s"].get<double>() < 1e6);  // when, on the log's clock
  CHECK(events[3]["stage_ended_wall_s"] == 1e9);
  CHECK(events[3]["steps"] == 5);
}

TEST_CASE("the run keeps the scene as used: the user's text, or with --set the values that held") {
  const ScratchFolder folder;
  const std::string text = "{ \"rouleau\": 1,\n   \"title\": \"as I wrote it\" }\n";
  Scene scene = small_scene();
  auto document = Document::parse(text, "scene.json");
  scene.document = std::make_shared<const Document>(document);
  { const RunDirectory run(folder.path(), scene); }
  CHECK(read_text(folder.path() / "scene.json") == text);
  document.set("/title=\"changed\"");
  scene.document = std::make_shared<const Document>(document);
  { const RunDirectory run(folder.path(), scene); }
  CHECK(nlohmann::json::parse(read_text(folder.path() / "scene.json"))["title"] == "changed");
}

TEST_CASE("a growing file goes back to a mark, and only if what came before is still there") {
  const ScratchFolder folder;
  const auto file = folder.path() / "table.csv";
  FileMark mark;
  {
    AppendFile table(file);
    table.clear();
    table.write("a,b\n");
    table.write("1,2\n");
    mark = table.mark();
    CHECK(mark.bytes == 8);
    table.write("3,4\n");
    table.close();
  }
  {
    AppendFile table(file);
    table.go_back(mark);
    table.write("5,6\n");
    const FileMark now = table.mark();
    CHECK(now.checksum == checksum_of(file).value());
  }
  CHECK(read_text(file) == "a,b\n1,2\n5,6\n");
  AppendFile table(file);
  write_into(file, "A");
  CHECK_THROWS_WITH(table.go_back(mark),
                    Contains("table.csv") && Contains("was changed since") && EndsWith("or begin anew"));
  CHECK(read_text(file) == "A,b\n1,2\n5,6\n");
  write_file(file, "a,b\n");
  AppendFile shorter(file);
  CHECK_THROWS_WITH(shorter.go_back(mark), Contains("4 bytes instead of 8"));
}

TEST_CASE("a last line that was never ended is dropped") {
  const ScratchFolder folder;
  const auto file = folder.path() / "log.jsonl";
  write_file(file, "{\"event\": \"started\"}\n{\"eve");
  AppendFile log(file);
  log.end_line();
  log.write("{}\n");
  log.close();
  CHECK(read_text(file) == "{\"event\": \"started\"}\n{}\n");
}

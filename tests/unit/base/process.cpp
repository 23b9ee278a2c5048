// Processes of the conformance checks: how they end is told, and nothing of them stays behind.
#include "base/process.hpp"

#include <signal.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "base/error.hpp"

namespace {

using namespace rouleau;

ProcessEnd shell(const std::string& script, double time_limit_s = 20) {
  return run_process("/bin/sh", {"-c", script}, time_limit_s);
}

}  // namespace

TEST_CASE("a process is told by its exit code, its finding and the beginning of what it printed") {
  const ProcessEnd end = shell("echo out; echo err >&2; echo found >&3; exit 7");
  CHECK(end.exit_code == 7);
  CHECK(end.signal == 0);
  CHECK_FALSE(end.timed_out);
  CHECK(end.finding == "found\n");
  CHECK(end.output == "out\nerr\n");
  CHECK(shell("yes | head -c 1000000").output.size() == 4096);
}

TEST_CASE("a process that a signal ended is told by the signal") {
  CHECK(shell("kill -SEGV $$").signal == SIGSEGV);
  CHECK(shell("kill -KILL $$").signal == SIGKILL);
}

TEST_CASE("at the time limit a process and all that it started are killed") {
  const ProcessEnd end = shell("sleep 1000 & echo $!; wait", 0.3);
  CHECK(end.timed_out);
  CHECK(end.wall_s < 5);
  const pid_t started = std::stoi(end.output);
  // Its parent is gone, too: it exists until the system has collected it.
  bool exists = true;
  for (int i = 0; i < 200 && exists; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    exists = kill(started, 0) == 0;
    // In a container nobody may collect the dead: a zombie is dead enough.
    if (exists && shell("grep -q '^State:.Z' /proc/" + std::to_string(started) + "/status").exit_code == 0) {
      exists = false;
    }
  }
  CHECK_FALSE(exists);
}

TEST_CASE("a process that leaves another one behind with its descriptors open does not keep us waiting") {
  const ProcessEnd end = shell("sleep 1000 & echo found >&3");
  CHECK(end.wall_s < 5);
  CHECK(end.finding == "found\n");
  CHECK_FALSE(end.timed_out);
}

TEST_CASE("a process that reads gets nothing") { CHECK(shell("cat; echo end").output == "end\n"); }

TEST_CASE("a program that is not there is trouble of input and output") {
  try {
    run_process("/nonexistent/program", {}, 1);
    FAIL("started");
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::input_output);
    CHECK(std::string(error.what()).find("/nonexistent/program could not be started: No such file") !=
          std::string::npos);
  }
}

TEST_CASE("what a process leaves behind in a session of its own is adopted and ended") {
  rouleau::adopt_orphans();
  // Two generations away, in another session and another process group, and deaf to what asks it to end.
  shell(
      "setsid sh -c 'trap \"\" TERM HUP; setsid sleep 1000.25 & setsid sleep 1000.25' & "
      "while [ $(ps -eo args | grep -c '^sleep 1000.25') -lt 2 ]; do sleep 0.02; done");
  const std::vector<std::string> names = rouleau::end_children();
  CHECK(std::count(names.begin(), names.end(), "sleep") == 2);
  CHECK(rouleau::end_children().empty());
}

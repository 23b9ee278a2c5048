// The ranks that a launcher has started for one run: how they begin, agree and end together.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "transport/connection.hpp"

namespace rouleau::command {

/// All processes of a run that ranks compute together. The first rank speaks for all of them: it alone prints, and
/// writes files. A rank that fails says why to the first one, and all end with its exit code.
class Crew {
 public:
  /// Null where this process was started alone, or what it does is nothing for ranks.
  [[nodiscard]] static Crew* present();
  /// Joins the other ranks, and waits for them. Where their processors differ, all take the instruction set that all
  /// have. Throws Error(bad_input); the last words of a rank alone, should all have the same, are those of the first.
  static void join(const transport::Launch& launch);

  [[nodiscard]] bool first() const { return connection_.rank() == 0; }
  [[nodiscard]] int ranks() const { return connection_.ranks(); }
  /// "rank 3 of 8 on node17".
  [[nodiscard]] std::string name() const;
  /// How so many ranks are started, before the program's name: "mpirun -n 8 ".
  [[nodiscard]] std::string start() const { return launch_.command + " -n " + std::to_string(ranks()) + ' '; }
  /// Name and version of the MPI.
  [[nodiscard]] std::string library() const { return connection_.library(); }
  [[nodiscard]] core::Transport& transport() { return connection_; }

  // All ranks call each of these, in the same order.

  /// Every rank does it, the first one before the others: what fails on all of them is reported once. Returns when all
  /// have done it.
  void in_turn(const std::function<void()>& body);
  /// The first rank's text, on all of them.
  std::string told(const std::string& text);
  /// Throws Error on the ranks where a value differs from the first one's, and returns only when none does.
  struct Fact {
    std::string what, value;
    Cause cause = Cause::bad_input;  ///< of the error where it differs
  };
  void require_same(const std::vector<Fact>& facts);

  /// This rank has failed, and all are to end with its exit code. `words`: for the first rank to show.
  void report(int exit_code, const std::string& words);
  /// The end of the process, by all ranks.
  void leave();

 private:
  explicit Crew(const transport::Launch& launch) : launch_(launch), connection_(launch) {}
  void agree_on_instruction_set();
  /// Every rank's text, on the first one.
  std::vector<std::string> gathered(const std::string& text);

  transport::Launch launch_;
  transport::Connection connection_;
  bool failed_ = false;
  int exit_code_ = 0;
  std::string last_words_;  ///< for the first rank to show
};

}  // namespace rouleau::command

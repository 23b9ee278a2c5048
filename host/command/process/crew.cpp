#include "crew.hpp"

#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <rouleau/dispatch.hpp>
#include <span>
#include <thread>

#include "core/domain/ranks.hpp"
#include "faults.hpp"
#include "json/json.hpp"
#include "terminal.hpp"

namespace rouleau::command {

namespace {

using Json = nlohmann::json;

Crew* joined = nullptr;

/// How long a rank that has failed waits for the others, who hear of it when they next wait for a message.
constexpr std::chrono::seconds patience(3);

core::Message message_of(const std::string& text) { return core::message_of(std::span<const char>(text)); }

std::string text_of(const core::Message& message) {
  const std::vector<char> letters = core::values_of<char>(message);
  return {letters.begin(), letters.end()};
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "an unknown machine";
}

}  // namespace

Crew* Crew::present() { return joined; }

void Crew::join(const transport::Launch& launch) {
  try {
    joined = new Crew(launch);  // for the life of the process: messages may be on their way when it ends
  } catch (const Error&) {
    // Where the first rank fails, too, the launcher ends the others (Open MPI's after a second), and there is one
    // message.
    if (launch.rank > 0) std::this_thread::sleep_for(patience);
    throw;
  }
  if (launch.rank > 0) {
    silence_terminal();
    speak_as(joined->name());
  }
  joined->agree_on_instruction_set();
}

std::string Crew::name() const {
  return "rank " + std::to_string(connection_.rank()) + " of " + std::to_string(ranks()) + " on " + host_name();
}

std::string Crew::told(const std::string& text) {
  if (!first()) return text_of(connection_.receive(0));
  for (int rank = 1; rank < ranks(); ++rank) connection_.send(rank, message_of(text));
  return text;
}

std::vector<std::string> Crew::gathered(const std::string& text) {
  if (!first()) {
    connection_.send(0, message_of(text));
    return {};
  }
  std::vector<std::string> all{text};
  for (int rank = 1; rank < ranks(); ++rank) all.push_back(text_of(connection_.receive(rank)));
  return all;
}

void Crew::in_turn(const std::function<void()>& body) {
  if (first()) body();
  told({});
  if (!first()) body();
  gathered({});
  told({});
}

void Crew::require_same(const std::vector<Fact>& facts) {
  Json mine = Json::array();
  for (const Fact& fact : facts) mine.push_back({fact.what, fact.value, name()});
  const Json firsts = Json::parse(told(mine.dump(-1, ' ', false, Json::error_handler_t::replace)));
  if (firsts.size() != mine.size())
    throw Error(Cause::bad_input, "another program than that of the first rank", {"install the same one everywhere"});
  for (std::size_t k = 0; k < facts.size(); ++k) {
    if (firsts[k][1] == facts[k].value) continue;
    throw Error(
        facts[k].cause,
        facts[k].what + " differs: " + facts[k].value + " here, " + firsts[k][1].get<std::string>() + " on " +
            firsts[k][2].get<std::string>(),
        {"ranks come to the same results only with the same program, plugins and C library, and the same scene"});
  }
  gathered({});
  told({});
}

void Crew::agree_on_instruction_set() {
  const InstructionSet mine = instruction_set();
  const std::vector<std::string> all = gathered(Json{static_cast<int>(mine), name()}.dump());
  std::string least;
  if (first()) {
    InstructionSet set = mine;
    std::string of;
    bool differ = false;
    for (const std::string& text : all) {
      const Json entry = Json::parse(text);
      const auto other = static_cast<InstructionSet>(entry[0].get<int>());
      differ = differ || other != mine;
      if (other < set) set = other, of = entry[1];
    }
    least = name_of(set);
    if (differ) {
      std::cerr << "warning: processors differ; all ranks compute with " << least << ", which is all that "
                << (of.empty() ? name() : of) << " has" << std::endl;
    }
  }
  least = told(least);
  if (least != name_of(mine)) ::setenv("ROULEAU_INSTRUCTION_SET", least.c_str(), 1);
}

void Crew::report(int exit_code, const std::string& words) {
  failed_ = true;
  exit_code_ = exit_code;
  last_words_ = words;
  connection_.say_farewell(exit_code, words);
}

void Crew::leave() {
  if (failed_) {
    std::thread([this] {
      std::this_thread::sleep_for(patience);
      if (!last_words_.empty() && ::write(STDERR_FILENO, (last_words_ + '\n').data(), last_words_.size() + 1) < 0)
        return;
      connection_.give_up(exit_code_);
    }).detach();
  }
  connection_.finish();
}

}  // namespace rouleau::command

#include "verify.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/error.hpp"
#include "file.hpp"
#include "frames.hpp"

namespace rouleau::files {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::string_view before_own_checksum = "\"summary_xxh3\": \"", no_checksum = "0000000000000000";

std::string checksum_of_text(std::string_view text) {
  Checksum checksum;
  checksum.update(text);
  return checksum_text(checksum.value());
}

/// Puts these digits where a summary's own checksum stands, and returns what stood there; empty: it has none.
std::string exchange_own_checksum(std::string& text, std::string_view digits) {
  const std::size_t at = text.rfind(before_own_checksum);
  if (at == std::string::npos || text.size() < at + before_own_checksum.size() + digits.size()) return {};
  const std::size_t first = at + before_own_checksum.size();
  std::string found = text.substr(first, digits.size());
  text.replace(first, digits.size(), digits);
  return found;
}

/// What is wrong with a file; empty: nothing.
std::string difference(const fs::path& file, const Json& record) {
  const std::string name = file.filename().string();
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (error) return name + " is not there";
  const auto expected = record.at("bytes").get<std::uintmax_t>();
  if (bytes != expected)
    return name + " has " + std::to_string(bytes) + " bytes instead of " + std::to_string(expected);
  const std::string found = checksum_text(checksum_of(file).value()), written = record.at("xxh3");
  return found == written ? "" : name + " was changed: its checksum is " + found + " instead of " + written;
}

}  // namespace

std::string sealed_summary(Json summary, const fs::path& directory, const std::vector<std::string>& names) {
  Json& files = summary["files"] = Json::object();
  for (const std::string& name : names) {
    const fs::path file = directory / name;
    files[name] = {{"bytes", fs::file_size(file)}, {"xxh3", checksum_text(checksum_of(file).value())}};
  }
  summary["summary_xxh3"] = no_checksum;
  std::string text = summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  exchange_own_checksum(text, checksum_of_text(text));
  return text;
}

void amend_summary(const fs::path& directory, const Json& sections) {
  const fs::path file = directory / "summary.json";
  std::string text = read_text(file);
  const std::string written = exchange_own_checksum(text, no_checksum);
  Json summary = Json::parse(text, nullptr, false);
  if (!summary.is_object() || written != checksum_of_text(text)) {
    throw Error(Cause::bad_input, Place{file.string()},
                "was changed since the run wrote it, so that nothing is added to it", {"replace the run", {Way::anew}});
  }
  summary.update(sections);
  text = summary.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  exchange_own_checksum(text, checksum_of_text(text));
  write_file(file, text);
}

Verification verify(const fs::path& directory, const std::function<bool(const std::string& name)>& wanted) {
  const fs::path file = directory / "summary.json";
  const auto refuse = [&](const std::string& problem) { throw Error(Cause::bad_input, Place{file.string()}, problem); };
  std::error_code ignored;
  if (!fs::exists(file, ignored)) refuse("is not there: no run has ended in this directory");
  std::string text = read_text(file);
  Verification result{1, {}};
  const std::string written = exchange_own_checksum(text, no_checksum), found = checksum_of_text(text);
  const Json summary = Json::parse(text, nullptr, false);
  if (!summary.is_object()) {
    result.differences.emplace_back("summary.json is damaged: it is no JSON any more");
    return result;
  }
  if (written.empty() || !summary.contains("files"))
    refuse("has no checksums: it was written by a version before 0.2, or they were taken out");
  if (found != written)
    result.differences.push_back("summary.json was changed: its checksum is " + found + " instead of " + written);
  for (const auto& [name, record] : summary.at("files").items()) {
    if (wanted && !wanted(name)) continue;
    ++result.files;
    try {
      const std::string wrong = difference(directory / fs::path(name).filename(), record);
      if (!wrong.empty()) result.differences.push_back(wrong);
    } catch (const Json::exception&) {
      result.differences.push_back("summary.json has no bytes and checksum of " + name);
    }
  }
  return result;
}

std::optional<std::string> find_no_number_in_frames(const std::filesystem::path& frames) {
  const hdf5::File file = open_frames(frames);
  for (const std::string& frame : file.names("/frames")) {
    for (const char* part : {"/membranes", "/fields"}) {
      const std::string group = "/frames/" + frame + part;
      if (!file.has(group)) continue;
      for (const std::string& name : file.names(group)) {
        const std::vector<double> values = file.read(group + '/' + name);
        if (std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); })) continue;
        return group + '/' + name + " of " + frames.filename().string() + " holds a value that is no number";
      }
    }
  }
  return std::nullopt;
}

}  // namespace rouleau::files

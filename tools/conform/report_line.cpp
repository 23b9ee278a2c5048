#include "report_line.hpp"
#include "base/process.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>

namespace rouleau::conform {

namespace {

using Json = nlohmann::json;

Verdict verdict_named(const std::string& name) {
  for (const Verdict verdict :
       {Verdict::pass, Verdict::warn, Verdict::fail, Verdict::crash, Verdict::timeout, Verdict::skip}) {
    if (name == to_string(verdict)) return verdict;
  }
  throw std::invalid_argument("no verdict is called " + name);
}

void write_all(const char* text, std::size_t size) {
  while (size > 0) {
    const ssize_t written = write(finding_descriptor, text, size);
    if (written <= 0) return;  // the parent is gone
    text += written;
    size -= static_cast<std::size_t>(written);
  }
}

}  // namespace

Json to_json(const Finding& finding) {
  Json entry = {{"verdict", to_string(finding.verdict)}, {"what", finding.what}};
  // JSON has no word for numbers that are none; as text they survive.
  const auto add = [&](const char* key, const std::optional<double>& value) {
    if (value) entry[key] = std::isfinite(*value) ? Json(*value) : Json(std::to_string(*value));
  };
  add("measured", finding.measured);
  add("limit", finding.limit);
  return entry;
}

Finding finding_from(const Json& entry) {
  Finding finding{verdict_named(entry.at("verdict")), entry.at("what"), {}, {}};
  const auto read = [&](const char* key) -> std::optional<double> {
    if (!entry.contains(key)) return {};
    const Json& value = entry[key];
    return value.is_string() ? std::stod(value.get<std::string>()) : value.get<double>();
  };
  finding.measured = read("measured");
  finding.limit = read("limit");
  return finding;
}

void send(const Finding& finding) {
  send(to_json(finding).dump(-1, ' ', false, Json::error_handler_t::replace) + '\n');
}

void send(const std::string& text) { write_all(text.data(), text.size()); }

void send_from_signal(const char* verdict, const char* text) {
  char line[1024];
  const int size = std::snprintf(line, sizeof line, "{\"verdict\":\"%s\",\"what\":\"%s\"}\n", verdict, text);
  write_all(line, static_cast<std::size_t>(size));
}

}  // namespace rouleau::conform

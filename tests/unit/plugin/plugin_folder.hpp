// A folder of plugins that lives as long as a test, and the errors that the host makes of it.
#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <functional>
#include <string>

#include "base/error.hpp"
#include "json/json.hpp"
#include "scratch_folder.hpp"

namespace rouleau::test {

class PluginFolder : public rouleau::test::ScratchFolder {
 public:
  using ScratchFolder::write;
  std::filesystem::path write(const std::filesystem::path& name, const nlohmann::json& document) const {
    return write(name, document.dump(2));
  }
  std::filesystem::path copy(const std::filesystem::path& file, const std::filesystem::path& name) const {
    std::filesystem::create_directories((path() / name).parent_path());
    std::filesystem::copy_file(file, path() / name);
    return path() / name;
  }
};

/// A manifest without a fault.
inline nlohmann::json good_manifest() {
  return nlohmann::json::parse(R"({
    "manifest": 1, "abi": 1, "kind": "interaction", "id": "good", "version": "1.0.0", "library": "libgood.so",
    "title": "A potential", "license": "MIT",
    "parameters": [
      { "name": "depth", "unit": "uJ/m2", "minimum": 0, "maximum": 100, "usual": [0.001, 10], "doc": "How deep." },
      { "name": "decay", "unit": "1/um", "default": 3.84, "exclusiveMinimum": 0 },
      { "name": "temperature", "unit": "K", "default": 310 },
      { "name": "form", "choices": ["sharp", "smooth"], "default": "smooth" }
    ],
    "needs": ["distance"], "gives": ["energy", "force"], "inactive_when": { "depth": 0 }
  })");
}

/// The error that `action` must throw.
inline Error thrown_by(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error;
  }
  FAIL("no error was thrown");
  throw std::logic_error("not reached");
}

}  // namespace rouleau::test

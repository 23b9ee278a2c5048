// A folder of plugins that lives as long as a test, and the errors that the host makes of it.
#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "error.hpp"

namespace rouleau::host::test {

class PluginFolder {
 public:
  PluginFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "rouleau-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~PluginFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  PluginFolder(const PluginFolder&) = delete;
  PluginFolder& operator=(const PluginFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(const std::filesystem::path& name, const std::string& text) const {
    const auto file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
    return file;
  }
  std::filesystem::path write(const std::filesystem::path& name, const nlohmann::json& document) const {
    return write(name, document.dump(2));
  }
  std::filesystem::path copy(const std::filesystem::path& file, const std::filesystem::path& name) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::filesystem::copy_file(file, path_ / name);
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
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

}  // namespace rouleau::host::test

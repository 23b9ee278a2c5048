#include "trust.hpp"

#include <algorithm>

namespace rouleau::plugin {

namespace {

namespace fs = std::filesystem;

fs::perms mode_of(const fs::path& path) {
  std::error_code error;
  const fs::perms mode = fs::status(path, error).permissions();
  return error || mode == fs::perms::unknown ? fs::perms::none : mode;
}

std::string octal(fs::perms mode) {
  auto bits = static_cast<unsigned>(mode & fs::perms::mask);
  std::string text(4, '0');
  for (auto digit = text.rbegin(); digit != text.rend(); ++digit, bits /= 8) *digit = static_cast<char>('0' + bits % 8);
  return text;
}

}  // namespace

fs::path open_to_others(const std::vector<fs::path>& paths) {
  const auto open = std::find_if(paths.begin(), paths.end(), [](const fs::path& path) {
    return !path.empty() && (mode_of(path) & fs::perms::others_write) != fs::perms::none;
  });
  return open == paths.end() ? fs::path() : *open;
}

std::string why_not_trusted(const fs::path& open) {
  std::error_code ignored;
  const bool folder = fs::is_directory(open, ignored);
  return std::string("every user of this machine may write to the ") + (folder ? "folder " : "file ") + open.string() +
         " (mode " + octal(mode_of(open)) +
         "), so anybody could have put code there; look at what is in it, then: " + "chmod o-w " + open.string();
}

fs::path true_folder(const fs::path& file) {
  std::error_code error;
  const fs::path canonical = fs::canonical(file, error);
  return error ? fs::path() : canonical.parent_path();
}

}  // namespace rouleau::plugin

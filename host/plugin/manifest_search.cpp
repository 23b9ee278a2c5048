#include "manifest_search.hpp"

#include <algorithm>
#include <set>

#include "base/error.hpp"
#include "trust.hpp"

namespace rouleau::plugin {

namespace {

namespace fs = std::filesystem;

class Search {
 public:
  FoundFiles found;

  void all_under(const fs::path& path) {
    searched_ = path;
    folders_ = 0;
    folder(path, {});
  }

 private:
  /// `open_above`: the first folder on the way here that every user may write to.
  void folder(const fs::path& path, const fs::path& open_above) {
    if (!is_new(path)) return;
    if (++folders_ > most_folders) {
      throw Error(Cause::bad_input, Place{searched_.string()},
                  "more than " + std::to_string(most_folders) +
                      " folders lie under this one, where plugins are looked for; name the folder that holds them");
    }
    const fs::path open = open_above.empty() ? open_to_others({path}) : open_above;
    std::vector<fs::path> files, folders;
    std::error_code error;
    for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error)) {
      std::error_code status_error;
      const fs::file_status status = entry->status(status_error);
      if (fs::is_directory(status)) {
        folders.push_back(entry->path());
      } else if (entry->path().extension() == ".json") {
        if (fs::is_regular_file(status))
          files.push_back(entry->path());
        else
          refuse(entry->path(), status_error ? status_error.message() : "not a regular file");
      } else if (entry->is_symlink() && status_error && status_error != std::errc::no_such_file_or_directory) {
        refuse(entry->path(), status_error.message());  // a link to a folder that cannot be followed
      }
    }
    if (error) refuse(path, error.message());
    std::sort(files.begin(), files.end());
    std::sort(folders.begin(), folders.end());
    for (const auto& file : files) {
      if (is_new(file)) found.files.push_back({file, open});
    }
    for (const auto& child : folders) folder(child, open);
  }

  bool is_new(const fs::path& path) {
    std::error_code error;
    const fs::path canonical = fs::canonical(path, error);
    if (error) {
      refuse(path, error.message());
      return false;
    }
    return seen_.insert(canonical).second;
  }

  void refuse(const fs::path& path, const std::string& reason) {
    found.unreadable.emplace_back(path, path.string() + "\n  cannot be read: " + reason);
  }

  static constexpr int most_folders = 10'000;
  fs::path searched_;
  int folders_ = 0;  ///< under it so far
  std::set<fs::path> seen_;
};

}  // namespace

FoundFiles find_json_files(const std::vector<fs::path>& folders) {
  Search search;
  for (const auto& folder : folders) search.all_under(folder);
  return std::move(search.found);
}

}  // namespace rouleau::plugin

// Runs a fuzz target on files and on the files of folders, without libFuzzer: a corpus as a test.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <vector>

#include "target.hpp"

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_in(const std::vector<fs::path>& places) {
  std::vector<fs::path> files;
  for (const auto& place : places) {
    if (!fs::is_directory(place)) {
      files.push_back(place);
      continue;
    }
    for (const auto& entry : fs::recursive_directory_iterator(place)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

int main(int count, char** words) {
  const auto files = files_in({words + 1, words + count});
  for (const auto& file : files) {
    std::cerr << "last file: " << file.string() << '\r';  // stays there when the target ends the process
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (stream.bad()) throw std::runtime_error(file.string() + " cannot be read");
    fuzz_target(bytes);
  }
  std::cerr << '\n';
  std::cout << files.size() << " files replayed\n";
  return files.empty() ? 1 : 0;
}

// Memory of a model's own that compute must leave alone: variables of its library, what it has allocated, thread-local
// storage, and the C library's variables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace rouleau::conform {

/// Made before a model's library is loaded; `watch` is called when its instances are made. Between freeze() and thaw()
/// writing to what came into being in the meantime ends the process, and describe() has the words for it.
class FrozenMemory {
 public:
  FrozenMemory();
  ~FrozenMemory();
  FrozenMemory(const FrozenMemory&) = delete;
  FrozenMemory& operator=(const FrozenMemory&) = delete;

  void watch();
  void freeze();
  /// What has changed that could not be frozen ("the thread-local variable x", ...); empty: nothing.
  std::string thaw();

  /// As GuardedArray::describe: "compute writes to the variable calls". For handlers of signals.
  static bool describe(const void* address, char* text, std::size_t size);

 private:
  struct Region {
    std::byte *begin, *end;
    int protection;
    std::string name;
  };
  struct Part {  // compared, for others may write to the same pages
    const std::byte* begin;
    std::size_t size;
    std::string name;
    bool of_c_library;  // which changes it itself where it allocates and locks
    std::vector<std::byte> copy;
  };
  struct Variable {
    const std::byte *begin, *end;
    std::string name;
  };
  static std::vector<Region> writable();
  [[nodiscard]] const Variable* variable_at(const std::byte* address) const;

  std::vector<Region> before_, frozen_;
  std::set<std::uintptr_t> objects_before_;  // where libraries were loaded
  std::vector<Part> compared_;
  std::vector<Variable> variables_;
  std::int64_t calls_of_the_library_ = 0;  // allocations and locks: these change the C library's variables
};

/// Allocates the thread-local variables of all libraries for this thread, which would happen when they are first used.
void touch_thread_local_storage();

}  // namespace rouleau::conform

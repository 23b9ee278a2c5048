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
  /// What has changed that could not be frozen ("a thread-local variable of ..."); empty: nothing.
  std::string thaw();

  /// As GuardedArray::describe: "compute writes to a variable of libmodel.so". For handlers of signals.
  static bool describe(const void* address, char* text, std::size_t size);

 private:
  struct Region {  // whole pages
    std::byte *begin, *end;
    const std::byte* base;  // where the library was loaded
    std::string name;
  };
  struct Part {  // compared, for others may write to the same pages
    const std::byte* begin;
    std::size_t size;
    std::string name;
    bool of_c_library;  // which changes it itself where it allocates
    std::vector<std::byte> copy;
  };

  std::set<std::uintptr_t> objects_before_;  // where libraries were loaded
  std::vector<Region> frozen_;
  std::vector<Part> compared_;
  std::int64_t allocations_ = 0;
};

/// Allocates the thread-local variables of all libraries for this thread, which would happen when they are first used.
void touch_thread_local_storage();

}  // namespace rouleau::conform

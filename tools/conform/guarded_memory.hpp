// Arrays between pages that nobody may touch, and the words for an access that hit one.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace rouleau::conform {

/// Memory of one array in pages of its own, with an inaccessible page on both sides. Not copyable; unmapped at the end.
class GuardedArray {
 public:
  enum class Flush { behind, before };  ///< which end of the array touches an inaccessible page

  /// `name`: what the message calls the array.
  GuardedArray(std::string name, std::size_t bytes, Flush flush);
  ~GuardedArray();
  GuardedArray(const GuardedArray&) = delete;
  GuardedArray& operator=(const GuardedArray&) = delete;

  [[nodiscard]] std::byte* data() { return data_; }
  void make_read_only();
  void make_unreadable();

  /// Says of an address which array was hit and how ("wrote to the input stretch", "reached 8 bytes behind ..."); null
  /// when it lies in none. Callable from a signal handler: writes into `text`, allocates nothing.
  static bool describe(const void* address, bool write, char* text, std::size_t size);

 private:
  std::string name_;
  std::byte* pages_;
  std::size_t mapped_, bytes_;
  std::byte* data_;
  const char* access_ = "";  ///< what is forbidden inside the array
};

}  // namespace rouleau::conform

// Numbers that take memory only where they are used.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "base/worker.hpp"

namespace rouleau::core {

/// Gives back to the system the pages that lie wholly within parts [begin, end) of `bytes` bytes from `first` on, and
/// keeps the others small, so that they can be given back one by one. What was there reads as zero, and takes memory
/// again once it is written to. What is beyond the last byte is left alone.
void release_pages(void* first, std::size_t bytes, std::span<const Range> parts, std::size_t bytes_of_element);

/// The same for parts of an array, counted in elements.
template <class V>
void release(std::vector<V>& values, std::span<const Range> parts) {
  release_pages(values.data(), values.size() * sizeof(V), parts, sizeof(V));
}

/// Zero bytes that take memory page by page, where one has been written to; std::bad_alloc if there are no addresses
/// left.
struct ReleasePages {
  std::size_t bytes = 0;
  void operator()(void* first) const;
};
std::unique_ptr<void, ReleasePages> take_pages(std::size_t bytes);

/// So many numbers, zero to begin with, in such pages.
template <class V>
class PagedArray {
 public:
  PagedArray() = default;
  explicit PagedArray(std::size_t count) : pages_(take_pages(count * sizeof(V))), count_(count) {}

  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] V* data() { return static_cast<V*>(pages_.get()); }
  [[nodiscard]] const V* data() const { return static_cast<const V*>(pages_.get()); }
  [[nodiscard]] V& operator[](std::size_t i) { return data()[i]; }
  [[nodiscard]] const V& operator[](std::size_t i) const { return data()[i]; }
  [[nodiscard]] V* begin() { return data(); }
  [[nodiscard]] V* end() { return data() + count_; }
  [[nodiscard]] const V* begin() const { return data(); }
  [[nodiscard]] const V* end() const { return data() + count_; }

 private:
  std::unique_ptr<void, ReleasePages> pages_;
  std::size_t count_ = 0;
};

template <class V>
void release(PagedArray<V>& values, std::span<const Range> parts) {
  release_pages(values.data(), values.size() * sizeof(V), parts, sizeof(V));
}

}  // namespace rouleau::core

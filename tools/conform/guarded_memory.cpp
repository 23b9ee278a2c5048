#include "guarded_memory.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <new>

namespace rouleau::conform {

namespace {

/// Every guarded array that exists; only ever changed by the one thread of a check.
std::vector<const GuardedArray*>& guarded_arrays() {
  static std::vector<const GuardedArray*> arrays;
  return arrays;
}

std::size_t page_size() { return static_cast<std::size_t>(sysconf(_SC_PAGESIZE)); }

}  // namespace

GuardedArray::GuardedArray(std::string name, std::size_t bytes, Flush flush) : name_(std::move(name)), bytes_(bytes) {
  const std::size_t page = page_size(), inner = std::max<std::size_t>(1, (bytes + page - 1) / page) * page;
  mapped_ = inner + 2 * page;
  void* pages = mmap(nullptr, mapped_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED) throw std::bad_alloc();
  pages_ = static_cast<std::byte*>(pages);
  mprotect(pages_, page, PROT_NONE);
  mprotect(pages_ + page + inner, page, PROT_NONE);
  data_ = pages_ + page + (flush == Flush::behind ? inner - bytes : 0);
  guarded_arrays().push_back(this);
}

GuardedArray::~GuardedArray() {
  std::erase(guarded_arrays(), this);
  munmap(pages_, mapped_);
}

void GuardedArray::make_read_only() {
  mprotect(pages_ + page_size(), mapped_ - 2 * page_size(), PROT_READ);
  access_ = "wrote to";
}

void GuardedArray::make_unreadable() {
  mprotect(pages_ + page_size(), mapped_ - 2 * page_size(), PROT_NONE);
  access_ = "touched";
}

bool GuardedArray::describe(const void* address, bool write, char* text, std::size_t size) {
  const auto* at = static_cast<const std::byte*>(address);
  for (const GuardedArray* array : guarded_arrays()) {
    if (at < array->pages_ || at >= array->pages_ + array->mapped_) continue;
    const char* verb = write ? "wrote" : "read";
    if (at < array->data_) {
      std::snprintf(text, size, "%s %td bytes before %s", verb, array->data_ - at, array->name_.c_str());
    } else if (at >= array->data_ + array->bytes_) {
      std::snprintf(text, size, "%s %td bytes behind the end of %s", verb, at - (array->data_ + array->bytes_),
                    array->name_.c_str());
    } else {
      std::snprintf(text, size, "%s %s", array->access_, array->name_.c_str());
    }
    return true;
  }
  return false;
}

}  // namespace rouleau::conform

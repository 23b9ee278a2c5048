#include "frozen_memory.hpp"

#include <dlfcn.h>
#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>

#include "counted_functions.hpp"

extern "C" void* __tls_get_addr(void* index);  // NOLINT(readability-identifier-naming): the C library's name

namespace rouleau::conform {

namespace {

const FrozenMemory* frozen_now = nullptr;

/// Where an object's variables for this thread lie; null: it has none.
std::byte* thread_local_of(const dl_phdr_info& info) {
  struct {
    unsigned long module, offset;
  } index{info.dlpi_tls_modid, 0};
  return info.dlpi_tls_modid == 0 ? nullptr : static_cast<std::byte*>(__tls_get_addr(&index));
}

/// Calls see(info) for each object that is loaded.
template <class See>
void for_each_object(See see) {
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* data) {
        (*static_cast<See*>(data))(*info);
        return 0;
      },
      &see);
}

std::int64_t allocations() {
  return process_counts == nullptr ? 0 : process_counts->allocations + process_counts->releases;
}

void protect(const std::byte* begin, const std::byte* end, int protection) {
  mprotect(const_cast<std::byte*>(begin), static_cast<std::size_t>(end - begin), protection);
}

}  // namespace

void touch_thread_local_storage() {
  for_each_object([](const dl_phdr_info& info) { thread_local_of(info); });
}

FrozenMemory::FrozenMemory() {
  for_each_object([&](const dl_phdr_info& info) { objects_before_.insert(info.dlpi_addr); });
  if (process_counts != nullptr) process_counts->from_pool = true;
}

FrozenMemory::~FrozenMemory() {
  if (frozen_now == this) thaw();
}

void FrozenMemory::watch() {
  touch_thread_local_storage();
  if (process_counts != nullptr) {
    process_counts->from_pool = false;
    frozen_.push_back({process_counts->pool, process_counts->pool_next, nullptr, {}});
  }
  Dl_info c_library{};
  dladdr(dlsym(RTLD_DEFAULT, "qsort"), &c_library);
  const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
  for_each_object([&](const dl_phdr_info& info) {
    const auto* base = reinterpret_cast<const std::byte*>(info.dlpi_addr);
    const bool is_c_library = base == c_library.dli_fbase;
    if (objects_before_.contains(info.dlpi_addr) && !is_c_library) return;
    const std::string file = std::filesystem::path(info.dlpi_name).filename();
    const std::byte* of_thread = thread_local_of(info);
    for (int i = 0; i < info.dlpi_phnum; ++i) {
      const auto& segment = info.dlpi_phdr[i];
      const std::uintptr_t begin = info.dlpi_addr + segment.p_vaddr, end = begin + segment.p_memsz;
      const bool writable = segment.p_type == PT_LOAD && (segment.p_flags & PF_W) != 0;
      if (writable && is_c_library) {
        compared_.push_back(
            {base + segment.p_vaddr, segment.p_memsz, "variables of the C library (rand, strtok?)", true, {}});
      } else if (writable) {
        frozen_.push_back({reinterpret_cast<std::byte*>(begin / page * page),
                           reinterpret_cast<std::byte*>((end + page - 1) / page * page), base, file});
      } else if (!is_c_library && segment.p_type == PT_TLS && of_thread != nullptr) {
        compared_.push_back({of_thread, segment.p_memsz, "a thread-local variable of " + file, false, {}});
      }
    }
  });
}

void FrozenMemory::freeze() {
  for (Part& part : compared_) part.copy.assign(part.begin, part.begin + part.size);
  allocations_ = allocations();
  frozen_now = this;
  for (const Region& region : frozen_) protect(region.begin, region.end, PROT_READ);
}

std::string FrozenMemory::thaw() {
  for (const Region& region : frozen_) protect(region.begin, region.end, PROT_READ | PROT_WRITE);
  frozen_now = nullptr;
  for (const Part& part : compared_) {
    if (std::memcmp(part.copy.data(), part.begin, part.size) == 0) continue;
    if (!part.of_c_library || allocations_ == allocations()) return part.name;
  }
  return {};
}

bool FrozenMemory::describe(const void* address, char* text, std::size_t size) {
  const auto* at = static_cast<const std::byte*>(address);
  if (frozen_now == nullptr) {
    if (process_counts == nullptr || !process_counts->is_of_pool(at)) return false;
    std::snprintf(text, size, "the model accesses memory behind what was allocated for it, or after its release");
    return true;
  }
  for (const Region& region : frozen_now->frozen_) {
    if (at < region.begin || at >= region.end) continue;
    if (region.base == nullptr)
      std::snprintf(text, size, "compute writes to memory that the model has allocated before, such as its instance");
    else
      std::snprintf(text, size, "compute writes to a variable of %s, at %#tx (nm -n names it)", region.name.c_str(),
                    at - region.base);
    return true;
  }
  return false;
}

}  // namespace rouleau::conform

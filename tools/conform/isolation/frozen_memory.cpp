#include "frozen_memory.hpp"

#include <dlfcn.h>
#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <boost/core/demangle.hpp>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "allocation_count.hpp"
#include "plugin/exported_symbols.hpp"

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

std::int64_t calls_of_the_library() {
  return process_counts == nullptr ? 0 : process_counts->allocations + process_counts->releases + process_counts->locks;
}

}  // namespace

void touch_thread_local_storage() {
  for_each_object([](const dl_phdr_info& info) { thread_local_of(info); });
}

FrozenMemory::FrozenMemory() : before_(writable()) {
  for_each_object([&](const dl_phdr_info& info) { objects_before_.insert(info.dlpi_addr); });
  if (process_counts != nullptr && process_counts->pool != nullptr) process_counts->from_pool = true;
}

FrozenMemory::~FrozenMemory() {
  if (frozen_now == this) thaw();
}

std::vector<FrozenMemory::Region> FrozenMemory::writable() {
  std::vector<Region> regions;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    std::istringstream words(line);
    std::uintptr_t begin = 0, end = 0;
    char dash = 0;
    std::string access, offset, device, inode, name;
    words >> std::hex >> begin >> dash >> end >> access >> offset >> device >> inode >> std::ws;
    std::getline(words, name);
    if (access.size() < 4 || access[1] != 'w' || name == "[stack]" || name == "[heap]") continue;
    const int protection = PROT_WRITE | (access[0] == 'r' ? PROT_READ : 0) | (access[2] == 'x' ? PROT_EXEC : 0);
    regions.push_back({reinterpret_cast<std::byte*>(begin), reinterpret_cast<std::byte*>(end), protection, name});
  }
  return regions;
}

void FrozenMemory::watch() {
  touch_thread_local_storage();
  if (process_counts != nullptr) process_counts->from_pool = false;
  const auto of_pool = [](const std::byte* address) {
    return process_counts != nullptr && address >= process_counts->pool && address < process_counts->pool_end;
  };
  for (Region region : writable()) {
    for (const Region& old : before_) {  // in order; what is left of a region is behind the last old one
      if (old.end <= region.begin || old.begin >= region.end || of_pool(old.begin)) continue;
      if (old.begin > region.begin) frozen_.push_back({region.begin, old.begin, region.protection, region.name});
      region.begin = std::min(old.end, region.end);
    }
    if (region.begin < region.end) frozen_.push_back(region);
  }
  for (Region& region : frozen_) {
    if (of_pool(region.begin)) region = {process_counts->pool, process_counts->pool_end, region.protection, "pool"};
  }
  compared_.push_back({reinterpret_cast<const std::byte*>(&signgam),
                       sizeof signgam,
                       "the C library's signgam (lgamma; lgamma_r does not)",
                       false,
                       {}});
  Dl_info c_library{};
  dladdr(dlsym(RTLD_DEFAULT, "qsort"), &c_library);
  for_each_object([&](const dl_phdr_info& info) {
    const auto* base = reinterpret_cast<const std::byte*>(info.dlpi_addr);
    const bool is_c_library = base == c_library.dli_fbase;
    if (objects_before_.contains(info.dlpi_addr) && !is_c_library) return;
    const std::filesystem::path file = info.dlpi_name;
    const std::byte* of_thread = thread_local_of(info);
    for (int i = 0; i < info.dlpi_phnum; ++i) {
      const auto& segment = info.dlpi_phdr[i];
      if (is_c_library && segment.p_type == PT_LOAD && (segment.p_flags & PF_W) != 0) {
        compared_.push_back(
            {base + segment.p_vaddr, segment.p_memsz, "variables of the C library (rand, strtok?)", true, {}});
      }
      if (!is_c_library && segment.p_type == PT_TLS && of_thread != nullptr) {
        compared_.push_back(
            {of_thread, segment.p_memsz, "a thread-local variable of " + file.filename().string(), false, {}});
      }
    }
    if (is_c_library) return;
    try {
      for (const auto& [name, address, size] : plugin::variables(file)) {
        variables_.push_back({base + address, base + address + size, boost::core::demangle(name.c_str())});
      }
    } catch (const std::exception&) {  // names are for the message alone
    }
  });
}

void FrozenMemory::freeze() {
  signgam = 7;  // lgamma writes 1 or -1

  for (Part& part : compared_) part.copy.assign(part.begin, part.begin + part.size);
  calls_of_the_library_ = calls_of_the_library();
  frozen_now = this;
  for (const Region& region : frozen_) {
    mprotect(region.begin, static_cast<std::size_t>(region.end - region.begin), region.protection & ~PROT_WRITE);
  }
}

std::string FrozenMemory::thaw() {
  for (const Region& region : frozen_) {
    mprotect(region.begin, static_cast<std::size_t>(region.end - region.begin), region.protection);
  }
  frozen_now = nullptr;
  for (const Part& part : compared_) {
    if (std::memcmp(part.copy.data(), part.begin, part.size) == 0) continue;
    if (!part.of_c_library || calls_of_the_library_ == calls_of_the_library()) {
      return part.name;
    }
  }
  return {};
}

const FrozenMemory::Variable* FrozenMemory::variable_at(const std::byte* address) const {
  const auto found = std::find_if(variables_.begin(), variables_.end(), [&](const Variable& variable) {
    return address >= variable.begin && address < variable.end;
  });
  return found == variables_.end() ? nullptr : &*found;
}

bool FrozenMemory::describe(const void* address, char* text, std::size_t size) {
  const auto* at = static_cast<const std::byte*>(address);
  if (frozen_now == nullptr) {
    if (process_counts == nullptr || at < process_counts->pool || at >= process_counts->pool_end) return false;
    std::snprintf(text, size, "the model accesses memory behind what was allocated for it, or after its release");
    return true;
  }
  for (const Part& part : frozen_now->compared_) {
    if (at < part.begin || at >= part.begin + part.size) continue;
    std::snprintf(text, size, "compute writes to %s", part.name.c_str());
    return true;
  }
  if (const Variable* variable = frozen_now->variable_at(at)) {
    std::snprintf(text, size, "compute writes to the variable %s", variable->name.c_str());
    return true;
  }
  for (const Region& region : frozen_now->frozen_) {
    if (at < region.begin || at >= region.end) continue;
    if (region.name == "pool")
      std::snprintf(text, size, "compute writes to memory that the model has allocated before, such as its instance");
    else
      std::snprintf(text, size, "compute writes to a variable in %s",
                    region.name.empty() ? "its own pages" : region.name.c_str());
    return true;
  }
  return false;
}

}  // namespace rouleau::conform

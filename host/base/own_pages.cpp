#include "own_pages.hpp"

#include <dlfcn.h>
#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>

namespace rouleau {

namespace {

/// Whole pages, with what lies between a library's variables, where an AddressSanitizer allows no reading.
__attribute__((no_sanitize("address"))) void copy_words(const void* from, void* to, std::size_t bytes) {
  const auto* const source = static_cast<const volatile std::uint64_t*>(from);  // volatile: or it becomes a memcpy
  auto* const copy = static_cast<std::uint64_t*>(to);
  for (std::size_t i = 0; i < bytes / sizeof(std::uint64_t); ++i) copy[i] = source[i];
}

void own(std::uintptr_t begin, std::uintptr_t end, int protection) {
  void* const copy = ::mmap(nullptr, end - begin, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (copy == MAP_FAILED) return;
  auto* const place = reinterpret_cast<void*>(begin);
  copy_words(place, copy, end - begin);
  if (::mprotect(copy, end - begin, protection) != 0 ||
      ::mremap(copy, end - begin, end - begin, MREMAP_MAYMOVE | MREMAP_FIXED, place) == MAP_FAILED) {
    ::munmap(copy, end - begin);
  }
}

int own_if_meant(dl_phdr_info* info, std::size_t, void* wanted) {
  if (info->dlpi_addr != static_cast<const link_map*>(wanted)->l_addr) return 0;
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto down = [&](std::uintptr_t address) { return address / page * page; };
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& part = info->dlpi_phdr[i];
    if (part.p_type != PT_LOAD || part.p_memsz == 0 || (part.p_flags & PF_R) == 0) continue;
    const std::uintptr_t begin = info->dlpi_addr + part.p_vaddr;
    const int protection =
        PROT_READ | ((part.p_flags & PF_W) != 0 ? PROT_WRITE : 0) | ((part.p_flags & PF_X) != 0 ? PROT_EXEC : 0);
    own(down(begin), down(begin + part.p_memsz + page - 1), protection);
  }
  for (int i = 0; i < info->dlpi_phnum; ++i) {
    const auto& part = info->dlpi_phdr[i];  // what only the loader has written to
    const std::uintptr_t begin = down(info->dlpi_addr + part.p_vaddr);
    const std::uintptr_t end = down(info->dlpi_addr + part.p_vaddr + part.p_memsz);
    if (part.p_type == PT_GNU_RELRO && end > begin) ::mprotect(reinterpret_cast<void*>(begin), end - begin, PROT_READ);
  }
  return 1;
}

}  // namespace

void own_pages(void* handle) {
  link_map* map = nullptr;
  if (::dlinfo(handle, RTLD_DI_LINKMAP, &map) == 0 && map != nullptr) dl_iterate_phdr(&own_if_meant, map);
}

}  // namespace rouleau

#include "exported_symbols.hpp"

#include <elf.h>
#include <link.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace rouleau::plugin {

namespace {

using Header = ElfW(Ehdr);
using Segment = ElfW(Phdr);
using Section = ElfW(Shdr);
using Symbol = ElfW(Sym);

/// Thrown for a damaged file; what() says in which way.
struct Damaged : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Bounds-checked reads; every offset and size in the file is taken for hostile.
class ElfFile {
 public:
  explicit ElfFile(const std::filesystem::path& path) : stream_(path, std::ios::binary) {
    if (!stream_) throw Damaged(std::string("cannot be read: ") + std::strerror(errno));
    stream_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(stream_.tellg());
  }

  [[nodiscard]] bool holds(std::uint64_t offset, std::uint64_t bytes) const {
    return offset <= size_ && bytes <= size_ - offset;
  }

  template <class Record>
  std::vector<Record> read(std::uint64_t offset, std::uint64_t count) {
    if (count > size_ / sizeof(Record) || !holds(offset, count * sizeof(Record))) throw Damaged("is cut short");
    std::vector<Record> records(count);
    stream_.seekg(static_cast<std::streamoff>(offset));
    stream_.read(reinterpret_cast<char*>(records.data()), static_cast<std::streamsize>(count * sizeof(Record)));
    if (!stream_) throw Damaged("cannot be read");
    return records;
  }

 private:
  std::ifstream stream_;
  std::uint64_t size_ = 0;
};

/// True for a defined symbol that other modules can see. (Not ELF64_ST_BIND and its like: they cast in the C way.)
bool is_exported(const Symbol& symbol) {
  const int binding = symbol.st_info >> 4, visibility = symbol.st_other & 3;
  return symbol.st_shndx != SHN_UNDEF && (binding == STB_GLOBAL || binding == STB_WEAK) &&
         (visibility == STV_DEFAULT || visibility == STV_PROTECTED);
}

std::vector<std::string> exported(ElfFile& file, const std::vector<Section>& sections) {
  constexpr std::size_t most_bytes = std::size_t{1} << 28;  // of all names; those of a damaged table may overlap
  std::vector<std::string> names;
  std::size_t bytes = 0;
  for (const Section& section : sections) {
    if (section.sh_type != SHT_DYNSYM) continue;
    if (section.sh_link >= sections.size()) throw Damaged("has a damaged table of symbols");
    const Section& strings = sections[section.sh_link];
    std::vector<char> text = file.read<char>(strings.sh_offset, strings.sh_size);
    text.push_back('\0');
    for (const Symbol& symbol : file.read<Symbol>(section.sh_offset, section.sh_size / sizeof(Symbol))) {
      if (!is_exported(symbol) || symbol.st_name >= text.size()) continue;
      names.emplace_back(&text[symbol.st_name]);
      bytes += names.back().size() + sizeof(std::string);
      if (bytes > most_bytes) throw Damaged("has a damaged table of symbols");
    }
  }
  return names;
}

/// What of the file's header this process cannot load.
std::string foreign_part(const Header& header) {
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0) return "is no shared library (not an ELF file)";
  ElfFile own("/proc/self/exe");
  const Header host = own.read<Header>(0, 1)[0];
  if (header.e_ident[EI_CLASS] != host.e_ident[EI_CLASS]) {
    return header.e_ident[EI_CLASS] == ELFCLASS32 ? "is a 32-bit library, this program has 64 bits"
                                                  : "has another word size than this program";
  }
  if (header.e_ident[EI_DATA] != host.e_ident[EI_DATA] || header.e_machine != host.e_machine) {
    return "is made for another kind of processor (ELF machine " + std::to_string(header.e_machine) + ", here " +
           std::to_string(host.e_machine) + ')';
  }
  if (header.e_type != ET_DYN) return "is an ELF file, but not a shared library";
  return {};
}

}  // namespace

std::string reason_not_loadable(const std::filesystem::path& path, const std::string& symbol) {
  try {
    ElfFile file(path);
    if (!file.holds(0, sizeof(Header))) return "is no shared library (not an ELF file)";
    const Header header = file.read<Header>(0, 1)[0];
    if (std::string reason = foreign_part(header); !reason.empty()) return reason;
    if (header.e_phentsize != sizeof(Segment) || header.e_shentsize != sizeof(Section))
      return "has a damaged ELF header";
    for (const Segment& segment : file.read<Segment>(header.e_phoff, header.e_phnum))
      if (segment.p_type == PT_LOAD && !file.holds(segment.p_offset, segment.p_filesz)) return "is cut short";
    const auto symbols = exported(file, file.read<Section>(header.e_shoff, header.e_shnum));
    if (std::find(symbols.begin(), symbols.end(), symbol) == symbols.end())
      return "does not export the function " + symbol;
  } catch (const Damaged& damage) {
    return damage.what();
  }
  return {};
}

std::vector<std::string> exported_symbols(const std::filesystem::path& path) {
  ElfFile file(path);
  const Header header = file.read<Header>(0, 1)[0];
  return exported(file, file.read<Section>(header.e_shoff, header.e_shnum));
}

bool own_unique_symbols(std::string& library) {
  Header header;
  if (library.size() < sizeof header) return false;
  std::memcpy(&header, library.data(), sizeof header);
  bool any = false;
  for (std::uint64_t i = 0; i < header.e_shnum; ++i) {
    Section table;
    const std::uint64_t place = header.e_shoff + i * sizeof table;
    if (header.e_shoff > library.size() || place + sizeof table > library.size()) return any;
    std::memcpy(&table, library.data() + place, sizeof table);
    if (table.sh_type != SHT_DYNSYM || table.sh_offset > library.size()) continue;
    const std::uint64_t end =
        table.sh_offset + std::min<std::uint64_t>(table.sh_size, library.size() - table.sh_offset);
    for (std::uint64_t at = table.sh_offset; at + sizeof(Symbol) <= end; at += sizeof(Symbol)) {
      char& info = library[at + offsetof(Symbol, st_info)];
      if (static_cast<unsigned char>(info) >> 4 != STB_GNU_UNIQUE) continue;
      info = static_cast<char>((STB_GLOBAL << 4) | (info & 0xf));
      any = true;
    }
  }
  return any;
}

}  // namespace rouleau::plugin

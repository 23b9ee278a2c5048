#include "cell_table.hpp"

#include <array>

#include "base/error.hpp"
#include "base/input_file.hpp"
#include "cell_rows.hpp"

namespace rouleau::scene {

std::string origin_of(const CellPlacement& cell) {
  return cell.pointer + (cell.line > 0 ? ", line " + std::to_string(cell.line) + " of its file" : "");
}

std::vector<CellPlacement> read_cell_table(const std::filesystem::path& file, const std::vector<CellType>& types,
                                           const units::Units& units, const std::string& pointer,
                                           std::optional<int> type) {
  std::array<char, 8> first{};
  InputFile(file).read(first.data(), first.size(), 0);
  const CellTableSource source{file, types, units, pointer, type};
  return std::string_view(first.data(), first.size()) == "\x89HDF\r\n\x1a\n" ? read_hdf5_cells(source)
                                                                             : read_csv_cells(source);
}

}  // namespace rouleau::scene

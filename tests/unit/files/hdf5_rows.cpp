// A dataset that is written some rows at a time is the one that is written at once, byte for byte.
#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

#include "files/file.hpp"
#include "hdf5/hdf5_rows.hpp"
#include "scratch_folder.hpp"
#include "unit/random.hpp"

namespace hdf5 = rouleau::hdf5;
using namespace rouleau::files;
using namespace rouleau::test;

namespace {

struct Shape {
  std::vector<hsize_t> size;
  bool layers;
  hid_t stored;
};

void write_after(hdf5::File& file) { file.write("/after", std::vector<double>{1, 2, 3}, "m"); }

}  // namespace

TEST_CASE("a dataset from some rows at a time has the bytes of one that is written at once") {
  auto random = generator(static_cast<unsigned>(std::random_device()()));
  const ScratchFolder folder;
  // The first ones have several chunks, the last of them is not full; then chunks of whole layers, and one row.
  const Shape shape = GENERATE(Shape{{700, 600}, false, H5T_IEEE_F64LE}, Shape{{301, 211, 3}, false, H5T_IEEE_F32LE},
                               Shape{{5, 300, 500}, true, H5T_IEEE_F64LE}, Shape{{23, 20, 40, 3}, true, H5T_IEEE_F32LE},
                               Shape{{1, 7}, false, H5T_IEEE_F64LE});
  const int compression = GENERATE(0, 1);
  const std::size_t rows = shape.size[0] * (shape.layers ? shape.size[1] : 1);
  std::size_t width = 1;
  for (std::size_t k = shape.layers ? 2 : 1; k < shape.size.size(); ++k) width *= shape.size[k];
  std::vector<double> values(rows * width);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i * i % 9973) / 8;
  const auto whole = folder.path() / "whole.h5";
  {
    hdf5::File file(whole, hdf5::File::Mode::create);
    file.write("/values", shape.size, shape.stored, H5T_NATIVE_DOUBLE, values.data(), "m/s", compression);
    write_after(file);
  }
  for (const std::size_t most : {std::size_t{1}, std::size_t{50}, rows}) {
    if (most == 1 && rows > 1000) continue;
    const auto parts = folder.path() / "parts.h5";
    {
      hdf5::File file(parts, hdf5::File::Mode::create);
      hdf5::Rows writing =
          file.begin("/values", shape.size, shape.layers, shape.stored, H5T_NATIVE_DOUBLE, "m/s", compression);
      for (std::size_t row = 0; row < rows;) {
        CHECK_FALSE(writing.full());
        const std::size_t count = std::min(rows - row, std::uniform_int_distribution<std::size_t>(1, most)(random));
        writing.append(values.data() + row * width, count);
        row += count;
      }
      CHECK(writing.full());
      writing.append(values.data(), 0);  // as of cells that have not come
      write_after(file);
    }
    CAPTURE(most, compression, rows);
    CHECK((read_text(parts) == read_text(whole)));
  }
  CHECK((hdf5::File(whole, hdf5::File::Mode::read).read("/values") == values || shape.stored == H5T_IEEE_F32LE));
}

TEST_CASE("a dataset without rows is finished when it is begun") {
  const ScratchFolder folder;
  hdf5::File file(folder.path() / "none.h5", hdf5::File::Mode::create);
  hdf5::Rows none = file.begin("/none", {0, 4}, false, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, "m");
  CHECK(none.full());
  none.append(nullptr, 0);
  CHECK(file.elements("/none") == 0);
}

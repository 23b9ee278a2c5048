// Runs whose cells come and leave: each frame has those that are there, under their numbers.
#include <catch2/catch.hpp>
#include <regex>

#include "files/file.hpp"
#include "files/frames.hpp"
#include "files/tables.hpp"
#include "files/verify.hpp"
#include "unit/run_fixture.hpp"

using namespace rouleau;
using namespace rouleau::files;
using namespace rouleau::scene;
using namespace rouleau::test;

namespace {

/// `parts`: of the run, each of which goes on behind what the one before has sealed.
void write_run(const std::filesystem::path& folder, const std::vector<std::size_t>& parts) {
  const Scene scene = open_scene();
  std::filesystem::create_directories(folder);
  FramesSaved saved;
  std::size_t output = 0;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    FrameWriter writer =
        part == 0 ? FrameWriter(folder / "frames.h5", scene) : FrameWriter(folder / "frames.h5", scene, saved);
    for (; output < parts[part]; ++output)
      writer.write(snapshot_of(static_cast<long>(output), cells_of_open_run[output]));
    saved = writer.seal();
    if (output == cells_of_open_run.size()) {
      writer.close();
      write_file(folder / "frames.xmf", writer.xdmf());
    }
  }
}

}  // namespace

TEST_CASE("a frame has the cells that are there, under their numbers, also where the run was stopped between") {
  const ScratchFolder folder;
  std::string xdmf;
  for (const std::vector<std::size_t>& parts : {std::vector<std::size_t>{6}, {2, 6}, {1, 3, 4, 5, 6}}) {
    CAPTURE(parts);
    const auto run = folder.path() / std::to_string(parts.size());
    write_run(run, parts);
    const FrameReader reader(run / "frames.h5");
    REQUIRE(reader.frames() == static_cast<int>(cells_of_open_run.size()));
    for (int frame = 0; frame < reader.frames(); ++frame) {
      CAPTURE(frame);
      const std::vector<int>& cells = cells_of_open_run[frame];
      const observe::OutlineSnapshot found = reader.outlines(frame);
      CHECK(found.cell == cells);
      CHECK(reader.nodes(frame) == 32 * cells.size());
      for (std::size_t k = 0; k < cells.size(); ++k) {
        CHECK(found.first[k] == static_cast<int>(32 * k));
        CHECK(found.tension[32 * k] == 1e-6 * (cells[k] + 1));
        CHECK(found.x[32 * k] == (2 + 3 * cells[k] + static_cast<double>(frame)) * 1e-6 + 1e-6);
      }
    }
    const hdf5::File file(run / "frames.h5", hdf5::File::Mode::read);
    CHECK_FALSE(file.has("/frames/000003/membranes"));
    CHECK(file.read("/frames/000005/membranes/aggregate")[32] == 2);
    CHECK(file.read("/frames/000004/membranes/aggregate")[0] == 3);
    CHECK(find_no_number_in_frames(run / "frames.h5") == std::nullopt);
    // What leads to the datasets says how large they are.
    const std::string text = read_text(run / "frames.xmf");
    if (xdmf.empty()) xdmf = text;
    CHECK(text == xdmf);
    const std::regex item("Dimensions=\"([0-9 ]+)\"[^>]*>frames.h5:([^<]+)<");
    int items = 0;
    for (auto match = std::sregex_iterator(text.begin(), text.end(), item); match != std::sregex_iterator(); ++match) {
      CAPTURE((*match)[2].str());
      std::size_t numbers = 1, dimension = 0;
      for (std::istringstream shape((*match)[1]); shape >> dimension;) numbers *= dimension;
      CHECK(file.read((*match)[2]).size() == numbers);
      ++items;
    }
    CHECK(items == 5 * 5);  // connectivity, points, tension, cell and aggregate of the frames with cells
  }
}

TEST_CASE("a topology is written once for as long as the same cells are there") {
  const ScratchFolder folder;
  FrameWriter writer(folder.path() / "frames.h5", open_scene());
  for (const std::vector<int>& cells : std::vector<std::vector<int>>{{0, 1}, {0, 1}, {0, 2}, {0, 2}, {}, {0, 2}, {2}})
    writer.write(snapshot_of(0, cells));
  writer.close();
  const hdf5::File file(folder.path() / "frames.h5", hdf5::File::Mode::read);
  CHECK(file.members("/topology") == 3);
  CHECK(file.address("/frames/000002/membranes/cell") == file.address("/frames/000005/membranes/cell"));
}

TEST_CASE("frames whose cells have numbers that do not ascend are refused") {
  const ScratchFolder folder;
  for (const std::vector<int>& cells : std::vector<std::vector<int>>{{2, 1}, {1, 1}, {-1, 1}}) {
    const auto file = folder.path() / "frames.h5";
    std::filesystem::remove(file);
    FrameWriter writer(file, open_scene());
    writer.write(snapshot_of(0, cells));
    writer.close();
    CHECK_THROWS_WITH(FrameReader(file).outlines(0),
                      Catch::Contains(file.string()) && Catch::Contains("/frames/000000/membranes/cell"));
  }
}

TEST_CASE("cells.csv has a row for each cell that is there, and series.csv says how many these are") {
  const ScratchFolder folder;
  RunDirectory run(folder.path(), open_scene());
  for (std::size_t output = 0; output < cells_of_open_run.size(); ++output)
    run.write(snapshot_of(static_cast<long>(output), cells_of_open_run[output]));
  run.finish(to_json(small_summary()));
  CHECK(verify(folder.path()).differences.empty());
  const StoredTable cells(folder.path() / "cells.csv"), series(folder.path() / "series.csv");
  std::vector<double> expected, inside;
  for (const std::vector<int>& there : cells_of_open_run) {
    expected.insert(expected.end(), there.begin(), there.end());
    inside.push_back(static_cast<double>(there.size()));
  }
  CHECK(cells.numbers("cell") == expected);
  CHECK(series.numbers("cells_inside") == inside);
}

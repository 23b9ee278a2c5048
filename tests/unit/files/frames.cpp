#include <catch2/catch.hpp>
#include <chrono>
#include <map>
#include <regex>
#include <thread>

#include "files/file.hpp"
#include "files/frames.hpp"
#include "unit/run_fixture.hpp"

namespace hdf5 = rouleau::hdf5;
using namespace rouleau::files;
using namespace rouleau::scene;
using namespace rouleau::test;

namespace {

std::string text_attribute(hid_t file, const char* path, const char* name) {
  const hdf5::Handle attribute(H5Aopen_by_name(file, path, name, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const hdf5::Handle type(H5Aget_type(attribute.id()), H5Tclose);
  char* text = nullptr;
  REQUIRE(H5Aread(attribute.id(), type.id(), static_cast<void*>(&text)) >= 0);
  const std::string result = text;
  H5free_memory(text);
  return result;
}

/// Shape of a dataset; empty when there is none.
std::vector<hsize_t> shape(hid_t file, const std::string& path) {
  const hdf5::Handle dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) return {};
  const hdf5::Handle space(H5Dget_space(dataset.id()), H5Sclose);
  std::vector<hsize_t> dimensions(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.id())));
  H5Sget_simple_extent_dims(space.id(), dimensions.data(), nullptr);
  return dimensions;
}

/// A run with two frames: the second has fields, and cells of unequal size.
void write_run(const std::filesystem::path& directory) {
  const Scene scene = small_scene();
  RunDirectory run(directory, scene);
  run.write(small_snapshot(0));
  run.write(small_snapshot(5, true, 40));
  run.finish(to_json(small_summary()));
}

/// Every element is closed by its own name: enough for a text without comments, and no parser is needed for it.
bool well_formed(const std::string& xml) {
  const std::regex tag(R"(<(/?)([A-Za-z0-9]+)((?:\s+[A-Za-z]+="[^"<>&]*")*)\s*(/?)>|<\?[^>]*\?>)");
  std::vector<std::string> open;
  std::size_t covered = 0;
  for (auto match = std::sregex_iterator(xml.begin(), xml.end(), tag); match != std::sregex_iterator(); ++match) {
    const auto between = xml.substr(covered, static_cast<std::size_t>(match->position()) - covered);
    if (between.find_first_of("<>&") != std::string::npos) return false;
    covered = static_cast<std::size_t>(match->position() + match->length());
    if (!(*match)[2].matched || (*match)[4].length() > 0) continue;
    if ((*match)[1].length() == 0) {
      open.push_back((*match)[2]);
    } else {
      if (open.empty() || open.back() != (*match)[2]) return false;
      open.pop_back();
    }
  }
  return open.empty();
}

}  // namespace

TEST_CASE("frames.h5 holds the outlines as given, with units") {
  const ScratchFolder folder;
  write_run(folder.path());
  const FrameReader reader(folder.path() / "frames.h5");
  REQUIRE(reader.frames() == 2);
  CHECK(reader.size().size() == 2);
  CHECK(reader.size()[0] == 20e-6);
  CHECK_FALSE(reader.periodic()[1]);
  CHECK(reader.step(1) == 5);
  for (int frame = 0; frame < 2; ++frame) {
    const auto given = small_outlines(frame == 0 ? 32 : 40);
    const auto stored = reader.outlines(frame);
    CHECK(stored.first == given.first);
    CHECK(stored.x == given.x);
    CHECK(stored.y == given.y);
    CHECK(stored.tension == given.tension);
  }
  const hdf5::Handle file(H5Fopen((folder.path() / "frames.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const std::map<std::string, std::string> units{{"membranes/points", "m"},
                                                 {"membranes/tension", "N/m"},
                                                 {"membranes/first", "1"},
                                                 {"fields/velocity", "m/s"},
                                                 {"fields/viscosity", "Pa s"}};
  for (const auto& [dataset, unit] : units)
    CHECK(text_attribute(file.id(), ("/frames/000001/" + dataset).c_str(), "unit") == unit);
}

TEST_CASE("the same run gives the same bytes at another time") {
  const ScratchFolder folder;
  write_run(folder.path() / "a");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5's time stamps count whole seconds
  write_run(folder.path() / "b");
  CHECK(read_text(folder.path() / "a/frames.h5") == read_text(folder.path() / "b/frames.h5"));
}

TEST_CASE("a field has y slowest and velocity a third component of zero") {
  const ScratchFolder folder;
  write_run(folder.path());
  const hdf5::File file(folder.path() / "frames.h5", hdf5::File::Mode::read);
  const auto velocity = file.read("/frames/000001/fields/velocity");
  REQUIRE(velocity.size() == 8 * 4 * 3);
  const std::size_t i = 3, j = 2;
  CHECK(velocity[3 * (8 * j + i)] == 8 * j + i);
  CHECK(velocity[3 * (8 * j + i) + 1] == -(8.0 * j + i));
  CHECK(velocity[3 * (8 * j + i) + 2] == 0);
  CHECK_FALSE(file.has("/frames/000000/fields"));
  CHECK_FALSE(file.has("/frames/000001/fields/vorticity"));
}

TEST_CASE("a file of frames can be read up to the last frame while the run goes on or after it was killed") {
  const ScratchFolder folder;
  const Scene scene = small_scene();
  RunDirectory run(folder.path(), scene);
  run.write(small_snapshot(0));
  std::filesystem::copy_file(folder.path() / "frames-0001.h5", folder.path() / ".killed.partial");
  const FrameReader reader(folder.path() / ".killed.partial");
  CHECK(reader.frames() == 1);
  CHECK(reader.outlines(0).x.size() == 64);
}

TEST_CASE("frames.xmf is well-formed and every dataset it names exists with the size it says") {
  const ScratchFolder folder;
  write_run(folder.path());
  const std::string xml = read_text(folder.path() / "frames.xmf");
  CHECK(well_formed(xml));
  const hdf5::Handle file(H5Fopen((folder.path() / "frames.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const std::regex item(R"re(<DataItem Dimensions="([0-9 ]+)"[^>]*Format="HDF">frames\.h5:([^<]+)</DataItem>)re");
  int items = 0;
  for (auto match = std::sregex_iterator(xml.begin(), xml.end(), item); match != std::sregex_iterator();
       ++match, ++items) {
    INFO(match->str());
    const auto stored = shape(file.id(), (*match)[2]);
    REQUIRE_FALSE(stored.empty());
    hsize_t said = 1, there = 1;
    std::istringstream dimensions((*match)[1]);
    for (hsize_t n = 0; dimensions >> n;) said *= n;
    for (const hsize_t n : stored) there *= n;
    CHECK(said == there);
  }
  CHECK(items == 5 + 5 + 2);
  CHECK(xml.find("TopologyType=\"Polyline\"") != std::string::npos);        // equal cells
  CHECK(xml.find("TopologyType=\"Mixed\"") != std::string::npos);           // unequal ones
  CHECK(xml.find(">0 1.25e-06 1.25e-06</DataItem>") != std::string::npos);  // the first node lies half a spacing inside
}

TEST_CASE("every outline of the topology is closed") {
  const ScratchFolder folder;
  write_run(folder.path());
  const hdf5::File file(folder.path() / "frames.h5", hdf5::File::Mode::read);
  const auto uniform = file.read("/frames/000000/membranes/connectivity");
  REQUIRE(uniform.size() == 2 * 33);
  CHECK(uniform[0] == uniform[32]);
  CHECK(uniform[33] == uniform[65]);
  const auto mixed = file.read("/frames/000001/membranes/connectivity");
  REQUIRE(mixed.size() == 2 + 33 + 2 + 41);
  CHECK(std::vector<double>(mixed.begin(), mixed.begin() + 3) == std::vector<double>{2, 33, 0});
  CHECK(mixed[34] == 0);
  CHECK(mixed[36] == 41);
  CHECK(mixed.back() == 32);
}

TEST_CASE("HDF5's trouble with a file is told with the path and the system's words") {
  const ScratchFolder folder;
  CHECK_THROWS_WITH(FrameReader(folder.path() / "none.h5"),
                    Catch::Contains("none.h5") && Catch::Contains("No such file"));
  write_file(folder.path() / "text.h5", "this is no HDF5 file");
  CHECK_THROWS_WITH(FrameReader(folder.path() / "text.h5"), Catch::Contains("text.h5") && Catch::Contains("HDF5 says"));
}

TEST_CASE("outlines whose first nodes do not fit their points are refused with file, frame and remedy") {
  const ScratchFolder scratch;
  const auto file = scratch.path() / "frames.h5";
  for (const std::vector<int>& first : std::vector<std::vector<int>>{
           {0, 1, 4}, {0, 5}, {1, 4}, {-1, 4}, {0, 3, 3}, {0, 3, 2}, {0, 2147483647}, {-2147483647, 4}}) {
    CAPTURE(first);
    {
      hdf5::File damaged(file, hdf5::File::Mode::create);
      for (const char* group : {"/frames", "/frames/000000", "/frames/000000/membranes"}) damaged.make_group(group);
      damaged.write("/frames/000000/membranes/points", std::vector<double>(8), "m");
      damaged.write("/frames/000000/membranes/tension", std::vector<double>(4), "N/m");
      damaged.write("/frames/000000/membranes/first", first, "1");
      damaged.write("/frames/000000/membranes/cell", std::vector<int>{0, 1, 1, 1}, "1");
      damaged.close();
    }
    const FrameReader reader(file);
    if (first == std::vector<int>{0, 1, 4}) {
      CHECK(reader.outlines(0).first == first);
      continue;
    }
    CHECK_THROWS_WITH(reader.outlines(0), Catch::Contains(file.string()) && Catch::Contains("/frames/000000") &&
                                              Catch::Contains("repeat the run"));
  }
}

TEST_CASE("tensions that do not fit the points are refused with file, frame and remedy") {
  const ScratchFolder scratch;
  const auto file = scratch.path() / "frames.h5";
  for (const std::size_t tensions : {0, 3, 4, 5}) {
    {
      hdf5::File damaged(file, hdf5::File::Mode::create);
      for (const char* group : {"/frames", "/frames/000000", "/frames/000000/membranes"}) damaged.make_group(group);
      damaged.write("/frames/000000/membranes/points", std::vector<double>(8), "m");
      damaged.write("/frames/000000/membranes/tension", std::vector<double>(tensions), "N/m");
      damaged.write("/frames/000000/membranes/first", std::vector<int>{0, 4}, "1");
      damaged.write("/frames/000000/membranes/cell", std::vector<int>(4), "1");
      damaged.close();
    }
    const FrameReader reader(file);
    if (tensions == 4)
      CHECK(reader.outlines(0).tension.size() == 4);
    else
      CHECK_THROWS_WITH(reader.outlines(0), Catch::Contains(file.string()) && Catch::Contains("/frames/000000") &&
                                                Catch::Contains("repeat the run"));
  }
}

TEST_CASE("a dataset that claims more numbers than its file can hold is refused before memory is asked for") {
  const ScratchFolder scratch;
  const auto file = scratch.path() / "frames.h5";
  hdf5::File(file, hdf5::File::Mode::create).close();
  {
    const hdf5::Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    const hsize_t count = hsize_t{1} << 50, chunk = 1024;
    const hdf5::Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
    const hdf5::Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    REQUIRE(H5Pset_chunk(layout.id(), 1, &chunk) >= 0);
    const hdf5::Handle dataset(
        H5Dcreate2(opened.id(), "/points", H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, layout.id(), H5P_DEFAULT),
        H5Dclose);
    REQUIRE(dataset.valid());
  }
  const hdf5::File damaged(file, hdf5::File::Mode::read);
  CHECK_THROWS_WITH(damaged.read("/points"), Catch::Contains(file.string()) && Catch::Contains("/points") &&
                                                 Catch::Contains("1125899906842624 numbers"));
}

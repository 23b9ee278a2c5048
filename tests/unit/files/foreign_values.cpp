// A run from a stranger shows nothing but its own files: no HDF5 link, no external storage, no link of the file system.
#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "base/error.hpp"
#include "files/file.hpp"
#include "files/frames.hpp"
#include "files/tables.hpp"
#include "hdf5/hdf5_file.hpp"
#include "scratch_folder.hpp"

using namespace rouleau;
using Catch::Matchers::Contains;
using Mode = hdf5::File::Mode;

namespace {

void put_external(const std::filesystem::path& file, const std::filesystem::path& to, const char* path) {
  hdf5::File made(file, Mode::create);
  made.link_to(to, path);
}

}  // namespace

TEST_CASE("a link within HDF5 leads to regular files of the same folder alone") {
  const test::ScratchFolder folder;
  std::filesystem::create_directory(folder.path() / "run");
  const auto run = folder.path() / "run", frames = run / "frames.h5";
  for (const auto& place : {folder.path() / "secret.h5", run / "frames-0001.h5"})
    hdf5::File(place, Mode::create).write("/values", std::vector<double>{1, 2, 3}, "m");
  put_external(frames, "frames-0001.h5", "/values");
  CHECK(hdf5::File(frames, Mode::read).read("/values") == std::vector<double>{1, 2, 3});
  put_external(frames, run / "frames-0001.h5", "/values");
  CHECK(hdf5::File(frames, Mode::read).elements("/values") == 3);

  REQUIRE(::mkfifo((run / "pipe").c_str(), 0600) == 0);
  std::filesystem::create_symlink("../secret.h5", run / "link.h5");
  for (const std::string& to : {std::string("../secret.h5"), (folder.path() / "secret.h5").string(),
                                std::string("pipe"), std::string("link.h5"), std::string("none.h5")}) {
    CAPTURE(to);
    put_external(frames, to, "/values");
    const hdf5::File file(frames, Mode::read);
    CHECK(file.has("/values"));
    const auto refuses = [&](const auto& read) {
      CHECK_THROWS_WITH(read(), Contains(to) && Contains("no file in the same folder") && Contains("damaged"));
    };
    refuses([&] { return file.read("/values"); });
    refuses([&] { return file.shape("/values"); });
    refuses([&] { return file.names("/values"); });
    refuses([&] { return file.has("/values/more"); });
    refuses([&] { return file.address("/values"); });
    refuses([&] { return file.read_attribute("/values", "unit"); });
  }
  // Over a segment that is the run's own.
  put_external(run / "frames-0001.h5", "../secret.h5", "/values");
  put_external(frames, "frames-0001.h5", "/values");
  CHECK_THROWS_WITH(hdf5::File(frames, Mode::read).read("/values"), Contains("../secret.h5"));
}

TEST_CASE("a dataset whose values lie in other files is damaged") {
  const test::ScratchFolder folder;
  const std::string secret = folder.write("secret", std::string(8, 's')).string();
  const auto file = folder.path() / "frames.h5";
  const bool is_virtual = GENERATE(false, true);
  hdf5::File(folder.path() / "secret.h5", Mode::create).write("/values", std::vector<double>{1}, "m");
  {
    const hdf5::Handle made(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    const hsize_t count = is_virtual ? 1 : 8;
    const hdf5::Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
    const hdf5::Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (is_virtual)
      REQUIRE(H5Pset_virtual(layout.id(), space.id(), "secret.h5", "/values", space.id()) >= 0);
    else
      REQUIRE(H5Pset_external(layout.id(), secret.c_str(), 0, 8) >= 0);
    const hdf5::Handle dataset(H5Dcreate2(made.id(), "/values", is_virtual ? H5T_IEEE_F64LE : H5T_STD_U8LE, space.id(),
                                          H5P_DEFAULT, layout.id(), H5P_DEFAULT),
                               H5Dclose);
    REQUIRE(dataset.valid());
  }
  const hdf5::File opened(file, Mode::read);
  const auto refuses = [&](const auto& read) {
    CHECK_THROWS_WITH(read(), Contains("takes its values from other files") && Contains("damaged"));
  };
  double value = 0;
  refuses([&] { return opened.read("/values"); });
  refuses([&] { return opened.elements("/values"); });
  refuses([&] { opened.read("/values", H5T_NATIVE_DOUBLE, {0}, {1}, &value); });
}

TEST_CASE("a file of a run that is a link to elsewhere, or a pipe, is not read") {
  const test::ScratchFolder folder;
  folder.write("secret", "a,b\n1,2\n");
  folder.write("run/own.csv", "a,b\n1,2\n");
  const auto run = folder.path() / "run";
  std::filesystem::create_symlink("../secret", run / "series.csv");
  std::filesystem::create_symlink("own.csv", run / "cells.csv");
  REQUIRE(::mkfifo((run / "frames.h5").c_str(), 0600) == 0);
  REQUIRE(::mkfifo((run / "pipe.csv").c_str(), 0600) == 0);
  CHECK_THROWS_WITH(files::StoredTable(run / "series.csv"), Contains("is a link to") && Contains("put a copy"));
  CHECK(files::StoredTable(run / "cells.csv").rows() == 1);
  CHECK_THROWS_WITH(files::StoredTable(run / "pipe.csv"), Contains("it is a pipe"));
  CHECK_THROWS_WITH(files::open_frames(run / "frames.h5"), Contains("it is a pipe"));
  CHECK_THROWS_WITH(files::checksum_of(run / "pipe.csv"), Contains("it is a pipe"));
  CHECK_THROWS_WITH(files::AppendFile(run / "pipe.csv"), Contains("a pipe that nobody reads"));
}

// Frames that outlive their writer: segments, frames.h5 made of them, and runs that go on behind them.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "files/file.hpp"
#include "files/frames.hpp"
#include "unit/run_fixture.hpp"

using namespace rouleau;
using namespace rouleau::files;
using namespace rouleau::observe;
using namespace rouleau::test;
using Catch::Contains;

namespace {

/// Frame `i` of the run that all tests write: cells of unequal size from frame 4 on, fields in every third frame.
Snapshot frame(int i) { return small_snapshot(i, i % 3 == 1, i < 4 ? 32 : 40); }
constexpr int frames_in_all = 8;

void write_frames(FrameWriter& writer, int from, int to) {
  for (int i = from; i < to; ++i) writer.write(frame(i));
}

std::string attributes(hid_t object) {
  std::ostringstream text;
  const auto add = [](hid_t at, const char* name, const H5A_info_t*, void* out) -> herr_t {
    auto& stream = *static_cast<std::ostringstream*>(out);
    const hdf5::Handle attribute(H5Aopen(at, name, H5P_DEFAULT), H5Aclose);
    const hdf5::Handle type(H5Aget_type(attribute.id()), H5Tclose), space(H5Aget_space(attribute.id()), H5Sclose);
    stream << " @" << name << " size " << H5Tget_size(type.id()) << " class " << H5Tget_class(type.id()) << " of "
           << H5Sget_simple_extent_npoints(space.id()) << (H5Sget_simple_extent_type(space.id()) == H5S_SCALAR) << " ";
    if (H5Tis_variable_str(type.id()) > 0) {
      char* value = nullptr;
      if (H5Aread(attribute.id(), type.id(), static_cast<void*>(&value)) < 0) return -1;
      stream << value << " in " << H5Tget_cset(type.id());
      H5free_memory(value);
      return 0;
    }
    std::string value(H5Tget_size(type.id()) * static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())), 0);
    if (H5Aread(attribute.id(), type.id(), value.data()) < 0) return -1;
    for (const char byte : value) stream << int(byte) << ",";
    return 0;
  };
  REQUIRE(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &text) >= 0);
  return text.str();
}

std::string dataset(hid_t object) {
  std::ostringstream text;
  const hdf5::Handle type(H5Dget_type(object), H5Tclose), space(H5Dget_space(object), H5Sclose);
  const hdf5::Handle creation(H5Dget_create_plist(object), H5Pclose);
  std::array<hsize_t, 4> size{}, chunk{};
  const int rank = H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
  text << " class " << H5Tget_class(type.id()) << " size " << H5Tget_size(type.id()) << " layout "
       << H5Pget_layout(creation.id());
  if (H5Pget_layout(creation.id()) == H5D_CHUNKED) H5Pget_chunk(creation.id(), rank, chunk.data());
  for (int i = 0; i < rank; ++i) text << " " << size[std::size_t(i)] << "/" << chunk[std::size_t(i)];
  for (int i = 0; i < H5Pget_nfilters(creation.id()); ++i) {
    unsigned flags = 0, level = 0;
    std::size_t values = 1;
    text << " filter " << H5Pget_filter2(creation.id(), unsigned(i), &flags, &values, &level, 0, nullptr, nullptr)
         << ":" << level;
  }
  std::string bytes(H5Tget_size(type.id()) * static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())), 0);
  REQUIRE(H5Dread(object, type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) >= 0);
  text << " data";
  for (const char byte : bytes) text << " " << int(byte);
  return text.str();
}

/// Everything that a reader can see of a file, in whichever file it lies: groups, attributes, datasets with filters.
std::string content(const std::filesystem::path& path) {
  const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  REQUIRE(file.valid());
  std::ostringstream text;
  text << "/" << attributes(file.id()) << "\n";
  const auto visit = [](hid_t at, const char* name, const H5L_info_t*, void* out) -> herr_t {
    auto& stream = *static_cast<std::ostringstream*>(out);
    const hdf5::Handle object(H5Oopen(at, name, H5P_DEFAULT), H5Oclose);
    stream << name << attributes(object.id());
    if (H5Iget_type(object.id()) == H5I_DATASET) stream << dataset(object.id());
    stream << "\n";
    return 0;
  };
  for (const std::string group : {"/frames", "/topology"}) {
    for (const std::string& name : hdf5::File(path, hdf5::File::Mode::read).names(group)) {
      text << group << "/" << name;
      const hdf5::Handle member(H5Oopen(file.id(), (group + "/" + name).c_str(), H5P_DEFAULT), H5Oclose);
      text << attributes(member.id()) << "\n";
      REQUIRE(H5Lvisit(member.id(), H5_INDEX_NAME, H5_ITER_INC, visit, &text) >= 0);
    }
  }
  return text.str();
}

/// What a closed run's folder holds that has so many segments.
std::set<std::string> closed(std::size_t segments) {
  std::set<std::string> names{"frames.h5"};
  for (std::size_t k = 1; segments > 1 && k <= segments; ++k) names.insert(segment_name(k));
  return names;
}

std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

/// A run that was never stopped, and what its frames are.
struct Whole {
  ScratchFolder folder;
  std::string bytes, xdmf;
  Whole() {
    const auto file = folder.path() / "frames.h5";
    FrameWriter writer(file, small_scene());
    write_frames(writer, 0, frames_in_all);
    writer.close();
    bytes = content(file);
    xdmf = writer.xdmf();
  }
};

/// A run that sealed its frames behind each of `seals` and was then killed, or closed.
struct Interrupted {
  ScratchFolder folder;
  std::filesystem::path file = folder.path() / "frames.h5";
  std::vector<FramesSaved> saved;  ///< what each checkpoint holds
  Interrupted(const std::vector<int>& seals, int end, bool closed) {
    FrameWriter writer(file, small_scene());
    int from = 0;
    for (const int seal : seals) {
      write_frames(writer, from, seal);
      saved.push_back(writer.seal());
      from = seal;
    }
    write_frames(writer, from, end);
    if (closed) writer.close();
  }
  /// Goes on from a checkpoint to the end and compares with the run that was never stopped.
  void check_resumed(const FramesSaved& from, const Whole& whole) const {
    FrameWriter writer(file, small_scene(), from);
    write_frames(writer, static_cast<int>(from.frames()), frames_in_all);
    writer.close();
    CHECK(content(file) == whole.bytes);
    CHECK(writer.xdmf() == whole.xdmf);
    const std::size_t more = from.frames() < frames_in_all ? 1 : 0;
    CHECK(names_in(folder.path()) == closed(from.segments.size() + more));
  }
};

/// `bytes` with one bit turned. Without write_file's care, which takes time thousands of times over.
void flip(const std::filesystem::path& file, std::string bytes, std::size_t at) {
  bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
  std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace

TEST_CASE("sealing once behind the last frame leaves the bytes of a run that was never sealed") {
  const Whole whole;
  const Interrupted run({frames_in_all}, frames_in_all, true);
  CHECK(read_text(run.file) == read_text(whole.folder.path() / "frames.h5"));
  CHECK(names_in(run.folder.path()) == std::set<std::string>{"frames.h5"});
}

TEST_CASE("what frames.h5 holds does not depend on the number of segments") {
  const Whole whole;
  for (const auto& seals : std::vector<std::vector<int>>{{1}, {4}, {5}, {1, 2, 3, 4, 5, 6, 7}, {2, 5, 8}}) {
    CAPTURE(seals);
    const Interrupted run(seals, frames_in_all, true);
    CHECK(content(run.file) == whole.bytes);
    const std::size_t more = seals.back() < frames_in_all ? 1 : 0;
    CHECK(names_in(run.folder.path()) == closed(seals.size() + more));
  }
}

TEST_CASE("no segment is made without frames, and a run without frames has a frames.h5 all the same") {
  const ScratchFolder folder;
  const auto file = folder.path() / "frames.h5";
  FrameWriter writer(file, small_scene());
  CHECK(writer.seal().segments.empty());
  CHECK(names_in(folder.path()).empty());
  writer.write(frame(0));
  const auto saved = writer.seal();
  CHECK(writer.seal() == saved);
  CHECK(saved.segments.size() == 1);
  CHECK(saved.frames() == 1);
  CHECK(saved.segments[0].bytes == std::filesystem::file_size(folder.path() / "frames-0001.h5"));
  CHECK(saved.segments[0].checksum == checksum_of(folder.path() / "frames-0001.h5").value());

  const ScratchFolder empty;
  FrameWriter none(empty.path() / "frames.h5", small_scene());
  none.close();
  CHECK(FrameReader(empty.path() / "frames.h5").frames() == 0);
  CHECK(FrameReader(empty.path() / "frames.h5").size()[0] == 20e-6);
}

TEST_CASE("a run that was killed goes on behind any of its checkpoints to the same frames") {
  const Whole whole;
  for (std::size_t checkpoint = 0; checkpoint < 3; ++checkpoint) {
    CAPTURE(checkpoint);
    const Interrupted run({1, 3, 5}, 7, false);
    // What was open when the program was killed may be anything.
    write_file(run.folder.path() / "frames-0004.h5", "damaged");
    write_file(run.folder.path() / ".frames.h5.123.partial", "damaged");
    run.check_resumed(run.saved[checkpoint], whole);
  }
  const Interrupted never({}, 2, false);
  never.check_resumed({}, whole);
}

TEST_CASE("a run that was closed goes on behind any of its checkpoints, also behind an earlier one") {
  const Whole whole;
  for (const auto& seals : std::vector<std::vector<int>>{{3}, {1, 3}, {1, 3, 6}})
    for (std::size_t checkpoint = 0; checkpoint < seals.size(); ++checkpoint)
      for (const int end : {seals.back(), 7}) {
        CAPTURE(seals, checkpoint, end);
        const Interrupted run(seals, end, true);
        run.check_resumed(run.saved[checkpoint], whole);
      }
}

TEST_CASE("a run goes on that was killed before, while or after frames.h5 was made") {
  const Whole whole;
  for (const auto& seals : std::vector<std::vector<int>>{{5}, {1, 3, 5}}) {
    CAPTURE(seals);
    const Interrupted before(seals, 5, false), after(seals, 5, true);
    write_file(before.folder.path() / ".frames.h5.1.partial", read_text(after.file).substr(0, 1000));
    before.check_resumed(before.saved.back(), whole);
    after.check_resumed(after.saved.back(), whole);
  }
}

TEST_CASE("frames.h5 leads to its segments wherever the run's folder is moved") {
  const Whole whole;
  const Interrupted run({1, 3, 5}, frames_in_all, true);
  const ScratchFolder elsewhere;
  std::filesystem::copy(run.folder.path(), elsewhere.path() / "moved");
  for (const auto& name : names_in(run.folder.path())) std::filesystem::remove(run.folder.path() / name);
  CHECK(content(elsewhere.path() / "moved" / "frames.h5") == whole.bytes);
}

TEST_CASE("a run that is resumed, killed, closed and resumed again still has the same frames") {
  const Whole whole;
  const Interrupted run({1, 3}, 5, true);
  FramesSaved second;
  {
    // Behind the first checkpoint: there are more frames than that, and another second segment is made.
    FrameWriter writer(run.file, small_scene(), run.saved[0]);
    write_frames(writer, 1, 2);
    second = writer.seal();
    write_frames(writer, 2, 4);
  }
  CHECK(names_in(run.folder.path()) == std::set<std::string>{"frames-0001.h5", "frames-0002.h5", "frames-0003.h5"});
  CHECK(second.frames() == 2);
  SECTION("resumed from the files as they were left") { run.check_resumed(second, whole); }
  SECTION("resumed behind a further stop") {
    FramesSaved third;
    {
      FrameWriter writer(run.file, small_scene(), second);
      write_frames(writer, 2, 6);
      third = writer.seal();
      writer.close();
    }
    CHECK(third.segments.size() == 3);
    CHECK(FrameReader(run.file).frames() == 6);
    SECTION("with the last checkpoint") { run.check_resumed(third, whole); }
    SECTION("with the one before") { run.check_resumed(second, whole); }
  }
  SECTION("closed without a further frame, it holds as many as the checkpoint says") {
    {
      FrameWriter writer(run.file, small_scene(), run.saved[0]);
      writer.close();
    }
    CHECK(FrameReader(run.file).frames() == 1);
    run.check_resumed(run.saved[0], whole);
  }
}

TEST_CASE("a flipped bit in a sealed segment is found, wherever it is") {
  const Interrupted run({2, 4}, 5, false);
  const auto file = run.folder.path() / "frames-0002.h5";
  const std::string bytes = read_text(file);
  CHECK_THROWS_WITH((flip(file, bytes, 0), FrameWriter(run.file, small_scene(), run.saved.back())),
                    Contains("frames-0002.h5") && Contains("has been changed since the checkpoint was written") &&
                        Contains("put back the file"));
  std::size_t missed = 0;
  for (std::size_t at = 0; at < bytes.size(); at += 61) {
    flip(file, bytes, at);
    try {
      require_segments(run.file, run.saved.back());
      ++missed;
    } catch (const Error& error) {
      CHECK(error.cause() == Cause::input_output);
    }
  }
  CHECK(missed == 0);
  write_file(file, bytes);
  CHECK_NOTHROW(require_segments(run.file, run.saved.back()));
}

TEST_CASE("a flipped bit in a frames.h5 that is the only segment is found, wherever it is") {
  const Interrupted run({4}, 4, true);
  const std::string bytes = read_text(run.file);
  std::size_t missed = 0;
  for (std::size_t at = 0; at < bytes.size(); at += 61) {
    flip(run.file, bytes, at);
    try {
      require_segments(run.file, run.saved.back());
      ++missed;
    } catch (const Error& error) {
      CHECK(error.place().file == run.file.string());
    }
  }
  CHECK(missed == 0);
  write_file(run.file, bytes);
  CHECK_NOTHROW(require_segments(run.file, run.saved.back()));
}

TEST_CASE("a truncated or missing segment is named with what it had") {
  const Interrupted run({2, 4}, 5, false);
  const auto first = run.folder.path() / "frames-0001.h5";
  const std::string bytes = read_text(first);
  write_file(first, bytes.substr(0, 1000));
  CHECK_THROWS_WITH(FrameWriter(run.file, small_scene(), run.saved.back()),
                    Contains("frames-0001.h5") && Contains("has 1000 bytes and had " + std::to_string(bytes.size())));
  std::filesystem::remove(first);
  CHECK_THROWS_WITH(FrameWriter(run.file, small_scene(), run.saved.back()),
                    Contains("frames-0001.h5") && Contains("is missing") && Contains("2 frames"));
  // Nothing is removed before all is found to be there.
  CHECK(names_in(run.folder.path()) == std::set<std::string>{"frames-0002.h5", "frames-0003.h5"});
}

TEST_CASE("frames.h5 of another run does not pass for this one's") {
  const Interrupted run({2}, 2, true), other({2}, 2, true);
  std::string bytes = read_text(other.file);
  bytes.back() ^= 1;
  write_file(run.file, bytes);
  CHECK_THROWS_WITH(FrameWriter(run.file, small_scene(), run.saved.back()),
                    Contains("frames.h5") && Contains("from another run"));
}

TEST_CASE("frames.h5 that cannot be made leaves the segments") {
  const Whole whole;
  const Interrupted run({2}, 2, false);
  {
    FrameWriter writer(run.file, small_scene(), run.saved.back());
    write_frames(writer, 2, frames_in_all);
    const auto saved = writer.seal();
    std::filesystem::create_directories(run.file / "in the way");
    CHECK_THROWS_WITH(writer.close(), Contains("frames.h5") && Contains("cannot be written"));
    CHECK(names_in(run.folder.path()) == std::set<std::string>{"frames.h5", "frames-0001.h5", "frames-0002.h5"});
    std::filesystem::remove_all(run.file);
    run.check_resumed(saved, whole);
  }
}

TEST_CASE("what a checkpoint keeps of the frames survives being text") {
  const FramesSaved saved{{{12, 34567, 0x0123456789abcdef}, {1, 5, 0xffffffffffffffff}}};
  const nlohmann::json json = saved;
  CHECK(json.dump().find("\"checksum\":\"0123456789abcdef\"") != std::string::npos);
  CHECK(nlohmann::json::parse(json.dump()).get<FramesSaved>() == saved);
  CHECK(saved.frames() == 13);
  CHECK_THROWS_AS(
      nlohmann::json::parse(R"({"segments": [{"frames": 1, "bytes": 2, "checksum": "12"}]})").get<FramesSaved>(),
      std::invalid_argument);
  CHECK_THROWS_AS(nlohmann::json::parse(R"({"segments": [{"frames": 1}]})").get<FramesSaved>(),
                  nlohmann::json::exception);
}

TEST_CASE("names of segments are read back as they are made, and no other name is one") {
  for (const std::size_t number : {std::size_t{1}, std::size_t{42}, std::size_t{9999}, std::size_t{10000}})
    CHECK(segment_number(segment_name(number)) == number);
  for (const char* name : {"frames.h5", "frames-.h5", "frames-1.h5", "frames-00001.h5", "frames-0001.h5x",
                           "frames-001x.h5", "xframes-0001.h5", "frames--001.h5"})
    CHECK_FALSE(segment_number(name));
}

TEST_CASE("the checksum of a file is XXH3 as published") {
  // Of the empty input and of the letters, as xxhsum 0.8.1 -H3 prints them.
  const ScratchFolder folder;
  write_file(folder.path() / "empty", "");
  CHECK(checksum_text(checksum_of(folder.path() / "empty").value()) == "2d06800538d394c2");
  CHECK_THROWS_WITH(checksum_of(folder.path() / "none").value(), Contains("none") && Contains("cannot be read"));
}

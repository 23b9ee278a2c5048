// checkpoint.h5: what goes in comes out to the last bit, and damage is found wherever it is.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>

#include "files/checkpoint_file.hpp"
#include "files/file.hpp"
#include "unit/run_fixture.hpp"

using namespace rouleau;
using namespace rouleau::files;
using namespace rouleau::test;
using Catch::Contains;

namespace {

std::uint64_t bits(double value) {
  std::uint64_t result;
  std::memcpy(&result, &value, sizeof result);
  return result;
}

const std::vector<double> awkward{0.0,
                                  -0.0,
                                  1.0 / 3,
                                  -std::numeric_limits<double>::denorm_min(),
                                  std::numeric_limits<double>::max(),
                                  std::numeric_limits<double>::infinity()};

const std::vector<double> floats{1.0f / 3, -1e-45f, 2, 3, 4, 5};

/// A checkpoint that holds `step`; it becomes the folder's last one.
void write_checkpoint(const std::filesystem::path& folder, long step) {
  CheckpointWriter writer(folder);
  writer.facts({{"step", step}});
  writer.state({{"values", awkward}, {"undefined", std::nan("")}});
  writer.begin_array("/group/doubles", awkward.size());
  writer.append(awkward);
  writer.begin_array("/floats", 2, 3, true);
  writer.append(floats);
  writer.begin_array("/none", 0);
  writer.finish();
  writer.take_place();
}

std::string refusal(const std::filesystem::path& file) {
  try {
    CheckpointReader reader(file);
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::input_output);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a checkpoint gives back every number to its last bit, in arrays and in its state") {
  const ScratchFolder folder;
  write_checkpoint(folder.path(), 7);
  const CheckpointReader reader(checkpoint_file(folder.path()));
  CHECK(reader.facts() == nlohmann::json{{"step", 7}});
  const auto values = reader.state().at("values").get<std::vector<double>>();
  const auto array = reader.array("/group/doubles");
  for (std::size_t i = 0; i < awkward.size(); ++i) {
    CHECK(bits(values[i]) == bits(awkward[i]));
    CHECK(bits(array[i]) == bits(awkward[i]));
  }
  CHECK(std::isnan(reader.state().at("undefined").get<double>()));
  std::vector<double> all(6), some(2);
  reader.block("/floats", {3, 2}, {0, 0}, {3, 2}, all.data());
  CHECK(all == floats);
  reader.block("/floats", {3, 2}, {1, 0}, {2, 2}, some.data());
  CHECK(some == std::vector<double>{-1e-45f, 4});
  CHECK(reader.array("/none").empty());
  CHECK_THROWS_WITH(reader.block("/floats", {2, 3}, {0, 0}, {1, 1}, all.data()), Contains("another shape"));
  std::vector<double> five(5);
  CHECK_THROWS_WITH(reader.array("/floats", 5, five.data()), Contains("/floats holds 6 values instead of 5"));
}

TEST_CASE("the checkpoint before the last is kept, and nothing else is left") {
  const ScratchFolder folder;
  for (const long step : {1, 2, 3}) write_checkpoint(folder.path(), step);
  CHECK(CheckpointReader(checkpoint_file(folder.path())).facts().at("step") == 3);
  CHECK(CheckpointReader(previous_checkpoint_file(folder.path())).facts().at("step") == 2);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 2);
  CheckpointReader(previous_checkpoint_file(folder.path())).take_place(folder.path());
  CHECK(CheckpointReader(checkpoint_file(folder.path())).facts().at("step") == 2);
}

TEST_CASE("a checkpoint that was not finished, or did not take its place, leaves the one before and no file") {
  const ScratchFolder folder;
  write_checkpoint(folder.path(), 1);
  {
    CheckpointWriter abandoned(folder.path());
    abandoned.facts({{"step", 2}});
  }
  {
    CheckpointWriter unsound(folder.path());
    unsound.facts({{"step", 3}});
    unsound.state({});
    unsound.finish();
  }
  CHECK(CheckpointReader(checkpoint_file(folder.path())).facts().at("step") == 1);
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("a flipped bit in a checkpoint is found, wherever it is, and so is a missing end") {
  const ScratchFolder folder;
  write_checkpoint(folder.path(), 1);
  const auto file = checkpoint_file(folder.path());
  const std::string whole = read_text(file);
  const auto seed = std::random_device{}();
  CAPTURE(seed);
  std::mt19937 random(seed);
  const std::size_t words = whole.find("HDF5 from");  // what follows in the head is for readers
  std::size_t missed = 0;
  for (std::size_t at = 0; at < whole.size(); at += at < words ? 1 : 37) {
    if (at >= words && at < 512) continue;
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << (random() % 8)));
    write_file(file, flipped);
    try {
      CheckpointReader reader(file);
      // A blank for another blank, or a leading zero, does not change what the head says.
      if (whole[at] != '\n' && whole[at] != ' ') ++missed;
    } catch (const Error&) {
    }
  }
  CHECK(missed == 0);
  for (const std::size_t size : {std::size_t{0}, std::size_t{100}, std::size_t{512}, whole.size() - 1}) {
    write_file(file, whole.substr(0, size));
    CHECK_THAT(refusal(file), Contains("checkpoint.h5") && Contains("is damaged"));
  }
}

TEST_CASE("a checkpoint of another format, earlier or later, is refused with what can read it") {
  const std::string format = GENERATE("rouleau checkpoint 1", "rouleau checkpoint 3");
  const ScratchFolder folder;
  write_checkpoint(folder.path(), 1);
  const auto file = checkpoint_file(folder.path());
  std::string other = read_text(file);
  other.replace(0, format.size(), format);
  write_file(file, other);
  CHECK_THROWS_WITH(CheckpointReader(file), Contains(format) && Contains("go on with that version"));
}

#include "report/draw/frame_choice.hpp"

#include <catch2/catch.hpp>

#include "base/error.hpp"

using namespace rouleau;
using namespace rouleau::report;
using Catch::Contains;
using Chosen = std::vector<std::size_t>;

namespace {

/// Three outputs at rest, then strains 0, 0.25, ..., each a little late as the steps come.
OutputTimes rest_and_shear() {
  OutputTimes outputs{{0, 0, 0}, {0, 0.5, 1}};
  for (int i = 1; i <= 60; ++i) {
    outputs.strain.push_back(0.25 * i + 1e-4);
    outputs.time_s.push_back(1 + 0.0125 * i);
  }
  return outputs;
}

std::string refusal(const OutputTimes& outputs, const std::vector<double>& strains) {
  try {
    outputs_at(outputs, strains);
  } catch (const Error& error) {
    CHECK(error.cause() == Cause::bad_input);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a strain is drawn at the nearest output, strain 0 where the shear begins") {
  CHECK(outputs_at(rest_and_shear(), {0, 5, 10}) == Chosen{2, 22, 42});
  CHECK(outputs_at(rest_and_shear(), {10, 0, 10.05}) == Chosen{2, 42});
  CHECK(outputs_at(rest_and_shear(), {15}) == Chosen{62});
}

TEST_CASE("a strain that the run did not reach is refused with those it has") {
  CHECK_THAT(refusal(rest_and_shear(), {0, 40}), Contains("no strain 40") && Contains("from 0 to 15"));
  CHECK(refusal(rest_and_shear(), {15.1}).empty());  // less than half an output away
  CHECK_THAT(refusal({{0, 0}, {0, 1}}, {0}), Contains("does not grow"));
}

TEST_CASE("without wishes frames lie evenly from the first output to the last") {
  CHECK(even_outputs(rest_and_shear(), 6) == Chosen{2, 14, 26, 38, 50, 62});
  CHECK(even_outputs({{0, 0, 0, 0, 0}, {0, 1, 2, 3, 4}}, 3) == Chosen{0, 2, 4});
  CHECK(even_outputs({{0}, {0}}, 6) == Chosen{0});
  CHECK(even_outputs({}, 6).empty());
}

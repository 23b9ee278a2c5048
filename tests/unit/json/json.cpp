#include "json/json.hpp"

#include <catch2/catch.hpp>
#include <cstdint>
#include <limits>
#include <vector>

using Json = nlohmann::json;

TEST_CASE("Whole numbers are read from whole numbers that fit") {
  CHECK(Json(3).get<int>() == 3);
  CHECK(Json(-3).get<long>() == -3);
  CHECK(Json(3U).get<std::int8_t>() == 3);
  CHECK(Json(std::numeric_limits<std::uint64_t>::max()).get<std::uint64_t>() == ~std::uint64_t{0});
  CHECK(Json(std::numeric_limits<std::int64_t>::min()).get<std::int64_t>() == INT64_MIN);
  CHECK(Json(true).get<bool>());
  CHECK(Json(3).get<double>() == 3);

  // What casts give nonsense for, or undefined behaviour.
  for (const Json& wrong : {Json(1.7e308), Json(-1e300), Json(1.5), Json(3.0), Json(INFINITY), Json(NAN)}) {
    INFO(wrong.dump());
    CHECK_THROWS_AS(wrong.get<int>(), Json::out_of_range);
    CHECK_THROWS_AS(wrong.get<std::int64_t>(), Json::out_of_range);
    CHECK_THROWS_AS(wrong.get<std::uint64_t>(), Json::out_of_range);
    CHECK_THROWS_AS(Json::array({wrong}).get<std::vector<long>>(), Json::out_of_range);
    CHECK_THROWS_AS(Json::object({{"steps", wrong}}).value("steps", 0), Json::out_of_range);
  }
  CHECK_THROWS_AS(Json(5'000'000'000).get<int>(), Json::out_of_range);
  CHECK_THROWS_AS(Json(5'000'000'000U).get<std::int32_t>(), Json::out_of_range);
  CHECK_THROWS_AS(Json(-1).get<std::size_t>(), Json::out_of_range);
  CHECK_THROWS_AS(Json(std::numeric_limits<std::uint64_t>::max()).get<std::int64_t>(), Json::out_of_range);
  CHECK_THROWS_AS(Json("3").get<int>(), Json::type_error);
  CHECK_THROWS_AS(Json().get<int>(), Json::type_error);
}

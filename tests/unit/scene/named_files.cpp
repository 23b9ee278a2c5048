// A file that a scene names is part of it.
#include "scene/named_files.hpp"

#include <catch2/catch.hpp>

using rouleau::scene::entries_with_files;

TEST_CASE("files are found wherever a scene names one, but not in what is for readers alone") {
  const auto scene = nlohmann::json::parse(R"({
    "cell_types": {"a": {"shape": {"mesh": {"file": "a.off", "unit": "1 um"}}}, "file": {"shape": {"sphere": {}}},
                   "b/c": {"stress_free": {"mesh": {"file": "b.ply"}}}},
    "cells": [{"type": "a", "at": [1, 2]}, {"file": "cells.csv"}],
    "domain": {"obstacles": [{"union": [{"image": {"file": "mask.png"}}]},
      {"image": {"file": ["a.png", "b.png"]}}, {"image": {"file": []}}]},
    "notes": {"file": "notes.txt"}, "expected": {"file": "right.csv"}, "title": "file"})");
  CHECK(entries_with_files(scene) ==
        std::vector<std::string>{"/cell_types/a/shape/mesh", "/cell_types/b~1c/stress_free/mesh", "/cells/1",
                                 "/domain/obstacles/0/union/0/image", "/domain/obstacles/1/image"});
  CHECK(entries_with_files(nlohmann::json::parse(R"({"cells": {"file": "c.csv"}})")) ==
        std::vector<std::string>{"/cells"});
  CHECK(entries_with_files(nlohmann::json::parse(R"([{"file": "c.csv"}])")).empty());
}

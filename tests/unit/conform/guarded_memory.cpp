// Guarded arrays: every byte of theirs can be used, and addresses around them are described.
#include "conform/guarded_memory.hpp"

#include <catch2/catch.hpp>
#include <cstring>
#include <string>

namespace {

using rouleau::conform::GuardedArray;

std::string description(const void* address, bool write) {
  char text[256] = "nothing";
  GuardedArray::describe(address, write, text, sizeof text);
  return text;
}

}  // namespace

TEST_CASE("all bytes of a guarded array can be written, and its neighbours are described as outside") {
  for (const auto flush : {GuardedArray::Flush::behind, GuardedArray::Flush::before}) {
    for (const std::size_t bytes : {0UL, 8UL, 4096UL, 5000UL}) {
      CAPTURE(bytes);
      GuardedArray array("the input x", bytes, flush);
      std::memset(array.data(), 1, bytes);
      CHECK(description(array.data() + bytes, true) == "wrote 0 bytes behind the end of the input x");
      CHECK(description(array.data() - 8, false) == "read 8 bytes before the input x");
    }
  }
}

TEST_CASE("what is forbidden inside an array is described, and what lies in none is not") {
  GuardedArray array("the input x", 80, GuardedArray::Flush::behind);
  array.make_read_only();
  CHECK(description(array.data() + 8, true) == "wrote to the input x");
  array.make_unreadable();
  CHECK(description(array.data() + 8, false) == "touched the input x");
  int elsewhere = 0;
  CHECK(description(&elsewhere, true) == "nothing");
}

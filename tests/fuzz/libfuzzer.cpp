// What libFuzzer calls: the target, and the mutator where the target's bytes are JSON.
#include "json_mutator.hpp"
#include "target.hpp"

using rouleau::fuzz::JsonMutator;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace {

/// Null for bytes that are no JSON, and with ROULEAU_FUZZ_BYTES set: to see what the mutator is worth.
const JsonMutator* mutator() {
  static const auto made = []() -> std::unique_ptr<JsonMutator> {
    const auto form = fuzz_form();
    if (form.schema == nullptr || std::getenv("ROULEAU_FUZZ_BYTES") != nullptr) return nullptr;
    return std::make_unique<JsonMutator>(*form.schema, form.words);
  }();
  return made.get();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz_target({reinterpret_cast<const char*>(data), size});
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  return mutator() == nullptr ? LLVMFuzzerMutate(data, size, most) : mutator()->mutate(data, size, most, seed);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* first, std::size_t first_size,
                                                 const std::uint8_t* second, std::size_t second_size, std::uint8_t* out,
                                                 std::size_t most, unsigned seed) {
  return mutator() == nullptr ? 0 : JsonMutator::cross(first, first_size, second, second_size, out, most, seed);
}

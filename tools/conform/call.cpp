#include "call.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cfenv>
#include <cmath>
#include <cstring>
#include <memory>
#include <rouleau/d3q19.hpp>

#include "base/foreign_call.hpp"
#include "base/text.hpp"
#include "guarded_memory.hpp"
#include "plugin/quantities.hpp"

namespace rouleau::conform {

namespace {

constexpr std::uint64_t unwritten_bits = 0x7ff8'0bad'0bad'0badU;
constexpr std::uint32_t unwritten_bits_single = 0x7fc0'0badU;
constexpr std::uint64_t signalling_bits = 0x7ff0'0000'0000'0001U;
constexpr std::uint32_t signalling_bits_single = 0x7f80'0001U;

template <class T>
T from_bits(std::uint64_t wide, std::uint32_t narrow) {
  if constexpr (sizeof(T) == 8)
    return std::bit_cast<T>(wide);
  else
    return std::bit_cast<T>(narrow);
}

bool untouched(double value) { return std::bit_cast<std::uint64_t>(value) == unwritten_bits; }
bool untouched(float value) { return std::bit_cast<std::uint32_t>(value) == unwritten_bits_single; }

/// NaNs are alike.
bool same_bits(double x, double y) {
  return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y) || (std::isnan(x) && std::isnan(y));
}

/// The memory of one compute call.
class Memory {
 public:
  explicit Memory(const Call& call) : guard_(call.guard), read_only_(call.read_only) {}

  /// An array at `offset` bytes from a cache line or, where the call says so, flush with an inaccessible page.
  std::byte* array(const std::string& name, std::size_t bytes, std::size_t offset) {
    if (guard_ == Guard::behind) return guarded(name, bytes, GuardedArray::Flush::behind).data();
    if (guard_ == Guard::before) return guarded(name, bytes, GuardedArray::Flush::before).data();
    return plain(bytes, offset);
  }
  /// The same for an input, which `fill` writes before it is protected.
  template <class Fill>
  std::byte* input(const std::string& name, std::size_t bytes, std::size_t offset, const Fill& fill) {
    std::byte* place = nullptr;
    if (read_only_) {
      GuardedArray& protected_array = guarded(name, bytes, GuardedArray::Flush::before);
      fill(place = protected_array.data());
      protected_array.make_read_only();
    } else {
      fill(place = array(name, bytes, offset));
    }
    return place;
  }
  std::byte* unreadable(const std::string& name, std::size_t bytes) {
    GuardedArray& array = guarded(name, bytes, GuardedArray::Flush::behind);
    array.make_unreadable();
    return array.data();
  }
  /// A struct or a list of pointers.
  std::byte* part_of_block(const std::string& name, std::size_t bytes) {
    return guard_ == Guard::structs ? guarded(name, bytes, GuardedArray::Flush::behind).data() : plain(bytes, 0);
  }

 private:
  GuardedArray& guarded(const std::string& name, std::size_t bytes, GuardedArray::Flush flush) {
    return *guarded_.emplace_back(std::make_unique<GuardedArray>(name, bytes, flush));
  }
  std::byte* plain(std::size_t bytes, std::size_t offset) {
    // A margin on both sides: what a faulty model writes there is for the check of bounds to find.
    constexpr std::size_t margin = 256;
    auto& block = plain_.emplace_back(new std::byte[bytes + offset + 2 * margin + 64]);
    const auto address = reinterpret_cast<std::uintptr_t>(block.get()) + margin;
    return block.get() + margin + (64 - address % 64) % 64 + offset;
  }

  Guard guard_;
  bool read_only_;
  std::vector<std::unique_ptr<std::byte[]>> plain_;
  std::vector<std::unique_ptr<GuardedArray>> guarded_;
};

/// Where the arrays of a call lie, by name; what is missing is NULL.
template <class T>
struct Arrays {
  std::map<std::string, T*> in, out;

  const T* input(const std::string& name, std::size_t first) const {
    const auto found = in.find(name);
    return found == in.end() ? nullptr : found->second + first;
  }
  T* output(const std::string& name, std::size_t first) const {
    const auto found = out.find(name);
    return found == out.end() ? nullptr : found->second + first;
  }
};

/// The input that an output may lie over.
std::string overlaid(const std::string& output, Outputs place) {
  const std::size_t dot = output.find('.') + 1;
  if (output.starts_with("velocity.")) return "force." + output.substr(dot);
  if (!output.starts_with("populations.") || place != Outputs::streamed) return output;
  return output.substr(0, dot) + std::to_string(d3q19::opposite[std::stoul(output.substr(dot))]);  // those of D2Q9, too
}

template <class T>
Arrays<T> place(Memory& memory, const Subject& subject, const Values& inputs, const Call& call, std::size_t count) {
  Arrays<T> arrays;
  const std::size_t bytes = count * sizeof(T), offset = call.offset * sizeof(T);
  const auto fill = [&](T* to, T value) { std::fill_n(to, count, value); };
  for (const std::string& name : subject.input_arrays()) {
    if (call.absent.contains(name.substr(0, name.find('.')))) continue;
    const auto& values = inputs.at(name);
    arrays.in[name] = reinterpret_cast<T*>(memory.input("the input " + name, bytes, offset, [&](std::byte* place) {
      for (std::size_t i = 0; i < count; ++i) reinterpret_cast<T*>(place)[i] = static_cast<T>(values[i]);
    }));
  }
  const auto kind = subject.manifest().kind;
  for (const std::string& quantity : plugin::inputs_of(kind, subject.manifest().dimension())) {
    if (subject.manifest().needs_input(quantity) || call.undeclared == Undeclared::null) continue;
    for (const std::string& name : arrays_of(subject, quantity)) {
      const std::string words = "the input " + name + ", which its manifest does not declare";
      auto* array =
          reinterpret_cast<T*>(call.undeclared == Undeclared::unreadable ? memory.unreadable(words, bytes)
                                                                         : memory.array(words, bytes, offset));
      if (call.undeclared == Undeclared::signalling_nan) {
        fill(array, from_bits<T>(signalling_bits, signalling_bits_single));
      }
      arrays.in[name] = array;
    }
  }
  for (const std::string& name : subject.output_arrays()) {
    if (call.outputs && !call.outputs->contains(name)) continue;
    const std::string over = overlaid(name, call.place);
    if (call.place != Outputs::apart && arrays.in.contains(over)) {
      arrays.out[name] = arrays.in[over];
      continue;
    }
    auto* array = reinterpret_cast<T*>(memory.array("the output " + name, bytes, offset));
    fill(array, from_bits<T>(unwritten_bits, unwritten_bits_single));
    arrays.out[name] = array;
  }
  return arrays;
}

/// A C array of pointers; null when the first of them is.
template <class T>
T** table(Memory& memory, const std::string& name, const std::vector<T*>& pointers) {
  if (pointers.empty() || pointers.front() == nullptr) return nullptr;
  const std::size_t bytes = pointers.size() * sizeof(T*);
  auto** array = reinterpret_cast<T**>(memory.part_of_block("the list of pointers " + name, bytes));
  std::copy(pointers.begin(), pointers.end(), array);
  return array;
}

template <class T>
struct Tables {
  Memory& memory;
  const Arrays<T>& arrays;
  std::size_t first;

  const T** in(const std::string& name, std::size_t count) const {
    std::vector<const T*> pointers;
    for (std::size_t k = 0; k < count; ++k) pointers.push_back(arrays.input(name + '.' + std::to_string(k), first));
    return table(memory, name, pointers);
  }
  T** out(const std::string& name, std::size_t count) const {
    std::vector<T*> pointers;
    for (std::size_t k = 0; k < count; ++k) pointers.push_back(arrays.output(name + '.' + std::to_string(k), first));
    return table(memory, "new " + name, pointers);
  }
};

template <class Block, class T>
Block collision_block(const Tables<T>& tables, int dimension) {
  const std::size_t velocities = dimension == 2 ? 9 : 19, components = static_cast<std::size_t>(dimension);
  Block block{};
  block.in = tables.in("populations", velocities);
  block.out = tables.out("populations", velocities);
  block.force = tables.in("force", components);
  block.relaxation_rate = tables.arrays.input("relaxation_rate", tables.first);
  block.velocity = tables.out("velocity", components);
  return block;
}

template <class Block>
struct Member {
  const char* name;
  const double* Block::*in;
  double* Block::*out;
};
using M = rouleau_membrane_block;
constexpr std::array membrane_members = {Member<M>{"stretch", &M::stretch, nullptr},
                                         Member<M>{"stretch_rate", &M::stretch_rate, nullptr},
                                         Member<M>{"curvature", &M::curvature, nullptr},
                                         Member<M>{"rest_curvature", &M::rest_curvature, nullptr},
                                         Member<M>{"area", &M::area, nullptr},
                                         Member<M>{"rest_area", &M::rest_area, nullptr},
                                         Member<M>{"perimeter", &M::perimeter, nullptr},
                                         Member<M>{"rest_perimeter", &M::rest_perimeter, nullptr},
                                         Member<M>{"invariant_1", &M::invariant_1, nullptr},
                                         Member<M>{"invariant_2", &M::invariant_2, nullptr},
                                         Member<M>{"area_ratio", &M::area_ratio, nullptr},
                                         Member<M>{"volume", &M::volume, nullptr},
                                         Member<M>{"rest_volume", &M::rest_volume, nullptr},
                                         Member<M>{"surface_area", &M::surface_area, nullptr},
                                         Member<M>{"rest_surface_area", &M::rest_surface_area, nullptr},
                                         Member<M>{"tension", nullptr, &M::tension},
                                         Member<M>{"moment", nullptr, &M::moment},
                                         Member<M>{"pressure", nullptr, &M::pressure},
                                         Member<M>{"perimeter_tension", nullptr, &M::perimeter_tension},
                                         Member<M>{"energy", nullptr, &M::energy},
                                         Member<M>{"tension_by_stretch", nullptr, &M::tension_by_stretch},
                                         Member<M>{"tension_by_rate", nullptr, &M::tension_by_rate},
                                         Member<M>{"moment_by_curvature", nullptr, &M::moment_by_curvature},
                                         Member<M>{"stress_1", nullptr, &M::stress_1},
                                         Member<M>{"stress_2", nullptr, &M::stress_2},
                                         Member<M>{"area_tension", nullptr, &M::area_tension},
                                         Member<M>{"surface_tension", nullptr, &M::surface_tension},
                                         Member<M>{"shear_viscosity", nullptr, &M::shear_viscosity},
                                         Member<M>{"area_viscosity", nullptr, &M::area_viscosity},
                                         Member<M>{"stress_1_by_1", nullptr, &M::stress_1_by_1},
                                         Member<M>{"stress_1_by_2", nullptr, &M::stress_1_by_2},
                                         Member<M>{"stress_2_by_2", nullptr, &M::stress_2_by_2},
                                         Member<M>{"area_tension_by_ratio", nullptr, &M::area_tension_by_ratio}};
using I = rouleau_interaction_block;
constexpr std::array interaction_members = {Member<I>{"distance", &I::distance, nullptr},
                                            Member<I>{"normal_velocity", &I::normal_velocity, nullptr},
                                            Member<I>{"tangential_velocity", &I::tangential_velocity, nullptr},
                                            Member<I>{"sliding_speed", &I::sliding_speed, nullptr},
                                            Member<I>{"energy", nullptr, &I::energy},
                                            Member<I>{"force", nullptr, &I::force},
                                            Member<I>{"force_by_distance", nullptr, &I::force_by_distance}};

template <class Block, std::size_t n>
Block element_block(const Tables<double>& tables, const std::array<Member<Block>, n>& members, std::size_t states,
                    double time_step) {
  Block block{};
  block.time_step = time_step;
  for (const auto& member : members) {
    if (member.in != nullptr)
      block.*member.in = tables.arrays.input(member.name, tables.first);
    else
      block.*member.out = tables.arrays.output(member.name, tables.first);
  }
  block.state = tables.in("state", states);
  block.new_state = tables.out("state", states);
  return block;
}

/// Calls with the floating-point environment and exceptions kept from spreading. The block lies where arrays lie, so
/// that reading past the fields of interface 1.0 hits a guard.
template <class Block>
void call_with(Memory& memory, const std::string& model, Block block, std::uint32_t count, std::uint32_t appended,
               CallWatch* watch, void (*function)(const void*, const Block*), const void* self) {
  block.struct_size = static_cast<std::uint32_t>(sizeof block) + appended;
  block.count = count;
  std::byte* placed = memory.part_of_block("the block's struct", sizeof block + appended);
  std::memset(placed, 0xab, sizeof block + appended);
  std::memcpy(placed, &block, sizeof block);
  std::fenv_t environment;
  std::fegetenv(&environment);
  try {
    const ForeignCall mark(model.c_str(), "compute");
    if (watch != nullptr) watch->before();
    function(self, reinterpret_cast<const Block*>(placed));
    if (watch != nullptr) watch->after();
  } catch (const std::exception& exception) {
    std::fesetenv(&environment);
    throw Fault(std::string("compute threw an exception: ") + exception.what());
  } catch (...) {
    std::fesetenv(&environment);
    throw Fault("compute threw an exception");
  }
  std::fesetenv(&environment);
}

template <class T>
void call_block(Memory& memory, const Subject& subject, const plugin::ModelInstance& instance, const Arrays<T>& arrays,
                std::size_t first, std::uint32_t count, const Call& call) {
  const Tables<T> tables{memory, arrays, first};
  const void* self = instance.self();
  if constexpr (sizeof(T) == 4) {
    call_with(memory, subject.manifest().id, collision_block<rouleau_collision_block_f32>(tables, subject.dimension()),
              count, call.appended_bytes, call.watch, instance.collision().collide_f32, self);
  } else if (subject.manifest().kind == plugin::ModelKind::collision) {
    call_with(memory, subject.manifest().id, collision_block<rouleau_collision_block_f64>(tables, subject.dimension()),
              count, call.appended_bytes, call.watch, instance.collision().collide_f64, self);
  } else if (subject.manifest().kind == plugin::ModelKind::membrane) {
    call_with(memory, subject.manifest().id,
              element_block(tables, membrane_members, subject.manifest().state.size(), call.time_step), count,
              call.appended_bytes, call.watch, instance.membrane().compute, self);
  } else {
    call_with(memory, subject.manifest().id,
              element_block(tables, interaction_members, subject.manifest().state.size(), call.time_step), count,
              call.appended_bytes, call.watch, instance.interaction().compute, self);
  }
}

template <class T>
Values compute_as(const Subject& subject, const plugin::ModelInstance& instance, const Values& inputs,
                  const Call& call) {
  const std::size_t count = inputs.begin()->second.size();
  Memory memory(call);
  const Arrays<T> arrays = place<T>(memory, subject, inputs, call, count);
  std::vector<std::pair<std::size_t, std::size_t>> blocks;  // first element, size
  for (std::size_t first = 0; first < count; first += blocks.back().second) {
    const std::size_t wanted = blocks.size() < call.sizes.size() ? call.sizes[blocks.size()] : call.block;
    blocks.emplace_back(first, std::min(wanted, count - first));
  }
  if (call.backwards) std::reverse(blocks.begin(), blocks.end());
  for (const auto& [first, size] : blocks) {
    call_block(memory, subject, instance, arrays, first, static_cast<std::uint32_t>(size), call);
  }
  Values outputs;
  for (const auto& [name, array] : arrays.out) {
    auto& values = outputs[name];
    for (std::size_t i = 0; i < count; ++i)
      values.push_back(untouched(array[i]) ? std::bit_cast<double>(unwritten_bits) : static_cast<double>(array[i]));
  }
  return outputs;
}

}  // namespace

Values compute(const Subject& subject, const plugin::ModelInstance& instance, const Values& inputs, const Call& call) {
  return call.single ? compute_as<float>(subject, instance, inputs, call)
                     : compute_as<double>(subject, instance, inputs, call);
}

std::function<bool()> repeated_call(const Subject& subject, const plugin::ModelInstance& instance, const Values& inputs,
                                    const Values& expected) {
  const Call call;
  const std::size_t count = inputs.begin()->second.size();
  const auto memory = std::make_shared<Memory>(call);
  return [&subject, &instance, &expected, call, count, memory,
          arrays = place<double>(*memory, subject, inputs, call, count)] {
    for (const auto& [name, array] : arrays.out) std::fill_n(array, count, std::bit_cast<double>(unwritten_bits));
    Memory structs(call);
    call_block(structs, subject, instance, arrays, 0, static_cast<std::uint32_t>(count), call);
    return std::all_of(arrays.out.begin(), arrays.out.end(), [&](const auto& output) {
      const auto& values = expected.at(output.first);
      return std::memcmp(values.data(), output.second, count * sizeof(double)) == 0 ||
             std::equal(values.begin(), values.end(), output.second, same_bits);
    });
  };
}

bool is_unwritten(double value) { return untouched(value); }

std::string first_difference(const Values& a, const Values& b) {
  for (const auto& [name, values] : a) {
    const auto other = b.find(name);
    if (other == b.end()) continue;
    for (std::size_t i = 0; i < std::min(values.size(), other->second.size()); ++i) {
      const double x = values[i], y = other->second[i];
      if (same_bits(x, y)) continue;
      return name + '[' + std::to_string(i) + "]: " + number(x, 17) + " and " + number(y, 17);
    }
  }
  return {};
}

}  // namespace rouleau::conform

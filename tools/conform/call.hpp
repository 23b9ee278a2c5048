// Calls a model's compute function in every way that the interface allows, with its arrays wherever a check wants them.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "subject.hpp"

namespace rouleau::conform {

/// What stands in place of inputs that the manifest does not declare.
enum class Undeclared { null, unreadable, signalling_nan };

/// Where pages lie that end the process on any access: nowhere, right behind or right before every array, or right
/// behind the block's struct and its lists of pointers.
enum class Guard { none, behind, before, structs };

/// Where outputs lie: in memory of their own; over inputs where the interface allows it; and as a run's lattice has it,
/// a population over its opposite.
enum class Outputs { apart, over_inputs, streamed };

/// Sees the moment right before and right after the model's function runs; allocations of compute() lie outside.
class CallWatch {
 public:
  virtual ~CallWatch() = default;
  virtual void before() = 0;
  virtual void after() = 0;
};

/// How to call; every choice must give the same bits.
struct Call {
  bool single = false;                                          ///< collision: f32; values are rounded on the way in
  std::size_t block = std::numeric_limits<std::size_t>::max();  ///< elements in one call, at most
  std::vector<std::size_t>
      sizes;               ///< of the blocks, one after another; empty: `block`, and after the last of them, too
  std::size_t offset = 0;  ///< elements between a cache line's start and the arrays
  bool backwards = false;  ///< the last block first
  Outputs place = Outputs::apart;
  std::set<std::string> absent;  ///< needs that are NULL all the same: a collision's "force", "relaxation_rate"
  Undeclared undeclared = Undeclared::null;
  Guard guard = Guard::none;
  bool read_only = false;                        ///< inputs in memory that cannot be written
  std::optional<std::set<std::string>> outputs;  ///< arrays that are wanted, of output_arrays(); others are NULL
  double time_step = 1;
  CallWatch* watch = nullptr;
  std::uint32_t appended_bytes = 0;  ///< a later host's blocks: longer by fields that this plugin does not know
};

/// Outputs of all wanted arrays. What the model did not write is a NaN of its own kind (`unwritten`). The
/// floating-point environment is put back after each call. Throws Fault when an exception leaves the model.
Values compute(const Subject& subject, const plugin::ModelInstance& instance, const Values& inputs,
               const Call& call = {});

/// The same call again and again, in memory that is laid out once, so that most of its time is the model's: each call
/// says whether the outputs are `expected`, bit for bit, and throws as compute does. In double precision. Subject,
/// instance and `expected` outlive what is returned.
std::function<bool()> repeated_call(const Subject& subject, const plugin::ModelInstance& instance, const Values& inputs,
                                    const Values& expected);

/// What compute's outputs hold where the model wrote nothing.
bool is_unwritten(double value);

/// A fault of the plugin that no check asked about.
struct Fault : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The first difference in bits of two results, "energy[3]: 1.5 and 1.25"; empty when there is none. NaNs are alike.
std::string first_difference(const Values& a, const Values& b);

}  // namespace rouleau::conform

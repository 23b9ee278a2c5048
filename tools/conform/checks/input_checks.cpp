// Level "robustness": what a model is given to read and where it may write.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/text.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "conform/guarded_memory.hpp"
#include "conform/isolation/counted_functions.hpp"
#include "conform/subject.hpp"
#include "plugin/library.hpp"
#include "plugin/parameters.hpp"
#include "plugin/quantities.hpp"

namespace rouleau::conform {

namespace {

/// A call of create with everything between guards: parameters, the setup itself, the buffer for the error.
struct Creation {
  bool made = false;
  std::string words;
};
Creation create_guarded(const Subject& subject, const std::vector<double>& values, std::size_t given,
                        std::size_t error_size = 256, std::uint32_t appended = 0) {
  const rouleau_model& model = plugin::open_model(subject.manifest());
  plugin::ModelSetup setup(subject.manifest(), values, subject.typical_setting());
  using Flush = GuardedArray::Flush;
  GuardedArray names("the setup's parameter names", given * sizeof(char*), Flush::behind);
  GuardedArray numbers("the setup's parameter values", given * sizeof(double), Flush::behind);
  std::copy_n(setup.get().parameter_names, given, reinterpret_cast<const char**>(names.data()));
  std::copy_n(setup.get().parameter_values, given, reinterpret_cast<double*>(numbers.data()));
  setup.get().parameter_names = reinterpret_cast<const char* const*>(names.data());
  setup.get().parameter_values = reinterpret_cast<const double*>(numbers.data());
  setup.get().parameter_count = static_cast<std::uint32_t>(given);
  const std::size_t velocities = setup.get().velocity_count, axes = setup.get().dimension;
  GuardedArray directions("the setup's velocities", velocities * axes * sizeof(double), Flush::behind);
  GuardedArray weights("the setup's weights", velocities * sizeof(double), Flush::behind);
  std::copy_n(setup.get().velocities, velocities * axes, reinterpret_cast<double*>(directions.data()));
  std::copy_n(setup.get().weights, velocities, reinterpret_cast<double*>(weights.data()));
  setup.get().velocities = reinterpret_cast<const double*>(directions.data());
  setup.get().weights = reinterpret_cast<const double*>(weights.data());
  setup.get().struct_size = static_cast<std::uint32_t>(sizeof(rouleau_setup)) + appended;
  GuardedArray placed("the setup's struct", sizeof(rouleau_setup) + appended, Flush::behind);
  std::memset(placed.data(), 0xab, sizeof(rouleau_setup) + appended);
  std::memcpy(placed.data(), &setup.get(), sizeof(rouleau_setup));
  placed.make_read_only();
  GuardedArray error("the buffer for the error", error_size, Flush::behind);
  void* self = nullptr;
  char* text = reinterpret_cast<char*>(error.data());
  const int code = model.create(reinterpret_cast<const rouleau_setup*>(placed.data()), &self, text, error_size);
  if (code == 0) {
    model.destroy(self);
    return {true, {}};
  }
  return {false, std::string(text, strnlen(text, error_size))};
}

/// Values at and just inside a parameter's limits, where it has any.
std::vector<double> allowed_extremes(const plugin::Parameter& parameter) {
  std::vector<double> values;
  const auto beside = [](double limit, double direction) { return std::nextafter(limit, direction * 1e300); };
  if (!parameter.choices.empty()) values.push_back(static_cast<double>(parameter.choices.size() - 1));
  if (parameter.minimum) values.push_back(*parameter.minimum);
  if (parameter.exclusive_minimum) values.push_back(beside(*parameter.exclusive_minimum, 1));
  if (parameter.maximum) values.push_back(*parameter.maximum);
  if (parameter.exclusive_maximum) values.push_back(beside(*parameter.exclusive_maximum, -1));
  return values;
}

/// What no host gives, because the manifest forbids it.
std::vector<double> forbidden(const plugin::Parameter& parameter) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> values = {std::nan(""), infinity, -infinity};
  if (parameter.minimum) values.push_back(*parameter.minimum - 1);
  if (parameter.exclusive_minimum) values.push_back(*parameter.exclusive_minimum);
  if (parameter.maximum) values.push_back(*parameter.maximum + 1);
  if (parameter.exclusive_maximum) values.push_back(*parameter.exclusive_maximum);
  return values;
}

/// create may refuse any values, in words; it may never crash, throw, or read and write where it should not.
Finding parameters(const Subject& subject) {
  const auto typical = subject.typical_parameters();
  int made = 0, refused = 0;
  const auto attempt = [&](const std::vector<double>& values) {
    const Creation creation = create_guarded(subject, values, values.size());
    ++(creation.made ? made : refused);
    return creation.made || !creation.words.empty();
  };
  Random random = subject.random();
  for (int i = 0; i < 100; ++i) {
    if (!attempt(subject.random_parameters(random))) return Finding::failed("refuses usual parameters without a word");
  }
  for (std::size_t i = 0; i < typical.size(); ++i) {
    const plugin::Parameter& parameter = subject.manifest().parameters[i];
    auto values = typical;
    for (const double value : allowed_extremes(parameter)) {
      values[i] = value;
      if (!attempt(values)) {
        return Finding::failed("refuses " + parameter.name + " = " + number(value) + " (SI) without a word");
      }
    }
    for (const double value : forbidden(parameter)) {
      values[i] = value;
      attempt(values);
    }
  }
  // Fewer than the manifest names, and no room for the words.
  for (std::size_t given = 0; given < typical.size(); ++given) {
    if (create_guarded(subject, typical, given).made && given == 0) {
      return Finding::warned("makes an instance although none of its parameters was given");
    }
    create_guarded(subject, typical, given, 1);
  }
  return Finding::passed(std::to_string(made) + " sets of parameters taken, " + std::to_string(refused) + " refused");
}

/// Blocks and setup end where interface 1.0 ends, right before a guard; or a later host appends what 1.0 does not know.
Finding struct_size(const Subject& subject) {
  const auto typical = subject.typical_parameters();
  for (const std::uint32_t appended : {0U, 8U, 64U}) {
    if (!create_guarded(subject, typical, typical.size(), 256, appended).made) {
      return Finding::failed("refuses a setup that is " + std::to_string(appended) + " bytes longer");
    }
  }
  Random random = subject.random();
  for (const plugin::ModelInstance& instance : subject.make_each_choice()) {
    const Values inputs = subject.random_inputs(instance, ordinary_count, random);
    const Values expected = compute(subject, instance, inputs);
    for (const std::uint32_t appended : {0U, 8U, 64U}) {
      Call call;
      call.guard = Guard::structs;
      call.appended_bytes = appended;
      const auto difference = first_difference(expected, compute(subject, instance, inputs, call));
      if (difference.empty()) continue;
      return Finding::failed("a block longer by " + std::to_string(appended) + " bytes changes " + difference);
    }
  }
  return Finding::passed("structs of interface 1.0 and of later hosts, the same bits");
}

Finding declared_inputs(const Subject& subject) {
  std::vector<std::string> undeclared;
  for (const std::string& name : plugin::inputs_of(subject.manifest().kind, subject.manifest().dimension())) {
    if (!subject.manifest().needs_input(name)) undeclared.push_back(name);
  }
  if (undeclared.empty()) return Finding::passed("declares every input that there is");
  Random random = subject.random();
  for (const plugin::ModelInstance& instance : subject.make_each_choice()) {
    const Values inputs = subject.random_inputs(instance, ordinary_count, random);
    const Values expected = compute(subject, instance, inputs);
    for (const auto kind : {Undeclared::signalling_nan, Undeclared::unreadable}) {
      Call call;
      call.undeclared = kind;
      if (const auto difference = first_difference(expected, compute(subject, instance, inputs, call));
          !difference.empty()) {
        return Finding::failed("reads an input that its manifest does not declare (" + listed(undeclared) +
                               "), which changes " + difference);
      }
    }
  }
  return Finding::passed("does not touch " + listed(undeclared));
}

Finding needs_matter(const Subject& subject) {
  std::vector<std::string> idle;
  for (const std::string& need : subject.manifest().needs) {
    Random random = subject.random();
    bool matters = false;
    auto instances = subject.make_each_choice();
    for (const plugin::ModelInstance& instance : instances) {
      const Values inputs = subject.random_inputs(instance, ordinary_count, random);
      Values changed = inputs;
      const Values other = subject.random_inputs(instance, ordinary_count, random);
      for (const std::string& array : arrays_of(subject, need)) changed[array] = other.at(array);
      matters =
          matters || !first_difference(compute(subject, instance, inputs), compute(subject, instance, changed)).empty();
    }
    if (!matters) idle.push_back(need);
  }
  if (idle.empty()) return Finding::passed(listed(subject.manifest().needs) + ": each changes the result");
  return Finding::warned("declares " + listed(idle) + ", which changed nothing; hosts compute it in vain");
}

Finding read_only_inputs(const Subject& subject) {
  Random random = subject.random();
  for (const plugin::ModelInstance& instance : subject.make_each_choice()) {
    const Values inputs = subject.random_inputs(instance, ordinary_count, random);
    Call call;
    call.read_only = true;
    for (const bool single : subject.precisions()) {
      call.single = single;
      compute(subject, instance, inputs, call);
    }
  }
  return Finding::passed("inputs in memory that cannot be written");
}

/// Instances with guards behind all that was allocated for them.
std::vector<plugin::ModelInstance> make_guarded(const Subject& subject) {
  if (process_counts != nullptr) process_counts->from_pool = true;
  auto instances = subject.make_each_choice();
  if (process_counts != nullptr) process_counts->from_pool = false;
  return instances;
}

Finding bounds(const Subject& subject) {
  Random random = subject.random();
  for (const plugin::ModelInstance& instance : make_guarded(subject)) {
    std::vector<std::size_t> counts = {1, 2, 3, 5, 8, 15, 17, 33, 64, 67, 1024};
    for (int i = 0; i < 8; ++i) counts.push_back(some_count(random));
    counts.push_back(2000 + random() % 3000);
    for (const std::size_t count : counts) {
      const Values inputs = subject.random_inputs(instance, count, random);
      for (const bool single : subject.precisions()) {
        Call call;
        call.single = single;
        const Values expected = compute(subject, instance, inputs, call);
        for (const Guard guard : {Guard::behind, Guard::before}) {
          call.guard = guard;
          const auto difference = first_difference(expected, compute(subject, instance, inputs, call));
          if (difference.empty()) continue;
          return Finding::failed(std::to_string(count) + " elements, with arrays elsewhere in memory: " + difference);
        }
      }
    }
  }
  return Finding::passed("nothing read or written outside of arrays and of its own memory, 1 to 5000 elements");
}

/// Each output alone, and all but each: what is not wanted must not change what is.
Finding outputs_optional(const Subject& subject) {
  // The populations of a collision are always wanted.
  const bool collision = subject.manifest().kind == plugin::ModelKind::collision;
  std::set<std::string> all, always;
  for (const std::string& name : subject.output_arrays()) {
    all.insert(name);
    if (collision && name.starts_with("populations.")) always.insert(name);
  }
  std::vector<std::set<std::string>> choices = {always};
  for (const std::string& given : subject.manifest().gives) {
    std::set<std::string> alone = always, others = all;
    for (const std::string& array : arrays_of(subject, given)) {
      alone.insert(array);
      if (!always.contains(array)) others.erase(array);
    }
    choices.push_back(alone);
    choices.push_back(others);
  }
  Random random = subject.random();
  for (const plugin::ModelInstance& instance : subject.make_each_choice()) {
    for (const bool single : subject.precisions()) {
      const Values inputs = subject.random_inputs(instance, some_count(random), random);
      Call call;
      call.single = single;
      const Values expected = compute(subject, instance, inputs, call);
      for (const auto& wanted : choices) {
        call.outputs = wanted;
        if (const auto difference = first_difference(compute(subject, instance, inputs, call), expected);
            !difference.empty()) {
          return Finding::failed("without the other outputs, and with them: " + difference);
        }
      }
    }
  }
  return Finding::passed(std::to_string(choices.size()) + " sets of wanted outputs, the same bits");
}

}  // namespace

std::vector<Check> input_checks() {
  const Level level = Level::robustness;
  return {
      {"parameters", level, "accepts any parameters, or refuses them with a message", {"struct-size"}, parameters},
      {"struct-size", level, "uses only the fields that both sides know", {"hidden-state"}, struct_size},
      {"declared-inputs", level, "reads only the inputs that its manifest declares", {"hidden-state"}, declared_inputs},
      {"needs-matter", level, "depends on every input that its manifest declares", {"hidden-state"}, needs_matter},
      {"read-only-inputs", level, "does not write to its inputs", {"compute"}, read_only_inputs},
      {"bounds", level, "stays within its arrays", {"hidden-state"}, bounds},
      {"outputs-optional",
       level,
       "gives the same result whichever outputs are asked for",
       {"hidden-state", "energy-optional"},
       outputs_optional},
  };
}

}  // namespace rouleau::conform

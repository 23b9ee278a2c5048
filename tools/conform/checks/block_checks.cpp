// Level "robustness": a result depends on the element's inputs and on nothing else.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <thread>

#include "base/text.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "conform/subject.hpp"

namespace rouleau::conform {

namespace {

/// Calls test(instance, inputs, call) for each choice and precision until it finds something; with `count` elements, or
/// with as many as chance will have it.
template <class Test>
std::string first_fault(const Subject& subject, std::optional<std::size_t> wanted, const Test& test) {
  Random random = subject.random();
  for (const plugin::ModelInstance& instance : subject.make_each_choice()) {
    for (const bool single : subject.precisions()) {
      Call call;
      call.single = single;
      const std::size_t count = wanted.value_or(some_count(random));
      std::string fault = test(instance, subject.random_inputs(instance, count, random), call);
      if (!fault.empty()) return fault;
    }
  }
  return {};
}

Finding hidden_state(const Subject& subject) {
  Random random = subject.random();
  const std::string fault =
      first_fault(subject, {}, [&](const plugin::ModelInstance& instance, const Values& inputs, const Call& call) {
        const Values first = compute(subject, instance, inputs, call);
        std::string difference = first_difference(first, compute(subject, instance, inputs, call));
        if (!difference.empty()) return "the same call twice: " + difference;
        compute(subject, instance, subject.random_inputs(instance, 5, random), call);
        const plugin::ModelInstance other = subject.make();
        compute(subject, other, subject.random_inputs(other, 5, random), call);
        difference = first_difference(first, compute(subject, instance, inputs, call));
        return difference.empty() ? difference : "after other calls: " + difference;
      });
  if (!fault.empty()) return Finding::failed(fault);
  for (const plugin::ModelSetting& setting : subject.settings()) {
    const auto make = [&] { return subject.make(subject.typical_parameters(), setting); };
    auto one = std::make_unique<plugin::ModelInstance>(make());
    const plugin::ModelInstance another = make();
    const Values inputs = subject.random_inputs(*one, ordinary_count, random);
    const Values expected = compute(subject, *one, inputs);
    auto difference = first_difference(expected, compute(subject, another, inputs));
    if (!difference.empty()) return Finding::failed("two instances with the same parameters: " + difference);
    one.reset();
    difference = first_difference(expected, compute(subject, another, inputs));
    if (!difference.empty()) return Finding::failed("after the end of another instance: " + difference);
  }
  return Finding::passed("the same bits again, after other calls, and from another instance");
}

/// The elements in the order of `order`.
Values permuted(const Values& values, const std::vector<std::size_t>& order) {
  Values result;
  for (const auto& [name, array] : values) {
    for (const std::size_t i : order) result[name].push_back(array[i]);
  }
  return result;
}

/// Sizes of blocks that add up to `count`: all small ones, those around powers of two, and random ones up to all of it.
std::vector<std::size_t> random_sizes(std::size_t count, Random& random) {
  std::vector<std::size_t> sizes;
  for (std::size_t size = 1; size <= 80; ++size) sizes.push_back(size);
  for (std::size_t power = 96; power <= 2048; power = power % 3 == 0 ? power / 3 * 4 : power / 2 * 3) {
    for (const std::size_t size : {power - 1, power, power + 1}) sizes.push_back(size);
  }
  for (std::size_t sum = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0}); sum < count;
       sum += sizes.back()) {
    sizes.push_back(static_cast<std::size_t>(std::exp(uniform(random, 0, std::log(2100.0)))));
  }
  std::shuffle(sizes.begin(), sizes.end(), random);
  return sizes;
}

/// Every result beside that of its element alone.
Finding blocks(const Subject& subject) {
  constexpr std::size_t count = 5000;  // hosts call with up to some thousands
  Random random = subject.random();
  const std::string fault =
      first_fault(subject, count, [&](const plugin::ModelInstance& instance, const Values& inputs, Call call) {
        call.block = 1;
        const Values expected = compute(subject, instance, inputs, call);
        const auto differs = [&](const std::string& how) {
          const auto difference = first_difference(expected, compute(subject, instance, inputs, call));
          return difference.empty() ? difference
                                    : how + ", " + std::to_string(call.offset) +
                                          " elements from a cache line, and each element by itself: " + difference;
        };
        for (call.offset = 0; call.offset < 16; ++call.offset) {
          // All at once; then one cut of each kind at each alignment.
          call.sizes.clear();
          call.block = count;
          if (auto difference = differs("all at once"); !difference.empty()) return difference;
          call.block = 1 + random() % 130;
          call.backwards = random() % 2 == 0;
          if (auto difference = differs("cut into blocks of " + std::to_string(call.block)); !difference.empty()) {
            return difference;
          }
          call.sizes = {static_cast<std::size_t>(std::exp(uniform(random, std::log(130.0), std::log(double(count)))))};
          call.block = call.sizes[0];
          if (auto difference = differs("cut into blocks of " + std::to_string(call.block)); !difference.empty()) {
            return difference;
          }
          call.sizes = random_sizes(count, random);
          if (auto difference = differs("cut into blocks of random sizes"); !difference.empty()) return difference;
        }
        std::vector<std::size_t> order(count);
        std::iota(order.begin(), order.end(), 0);
        std::shuffle(order.begin(), order.end(), random);
        Call whole;
        whole.single = call.single;
        const auto difference =
            first_difference(permuted(expected, order), compute(subject, instance, permuted(inputs, order), whole));
        return difference.empty() ? difference : "in another order: " + difference;
      });
  if (!fault.empty()) return Finding::failed(fault);
  return Finding::passed("blocks of 1 to 5000 elements, any alignment and order, the bits of each element by itself");
}

Finding aliasing(const Subject& subject) {
  if (subject.manifest().kind != plugin::ModelKind::collision && subject.manifest().state.empty()) {
    return Finding::skipped("no output of this model may lie over an input");
  }
  const std::string fault =
      first_fault(subject, {}, [&](const plugin::ModelInstance& instance, const Values& inputs, Call call) {
        const Values expected = compute(subject, instance, inputs, call);
        for (const Outputs place : {Outputs::over_inputs, Outputs::streamed}) {
          call.place = place;
          auto difference = first_difference(expected, compute(subject, instance, inputs, call));
          if (!difference.empty()) return difference;
        }
        return std::string{};
      });
  if (!fault.empty()) return Finding::failed("outputs over inputs change " + fault);
  return Finding::passed("outputs over inputs, the same bits");
}

/// What is no number, or is as small as numbers get, stays in its own element.
Finding contained(const Subject& subject) {
  const std::string fault = first_fault(
      subject, ordinary_count, [&](const plugin::ModelInstance& instance, const Values& inputs, const Call& call) {
        const Values expected = compute(subject, instance, inputs, call);
        for (const std::size_t sick : {0UL, 3UL, 30UL, ordinary_count - 1}) {
          for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(),
                                     std::numeric_limits<double>::denorm_min(), 1e-310}) {
            Values changed = inputs;
            for (auto& [name, array] : changed) array[sick] = value;
            Values outputs = compute(subject, instance, changed, call);
            for (auto& [name, array] : outputs) array[sick] = expected.at(name)[sick];
            const auto difference = first_difference(expected, outputs);
            if (!difference.empty()) {
              return "element " + std::to_string(sick) + " with the value " + number(value) + " changes " + difference;
            }
          }
        }
        return std::string();
      });
  if (!fault.empty()) return Finding::failed(fault);
  return Finding::passed("NaN, infinity and denormals in one element leave the others alone");
}

Finding threads(const Subject& subject) {
  Random random = subject.random();
  // All of typical parameters; a collision operator's threads share two, without and with inertia.
  std::vector<plugin::ModelInstance> instances;
  for (const auto& setting : subject.settings()) {
    instances.push_back(subject.make(subject.typical_parameters(), setting));
  }
  // Calls must last, or no two of them meet: setting one up takes longer than computing a few elements.
  constexpr std::size_t count = 4099;
  constexpr int thread_count = 8, least_calls = 300;
  constexpr std::chrono::milliseconds least_time{350};
  struct Task {
    const plugin::ModelInstance& instance;
    Values inputs, expected;
  };
  std::vector<Task> tasks;
  for (int i = 0; i < thread_count; ++i) {
    const plugin::ModelInstance& instance = instances[static_cast<std::size_t>(i) % instances.size()];
    Task task{instance, subject.random_inputs(instance, count, random), {}};
    task.expected = compute(subject, instance, task.inputs);
    tasks.push_back(std::move(task));
  }
  std::atomic<int> calls{0}, differences{0}, waiting{thread_count};
  std::vector<std::thread> workers;
  workers.reserve(tasks.size());
  for (const Task& task : tasks) {
    workers.emplace_back([&] {
      const auto is_as_before = repeated_call(subject, task.instance, task.inputs, task.expected);
      --waiting;
      while (waiting > 0) std::this_thread::yield();
      const auto begin = std::chrono::steady_clock::now();
      for (int i = 0; i < least_calls || std::chrono::steady_clock::now() - begin < least_time; ++i, ++calls) {
        if (!is_as_before()) ++differences;
      }
    });
  }
  for (std::thread& worker : workers) worker.join();
  return Finding::at_most(differences, 0,
                          "wrong results of " + std::to_string(calls) + " calls by eight threads on one instance");
}

}  // namespace

std::vector<Check> block_checks() {
  const Level level = Level::robustness;
  return {
      {"hidden-state",
       level,
       "gives the same result again: nothing is kept from earlier calls",
       {"compute"},
       hidden_state},
      {"blocks", level, "gives the same result for any block size", {"hidden-state", "bounds"}, blocks},
      {"aliasing", level, "works when outputs are written over inputs", {"hidden-state"}, aliasing},
      {"contained", level, "keeps a NaN within the element where it came in", {"blocks"}, contained},
      {"threads", level, "gives the same result to eight threads that share an instance", {"hidden-state"}, threads},
  };
}

}  // namespace rouleau::conform

// Level "interface": manifest, library, loading, the table, making an instance, a first call.
#include <algorithm>
#include <boost/core/demangle.hpp>
#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"
#include "conform/call.hpp"
#include "conform/check.hpp"
#include "conform/subject.hpp"
#include "plugin/exported_symbols.hpp"
#include "plugin/library.hpp"

namespace rouleau::conform {

namespace {

/// Reading it was the check: schema, units, limits, defaults inside them, names that fit each other.
Finding manifest(const Subject& subject) {
  std::vector<std::string> silent;
  for (const plugin::Parameter& parameter : subject.manifest().parameters) {
    if (parameter.doc.empty()) silent.push_back(parameter.name);
  }
  if (!silent.empty()) return Finding::warned("parameters without \"doc\": " + listed(silent));
  return Finding::passed(std::to_string(subject.manifest().parameters.size()) + " parameters, each documented");
}

Finding library(const Subject& subject) {
  return Finding::passed(plugin::checked_library(subject.manifest()).filename().string());
}

Finding exports(const Subject& subject) {
  auto symbols = plugin::exported_symbols(plugin::checked_library(subject.manifest()));
  std::erase(symbols, std::string(ROULEAU_OPEN_SYMBOL));
  if (symbols.empty()) return Finding::passed(ROULEAU_OPEN_SYMBOL " and nothing else");
  for (std::string& symbol : symbols) symbol = boost::core::demangle(symbol.c_str());
  const std::string more = symbols.size() > 3 ? " and others" : "";
  if (symbols.size() > 3) symbols.resize(3);
  return Finding::failed("exports more than " ROULEAU_OPEN_SYMBOL ": " + listed(symbols) + more +
                         "; rouleau_add_plugin() hides them");
}

Finding load(const Subject& subject) {
  plugin::load_library(subject.manifest());
  return Finding::passed("RTLD_NOW | RTLD_LOCAL");
}

/// The table must be there for hosts of this and of later minor versions, and stay where it is.
Finding open(const Subject& subject) {
  const auto open = plugin::load_library(subject.manifest());
  const rouleau_plugin* first = open(ROULEAU_ABI_MINOR);
  if (first == nullptr) return Finding::failed("returns NULL for a host of interface 1.0");
  if (open(ROULEAU_ABI_MINOR + 7) == nullptr) {
    return Finding::failed("returns NULL for a host of a later minor version, which understands all of 1.0");
  }
  if (open(ROULEAU_ABI_MINOR) != first) return Finding::failed("returns another table at a second call");
  return Finding::passed("the same table for hosts of interface 1.0 and later");
}

Finding agreement(const Subject& subject) {
  const rouleau_model& model = plugin::open_model(subject.manifest());
  return Finding::passed(std::string(model.id) + ' ' + model.version + " as the manifest says");
}

Finding create(const Subject& subject) {
  const plugin::ModelInstance one = subject.make(), another = subject.make();
  if (one.self() == nullptr) return Finding::passed("without a self");
  if (one.self() == another.self()) return Finding::failed("two instances share one self");
  return Finding::passed("instances with typical parameters");
}

/// One ordinary call: everything that the manifest gives is written and is a number.
Finding computes(const Subject& subject) {
  Random random = subject.random();
  for (const plugin::ModelInstance& instance : subject.make_each_choice()) {
    const Values outputs = compute(subject, instance, subject.random_inputs(instance, 64, random));
    for (const auto& [name, values] : outputs) {
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (is_unwritten(values[i])) return Finding::failed("does not write " + name + ", which its manifest gives");
        if (!std::isfinite(values[i])) {
          return Finding::failed(name + '[' + std::to_string(i) + "] is " + number(values[i]) + " for ordinary inputs");
        }
      }
    }
  }
  return Finding::passed("64 elements, all outputs finite");
}

}  // namespace

std::vector<Check> interface_checks() {
  return {
      {"manifest", Level::interface, "fits the schema; units, limits and defaults agree", {}, manifest},
      {"library", Level::interface, "lies beside its manifest and is built for this machine", {"manifest"}, library},
      {"exports", Level::interface, "exports rouleau_open_v1 and nothing else", {"library"}, exports},
      {"load", Level::interface, "loads, with every symbol found", {"library"}, load},
      {"open", Level::interface, "gives the same table to this host and to later ones", {"load"}, open},
      {"agreement",
       Level::interface,
       "has a table that agrees with its manifest: id, version, kind, functions",
       {"open"},
       agreement},
      {"create", Level::interface, "creates instances with typical parameters", {"agreement"}, create},
      {"compute", Level::interface, "writes finite outputs for ordinary inputs", {"create"}, computes},
  };
}

}  // namespace rouleau::conform

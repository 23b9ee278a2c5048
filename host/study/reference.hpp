// What a quantity of a study should be, and how well that is known: the reference that errors are measured against.
#pragma once

#include <limits>
#include <map>
#include <string>

namespace rouleau::json {
class Document;
}  // namespace rouleau::json
namespace rouleau::scene {
class SceneFields;
}  // namespace rouleau::scene
namespace rouleau::study {

enum class ReferenceKind {
  value,       ///< given in the study
  file,        ///< a number of a JSON file
  analytic,    ///< known exactly
  richardson,  ///< limit of the study's own grids
  point        ///< what the study finds at one of its points
};

struct Reference {
  ReferenceKind kind = ReferenceKind::richardson;
  double value = std::numeric_limits<double>::quiet_NaN();  ///< in the quantity's unit; NaN until the study has run
  double uncertainty = 0;                                   ///< of `value`; 0 where none is known
  std::string source;                                       ///< in the user's words, or the file and pointer
  /// Of `point`: the point. Of `richardson`: the method whose limit is the reference; empty: the surest one.
  std::map<std::string, std::string> labels;
};

/// The reference at `pointer` of a document:
///     {"value": 0.2386, "uncertainty": 0.0002, "source": "..."}
///     {"file": "x.json", "pointer": "/0/steady/D", "uncertainty": 1e-4 | "/0/error_bar/D", "factor", "offset",
///     "source"}
///                           the file is relative to the document's folder; value = number x factor + offset
///     {"analytic": "zero"}  "richardson"  {"richardson": {"scheme": "corrected"}}  {"point": {"resolution": "40"}}
/// Throws Error(bad_input) at the place of a fault, Error(input_output) for a file that cannot be read.
Reference read_reference(const scene::SceneFields& fields, const json::Document& document, const std::string& pointer);

/// "value", "file", ...
const char* name_of(ReferenceKind kind);

}  // namespace rouleau::study

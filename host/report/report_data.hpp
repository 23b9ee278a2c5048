// What report.html shows, gathered from the files of a run's directory and thinned to what a page can carry.
#pragma once

#include <filesystem>

#include "json/json.hpp"

namespace rouleau::report {

/// Whether the directory has the files of a run, one that has not ended included.
bool has_run(const std::filesystem::path& directory);

/// Object with
///   summary   summary.json as it is, null when the run has not ended
///   scene     text of scene.json, null when there is none
///   shown     {outputs, of, node_stride, note, damage}: what was thinned, why there is no animation, and sentences on
///             the files of an ended run that are damaged
///   step, time_s, strain, stage   one entry per shown output
///   charts    [{title, unit, table: series | cells, lines: [{name, label, doc}]}]: what is drawn, of the columns that
///             have a chart (observe/observables.hpp), lengths in um and angles in degrees
///   series    name -> values per shown output; only those that the run wrote; the total energy without the fluid's
///             kinetic energy
///   shear_rate  of the walls per shown output, 1/s, null where they rest; null for runs of earlier versions
///   cells     {ids, types, from, aggregate, and name -> a line of values for each cell}: of the cells that are there
///             at some shown output, by their numbers `ids`, types and the shown output with which their lines begin;
///             without `from` all lines have all outputs; aggregate by output and cell, null or cut off where that is
///             not there; beside what has a chart speed_um_per_s, of the centroid
///   domain    {size_um, periodic} along each axis; absent without frames
///   outlines  outline_data() of the shown outputs (report_outlines.hpp), or null
///   surfaces  surface_data() of them (report_outlines.hpp) in space, or null
///   fields    field_data() of the shown outputs (report_fields.hpp), or null
/// Undefined numbers are null. Throws Error(bad_input) when the directory is no run's.
nlohmann::json report_data(const std::filesystem::path& directory);

/// Outputs to show, at most about `most` of `aggregate_count`'s: evenly spread, the first, the last, and where the
/// count changes.
std::vector<std::size_t> shown_outputs(const std::vector<double>& aggregate_count, std::size_t most);

}  // namespace rouleau::report

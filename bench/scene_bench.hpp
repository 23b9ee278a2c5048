// Whole scenes: where the time of a step goes, and how it grows with the number of cells.
#pragma once

namespace rouleau::bench {

/// The four-cell scene by pass, in both precisions, with one and two threads; `whole`: to its end, through tumbling and
/// separation, else its first 20 000 steps. Then two cells in three dimensions, their first 1 000 steps.
void scene_table(bool whole);

/// Cost of a step with 1 to 1024 cells at the same volume fraction.
void cells_table();

/// What a membrane node takes in three dimensions, with contacts, by scheme, in turn with space_speed().
void nodes_table();

}  // namespace rouleau::bench

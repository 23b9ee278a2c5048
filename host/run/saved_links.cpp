#include "saved_links.hpp"

namespace rouleau::run {

namespace {

constexpr const char *link_places = "/links/place", *lefts = "/links/left", *aways = "/links/away";

}  // namespace

std::size_t save_links(files::CheckpointWriter* writer, const core::LinkMemory& links) {
  if (writer == nullptr || links.place.empty()) return links.place.size();
  for (const auto& [path, values] :
       {std::pair{link_places, &links.place}, std::pair{lefts, &links.left}, std::pair{aways, &links.away}}) {
    writer->begin_array(path, values->size());
    writer->append(*values);
  }
  return links.place.size();
}

core::LinkMemory read_links(const files::CheckpointReader& reader, const nlohmann::json& of_solver) {
  if (of_solver.value("links", 0) == 0) return {};
  core::LinkMemory links{reader.array(link_places), reader.array(lefts), reader.array(aways)};
  if (links.left.size() != links.place.size() || links.away.size() != links.place.size())
    reader.refuse("links without what has left along them");
  return links;
}

}  // namespace rouleau::run

// Holds the sources of the shipped collision operators, to reach their loops for each instruction set.
#include "operators.hpp"

#define rouleau_open_v1 open_bgk
#include "collision/bgk/bgk.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_trt
#include "collision/trt/trt.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_mrt
#include "collision/mrt/mrt.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_regularised
#include "collision/regularised/regularised.cpp"
#undef rouleau_open_v1
#define rouleau_open_v1 open_central_moment
#include "collision/central-moment/central-moment.cpp"
#undef rouleau_open_v1

namespace rouleau::test {

namespace {

template <class Model>
Operator with_loops(Self self, const std::string& id, const std::string& set, bool inertia) {
  return {id, inertia, std::move(self),
          pick_for<detail::CollisionLoop<Model, double>, const void*, const rouleau_collision_block_f64*>(set),
          pick_for<detail::CollisionLoop<Model, float>, const void*, const rouleau_collision_block_f32*>(set)};
}

struct Entry {
  const char* id;
  const rouleau_plugin* (*open)(std::uint32_t);
  Operator (*with_loops)(Self, const std::string&, const std::string&, bool);
  NamedValues parameters;
};

const Entry& entry(const std::string& id) {
  static const Entry entries[] = {
      {"bgk", open_bgk, with_loops<Bgk>, {}},
      {"trt", open_trt, with_loops<Trt>, {{"magic", 0.1875}}},
      {"mrt",
       open_mrt,
       with_loops<Mrt>,
       {{"energy_rate", 1.64}, {"energy_square_rate", 1.54}, {"heat_flux_rate", 0}, {"magic", 0.1875}}},
      {"regularised", open_regularised, with_loops<Regularised>, {}},
      {"central-moment",
       open_central_moment,
       with_loops<CentralMoment>,
       {{"bulk_rate", 0.8}, {"third_order_rate", 0}, {"fourth_order_rate", 1.1}, {"magic", 0.1875}}}};
  for (const Entry& candidate : entries) {
    if (id == candidate.id) return candidate;
  }
  throw std::invalid_argument("no operator " + id);
}

}  // namespace

const rouleau_model& collision_model(const std::string& id) { return *entry(id).open(0)->models[0]; }
NamedValues parameters_of(const std::string& id) { return entry(id).parameters; }

Operator make_operator(const std::string& id, const std::string& set, double relaxation_rate, bool inertia,
                       const NamedValues& parameters) {
  return entry(id).with_loops(make(collision_model(id), {parameters, relaxation_rate, inertia}), id, set, inertia);
}

}  // namespace rouleau::test

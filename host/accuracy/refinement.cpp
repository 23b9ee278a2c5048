#include "refinement.hpp"

#include <algorithm>

namespace rouleau::accuracy {

double refined_target(const plan::NumericsChoice& choice, const Worst& worst) {
  constexpr double spared = 0.8, least = 0.001;  // the least that a scene may ask for
  const double measured = worst.error - worst.uncertainty, left = choice.target - worst.uncertainty;
  if (!(left > 0)) return 0;
  return std::max(least, spared * std::min(choice.expected.total(), choice.target) * left / measured);
}

void add_measured(nlohmann::json& choice, const std::optional<Worst>& worst) {
  if (!choice.is_object()) return;
  choice["measured_error"] = worst ? nlohmann::json(worst->error) : nlohmann::json();
  choice["measured_of"] = worst ? nlohmann::json(worst->name) : nlohmann::json();
  if (!worst) return;
  choice["measured_shares"] = {{"resolution", worst->shares.lattice},
                               {"inertia", worst->shares.inertia},
                               {"start", worst->shares.start},
                               {"outputs", worst->uncertainty}};
}

std::optional<Worst> measured(const nlohmann::json& choice) {
  if (!choice.is_object() || !choice.contains("measured_shares")) return std::nullopt;
  const nlohmann::json& shares = choice.at("measured_shares");
  return Worst{choice.at("measured_error"),
               choice.at("measured_of"),
               {shares.at("resolution"), shares.at("start"), shares.at("inertia")},
               shares.at("outputs")};
}

}  // namespace rouleau::accuracy

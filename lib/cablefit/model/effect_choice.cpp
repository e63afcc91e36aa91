#include "cablefit/model/effect_choice.hpp"

#include <algorithm>

namespace cablefit {

std::vector<const Effect*> effects_with(Side side,
                                        const std::function<bool(std::string_view)>& has) {
  const auto has_it = [&](const ParameterInfo& info) { return has(info.name); };
  std::vector<const Effect*> found;
  std::vector<std::string_view> replaced;
  for (const Effect& effect : effects()) {
    if (effect.side != side) continue;
    const auto& parameters = effect.parameters;
    const bool stands_in = !effect.instead_of.empty();
    const bool is_there = stands_in ? std::all_of(parameters.begin(), parameters.end(), has_it)
                                    : std::any_of(parameters.begin(), parameters.end(), has_it);
    if (!is_there) continue;
    found.push_back(&effect);
    if (stands_in) replaced.push_back(effect.instead_of);
  }
  std::erase_if(found, [&](const Effect* effect) {
    return std::find(replaced.begin(), replaced.end(), effect->name) != replaced.end();
  });
  return found;
}

}  // namespace cablefit

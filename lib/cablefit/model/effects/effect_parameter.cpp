#include "cablefit/model/effects/effect_parameter.hpp"

#include <fmt/format.h>

namespace cablefit {

const ParameterInfo* effect_parameter(std::string_view name) {
  for (const Effect& row : candidate_effects())
    for (const ParameterInfo& info : row.parameters)
      if (name == added_parameter_name(row, info)) return &info;
  const std::string_view base = name.substr(0, name.find('['));
  for (const Effect& effect : base_effects())
    for (const ParameterInfo& info : effect.parameters)
      if (info.name == base) return &info;
  return nullptr;
}

std::string added_parameter_name(const Effect& row, const ParameterInfo& info) {
  return fmt::format("{}[{}].{}", row.name, to_string(row.site), info.name);
}

Estimate* find_parameter(std::vector<EffectInstance>& effects, std::string_view name) {
  for (EffectInstance& effect : effects)
    for (std::size_t k = 0; k < effect.parameters.size(); ++k)
      if (name == added_parameter_name(*effect.effect, effect.effect->parameters[k]))
        return &effect.parameters[k];
  return nullptr;
}

}  // namespace cablefit

#include "cablefit/model/effect_parameter.hpp"

#include "cablefit/model/effects.hpp"

namespace cablefit {

const ParameterInfo* effect_parameter(std::string_view name) {
  const std::string_view base = name.substr(0, name.find('['));
  for (const Effect& effect : effects())
    for (const ParameterInfo& info : effect.parameters)
      if (info.name == base) return &info;
  return nullptr;
}

}  // namespace cablefit

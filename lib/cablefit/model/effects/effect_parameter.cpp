#include "cablefit/model/effects/effect_parameter.hpp"

#include <fmt/format.h>

namespace cablefit {
namespace {

/// "f_v[2]" -> "f_v".
std::string_view without_joint(std::string_view name) {
  return name.ends_with(']') ? name.substr(0, name.rfind('[')) : name;
}

}  // namespace

const ParameterInfo* effect_parameter(std::string_view name) {
  const std::string_view base = without_joint(name);
  for (const Effect& row : candidate_effects())
    for (const ParameterInfo& info : row.parameters)
      if (base == added_parameter_name(row, info)) return &info;
  for (const Effect& effect : base_effects())
    for (const ParameterInfo& info : effect.parameters)
      if (info.name == base) return &info;
  return nullptr;
}

std::string added_parameter_name(const Effect& row, const ParameterInfo& info) {
  return fmt::format("{}[{}].{}", row.name, to_string(row.site), info.name);
}

bool may_be_left_out(const Effect& row, std::size_t parameter) {
  if (parameter < row.n_linear()) return false;
  return row.shape[parameter - row.n_linear()].low == 0;
}

}  // namespace cablefit

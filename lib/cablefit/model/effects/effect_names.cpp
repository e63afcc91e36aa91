#include "cablefit/model/effects/effect_names.hpp"

#include <fmt/format.h>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

/// "stribeck[motor]", or "cogging" of what acts on one side only.
const Effect& effect_named(const std::string& text) {
  const bool has_side = text.find('[') != std::string::npos;
  std::vector<std::string> names;
  std::vector<const Effect*> found;
  for (const Effect& row : candidate_effects()) {
    std::string name(row.name);
    if (has_side) name += fmt::format("[{}]", to_string(row.site));
    if (text == name) found.push_back(&row);
    if (names.empty() || names.back() != name) names.push_back(std::move(name));
  }
  if (found.empty())
    throw usage_error(fmt::format("unknown effect {}", cablefit::quoted(text)),
                      suggestion(text, std::vector<std::string_view>(names.begin(), names.end())));
  if (found.size() > 1)
    throw usage_error(fmt::format("effect {} acts on several sides", cablefit::quoted(text)),
                      fmt::format("write {0}[{1}] or {0}[{2}]", text, to_string(found[0]->site),
                                  to_string(found[1]->site)));
  return *found.front();
}

}  // namespace

EffectInstance blank_effect(const Effect& row) {
  EffectInstance effect{&row, {}};
  for (const ParameterInfo& info : row.parameters) {
    Estimate& e = effect.parameters.emplace_back();
    e.name = info.name;
    e.symbol = info.symbol;
    e.unit = info.unit;
  }
  return effect;
}

std::vector<EffectInstance> blank_effects(const std::vector<std::string>& names) {
  std::vector<EffectInstance> effects;
  for (const std::string& name : names) effects.push_back(blank_effect(effect_named(name)));
  return effects;
}

}  // namespace cablefit

#include "cablefit/model/effects/effect_names.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

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
    throw usage_error(fmt::format("unknown effect {}", in_quotes(text)),
                      suggestion(text, std::vector<std::string_view>(names.begin(), names.end())));
  if (found.size() > 1)
    throw usage_error(fmt::format("effect {} acts on several sides", in_quotes(text)),
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

WantedEffect wanted_effect(const std::string& name) {
  const std::size_t space = name.find(' ');
  if (space == std::string::npos) return {&effect_named(name), 0};
  int joint = 0;
  const char* const end = name.data() + name.size();
  const auto [rest, failure] = std::from_chars(name.data() + space + 1, end, joint);
  if (failure != std::errc{} || joint < 1 || std::string_view(rest, end) != "]")
    throw usage_error(fmt::format("effect {} names no joint", in_quotes(name)),
                      "write stribeck[motor 2] for the second joint");
  return {&effect_named(name.substr(0, space) + "]"), joint};
}

EffectsPerJoint blank_effects(const std::vector<std::string>& names, int n_joints) {
  EffectsPerJoint effects(static_cast<std::size_t>(n_joints));
  for (const std::string& name : names) {
    const WantedEffect wanted = wanted_effect(name);
    if (wanted.joint > n_joints)
      throw usage_error(fmt::format("effect {}: the rig file has {} joint{}", in_quotes(name),
                                    n_joints, n_joints == 1 ? "" : "s"),
                        "name one of its joints, or leave the number out for each of them");
    for (int joint = 1; joint <= n_joints; ++joint)
      if (wanted.joint == 0 || wanted.joint == joint)
        effects[static_cast<std::size_t>(joint) - 1].push_back(blank_effect(*wanted.effect));
  }
  return effects;
}

}  // namespace cablefit

#include "cablefit/model/effects.hpp"

#include <algorithm>
#include <vector>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/model/effects/rows.hpp"

namespace cablefit {
namespace {

/// The table. The paper's model comes first, side by side; candidates of refine follow.
const std::vector<Effect>& table() {
  static const std::vector<Effect> kRows{
      rows::inertia(Side::link),         rows::viscous(Side::link),
      rows::coulomb(Side::link),         rows::inertia(Side::motor),
      rows::viscous(Side::motor),        rows::coulomb(Side::motor),
      rows::offset(Side::motor),         rows::inertia(Side::rigid),
      rows::viscous(Side::rigid),        rows::coulomb(Side::rigid),
      rows::offset(Side::rigid),         rows::smooth_coulomb(Side::link),
      rows::smooth_coulomb(Side::motor), rows::smooth_coulomb(Side::rigid),
  };
  return kRows;
}
constexpr std::size_t kBaseRows = 11;  // of the paper

}  // namespace

std::string_view to_string(Side side) {
  return rows::PerSide<std::string_view>{"link", "motor", "rigid"}.at(side);
}

std::span<const Effect> effects() { return table(); }

std::span<const Effect> base_effects(Side side) {
  const auto base = effects().first(kBaseRows);
  const auto on_side = [side](const Effect& effect) { return effect.side == side; };
  const auto begin = std::find_if(base.begin(), base.end(), on_side);
  return {begin, std::find_if_not(begin, base.end(), on_side)};
}

const Effect& find_effect(std::string_view name, Side side) {
  std::vector<std::string_view> known;
  for (const Effect& effect : effects()) {
    if (effect.side != side) continue;
    if (effect.name == name) return effect;
    known.push_back(effect.name);
  }
  throw input_error(
      {},
      "unknown effect '" + std::string(name) + "' on the " + std::string(to_string(side)) + " side",
      suggestion(name, known));
}

}  // namespace cablefit

#include "cablefit/refine/search/applicable.hpp"

#include <algorithm>

#include "cablefit/model/effects/path_friction.hpp"

namespace cablefit {
namespace {

bool has_shared_cable(const Model& one) {
  if (one.whole == nullptr) return false;
  const std::vector<Cable>& cables = one.whole->transmission.cables;
  return std::any_of(cables.begin(), cables.end(), [&](const Cable& cable) {
    return rubs_on_path(cable) && !cable.link_map[static_cast<std::size_t>(one.joint)].is_zero();
  });
}

bool has_yardstick(Yardstick wanted, const Design& design) {
  if (wanted == Yardstick::none) return true;
  if (wanted == Yardstick::shared_cable) return has_shared_cable(design.models.front());
  if (wanted == Yardstick::load_or_inertia && design.layout.given) return true;
  return std::any_of(design.stretches.begin(), design.stretches.end(), [](const Stretch& stretch) {
    return (stretch.recording.tau_load != 0).any();
  });
}

}  // namespace

bool is_candidate(const Effect& effect, const Design& design) {
  return (effect.is_static || !is_blocked_only(design.stretches)) &&
         has_yardstick(effect.yardstick, design);
}

}  // namespace cablefit

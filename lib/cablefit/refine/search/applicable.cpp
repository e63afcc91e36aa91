#include "cablefit/refine/search/applicable.hpp"

#include <algorithm>

namespace cablefit {
namespace {

bool has_yardstick(Yardstick wanted, const Design& design) {
  if (wanted == Yardstick::none) return true;
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

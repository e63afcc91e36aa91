#include "cablefit/refine/steps/determined_effects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/refine/null/kept_effects.hpp"

namespace cablefit {
namespace {

constexpr KindLevels kAlike = {1, 1, 1};

}  // namespace

void remove_effect(const Effect& effect, bool on_link, std::vector<Model>& models) {
  for (Model& model : models) {
    JointModel& axes = model.joints.front();
    std::erase_if(on_link ? axes.link : axes.motor,
                  [&](const EffectInstance& has) { return has.effect == &effect; });
  }
}

std::vector<Model> with_determined_effects(std::vector<Model> models,
                                           const std::vector<Stretch>& stretches,
                                           const Smoothing& smoothing, double block_seconds,
                                           std::vector<std::string>& warnings) {
  const Design design = make_design(without_kept(models), stretches, smoothing);
  const BlockGrams grams = block_grams(design, block_seconds);
  if (fit_blocks(grams, kAlike, false)) return models;
  const std::vector<Eigen::Index> determined = determined_columns(grams, kAlike, 0);
  std::vector<Model> fewer = models;
  std::vector<std::string> held;
  const JointModel& axes = models.front().joints.front();
  for (std::size_t k = 0; k < design.layout.parameters.size(); ++k) {
    if (std::binary_search(determined.begin(), determined.end(), static_cast<Eigen::Index>(k)))
      continue;
    const ModelParameter& p = design.layout.parameters[k];
    if (p.kind != ParameterKind::effect || is_inertia(models.front(), p)) return models;
    remove_effect(*(p.on_link ? axes.link : axes.motor)[p.effect].effect, p.on_link, fewer);
    held.push_back(fmt::format(
        "the logs do not separate {} of the base model from its other parameters: it is held at 0; "
        "move in both directions, at several speeds",
        p.name));
  }
  warnings.insert(warnings.end(), held.begin(), held.end());
  return fewer;
}

}  // namespace cablefit

#include "cablefit/refine/rows/recorded_effects.hpp"

namespace cablefit {

bool is_recorded(const Effect& row) { return !row.is_event && row.site != Site::sensor; }

std::vector<Model> recorded_models(std::vector<Model> models) {
  for (Model& model : models)
    std::erase_if(model.joints.front().added,
                  [](const EffectInstance& instance) { return !is_recorded(*instance.effect); });
  return models;
}

void forget_unrecorded(const Design& design, Eigen::VectorXd& x) {
  Eigen::Index at = design.layout.n();
  for (const Variant& variant : design.added) {
    const Eigen::Index n = n_linear(variant);
    if (!is_recorded(*variant.effect)) x.segment(at, n).setZero();
    at += n;
  }
}

}  // namespace cablefit

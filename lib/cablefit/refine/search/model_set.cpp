#include "cablefit/refine/search/model_set.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

bool same_effects(const std::vector<EffectInstance>& a, const std::vector<EffectInstance>& b) {
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(),
      [](const EffectInstance& x, const EffectInstance& y) { return x.effect == y.effect; });
}

bool same_cables(const std::vector<Cable>& a, const std::vector<Cable>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Cable& x, const Cable& y) {
    return x.law == y.law && x.order == y.order;
  });
}

/// What an earlier refine added, with its nonlinear parameters: the linear ones are fitted anew.
bool same_refinements(const std::vector<EffectInstance>& a, const std::vector<EffectInstance>& b) {
  const auto is_same = [](const EffectInstance& x, const EffectInstance& y) {
    if (x.effect != y.effect) return false;
    for (std::size_t p = x.effect->n_linear(); p < x.parameters.size(); ++p)
      if (x.parameters[p].value != y.parameters[p].value) return false;
    return true;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same);
}

bool same_structure(const Model& a, const Model& b) {
  return a.rigid == b.rigid && a.joints.size() == b.joints.size() &&
         same_cables(a.transmission.cables, b.transmission.cables) &&
         std::equal(a.joints.begin(), a.joints.end(), b.joints.begin(),
                    [](const JointModel& x, const JointModel& y) {
                      return same_effects(x.link, y.link) && same_effects(x.motor, y.motor) &&
                             same_refinements(x.added, y.added);
                    });
}

/// What happened in a log of an earlier refine is in all rows of later logs, like a parameter of
/// the base.
void require_no_event(const Model& model) {
  for (const JointModel& joint : model.joints)
    for (const EffectInstance& has : joint.added)
      if (has.effect->is_event)
        throw usage_error(
            fmt::format("the model of preload '{}' has '{}' ({}), an event of an earlier refine",
                        model.preload, has.effect->name, to_string(has.effect->site)),
            "its change is in all rows of later logs: fit the model again ('cablefit "
            "identify') to logs from after it");
}

}  // namespace

void require_model_set(std::span<const Model> models) {
  for (const Model& model : models) require_no_event(model);
  for (std::size_t k = 1; k < models.size(); ++k) {
    if (!same_structure(models[k], models[0]))
      throw usage_error(fmt::format("the models of preload '{}' and '{}' have different equations",
                                    models[0].preload, models[k].preload),
                        "refine shares coefficients between preloads: fit both in the same way, or "
                        "refine one of them with --preload NAME");
    for (std::size_t j = 0; j < k; ++j)
      if (models[k].preload == models[j].preload)
        throw usage_error(fmt::format("two models of preload '{}'", models[k].preload),
                          "give one model for each preload");
  }
}

std::vector<Model> models_with_logs(std::vector<Model> models, std::span<const LogSurvey> logs) {
  if (models.size() < 2) return models;
  std::vector<Model> wanted;
  for (Model& model : models)
    if (std::any_of(logs.begin(), logs.end(), [&](const LogSurvey& log) {
          return std::any_of(log.parts.begin(), log.parts.end(),
                             [&](const PartSurvey& part) { return part.preload == model.preload; });
        }))
      wanted.push_back(model);
  return wanted.empty() ? models : wanted;
}

}  // namespace cablefit

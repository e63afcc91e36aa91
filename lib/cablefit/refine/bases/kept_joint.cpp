#include "cablefit/refine/bases/kept_joint.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/bases/own_base.hpp"
#include "cablefit/refine/null/kept_effects.hpp"
#include "cablefit/refine/rows/physical_values.hpp"
#include "cablefit/refine/rows/refined_model.hpp"
#include "cablefit/refine/steps/elastic_stage.hpp"
#include "cablefit/refine/undetermined.hpp"

namespace cablefit {
namespace {

/// Empty: blocked logs alone, or none.
std::optional<KeptBase> base_of(const std::vector<Model>& models, const RefineLogs& logs,
                                const ScanSettings& settings) {
  const RefineStage stage = stage_of(models, logs);
  if (stage.elastic_only) return {};
  std::vector<Stretch> stretches = read_stretches(logs.fitted(), stage.models, stage.wanted);
  if (stretches.empty()) return {};
  const Smoothing wanted = smoothing_for(finest_period(stretches, false));
  return fit_kept_base(stage.models, std::move(stretches), wanted, settings);
}

}  // namespace

std::optional<BaseFit> base_fit_of(const std::vector<Model>& models, const RefineLogs& logs) {
  return unless_undetermined([&]() -> std::optional<BaseFit> {
    auto kept = base_of(models, logs, {});
    if (!kept) return {};
    return std::move(kept->base);
  });
}

std::vector<std::optional<BaseFit>> base_fits_of(const std::vector<Model>& models,
                                                 const RefineLogs& logs) {
  std::vector<std::optional<BaseFit>> all;
  for (int joint = 0; joint < static_cast<int>(models.front().joints.size()); ++joint) {
    all.push_back(base_fit_of(one_joint(models, joint), logs));
    if (!all.back()) continue;
    all.back()->design.states.clear();
    all.back()->design.coarse_states.clear();
  }
  return all;
}

std::optional<std::vector<Model>> base_estimates(const std::vector<Model>& models,
                                                 const RefineLogs& logs) {
  const ScanSettings settings;
  return unless_undetermined([&]() -> std::optional<std::vector<Model>> {
    const auto kept = base_of(models, logs, settings);
    if (!kept) return {};
    const BaseFit& base = kept->base;
    FinalFit fit = final_fit(kept->bare, base.design, base.levels, settings.block_seconds);
    take_physical(base.design, settings.block_seconds, base.levels, base.fit.x, fit);
    return refined_models(base.design, fit);
  });
}

namespace {

bool is_start(const Estimate& e) { return e.not_identifiable == kStartValue; }

template <typename Axes, typename Call>
void for_each_parameter(Axes& axes, Call call) {
  for (auto* side : {&axes.link, &axes.motor})
    for (auto& instance : *side)
      for (auto& parameter : instance.parameters) call(parameter);
}

bool has_start_values(const Model& one) {
  bool any = false;
  for_each_parameter(one.joints.front(), [&](const Estimate& e) { any = any || is_start(e); });
  return any;
}

/// A start value looks like an estimate in a file.
void drop_start_values(Model& one) {
  const auto none = std::numeric_limits<double>::quiet_NaN();
  const char* const why = "the joint was not refined, and the logs do not determine it";
  for_each_parameter(one.joints.front(), [&](Estimate& e) {
    if (!is_start(e)) return;
    e.value = none;
    e.not_identifiable = why;
  });
  const Estimate* spring =
      find_estimate(one.whole->elastic, name_in_whole(one, std::string(kSpringName)));
  if (spring == nullptr || !is_start(*spring)) return;
  Estimate unknown = *spring;
  unknown.name = unknown.symbol = kSpringName;
  unknown.value = none;
  unknown.not_identifiable = why;
  one.transmission.linear_stiffness.setConstant(none);
  one.elastic.push_back(unknown);
}

/// The part of the given covariance that is about the axes and the cables of this joint.
ParameterCovariance own_covariance(const Model& given, const Model& one) {
  ParameterCovariance own;
  std::vector<Eigen::Index> places;
  const auto add = [&](const std::string& name, const std::string& own_name) {
    const auto& names = given.covariance.parameters;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return;
    places.push_back(found - names.begin());
    own.parameters.push_back(own_name);
  };
  for_each_parameter(one.joints.front(),
                     [&](const Estimate& e) { add(e.name, e.name.substr(0, e.name.rfind('['))); });
  for (const Cable& cable : one.transmission.cables)
    for (int k = 0; k < cable.n_coefficients(); ++k) {
      const std::string name = coefficient_name(cable, k, one.rig.cables_given);
      add(name, name);
    }
  own.matrix = given.covariance.matrix(places, places);
  return own;
}

/// The joint as it was given, in the models that the others begin with.
std::vector<Model> as_given(std::span<const Model> given, std::span<const Model> started,
                            int joint) {
  std::vector<Model> models;
  for (std::size_t m = 0; m < given.size(); ++m) {
    Model& one = models.emplace_back(one_joint(started[m], joint));
    const Model own = one_joint(given[m], joint);
    one.joints = own.joints;
    one.transmission = own.transmission;
    one.covariance = own_covariance(given[m], one);
  }
  return models;
}

}  // namespace

std::vector<Model> with_base_fit(const std::vector<Model>& models, const RefineLogs& logs) {
  const ScanSettings settings;
  const auto kept = base_of(models, logs, settings);
  if (!kept) return models;
  const BaseFit& base = kept->base;
  return models_with(base.design,
                     physical_values(base.design, settings.block_seconds, base.levels, base.fit.x));
}

KeptJoint kept_joint(std::span<const Model> given, std::span<const Model> started, int joint,
                     const RefineLogs& logs) {
  std::vector<Model> own = as_given(given, started, joint);
  if (std::none_of(own.begin(), own.end(), has_start_values))
    return {std::move(own), "its values in the refined model are those that it had before"};
  if (auto fitted = base_estimates(own, logs))
    return {*std::move(fitted), "its values in the refined model are those of the base fit"};
  for (Model& one : own) drop_start_values(one);
  return {std::move(own),
          "its values that the logs do not determine are null in the refined model"};
}

}  // namespace cablefit

#include "cablefit/refine/held_cables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/bases/kept_joint.hpp"

namespace cablefit {
namespace {

void set_holding(bool holds, int joint, std::vector<Model>& models) {
  for (Model& model : models)
    model.joints[static_cast<std::size_t>(joint)].holds_passing_cables = holds;
}

/// Whether the model of one joint has cables that its motor does not wind.
bool any_to_hold(const Model& one) {
  const std::vector<Cable>& cables = one.transmission.cables;
  return std::any_of(cables.begin(), cables.end(), [](const Cable& c) { return !winds(c, 0); });
}

std::vector<std::string> names_of_held(const Model& one) {
  std::vector<std::string> names;
  for (const Cable& cable : one.transmission.cables)
    if (is_held(one, cable)) names.push_back(cable.name);
  return names;
}

}  // namespace

bool hold_cables(std::vector<Model>& one) {
  if (holds_cables(one.front(), 0) || !any_to_hold(one.front())) return false;
  set_holding(true, 0, one);
  return true;
}

void hold_undetermined_cables(std::vector<Model>& models, const RefineLogs& logs) {
  const int n = static_cast<int>(models.front().joints.size());
  for (int joint = 0; n > 1 && joint < n; ++joint) {
    set_holding(false, joint, models);
    const std::vector<Model> free = one_joint(models, joint);
    if (any_to_hold(free.front()) && !base_fit_of(free, logs)) set_holding(true, joint, models);
  }
}

bool holds_cables(const Model& model, int joint) {
  return model.joints[static_cast<std::size_t>(joint)].holds_passing_cables;
}

std::vector<int> refining_order(const Model& model) {
  std::vector<int> order(model.joints.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_partition(order.begin(), order.end(),
                        [&](int joint) { return !holds_cables(model, joint); });
  return order;
}

void take_refined_cables(const std::vector<Model>& one, std::vector<Model>& models) {
  for (std::size_t m = 0; m < one.size(); ++m) take_wound_cables(one[m], models[m]);
}

void warn_of_held_cables(RefineResult& result) {
  if (result.elastic_only || result.models.empty()) return;
  const std::vector<std::string> names = names_of_held(result.models.front());
  if (names.empty()) return;
  result.warnings.push_back(
      fmt::format("the logs do not separate the stiffness of {}: the values of the joints whose "
                  "motors wind them are used; move until one goes slack",
                  fmt::join(names, ", ")));
}

}  // namespace cablefit

// One pass of refine over all joints. Internal to refine/.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "cablefit/base/error.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/refine_result.hpp"

namespace cablefit {

/// Refines models of one joint each.
using RefineOne =
    std::function<RefineResult(std::span<const Model>, const RefineLogs&, const RefineOptions&)>;

/// Each joint from the same models.
struct JointRun {
  std::vector<Model> models;  ///< of all joints, with base fits
  std::vector<RefineResult> joints;
  std::optional<Error> error;  ///< of the first joint that could not be refined

  bool is_refined() const {
    return std::any_of(joints.begin(), joints.end(),
                       [](const RefineResult& r) { return r.not_refined.empty(); });
  }
  bool any_gap() const {
    return std::any_of(joints.begin(), joints.end(), [](const RefineResult& r) {
      return !r.not_refined.empty() || r.verdict != Verdict::none;
    });
  }
};

/// Refines one joint after the other, those that hold cables last. A joint that cannot be refined
/// does not stop the others. `given`: models of all joints, one per preload.
JointRun run_joints(std::span<const Model> given, const RefineLogs& logs,
                    const RefineOptions& options, const RefineOne& refine_one);

}  // namespace cablefit

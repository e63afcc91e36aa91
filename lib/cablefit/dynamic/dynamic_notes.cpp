#include "cablefit/dynamic/dynamic_notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cablefit/samples/agreement.hpp"

namespace cablefit {
namespace {

constexpr double kRangeSlack = 0.02;  // of stage 1's range: rounding, not extrapolation

/// Stage 1's range is where its curve was fitted; beyond it the curve is a guess.
struct Range {
  double low = kUnbounded, high = -kUnbounded;
};

Range deflections_of(const ElasticPreload& stage1, int joint) {
  if (stage1.joints.empty()) return {stage1.deflection_low, stage1.deflection_high};
  const ElasticJoint& own = stage1.joints[static_cast<std::size_t>(joint)];
  return {own.deflection_low, own.deflection_high};
}

void note_extrapolation(const ElasticPreload& stage1, const std::vector<EquationRows>& equations,
                        int joint, double theta_0, DynamicPreload& preload) {
  const Range known = deflections_of(stage1, joint);
  const double slack = kRangeSlack * (known.high - known.low);
  double low = kUnbounded, high = -kUnbounded;
  for (const EquationRows& e : equations) {
    if (e.columns.place.joint != joint) continue;
    low = std::min(low, e.deflection_low - theta_0);
    high = std::max(high, e.deflection_high - theta_0);
  }
  if (low >= known.low - slack && high <= known.high + slack) return;
  preload.warnings.push_back(fmt::format(
      "{}deflections of {:.3g} to {:.3g} {} leave the range of stage 1 ({:.3g} to {:.3g}): the "
      "elastic torque is extrapolated there",
      stage1.joints.empty() ? "" : fmt::format("joint {}: ", joint + 1), low, high, stage1.unit,
      known.low, known.high));
}

}  // namespace

void note_extrapolations(const DynamicJob& job, const std::vector<EquationRows>& equations,
                         const ElasticResult& elastic, DynamicPreload& preload) {
  if (job.rigid) return;
  for (const ElasticPreload& stage1 : elastic.preloads)
    for (int joint = 0; joint < job.n_joints(); ++joint)
      if (stage1.name == job.preload)
        note_extrapolation(stage1, equations, joint,
                           job.elastic.front()->transmission.theta_0(joint), preload);
}

void note_load(const DynamicJob& job, DynamicPreload& preload) {
  const Load& load = job.rig().load;
  if (load.law != nullptr) {
    preload.load_inertia = load.law->inertia(load.parameters);
    const bool by_position =
        load.law->torque(load.parameters, 0.1) != load.law->torque(load.parameters, -0.2);
    if (job.rigid && !load.law->from_column && by_position)
      require_measured(job.first_log().plan, Channel::theta, "a load that depends on position");
    return;
  }
  if (job.rigid) return;
  for (std::string& warning : unloaded_warnings(job.logs, job.wanted))
    preload.warnings.push_back(std::move(warning));
}

void note_free_fall(const Load& load, const std::vector<EquationRows>& equations,
                    DynamicPreload& preload) {
  if (load.law == nullptr || load.law->free_fall == nullptr) return;
  const EquationRows& link = equations.front();  // or the one of a rigid drive
  const double most = load.law->free_fall(load.parameters);
  if (link.acceleration > most)
    preload.warnings.push_back(fmt::format(
        "the link accelerates by up to {:.3g} rad/s^2, beyond the {:.3g} rad/s^2 (g/r) at which a "
        "'{}' load lets its rope go slack: there tau_load is not what the rig file says; move more "
        "gently or hang the mass on a smaller radius",
        link.acceleration, most, load.law->name));
}

}  // namespace cablefit

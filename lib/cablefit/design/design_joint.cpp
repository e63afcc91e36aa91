// One joint of preloaded cables: closure, stiffness, tensions, friction and simpler models.
#include <cmath>
#include <numbers>

#include "cablefit/design/curves/curve_models.hpp"
#include "cablefit/design/curves/joint_curve.hpp"
#include "cablefit/design/design_friction.hpp"
#include "cablefit/design/design_sweep.hpp"
#include "cablefit/model/joint_inertias.hpp"

namespace cablefit {
namespace {

constexpr int kRangeSteps = 400;  // over the working range, for its extremes

/// 1/J_motor + 1/J_link, J_link of a coupled arm with the other links held at q = 0; NaN when the
/// model has no inertias.
double mobility(const Model& model, int joint) {
  if (model.joints.empty()) return kNotKnown;
  const auto k = static_cast<std::size_t>(joint);
  return 1 / inertia_of(model.joints[k].motor) + 1 / link_inertias(model)[k];
}

/// `visit` at deflections over the range and at every change of a cable.
template <typename Visit>
void over_range(const JointCurve& curve, const WorkingRange& range, Visit visit) {
  for (int i = 0; i <= kRangeSteps; ++i)
    visit(range.low + (range.high - range.low) * i / kRangeSteps);
  for (const double at : smooth_pieces(curve, range.low, range.high)) visit(at);
}

void add_stiffness(const JointCurve& curve, const WorkingRange& range, DesignJoint& out) {
  const double beside = 1e-9 * (range.high - range.low);
  out.stiffness_zero = (curve.stiffness(-beside) + curve.stiffness(beside)) / 2;
  out.stiffness_low = curve.stiffness(range.low);
  out.stiffness_high = curve.stiffness(range.high);
  out.stiffness_least = out.stiffness_most = out.stiffness_low;
  // On either side of a change of a cable its slope jumps; the step there is what belongs to it.
  const double hair = 1e-9 * (range.high - range.low);
  over_range(curve, range, [&](double phi) {
    for (const double at : {phi - hair, phi + hair}) {
      if (at < range.low || at > range.high) continue;
      out.stiffness_least = std::min(out.stiffness_least, curve.stiffness(at));
      out.stiffness_most = std::max(out.stiffness_most, curve.stiffness(at));
    }
  });
}

void add_tensions(const JointCurve& curve, const WorkingRange& range, DesignJoint& out) {
  const Eigen::VectorXd rest = curve.tensions(0);
  for (Eigen::Index i = 0; i < rest.size(); ++i)
    out.tensions.push_back(
        {curve.transmission().cables[static_cast<std::size_t>(i)].name, rest(i), rest(i), rest(i)});
  over_range(curve, range, [&](double phi) {
    const Eigen::VectorXd f = curve.tensions(phi);
    for (Eigen::Index i = 0; i < f.size(); ++i) {
      TensionRange& t = out.tensions[static_cast<std::size_t>(i)];
      t.least = std::min(t.least, f(i));
      t.largest = std::max(t.largest, f(i));
    }
  });
}

void add_closure(const JointCurve& curve, DesignJoint& out) {
  const ClosureRange closure = closure_range(curve);
  out.closure_low = closure.low;
  out.closure_high = closure.high;
  out.closure_torque_low = closure.torque_low;
  out.closure_torque_high = closure.torque_high;
  out.closure_torque = closure.threshold();
  const bool low_first = -closure.torque_low < closure.torque_high;
  const int first = low_first ? closure.cable_low : closure.cable_high;
  if (first >= 0)
    out.slack_first = curve.transmission().cables[static_cast<std::size_t>(first)].name;
}

std::optional<CollisionThreshold> collision(const DesignOptions& options, double model_error) {
  if (!options.detector) return std::nullopt;
  CollisionDetector detector = *options.detector;
  detector.model_error += model_error;
  return collision_threshold(detector);
}

ModelCost cost_of(const CurveModel& simpler, const JointCurve& curve, const WorkingRange& range,
                  double mobility, const DesignOptions& options) {
  ModelCost cost;
  cost.model = simpler.name;
  cost.coefficients = simpler.coefficients;
  cost.max_error = simpler.max_error;
  cost.rms_error = simpler.rms_error;
  cost.at = simpler.at;
  cost.static_error = simpler.static_error;
  cost.collision = collision(options, simpler.max_error);
  const double hair = 1e-9 * (range.high - range.low);
  double least = kUnbounded, most = 0;
  over_range(curve, range, [&](double phi) {
    for (const double at : {phi - hair, phi + hair}) {
      if (at < range.low || at > range.high) continue;
      const double k = std::max(0.0, simpler.stiffness(at));
      least = std::min(least, k);
      most = std::max(most, k);
    }
  });
  const auto hz = [&](double k) { return std::sqrt(k * mobility) / (2 * std::numbers::pi); };
  cost.resonance_low = hz(least);
  cost.resonance_high = hz(most);
  return cost;
}

}  // namespace

const ModelCost& DesignJoint::model(const std::string& which) const {
  for (const ModelCost& cost : models)
    if (cost.model == which) return cost;
  return models.back();
}

DesignJoint describe_joint(const Model& model, const Transmission& preloaded, int joint,
                           const DesignOptions& options) {
  const JointCurve curve(preloaded, joint);
  const WorkingRange range = working_range(curve, options.torque);
  DesignJoint out;
  out.name = model.rig.joints[static_cast<std::size_t>(joint)];
  out.low = range.low;
  out.high = range.high;
  add_closure(curve, out);
  add_stiffness(curve, range, out);
  add_tensions(curve, range, out);
  out.friction =
      design_friction(model, curve, options.torque, options.tension_friction, options.friction);
  std::vector<CurveModel> models = simpler_models(curve, range, options.orders);
  models.push_back(cables_themselves(curve));
  const double per_inertia = mobility(model, joint);
  for (const CurveModel& simpler : models)
    out.models.push_back(cost_of(simpler, curve, range, per_inertia, options));
  return out;
}

}  // namespace cablefit

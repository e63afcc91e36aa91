#include "cablefit/design/friction_curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cablefit/base/error.hpp"
#include "cablefit/design/curves/joint_curve.hpp"
#include "cablefit/design/design_friction.hpp"
#include "cablefit/model/principal_copies.hpp"

namespace cablefit {
namespace {

constexpr double kAlikePreload = 0.02;  // of an l_o: one preload
constexpr double kSmallest = 1e-9;      // m (rad): no preload
constexpr double kSignificance = 0.05;  // of a misfit
constexpr double kTwoSided = 1.96;

/// What is read off a model at its own preload.
struct Reading {
  double l_o = 0, tension = 0, value = 0;
};

/// A number of friction of one joint: an effect's parameter, or all dry friction.
struct Quantity {
  int joint = 0;
  const Estimate* estimate = nullptr;  ///< nullptr: dry friction
  bool on_link = false;
  std::size_t effect = 0;
};

const std::vector<EffectInstance>& side_of(const Model& model, const Quantity& q) {
  const JointModel& joint = model.joints[static_cast<std::size_t>(q.joint)];
  return q.on_link ? joint.link : joint.motor;
}

double value_of(const Model& model, const Quantity& q, const JointCurve& curve) {
  if (q.estimate != nullptr) return side_of(model, q)[q.effect].parameters.front().value;
  return friction_at(model, curve, 0, 1, 0);
}

Reading reading_of(const Model& model, const Quantity& q) {
  const JointCurve curve(model.transmission, q.joint);
  return {std::max(0.0, model.transmission.cables.front().initial_elongation),
          curve.tension_at_pulleys(0), value_of(model, q, curve)};
}

/// Variances by the model's covariance; without one that of the estimate alone.
PreloadEstimate with_variances(const std::vector<MovedModel>& copies, const Quantity& q,
                               const Reading& middle, double Reading::*x, double alone) {
  PreloadEstimate out{middle.*x, middle.value, 0, 0, 0};
  if (copies.empty() && std::isfinite(alone)) out.var_y = alone * alone;
  for (const MovedModel& copy : copies) {
    const Reading moved = reading_of(copy.model, q);
    const double dx = (moved.*x - middle.*x) / copy.by;
    const double dy = (moved.value - middle.value) / copy.by;
    out.var_x += dx * dx;
    out.var_y += dy * dy;
    out.cov += dx * dy;
  }
  return out;
}

/// sd of the quantity as the fit gives it; of the dry friction that of both parts.
double own_sd(const Model& model, const Quantity& q) {
  if (q.estimate != nullptr) return side_of(model, q)[q.effect].parameters.front().sd;
  const JointModel& joint = model.joints[static_cast<std::size_t>(q.joint)];
  double sum = 0;
  for (const auto* side : {&joint.link, &joint.motor})
    for (const EffectInstance& e : *side)
      if (e.effect->follows == MotionPart::direction)
        sum += e.parameters.front().sd * e.parameters.front().sd;
  return std::sqrt(sum);
}

void add_side(const std::vector<EffectInstance>& effects, int joint, bool on_link,
              std::vector<Quantity>& all) {
  for (std::size_t k = 0; k < effects.size(); ++k) {
    const MotionPart part = effects[k].effect->follows;
    if (part == MotionPart::direction || part == MotionPart::velocity)
      all.push_back({joint, &effects[k].parameters.front(), on_link, k});
  }
}

/// As the first model has them.
std::vector<Quantity> quantities(const Model& model) {
  std::vector<Quantity> all;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    add_side(model.joints[j].link, static_cast<int>(j), true, all);
    add_side(model.joints[j].motor, static_cast<int>(j), false, all);
    all.push_back({static_cast<int>(j)});
  }
  return all;
}

/// The same number of another model: by its name.
std::optional<Quantity> in_model(const Model& model, const Quantity& q) {
  if (q.estimate == nullptr) return q;
  const std::vector<EffectInstance>& effects = side_of(model, q);
  for (std::size_t k = 0; k < effects.size(); ++k)
    if (!effects[k].parameters.empty() && effects[k].parameters.front().name == q.estimate->name)
      return Quantity{q.joint, &effects[k].parameters.front(), q.on_link, k};
  return std::nullopt;
}

bool differ(std::span<const PreloadEstimate> all) {
  for (const PreloadEstimate& e : all)
    if (!same_preload(e.x, all.front().x)) return true;
  return false;
}

/// The line over the tension where it explains the preloads and does not fall.
void choose_line(std::span<const PreloadEstimate> by_tension,
                 std::span<const PreloadEstimate> by_length, FrictionCurve& curve) {
  if (by_tension.size() < 2 || !differ(by_tension)) return;
  curve.line = fit_preload_line(by_tension);
  curve.by_tension = true;
  const bool falls = curve.line->slope < -kTwoSided * curve.line->slope_sd();
  if ((!falls && curve.line->p_value >= kSignificance) || !differ(by_length)) return;
  const PreloadLine over_length = fit_preload_line(by_length);
  if (over_length.misfit > curve.line->misfit) return;
  curve.line = over_length;
  curve.by_tension = false;
}

FrictionCurve curve_of(const Quantity& q, std::span<const Model> fitted,
                       std::span<const std::vector<MovedModel>> copies) {
  FrictionCurve curve{q.joint, kDryFriction, torque_unit(fitted.front().rig.axes.all()),
                      {},      {},           false};
  if (q.estimate != nullptr) {
    curve.name = q.estimate->name;
    const std::string_view unit =
        side_of(fitted.front(), q)[q.effect].effect->parameters.front().unit;
    curve.unit = unit_for(fitted.front().rig.axes.all(), unit);
  }
  std::vector<PreloadEstimate> by_tension, by_length;
  for (std::size_t k = 0; k < fitted.size(); ++k) {
    const auto own = in_model(fitted[k], q);
    if (!own) continue;
    const Reading reading = reading_of(fitted[k], *own);
    if (!std::isfinite(reading.value)) continue;  // the fit did not determine it
    const double sd = own_sd(fitted[k], *own);
    by_tension.push_back(with_variances(copies[k], *own, reading, &Reading::tension, sd));
    by_length.push_back(with_variances(copies[k], *own, reading, &Reading::l_o, sd));
    const double var = by_tension.back().var_y;
    curve.points.push_back({fitted[k].preload, reading.l_o, reading.tension, reading.value,
                            var > 0 ? std::sqrt(var) : sd});
  }
  choose_line(by_tension, by_length, curve);
  return curve;
}

void require_same_joints(std::span<const Model> fitted) {
  for (const Model& model : fitted)
    if (model.joints.size() != fitted.front().joints.size() || model.transmission.cables.empty())
      throw Error(ErrorKind::input,
                  fmt::format("the fit of preload '{}' has other joints or no cables; give fits of "
                              "one rig, with cables (--model poly)",
                              model.preload));
}

/// No friction is below 0.
FrictionValue value_within(double value, double sd, double reach) {
  if (!std::isfinite(reach)) return {value, sd, reach, reach};
  return {value, sd, std::max(0.0, value - reach), value + reach};
}

}  // namespace

bool same_preload(double l_o, double other) {
  return std::abs(l_o - other) <=
         kSmallest + kAlikePreload * std::max(std::abs(l_o), std::abs(other));
}

std::vector<FrictionCurve> friction_curves(std::span<const Model> fitted) {
  std::vector<FrictionCurve> curves;
  if (fitted.empty()) return curves;
  require_same_joints(fitted);
  std::vector<std::vector<MovedModel>> copies;
  for (const Model& model : fitted) copies.push_back(principal_copies(model));
  for (const Quantity& q : quantities(fitted.front())) {
    FrictionCurve curve = curve_of(q, fitted, copies);
    if (!curve.points.empty()) curves.push_back(std::move(curve));
  }
  return curves;
}

const FrictionCurve* find_curve(std::span<const FrictionCurve> curves, int joint,
                                const std::string& name) {
  for (const FrictionCurve& curve : curves)
    if (curve.joint == joint && curve.name == name) return &curve;
  return nullptr;
}

std::optional<FrictionValue> FrictionCurve::at(double l_o, double tension) const {
  if (!line) {
    if (points.size() != 1 || !same_preload(std::max(0.0, l_o), points.front().l_o))
      return std::nullopt;
    const FittedFriction& only = points.front();
    return value_within(only.value, only.sd, kTwoSided * only.sd);
  }
  const double x = by_tension ? tension : std::max(0.0, l_o);
  if (!line->holds(x)) return std::nullopt;
  const double sd = line->sd(x);
  return value_within(std::max(0.0, line->value(x)), sd, line->t_quantile * sd);
}

}  // namespace cablefit

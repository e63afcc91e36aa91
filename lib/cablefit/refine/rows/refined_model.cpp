#include "cablefit/refine/rows/refined_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "cablefit/estimate/spread/long_run.hpp"
#include "cablefit/model/effects/effect_parameter.hpp"
#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/rows/shape_moves.hpp"

namespace cablefit {
namespace {

void set_estimate(Estimate& e, double value, double sd, double dof) {
  const auto none = std::numeric_limits<double>::quiet_NaN();
  e.value = value;
  e.sd = e.sd_white = e.ci_low = e.ci_high = none;
  e.profiled = false;
  e.active_bound.clear();
  e.not_identifiable =
      std::isnan(sd) ? "the logs do not separate it from the other parameters" : "";
  if (!(sd > 0) || !std::isfinite(sd)) return;
  e.sd = sd;  // see FinalFit; there is none of white residuals
  const double reach = t_quantile_975(dof) * sd;
  e.ci_low = value - reach;
  e.ci_high = value + reach;
}

Estimate estimate_of(const ParameterInfo& info, double value, double sd, double dof) {
  Estimate e;
  e.name = info.name;
  e.symbol = info.symbol;
  e.unit = info.unit;
  set_estimate(e, value, sd, dof);
  return e;
}

double sd_at(const FinalFit& fit, Eigen::Index i) { return std::sqrt(fit.covariance(i, i)); }

/// Amplitude of each harmonic from its sine and cosine, by the delta method.
std::vector<Estimate> amplitudes(const Variant& variant, const FinalFit& fit, Eigen::Index first) {
  constexpr std::array<std::string_view, 3> kNames{"amplitude", "amplitude_2", "amplitude_3"};
  std::vector<Estimate> out;
  const Effect& row = *variant.effect;
  const int n_harmonics = std::min<int>(row.n_harmonics, static_cast<int>(n_linear(variant)) / 2);
  for (int h = 0; h < std::min(n_harmonics, 3); ++h) {
    const Eigen::Index at = first + 2 * h;
    const double a = std::hypot(fit.x(at), fit.x(at + 1));
    if (!(a > 0)) continue;
    const Eigen::Vector2d slope(fit.x(at) / a, fit.x(at + 1) / a);
    const double sd = std::sqrt(slope.dot(fit.covariance.block<2, 2>(at, at) * slope));
    const std::string_view name = kNames[static_cast<std::size_t>(h)];
    const std::string_view unit = row.parameters[static_cast<std::size_t>(2 * h)].unit;
    out.push_back(estimate_of({name, name, unit, ""}, a, sd, fit.degrees_of_freedom));
  }
  return out;
}

/// The parameters of arm and effects that have a column; an inertia that the rig file gives has
/// none.
void set_effect_estimates(const Design& design, const FinalFit& fit, Model& model) {
  JointModel& axes = model.joints.front();
  const std::vector<ModelParameter>& columns = design.layout.parameters;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const ModelParameter& p = columns[k];
    const auto at = static_cast<Eigen::Index>(k);
    if (p.kind == ParameterKind::arm)
      set_estimate(model.arm[p.index], fit.x(at), sd_at(fit, at), fit.degrees_of_freedom);
    if (p.kind != ParameterKind::effect) continue;
    set_estimate((p.on_link ? axes.link : axes.motor)[p.effect].parameters[p.index], fit.x(at),
                 sd_at(fit, at), fit.degrees_of_freedom);
  }
}

/// The coefficients of stage 1 in the file, as far as there are any. A cable that got a higher
/// order has more than stage 1 had.
void set_elastic_estimates(const Design& design, const FinalFit& fit, Model& model) {
  if (model.rigid) return;
  std::vector<Estimate> elastic;
  Eigen::Index at = design.layout.n_link + design.layout.n_motor;
  const auto add = [&](const std::string& name, const std::string& unit) {
    Estimate e;
    e.name = e.symbol = name;
    e.unit = unit;
    set_estimate(e, fit.x(at), sd_at(fit, at), fit.degrees_of_freedom);
    elastic.push_back(std::move(e));
    ++at;
  };
  if (model.transmission.cables.empty()) add("K", "N m/rad");
  for (const Cable& cable : model.transmission.cables)
    for (int i = 0; !is_held(model, cable) && i < cable.n_coefficients(); ++i)
      add(coefficient_name(cable, i, model.rig.cables_given),
          coefficient_unit(*cable.law, i, model.rig.cables_given));
  for (const Estimate& old : model.elastic) {
    const bool again = find_estimate(elastic, old.name) != nullptr;
    if (!again) elastic.push_back(old);
  }
  model.elastic = std::move(elastic);
}

/// Those of the effects that both designs begin with.
std::vector<ParameterShift> kept_shifts(const Design& first, const Eigen::VectorXd& before,
                                        const Design& design, const FinalFit& fit) {
  const auto old = first_columns(first), now = first_columns(design);
  std::vector<ParameterShift> shifts;
  for (std::size_t k = 0; k < first.added.size(); ++k) {
    const Effect& row = *first.added[k].effect;
    for (Eigen::Index p = 0; p < n_linear(first.added[k]); ++p) {
      const ParameterInfo& info = row.parameters[static_cast<std::size_t>(p)];
      shifts.push_back({fmt::format("{} ({}) {}", row.name, to_string(row.site), info.name),
                        unit_for(design.models.front().rig.axes.all(), info.unit),
                        before(old[k] + p), fit.x(now[k] + p), sd_at(fit, now[k] + p)});
    }
  }
  return shifts;
}

/// What a model holds of an effect: other cables it has already, what passed is over, and what
/// lasts has happened before any log to come.
std::optional<EffectInstance> as_state(EffectInstance instance) {
  const Effect& row = *instance.effect;
  if (row.change != nullptr || row.passes() || instance.ends_with_log) return {};
  instance.event_log = 0;
  instance.event_time = 0;
  return instance;
}

/// Names of the parameters of FinalFit, in its order; empty: a parameter that no model file has.
std::vector<std::string> fitted_names(const Design& design) {
  std::vector<std::string> names;
  for (const ModelParameter& p : design.layout.parameters) names.push_back(p.name);
  const auto name = [](const Effect& row, std::size_t parameter) {
    return row.change != nullptr ? "" : added_parameter_name(row, row.parameters[parameter]);
  };
  for (const Variant& variant : design.added)
    for (Eigen::Index p = 0; p < n_linear(variant); ++p)
      names.push_back(name(*variant.effect, static_cast<std::size_t>(p)));
  for (const FreeShape& at : free_shapes(design)) {
    const Effect& row = *design.added[at.variant].effect;
    names.push_back(name(row, row.n_linear() + at.shape));
  }
  return names;
}

/// Of all that the rows determine.
ParameterCovariance covariance_of(const Design& design, const FinalFit& fit) {
  ParameterCovariance covariance;
  const std::vector<std::string> names = fitted_names(design);
  std::vector<Eigen::Index> places;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    if (names[k].empty() || !std::isfinite(fit.covariance(at, at))) continue;
    covariance.parameters.push_back(names[k]);
    places.push_back(at);
  }
  covariance.matrix = fit.covariance(places, places);
  return covariance;
}

}  // namespace

std::vector<NamedEffect> named_effects(const Design& design, const FinalFit& fit) {
  const Model& model = design.models.front();
  std::vector<NamedEffect> effects;
  const auto first = first_columns(design);
  Eigen::Index shape_at = design.n_columns();
  for (std::size_t k = 0; k < design.added.size(); ++k) {
    const Variant& variant = design.added[k];
    const Effect& row = *variant.effect;
    const Eigen::Index n = n_linear(variant);
    NamedEffect& effect = effects.emplace_back();
    effect.instance.effect = &row;
    effect.instance.event_log = variant.event_log;
    effect.instance.event_time = variant.event_time;
    effect.instance.ends_with_log = variant.ends_with_log;
    const auto add = [&](std::size_t parameter, double value, double sd) {
      effect.instance.parameters.push_back(
          estimate_of(row.parameters[parameter], value, sd, fit.degrees_of_freedom));
      Estimate& e = effect.instance.parameters.back();
      e.unit = unit_for(model.rig.axes.all(), e.unit);
    };
    for (Eigen::Index p = 0; p < n; ++p)
      add(static_cast<std::size_t>(p), fit.x(first[k] + p), sd_at(fit, first[k] + p));
    const Eigen::Index dry = n == 0 && row.takes_dry_friction ? dry_column(design, row) : -1;
    for (auto p = static_cast<std::size_t>(n); p < row.n_linear(); ++p)
      add(p, dry >= 0 ? fit.x(dry) : 0, dry >= 0 ? sd_at(fit, dry) : 0);
    for (std::size_t p = 0; p < variant.shape.size(); ++p)
      add(row.n_linear() + p, variant.shape[p], is_free(variant, p) ? sd_at(fit, shape_at++) : 0);
    effect.derived = amplitudes(variant, fit, first[k]);
    for (Estimate& e : effect.derived) e.unit = unit_for(model.rig.axes.all(), e.unit);
    if (n > 0) effect.torque_rms = carried_torque(design, fit.x, first[k], n);
  }
  return effects;
}

std::vector<ParameterShift> parameter_shifts(const Design& first, const Eigen::VectorXd& before,
                                             const Design& design, const FinalFit& fit) {
  const std::vector<ModelParameter>& old = first.layout.parameters;
  const std::vector<ModelParameter>& now = design.layout.parameters;
  std::vector<ParameterShift> shifts;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const auto same = std::find_if(old.begin(), old.end(),
                                   [&](const ModelParameter& p) { return p.name == now[i].name; });
    if (same == old.end()) continue;  // the effect brought it
    const auto at = static_cast<Eigen::Index>(i);
    shifts.push_back(
        {now[i].name, now[i].unit, before(same - old.begin()), fit.x(at), sd_at(fit, at)});
  }
  for (ParameterShift& shift : kept_shifts(first, before, design, fit))
    shifts.push_back(std::move(shift));
  return shifts;
}

std::vector<Model> models_with(const Design& design, const Eigen::VectorXd& x) {
  FinalFit fit;
  fit.x = x;
  Eigen::Index n = design.n_columns();
  for (const Variant& variant : design.added) n += static_cast<Eigen::Index>(variant.shape.size());
  fit.covariance = Eigen::MatrixXd::Zero(n, n);
  const std::vector<NamedEffect> effects = named_effects(design, fit);
  std::vector<Model> models = design.models;
  for (Model& model : models) {
    set_base_values(design.layout, x, model);
    for (const Variant& variant : design.added) change_again(variant, model.transmission);
    for (const NamedEffect& effect : effects)
      if (auto instance = as_state(effect.instance))
        model.joints.front().added.push_back(std::move(*instance));
  }
  return models;
}

std::vector<Model> refined_models(const Design& design, const FinalFit& fit) {
  std::vector<Model> models = models_with(design, fit.x);
  const std::vector<NamedEffect> effects = named_effects(design, fit);
  for (Model& model : models) {
    set_effect_estimates(design, fit, model);
    set_elastic_estimates(design, fit, model);
    model.covariance = covariance_of(design, fit);
    auto& instances = model.joints.front().added;
    std::size_t next = 0;
    for (const NamedEffect& effect : effects)
      if (auto instance = as_state(effect.instance)) instances[next++] = std::move(*instance);
  }
  return models;
}

}  // namespace cablefit

#include "cablefit/refine/base_rows.hpp"

#include "cablefit/elastic/elastic_columns.hpp"

namespace cablefit {
namespace {

/// A shape parameter (v_s) stays where the table has it; its linear ones are columns.
Eigen::Index n_linear(const std::vector<EffectInstance>& effects) {
  Eigen::Index n = 0;
  for (const EffectInstance& instance : effects)
    n += static_cast<Eigen::Index>(instance.effect->n_linear());
  return n;
}

void add_infos(const std::vector<EffectInstance>& effects, std::vector<ParameterInfo>& infos) {
  for (const EffectInstance& instance : effects)
    for (const ParameterInfo& info : instance.effect->parameters.first(instance.effect->n_linear()))
      infos.push_back(info);
}

Eigen::Index n_elastic(const Model& model) {
  if (model.rigid) return 0;
  return model.transmission.cables.empty() ? 1 : n_elastic_columns(model.transmission);
}

template <typename Axes, typename Use>
void for_each_value(Axes& axes, Use use) {
  for (auto* effects : {&axes.link, &axes.motor})
    for (auto& instance : *effects)
      for (std::size_t i = 0; i < instance.effect->n_linear(); ++i)
        use(instance.parameters[i].value);
}

void fill_effects(const std::vector<EffectInstance>& effects, const Motion& motion,
                  Eigen::Ref<Eigen::MatrixXd> out) {
  Eigen::Index first = 0;
  for (const EffectInstance& instance : effects) {
    const auto n = static_cast<Eigen::Index>(instance.effect->n_linear());
    instance.effect->regressor(motion, out.middleCols(first, n));
    first += n;
  }
}

void fill_elastic(const Model& model, const SmoothMotion& m, bool link,
                  Eigen::Ref<Eigen::MatrixXd> out) {
  if (out.cols() == 0) return;
  const Transmission& transmission = model.transmission;
  if (transmission.cables.empty()) {
    out.col(0) = (m.theta - transmission.encoder_zero()(0) - m.q).matrix();
  } else {
    JointSignals signals;
    signals.q = m.q;
    signals.theta = m.theta;
    elastic_basis(transmission, signals, link ? ElasticSide::link : ElasticSide::motor, out);
  }
  if (link) out = -out;
}

/// All columns and the response of one kind at the full rate.
Eigen::MatrixXd full_columns(RowKind kind, const SmoothMotion& m, const Model& model,
                             const BaseLayout& c) {
  const JointModel& axes = model.joints.front();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(m.size(), c.n() + 1);
  const bool link = kind == RowKind::link;
  if (link) {
    fill_effects(axes.link, {m.q, m.qd, m.qdd, m.q_direction}, all.leftCols(c.n_link));
  } else {
    fill_effects(axes.motor, {m.theta, m.thetad, m.thetadd, m.theta_direction},
                 all.middleCols(c.n_link, c.n_motor));
  }
  fill_elastic(model, m, link, all.middleCols(c.n_link + c.n_motor, c.n_elastic));
  all.col(c.n()) = (link ? m.tau_load : model.rigid ? m.tau + m.tau_load : m.tau).matrix();
  return all;
}

std::vector<RowKind> kinds_of(const Stretch& stretch, const Model& model) {
  if (stretch.blocked) return {RowKind::blocked};
  if (model.rigid) return {RowKind::motor};
  return {RowKind::link, RowKind::motor};
}

}  // namespace

BaseLayout base_layout(const Model& model) {
  BaseLayout layout;
  const JointModel& axes = model.joints.front();
  layout.n_link = n_linear(axes.link);
  layout.n_motor = n_linear(axes.motor);
  layout.n_elastic = n_elastic(model);
  add_infos(axes.link, layout.effects);
  add_infos(axes.motor, layout.effects);
  return layout;
}

Eigen::VectorXd base_values(const BaseLayout& layout, const Model& model) {
  Eigen::VectorXd values(layout.n());
  Eigen::Index next = 0;
  for_each_value(model.joints.front(), [&](double value) { values(next++) = value; });
  if (model.rigid) return values;
  if (model.transmission.cables.empty()) values(next) = model.transmission.linear_stiffness(0);
  for (const Cable& cable : model.transmission.cables)
    for (const double coefficient : cable.coefficients) values(next++) = coefficient;
  return values;
}

void set_base_values(const Eigen::VectorXd& values, Model& model) {
  Eigen::Index next = 0;
  for_each_value(model.joints.front(), [&](double& value) { value = values(next++); });
  if (model.rigid) return;
  if (model.transmission.cables.empty()) model.transmission.linear_stiffness(0) = values(next);
  for (Cable& cable : model.transmission.cables)
    for (double& coefficient : cable.coefficients) coefficient = values(next++);
}

StretchRows base_rows(const Stretch& stretch, const Model& model, const BaseLayout& layout,
                      const Smoothing& smoothing, const StretchRows* kept) {
  StretchRows rows;
  const bool held = model.rig.torque_hold != TorqueHold::none;
  rows.motion = smooth_motion_of(stretch.recording, stretch.t0, held, smoothing);
  const Kernel filter = gaussian(smoothing.columns, stretch.recording.period);
  for (const RowKind kind : kinds_of(stretch, model)) {
    KindRows& k = rows.kinds.emplace_back();
    k.kind = kind;
    const bool link = kind == RowKind::link;
    k.at = kept != nullptr
               ? kept->kinds[rows.kinds.size() - 1].at
               : moving_rows(link ? rows.motion.qd : rows.motion.thetad,
                             link ? smoothing.least_speed_q : smoothing.least_speed_theta,
                             stretch.recording.period, smoothing);
    const Eigen::MatrixXd all =
        apply_at(filter, full_columns(kind, rows.motion, model, layout), k.at);
    k.base = all.leftCols(layout.n());
    k.response = all.col(layout.n());
  }
  return rows;
}

}  // namespace cablefit

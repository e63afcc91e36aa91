#include "cablefit/refine/rows/base_rows.hpp"

#include <algorithm>

#include "cablefit/elastic/rows/elastic_columns.hpp"
#include "cablefit/model/one_joint.hpp"

namespace cablefit {
namespace {

Eigen::Index n_elastic(const Model& model) {
  if (model.rigid) return 0;
  return model.transmission.cables.empty() ? 1 : n_elastic_columns(model.transmission);
}

void fill_effects(const std::vector<EffectInstance>& effects, const Motion& motion,
                  Eigen::Ref<Eigen::MatrixXd> out) {
  for (std::size_t k = 0; k < effects.size(); ++k)
    fill_base_column(*effects[k].effect, motion, out.col(static_cast<Eigen::Index>(k)));
}

void fill_elastic(const Model& model, const SmoothMotion& m, bool link,
                  Eigen::Ref<Eigen::MatrixXd> out) {
  if (out.cols() == 0) return;
  const Transmission& transmission = model.transmission;
  if (transmission.cables.empty()) {
    out.col(0) = transmission.deflections(0, m.q, m.theta).matrix();
    if (link) out.col(0) *= transmission.reductions()(0);
  } else {
    JointSignals signals;
    signals.q = m.q;
    signals.theta = m.theta;
    elastic_basis(transmission, signals, link ? ElasticSide::link : ElasticSide::motor, out,
                  m.others);
  }
  if (link) out = -out;
}

/// Columns of the cables (or K) that are fitted; what the held ones give is added to `given`.
void fill_elastic(const Model& model, const SmoothMotion& m, bool link, const BaseLayout& c,
                  Eigen::Ref<Eigen::MatrixXd> out, Eigen::Ref<Eigen::VectorXd> given) {
  if (c.held.empty()) return fill_elastic(model, m, link, out);
  Eigen::MatrixXd all(m.size(), n_elastic(model));
  fill_elastic(model, m, link, all);
  out = all(Eigen::all, c.elastic);
  for (const BaseLayout::Held& held : c.held)
    given += parameter_value(model, held.parameter) * all.col(held.column);
}

Eigen::ArrayXd response_of(RowKind kind, const SmoothMotion& m, const Model& model) {
  if (kind == RowKind::link) return m.tau_load;
  return model.rigid ? Eigen::ArrayXd(m.tau + m.tau_load) : m.tau;
}

/// Torques of the links' masses on this one: base parameters with a column, and what the others
/// give with their values in the last column.
void fill_arm(const Model& model, const SmoothMotion& m, const BaseLayout& c,
              Eigen::Ref<Eigen::MatrixXd> all) {
  Eigen::MatrixXd own = arm_columns(model, m.links, m.links_d, m.links_dd);
  for (std::size_t k = 0; k < c.arm.size(); ++k) {
    all.col(static_cast<Eigen::Index>(k)) = own.col(c.arm[k]);
    own.col(c.arm[k]).setZero();
  }
  for (Eigen::Index k = 0; k < own.cols(); ++k)
    all.rightCols(1) += model.arm[static_cast<std::size_t>(k)].value * own.col(k);
}

/// The link's effects; that of a given inertia as a torque in the last column.
void fill_link(const Model& model, const SmoothMotion& m, const BaseLayout& c,
               Eigen::Ref<Eigen::MatrixXd> all) {
  const JointModel& axes = model.joints.front();
  const Motion motion{m.q, m.qd, m.qdd, m.q_direction};
  const auto n_arm = static_cast<Eigen::Index>(c.arm.size());
  if (model.is_coupled()) fill_arm(model, m, c, all);
  if (!c.given) return fill_effects(axes.link, motion, all.middleCols(n_arm, c.n_link - n_arm));
  Eigen::MatrixXd effects(m.size(), c.n_link + 1);
  fill_effects(axes.link, motion, effects);
  const Eigen::Index at = c.given->effect_column;
  all.leftCols(at) = effects.leftCols(at);
  all.middleCols(at, c.n_link - at) = effects.rightCols(c.n_link - at);
  all.rightCols(1) = c.given->inertia * effects.col(at);
}

/// All columns, the response and the given torque of one kind at the full rate.
Eigen::MatrixXd full_columns(RowKind kind, const SmoothMotion& m, const Model& model,
                             const BaseLayout& c) {
  const JointModel& axes = model.joints.front();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(m.size(), c.n() + 2);
  if (kind == RowKind::link) {
    fill_link(model, m, c, all);
  } else {
    fill_effects(axes.motor, {m.theta, m.thetad, m.thetadd, m.theta_direction},
                 all.middleCols(c.n_link, c.n_motor));
  }
  fill_elastic(model, m, kind == RowKind::link, c,
               all.middleCols(c.n_link + c.n_motor, c.n_elastic), all.col(c.n() + 1));
  all.col(c.n()) = response_of(kind, m, model).matrix();
  return all;
}

// Of the longest way of the other cables from the reference pose, which no effect changes.
constexpr double kSlackMargin = 0.1;

/// Samples at which an idle cable is taut, or near it: a late encoder shows it slack too long.
Eigen::Array<bool, Eigen::Dynamic, 1> is_idle_cable_taut(const Transmission& transmission,
                                                         const SmoothMotion& m) {
  std::vector<JointSignals> joint(1);
  joint.front().q = m.q;
  joint.front().theta = m.theta;
  double longest = 0;
  for (const Cable& cable : transmission.cables)
    longest = std::max(
        longest, elongation(transmission, cable, joint).maxCoeff() - cable.initial_elongation);
  Eigen::Array<bool, Eigen::Dynamic, 1> is_taut =
      Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(m.size(), false);
  for (const Cable& cable : transmission.idle_cables)
    is_taut = is_taut || elongation(transmission, cable, joint) > -kSlackMargin * longest;
  return is_taut;
}

/// Without those for which an idle cable is taut within reach of the kernel.
void erase_unknown(const Transmission& transmission, const SmoothMotion& m, Eigen::Index reach,
                   std::vector<Eigen::Index>& rows) {
  if (transmission.idle_cables.empty()) return;
  const auto is_taut = is_idle_cable_taut(transmission, m);
  std::erase_if(rows,
                [&](Eigen::Index i) { return is_taut.segment(i - reach, 2 * reach + 1).any(); });
}

std::vector<RowKind> kinds_of(const Stretch& stretch, const Model& model) {
  if (stretch.blocked) return {RowKind::blocked};
  if (model.rigid) return {RowKind::motor};
  return {RowKind::link, RowKind::motor};
}

/// Samples from one evaluation of cables and torques to the next.
Eigen::Index spacing(const Smoothing& smoothing, Evaluation evaluation) {
  return evaluation == Evaluation::coarse ? smoothing.stride : 1;
}

/// Positions at every so many of the samples.
SmoothMotion thinned_positions(const SmoothMotion& m, Eigen::Index every) {
  const auto some = Eigen::seq(0, m.size() - 1, every);
  SmoothMotion out;
  out.period = static_cast<double>(every) * m.period;
  out.q = m.q(some);
  out.theta = m.theta(some);
  if (m.others.cols() > 0) out.others = m.others(some, Eigen::all);
  return out;
}

/// The numbers of the same samples there.
std::vector<Eigen::Index> thinned(std::vector<Eigen::Index> at, Eigen::Index every) {
  for (Eigen::Index& i : at) i /= every;
  return at;
}

}  // namespace

std::optional<double> given_link_inertia(const Model& model) {
  const std::vector<double>& given = model.rig.arm.parameters.J_link;
  return model.rigid || given.empty() ? std::nullopt : std::optional(given.front());
}

BaseLayout base_layout(const Model& model) {
  BaseLayout layout;
  const JointModel& axes = model.joints.front();
  if (model.is_coupled()) layout.arm = determined_arm_columns(model);
  layout.n_link = static_cast<Eigen::Index>(layout.arm.size() + axes.link.size());
  layout.has_given = model.is_coupled();
  layout.n_motor = static_cast<Eigen::Index>(axes.motor.size());
  Eigen::Index column = 0;  // of the cables
  const std::optional<double> given = given_link_inertia(model);
  for (ModelParameter& p : model_parameters(model)) {
    const bool is_of_arm = p.kind == ParameterKind::arm &&
                           std::find(layout.arm.begin(), layout.arm.end(),
                                     static_cast<Eigen::Index>(p.index)) != layout.arm.end();
    const bool is_column = is_of_arm || p.kind == ParameterKind::effect ||
                           p.kind == ParameterKind::stiffness ||
                           p.kind == ParameterKind::coefficient;
    if (!is_column) continue;
    if (p.kind == ParameterKind::coefficient &&
        is_held(model, model.transmission.cables[p.cable])) {
      layout.held.push_back({column++, std::move(p)});
      continue;
    }
    if (p.kind == ParameterKind::stiffness || p.kind == ParameterKind::coefficient)
      layout.elastic.push_back(column++);
    const bool is_effect = p.kind == ParameterKind::effect;
    if (is_effect &&
        (p.on_link ? axes.link : axes.motor)[p.effect].effect->follows == MotionPart::direction)
      (p.on_link ? layout.dry_link : layout.dry_motor) =
          static_cast<Eigen::Index>(layout.parameters.size());
    if (is_effect && p.on_link && given && axes.link[p.effect].effect->is_inertia()) {
      layout.given = {{static_cast<Eigen::Index>(layout.parameters.size()), *given}};
      layout.has_given = true;
      layout.n_link -= 1;
      continue;
    }
    layout.parameters.push_back(std::move(p));
  }
  layout.n_elastic = static_cast<Eigen::Index>(layout.elastic.size());
  layout.has_given = layout.has_given || !layout.held.empty();
  return layout;
}

Eigen::VectorXd base_values(const BaseLayout& layout, const Model& model) {
  Eigen::VectorXd values(layout.n());
  for (std::size_t k = 0; k < layout.parameters.size(); ++k)
    values(static_cast<Eigen::Index>(k)) = parameter_value(model, layout.parameters[k]);
  return values;
}

void set_base_values(const BaseLayout& layout, const Eigen::VectorXd& values, Model& model) {
  for (std::size_t k = 0; k < layout.parameters.size(); ++k)
    set_parameter_value(model, layout.parameters[k], values(static_cast<Eigen::Index>(k)));
}

Eigen::Index count_rows(const std::vector<StretchRows>& rows) {
  Eigen::Index n = 0;
  for (const StretchRows& stretch : rows)
    for (const KindRows& kind : stretch.kinds) n += kind.response.size();
  return n;
}

std::shared_ptr<const SmoothMotion> motion_of(const Stretch& stretch, const Model& model,
                                              const Smoothing& wanted) {
  const Recording& recording = stretch.recording;
  return std::make_shared<const SmoothMotion>(
      smooth_motion_of(recording, stretch.t0, torque_lateness(model.rig, recording.period),
                       suited(wanted, recording.period), model.is_coupled()));
}

StretchRows base_rows(const Stretch& stretch, const Model& model, const BaseLayout& layout,
                      const Smoothing& wanted, const StretchRows* kept) {
  StretchRows rows;
  const Smoothing smoothing = suited(wanted, stretch.recording.period);
  rows.motion = motion_of(stretch, model, smoothing);
  const Kernel filter = gaussian(smoothing.columns, stretch.recording.period);
  for (const RowKind kind : kinds_of(stretch, model)) {
    KindRows& k = rows.kinds.emplace_back();
    k.kind = kind;
    const bool link = kind == RowKind::link;
    const double least = link                       ? smoothing.least_speed_q
                         : kind == RowKind::blocked ? smoothing.least_speed_blocked
                                                    : smoothing.least_speed_theta;
    k.at = kept != nullptr ? kept->kinds[rows.kinds.size() - 1].at
                           : moving_rows(link ? rows.motion->qd : rows.motion->thetad, least,
                                         stretch.recording.period, smoothing);
    std::erase_if(k.at, [&](Eigen::Index i) { return i < stretch.rows_from; });
    if (kept == nullptr) erase_unknown(model.transmission, *rows.motion, filter.reach(), k.at);
    const Eigen::MatrixXd all =
        apply_at(filter, full_columns(kind, *rows.motion, model, layout), k.at);
    k.base = all.leftCols(layout.n());
    k.response = all.col(layout.n());
    if (layout.has_given && link) {
      k.given = all.col(layout.n() + 1);
      k.response -= k.given;
    }
  }
  return rows;
}

std::vector<ReplacedColumns> columns_of_torque(const StretchRows& kept, const Recording& changed,
                                               const Model& model, const Smoothing& wanted,
                                               Evaluation evaluation) {
  const Smoothing smoothing = suited(wanted, changed.period);
  const Eigen::Index every = spacing(smoothing, evaluation);
  SmoothMotion motion;
  motion.tau = smooth_torque(changed, torque_lateness(model.rig, changed.period), smoothing, every);
  motion.tau_load = kept.motion->tau_load(Eigen::seq(0, kept.motion->size() - 1, every));
  const Kernel filter =
      gaussian(smoothing.columns, static_cast<double>(every) * kept.motion->period);
  std::vector<ReplacedColumns> replaced;
  for (const KindRows& k : kept.kinds) {
    ReplacedColumns& response = replaced.emplace_back(ReplacedColumns{0, 1, {}});
    response.columns =
        apply_at(filter, response_of(k.kind, motion, model).matrix(), thinned(k.at, every));
    if (k.given.size() > 0) response.columns -= k.given;
    if (k.linearised.size() > 0) response.columns += k.linearised;
  }
  return replaced;
}

std::vector<ReplacedColumns> columns_of_cables(const SmoothMotion& motion,
                                               const std::vector<KindRows>& kinds,
                                               const BaseLayout& before, const Model& model,
                                               const BaseLayout& layout, const Smoothing& wanted,
                                               Evaluation evaluation) {
  const Smoothing smoothing = suited(wanted, motion.period);
  const Eigen::Index every = spacing(smoothing, evaluation);
  const SmoothMotion positions = thinned_positions(motion, every);
  const Kernel filter = gaussian(smoothing.columns, positions.period);
  std::vector<ReplacedColumns> replaced;
  for (const KindRows& k : kinds) {
    Eigen::MatrixXd elastic(positions.size(), layout.n_elastic);
    Eigen::VectorXd given = Eigen::VectorXd::Zero(positions.size());
    fill_elastic(model, positions, k.kind == RowKind::link, layout, elastic, given);
    replaced.push_back({1 + before.n_link + before.n_motor, before.n_elastic,
                        apply_at(filter, elastic, thinned(k.at, every))});
  }
  return replaced;
}

void put_in(StretchRows& rows, const std::vector<ReplacedColumns>& replaced) {
  for (std::size_t i = 0; i < rows.kinds.size(); ++i) {
    KindRows& kind = rows.kinds[i];
    const ReplacedColumns& part = replaced[i];
    const Eigen::Index of_response = part.first == 0 ? 1 : 0;
    if (of_response > 0) kind.response = part.columns.col(0);
    const Eigen::Index before = part.first + of_response - 1, n = part.columns.cols() - of_response;
    const Eigen::Index behind = kind.base.cols() - before - (part.n - of_response);
    if (n == 0 && before + behind == kind.base.cols()) continue;
    Eigen::MatrixXd base(kind.base.rows(), before + n + behind);
    base.leftCols(before) = kind.base.leftCols(before);
    base.middleCols(before, n) = part.columns.rightCols(n);
    base.rightCols(behind) = kind.base.rightCols(behind);
    kind.base = std::move(base);
  }
}

}  // namespace cablefit

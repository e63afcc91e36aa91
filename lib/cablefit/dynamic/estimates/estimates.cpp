#include "cablefit/dynamic/estimates/estimates.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "cablefit/estimate/fit/parameter_estimate.hpp"
#include "cablefit/estimate/fit/sd_choice.hpp"
#include "cablefit/estimate/spread/long_run.hpp"
#include "cablefit/model/effects/effects_per_joint.hpp"

namespace cablefit {
namespace {

// An inertia is not separable from a torque that depends on position (stiffness, gravity, a wrong
// elastic stage) when position and the other columns explain more than this of its column.
constexpr double kPositionAlias = 0.98;
// Relative change of an inertia when torques of position are allowed beside it.
constexpr double kShiftNoted = 0.2;
constexpr double kShiftRefused = 2.0 / 3;
constexpr double kDrownedShare = 0.1;  // of an inertial torque in a residual that is systematic

/// R^2 of column `k` on the other effect columns and the position.
double explained_by_position(const RowStatistics& rows, const DynamicColumns& c, Eigen::Index k) {
  LinearProblem problem;
  for (Eigen::Index j = 0; j < c.n_effects; ++j)
    if (j != k) problem.regressors.push_back(j);
  problem.regressors.push_back(c.position);
  problem.names.assign(problem.regressors.size(), "");
  problem.response = Eigen::VectorXd::Unit(rows.n_columns(), k);
  const double total = rows.r().col(k).squaredNorm();
  return total > 0 ? 1 - solve(rows, problem).rss / total : 1;
}

/// The elastic torque is all that moves the link: there is no load beside it.
bool is_moved_by_cables_alone(const RowStatistics& rows, const DynamicColumns& c) {
  constexpr double kNone = 1e-9;
  if (c.side != Side::link || c.elastic.empty()) return false;
  const double load = rows.r().col(c.torque).norm();
  return load <= kNone * rows.r().middleCols(c.elastic.front(), c.n_elastic.front()).norm();
}

/// Effect column `k`'s coefficient when torques of position are allowed whose sum with the elastic
/// torque has the same size as the elastic torque alone: without a load a torque of any size could
/// take it away and leave every parameter 0. How large it is, stage 1 says, with its sd.
double with_torque_of_other_shape(const RowStatistics& rows, const DynamicColumns& c,
                                  Eigen::Index k, const Eigen::VectorXd& response,
                                  std::size_t which) {
  const auto& r = rows.r();
  const Eigen::VectorXd elastic = r * response;
  const Eigen::VectorXd unit = elastic.normalized();
  Eigen::MatrixXd free(r.rows(), 1 + c.n_elastic[which]);
  free << r.col(c.position), r.middleCols(c.elastic[which], c.n_elastic[which]);
  free -= unit * (unit.transpose() * free).eval();
  Eigen::MatrixXd all(r.rows(), c.n_effects + free.cols());
  all << r.leftCols(c.n_effects), free;
  const Eigen::VectorXd size =
      all.colwise().norm().transpose().unaryExpr([](double x) { return x > 0 ? x : 1; });
  const Eigen::VectorXd x =
      (all * size.cwiseInverse().asDiagonal()).colPivHouseholderQr().solve(elastic);
  return x(k) / size(k);
}

/// Effect column `k`'s coefficient when a torque proportional to position or to the elastic columns
/// is allowed as well: what a wrong stiffness, gravity or hysteresis would look like.
double with_position_torque(const RowStatistics& rows, const DynamicColumns& c, Eigen::Index k,
                            const LinearSolution& s, std::size_t which) {
  LinearProblem problem;
  for (Eigen::Index j = 0; j < c.n_effects; ++j) problem.regressors.push_back(j);
  problem.regressors.push_back(c.position);
  if (!c.elastic.empty())
    for (Eigen::Index j = 0; j < c.n_elastic[which]; ++j)
      problem.regressors.push_back(c.elastic[which] + j);
  problem.names.assign(problem.regressors.size(), "");
  problem.response = s.residual_combination;
  for (Eigen::Index j = 0; j < c.n_effects; ++j) problem.response(j) += s.x(j);
  // One elastic column has no other shape.
  if (is_moved_by_cables_alone(rows, c) && c.n_elastic[which] > 1)
    return with_torque_of_other_shape(rows, c, k, problem.response, which);
  problem.instruments = s.instruments;
  // What is allowed in addition is its own instrument.
  if (!s.instruments.empty())
    problem.instruments.insert(problem.instruments.end(), problem.regressors.begin() + c.n_effects,
                               problem.regressors.end());
  return solve(rows, problem).x(k);
}

Eigen::MatrixXd stage1_covariance(const RowStatistics& rows, const DynamicColumns& c,
                                  const LinearSolution& s, const ElasticFit& stage1,
                                  std::size_t which) {
  const Eigen::Index n = c.n_elastic[which];
  if (stage1.covariance.rows() != n) return Eigen::MatrixXd::Zero(s.x.size(), s.x.size());
  const Eigen::MatrixXd sensitivity = moved_by(rows, s, c.elastic[which], n);
  return sensitivity * stage1.covariance * sensitivity.transpose();
}

/// By how much the curve and the loop that stage 1 leaves move each parameter; empty: there are
/// none.
std::map<std::string, double> misfit_sd(const RowStatistics& rows, const DynamicColumns& c,
                                        const LinearSolution& s, std::size_t which) {
  std::map<std::string, double> sd;
  if (c.misfit.empty() || c.misfit[which] < 0) return sd;
  const Eigen::MatrixXd shift = moved_by(rows, s, c.misfit[which], 2);
  for (Eigen::Index k = 0; k < c.n_effects; ++k)
    sd[c.parameters[static_cast<std::size_t>(k)].name] = shift.row(k).norm();
  return sd;
}

/// "an inertial torque of 0.02 rms is too small ...; accelerate with ...". A value below its own sd
/// is noise: the inertia may be as large as its sd.
std::string drowned_text(double torque, double left, double relative_sd, const MotionColumn& column,
                         double acceleration) {
  return fmt::format(
      "its inertial torque of {:.2g} rms is too small compared with the residual "
      "({:.2g} rms); {}",
      torque, left, stronger_motion(column, acceleration, std::min(1.0, relative_sd)));
}

/// An inertia has to be positive: an interval that reaches zero has determined nothing.
void judge_inertia(const RowStatistics& rows, const DynamicColumns& c, const LinearSolution& s,
                   Eigen::Index k, std::size_t which, Estimate& e,
                   std::vector<std::string>& warnings) {
  if (!e.not_identifiable.empty()) return;
  const MotionColumn column = motion_column(c, static_cast<std::size_t>(k));
  if (const std::string alias = inertia_alias(rows, c, k); !alias.empty()) return refuse(e, alias);
  const double inertia = std::max(std::abs(s.unbounded_x(k)), std::abs(e.value));
  const double acceleration =
      rows.r().col(k).norm() /
      std::sqrt(static_cast<double>(std::max<Eigen::Index>(1, rows.n_rows())));
  const double torque = inertia * acceleration;
  // Noise averages out, a wrong model does not: an inertial torque far below a residual that is
  // mostly systematic (few effective rows) would only fit that residual.
  const bool systematic = s.effective_rows < 0.25 * static_cast<double>(s.n_rows);
  const bool drowned = systematic && torque < kDrownedShare * s.rms();
  const double alternative = with_position_torque(rows, c, k, s, which);
  if (!e.active_bound.empty() || e.ci_low <= 0 || drowned)
    refuse(e, drowned_text(
                  torque, s.rms(),
                  std::max(e.sd / inertia, kWantedRelativeSd * kDrownedShare * s.rms() / torque),
                  column, acceleration));
  const double shift = e.value > 0 ? std::abs(alternative - e.value) / e.value : 0;
  if (!e.not_identifiable.empty() || shift < kShiftNoted) return;
  const char* const what = c.side == Side::rigid ? "the load model" : "the stiffness model";
  if (shift > kShiftRefused)
    refuse(e, fmt::format("sensitive to {}: {:.3g} becomes {:.3g} with a free position-dependent "
                          "torque; {}",
                          what, e.value, alternative,
                          is_moved_by_cables_alone(rows, c) ? "record a log with a known load"
                                                            : "move faster"));
  else
    warnings.push_back(fmt::format(
        "{} is sensitive to {}: {:.3g} becomes {:.3g} with a free position-dependent torque",
        e.name, what, e.value, alternative));
}

/// The chosen sd and its quantile, where they are not those of the solution.
void take_chosen(const ChosenSd& chosen, const LinearSolution& s, Eigen::Index k,
                 double extra_variance, double lower, Estimate& e) {
  const bool has_sd = e.not_identifiable.empty() && e.active_bound.empty();
  if (!has_sd || chosen.kind[static_cast<std::size_t>(k)] != SdKind::block_bootstrap) return;
  e.sd = std::sqrt(chosen.variance(k) + extra_variance);
  set_interval(e, chosen.degrees_of_freedom(k), lower);
  if (!e.profiled) return;
  const double t =
      t_quantile_975(chosen.degrees_of_freedom(k)) / t_quantile_975(s.degrees_of_freedom);
  const double wider = t * t * e.sd * e.sd / s.covariance(k, k);
  set_profile(e, s.profile[static_cast<std::size_t>(k)], wider - 1, lower);
}

/// From the distance to a nonlinear parameter's origin to the parameter.
void move_by(double origin, Estimate& e) {
  e.value += origin;
  e.ci_low += origin;
  e.ci_high += origin;
}

}  // namespace

Eigen::MatrixXd moved_by(const RowStatistics& rows, const LinearSolution& s, Eigen::Index first,
                         Eigen::Index n) {
  return s.solve_operator *
         ((rows.r() * s.score_columns).transpose() * rows.r().middleCols(first, n));
}

Estimate given_estimate(const DynamicParameter& parameter) {
  Estimate e;
  e.name = parameter.name;
  e.symbol = parameter.info.symbol;
  e.unit = parameter.unit();
  e.value = e.ci_low = e.ci_high = *parameter.given;
  e.sd = e.sd_white = 0;
  return e;
}

void refuse(Estimate& e, const std::string& why) {
  e.not_identifiable = why;
  e.active_bound.clear();
  e.value = e.sd = e.sd_white = e.ci_low = e.ci_high = std::numeric_limits<double>::quiet_NaN();
}

namespace {

void refuse_dependent(const Effect& row, int joint, int n_joints,
                      std::vector<Estimate>& parameters) {
  const auto find = [&](std::size_t k) {
    const std::string name = added_parameter_name(row, row.parameters[k], joint, n_joints);
    return std::find_if(parameters.begin(), parameters.end(),
                        [&](const Estimate& e) { return e.name == name; });
  };
  for (std::size_t shape = row.n_linear(); shape < row.parameters.size(); ++shape) {
    const auto unknown = find(shape);
    if (unknown == parameters.end() || unknown->not_identifiable.empty()) continue;
    for (std::size_t k = 0; k < row.n_linear(); ++k)
      if (const auto e = find(k); e != parameters.end() && e->not_identifiable.empty())
        refuse(*e, fmt::format("it depends on {}, which the logs do not determine",
                               row.parameters[shape].name));
  }
}

}  // namespace

void refuse_dependent(const EffectsPerJoint& effects, std::vector<Estimate>& parameters) {
  const auto n_joints = static_cast<int>(effects.size());
  for (int joint = 0; joint < n_joints; ++joint)
    for (const EffectInstance& effect : effects[static_cast<std::size_t>(joint)])
      refuse_dependent(*effect.effect, joint, n_joints, parameters);
}

std::string inertia_alias(const RowStatistics& rows, const DynamicColumns& c, Eigen::Index k) {
  const double explained = explained_by_position(rows, c, k);
  if (!(explained > kPositionAlias)) return "";
  const MotionColumn column = motion_column(c, static_cast<std::size_t>(k));
  return fmt::format(
      "the acceleration is {:.1f} % a function of position, speed and direction (one sine?): "
      "inertia is not separable from stiffness or gravity; {}",
      100 * explained, separating_motion(column, 0, {MotionPart::position}, 0));
}

void add_estimates(const RowStatistics& rows, const DynamicColumns& c, const LinearSolution& s,
                   const ElasticFit* stage1, std::size_t which, bool robust, DynamicFit& fit) {
  Eigen::MatrixXd extra = Eigen::MatrixXd::Zero(s.x.size(), s.x.size());
  if (stage1 != nullptr && robust) extra = stage1_covariance(rows, c, s, *stage1, which);
  if (stage1 != nullptr && robust) fit.stage1_misfit.merge(misfit_sd(rows, c, s, which));
  const std::optional<ChosenSd> chosen = robust ? std::optional(choose_sd(rows, s)) : std::nullopt;
  for (Eigen::Index k = 0; k < c.n_effects; ++k) {
    const DynamicParameter& parameter = c.parameters[static_cast<std::size_t>(k)];
    Estimate e = parameter.given
                     ? given_estimate(parameter)
                     : estimate_of(parameter.info, parameter.axes, s, k, {robust, extra(k, k)});
    if (chosen && !parameter.given)
      take_chosen(*chosen, s, k, extra(k, k), parameter.info.lower, e);
    e.name = parameter.name;
    move_by(parameter.origin, e);
    if (parameter.is_nonlinear && (e.value < parameter.lowest || e.value > parameter.highest))
      refuse(e, fmt::format("the fit leaves its range of {:.3g} to {:.3g}: the logs do not "
                            "determine it",
                            parameter.lowest, parameter.highest));
    if (!e.active_bound.empty() && parameter.info.lower == 0)
      e.active_bound = fmt::format("{} >= 0", e.name);
    if (parameter.is_inertia && !parameter.given)
      judge_inertia(rows, c, s, k, which, e, fit.doubts);
    fit.verdicts[e.name] = parameter.given              ? "given"
                           : e.not_identifiable.empty() ? "identified"
                                                        : "not identifiable";
    fit.parameters.push_back(std::move(e));
  }
  fit.warnings.insert(fit.warnings.end(), s.warnings.begin(), s.warnings.end());
}

std::string sd_reason(const RowStatistics& rows, const DynamicColumns& c, const LinearSolution& s,
                      double row_seconds) {
  const ChosenSd chosen = choose_sd(rows, s);
  const double seconds = static_cast<double>(s.n_rows) / chosen.effective_rows * row_seconds;
  const std::string correlated = fmt::format(
      "residuals are correlated over {}, effective rows {:.0f} of {}",
      seconds < 1 ? fmt::format("{:.2g} ms", 1e3 * seconds) : fmt::format("{:.2g} s", seconds),
      chosen.effective_rows, s.n_rows);
  if (chosen.worst() == SdKind::white)
    return fmt::format("white: residuals are not correlated, all {} rows count", s.n_rows);
  if (chosen.worst() == SdKind::hac) return "HAC: " + correlated;
  std::string names;
  double dof = kUnbounded;
  for (std::size_t k = 0; k < chosen.kind.size(); ++k) {
    if (chosen.kind[k] != SdKind::block_bootstrap) continue;
    names += (names.empty() ? "" : ", ") + c.parameters[k].name;
    dof = std::min(dof, chosen.degrees_of_freedom(static_cast<Eigen::Index>(k)));
  }
  return fmt::format(
      "block bootstrap of {}, HAC of the rest: {}: {} blocks, t with {:.0f} degrees "
      "of freedom",
      names, correlated, chosen.blocks, dof);
}

void add_errors(const RowStatistics& rows, const std::string& equation, const LinearSolution& s,
                DynamicFit& fit) {
  TorqueError& error = fit.torque_error[equation];
  const double rss = (rows.r() * s.residual_combination).squaredNorm();
  const auto n_rows = static_cast<double>(rows.n_rows());
  error.rms = n_rows > 0 ? std::sqrt(rss / n_rows) : 0;
  Eigen::VectorXd y = s.residual_combination;
  for (Eigen::Index j = 0; j < s.x.size(); ++j) y(j) += s.x(j);
  const double total = (rows.r() * y).norm();
  error.relative = total > 0 ? std::sqrt(rss) / total : 0;
  fit.weight[equation] = rss > 0 ? n_rows / rss : 0;
  fit.condition[equation] = s.condition;
  fit.effective_rows[equation] = s.effective_rows;
}

}  // namespace cablefit

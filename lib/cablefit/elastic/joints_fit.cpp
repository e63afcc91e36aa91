#include "cablefit/elastic/joints_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/elastic/checks/elastic_checks.hpp"
#include "cablefit/elastic/checks/preload_checks.hpp"
#include "cablefit/elastic/estimates/elastic_estimates.hpp"
#include "cablefit/elastic/figures/elastic_figures.hpp"
#include "cablefit/elastic/models/model_errors.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {
namespace {

constexpr double kLeastVariance =
    1e-12;  // of the torque's mean square: residuals that are rounding
constexpr int kJointsZeroIterations = 10;
constexpr double kZeroFound = 1e-3;  // of the noise, in deflection

/// One preload on the way to a result.
struct JointsStage {
  ElasticJob job;
  std::vector<BlockedRows> joints;
  BlockedRows all;  ///< of all joints, weighted
  std::vector<Nuisance> nuisance;
  std::vector<double> weights;  ///< of the rows of each joint

  int n_joints() const { return job.basis.n_joints; }
};

void look_at_branches(JointsStage& stage, int joint, ElasticPreload& preload) {
  const auto k = static_cast<std::size_t>(joint);
  Nuisance& nuisance = stage.nuisance[k];
  nuisance.branches = has_both_branches(stage.joints[k], joint);
  nuisance.speed = nuisance.branches && speed_tells_more(stage.joints[k], joint);
  preload.joints[k].both_branches = nuisance.branches;
  preload.both_branches = preload.both_branches && nuisance.branches;
  if (!nuisance.branches)
    preload.warnings.push_back(
        fmt::format("theta{0} moves in one direction only: the static friction of motor {0} is not "
                    "separable from the elastic torque; stiffness and offset[{0}] may be wrong by "
                    "that torque, f_sm[{0}] is not estimated; sweep up and down",
                    joint + 1));
}

/// Variance of what the cables leave of one joint's torque when fitted to that joint alone.
double own_variance(const JointsStage& stage, const BlockedRows& rows) {
  const LinearSolution s = solve_plain(
      rows, poly_candidate(stage.job, rows, orders_of(stage.job.basis), stage.nuisance));
  const auto n = static_cast<double>(s.n_rows);
  const double least = kLeastVariance * rows.rows->r().col(rows.columns.tau).squaredNorm() / n;
  return std::max(s.rss / std::max(1.0, n - s.n_params), least);
}

/// 1/variance of every joint, scaled so that weighted residuals are as large as plain ones.
std::vector<double> weights_of(const JointsStage& stage) {
  std::vector<double> weights;
  double total = 0, rows = 0;
  for (const BlockedRows& joint : stage.joints) {
    const double variance = own_variance(stage, joint);
    weights.push_back(variance > 0 ? 1 / variance : 1);
    total += weights.back() * static_cast<double>(joint.rows->n_rows());
    rows += static_cast<double>(joint.rows->n_rows());
  }
  for (double& weight : weights) weight *= rows / total;
  return weights;
}

/// Puts the rows of all joints together, by weights that know which frictions are fitted.
void weigh(JointsStage& stage) {
  stage.weights = weights_of(stage);
  stage.all = stack(stage.joints, stage.weights);
}

void collect_rows(JointsStage& stage, ElasticPreload& preload) {
  stage.joints = collect_joints(stage.job, Eigen::VectorXd::Zero(stage.n_joints()), nullptr);
  stage.nuisance.resize(stage.joints.size());
  for (int joint = 0; joint < stage.n_joints(); ++joint) {
    const BlockedRows& rows = stage.joints[static_cast<std::size_t>(joint)];
    require_rows(rows, stage.job, preload.name, joint);
    ElasticJoint& own = preload.joints.emplace_back();
    own.name = stage.job.rig().joints[static_cast<std::size_t>(joint)];
    look_at_branches(stage, joint, preload);
  }
  weigh(stage);
}

/// Places of the parameters of that name among those of the candidate, by joint.
std::vector<Eigen::Index> places_of(const JointsStage& stage, const ElasticCandidate& candidate,
                                    const char* name) {
  std::vector<Eigen::Index> places;
  for (int joint = 0; joint < stage.n_joints(); ++joint) {
    const auto at = std::find(candidate.names.begin(), candidate.names.end(),
                              joint_parameter_name(name, joint + 1, stage.n_joints()));
    places.push_back(at - candidate.names.begin());
  }
  return places;
}

/// Gauss-Newton on the encoder zeros of all joints, as of one: every zero with its own column.
/// Leaves `stage` with the rows about the last zeros; returns the logarithm of the joints' residual
/// variances, infinite where there is none.
double settle_zeros(JointsStage& stage, Transmission preliminary, const Eigen::VectorXd& width,
                    Eigen::VectorXd& zeros) {
  for (int iteration = 0; iteration < kJointsZeroIterations && zeros.allFinite(); ++iteration) {
    preliminary.theta_0 = zeros;
    stage.joints.clear();  // not two of them at a time: those of a hand are large
    stage.all = {};
    stage.joints = collect_joints(stage.job, zeros, &preliminary);
    weigh(stage);
    const ElasticCandidate curve =
        poly_candidate(stage.job, stage.all, preliminary_orders(stage.job), stage.nuisance);
    const LinearSolution s = solve_plain(stage.all, curve);
    const Eigen::VectorXd step = s.x(places_of(stage, curve, "theta_0"));
    preliminary = fitted_transmission(curve, s.x);
    if (!step.allFinite() || (step.cwiseAbs().array() < kZeroFound * width.array()).all()) break;
    zeros += step.cwiseMin(5 * width).cwiseMax(-5 * width);
  }
  double sum = 0;
  for (const BlockedRows& joint : stage.joints) sum += std::log(own_variance(stage, joint));
  return std::isnan(sum) ? kUnbounded : sum;
}

/// There may be several minima: begun where the straight lines cross zero, and at the encoders' own
/// zeros.
void find_zeros(JointsStage& stage) {
  const ElasticCandidate line = linear_candidate(stage.all, stage.nuisance);
  const LinearSolution straight = solve_candidate(stage.all, line);
  const Eigen::VectorXd stiffness = straight.x.head(stage.n_joints());
  const Eigen::VectorXd constant = straight.x(places_of(stage, line, "offset"));
  const Eigen::VectorXd width = straight.rms() * stiffness.cwiseAbs().cwiseInverse();
  Transmission preliminary = classical_spring(stage.job.basis);
  preliminary.linear_stiffness = stiffness;
  Eigen::VectorXd from_lines = -constant.cwiseQuotient(stiffness);
  Eigen::VectorXd from_own = Eigen::VectorXd::Zero(stage.n_joints());
  const double of_lines = settle_zeros(stage, preliminary, width, from_lines);
  const double of_own = settle_zeros(stage, preliminary, width, from_own);
  if (of_lines <= of_own) settle_zeros(stage, preliminary, width, from_lines);
}

/// --zero theta_0: of every joint its encoder's zero instead of the drive's offset.
void choose_zeros(JointsStage& stage, ElasticPreload& preload) {
  if (stage.job.options.zero != ZeroMode::theta_0) return;
  preload.decisions.push_back({"zero", "theta_0", "given"});
  for (Nuisance& nuisance : stage.nuisance) nuisance.theta_0 = true;
  find_zeros(stage);
}

/// What the rows show that are fitted in the end.
void describe_rows(const JointsStage& stage, ElasticPreload& preload) {
  for (std::size_t k = 0; k < stage.joints.size(); ++k) {
    preload.joints[k].counts = stage.joints[k].counts;
    preload.joints[k].deflection_low = stage.joints[k].deflection_low;
    preload.joints[k].deflection_high = stage.joints[k].deflection_high;
    preload.joints[k].weight = stage.weights[k];
  }
  preload.counts = stage.all.counts;
  preload.modes = stage.all.modes;
  preload.windows = stage.all.windows;
  preload.deflection_low = stage.all.deflection_low;
  preload.deflection_high = stage.all.deflection_high;
}

double offset_of(const ElasticFit& fit, int joint, int n_joints) {
  const Estimate* e =
      find_estimate(fit.parameters, joint_parameter_name("offset", joint + 1, n_joints));
  return e != nullptr && e->not_identifiable.empty() ? e->value : 0;
}

/// An encoder's zero is looked for when asked; what looks like one is reported.
void note_zero(const JointsStage& stage, int joint, ElasticPreload& preload) {
  const BlockedRows& rows = stage.joints[static_cast<std::size_t>(joint)];
  const BlockedColumns c = rows.columns.of_joint(joint);
  const double offset = offset_of(preload.fits.back(), joint, stage.n_joints());
  const auto& r = rows.rows->r();
  const double spread = (r.col(c.tau) - offset * r.col(c.offset)).norm() /
                        std::sqrt(static_cast<double>(rows.rows->n_rows()));
  if (std::abs(offset) > kArbitraryZero * std::sqrt(2.0) * spread)
    preload.warnings.push_back(
        fmt::format("joint {}: the torque is {:.3g} {} at zero deflection; if an encoder's "
                    "arbitrary zero causes it, not an offset of the drive, give --zero theta_0",
                    joint + 1, offset, torque_unit(stage.job.rig().axes.of(joint))));
}

void note_joints(const JointsStage& stage, ElasticPreload& preload) {
  const ElasticFit& best = *preload.find(preload.selected);
  for (int joint = 0; joint < stage.n_joints(); ++joint) {
    const auto k = static_cast<std::size_t>(joint);
    ElasticJoint& own = preload.joints[k];
    const Estimate* friction =
        find_estimate(best.parameters, joint_parameter_name("f_sm", joint + 1, stage.n_joints()));
    own.loop_half_width =
        friction != nullptr && friction->not_identifiable.empty() ? friction->value : 0;
    preload.loop_half_width = std::max(preload.loop_half_width, own.loop_half_width);
    const LoopSeen loop{own.loop_half_width, own.peak_torque, best.joints[k].rms_error,
                        stage.joints[k].plateaus};
    for (const std::string& warning : loop_warnings(loop, stage.job.rig().axes.of(joint)))
      preload.warnings.push_back(fmt::format("joint {}: {}", joint + 1, warning));
    note_zero(stage, joint, preload);
  }
}

void draw(const JointsStage& stage, const std::vector<ElasticCandidate>& candidates,
          const std::vector<LinearSolution>& solutions, ElasticPreload& preload) {
  for (int joint = 0; joint < stage.n_joints(); ++joint)
    for (Figure& figure : elastic_figures(stage.job, stage.joints[static_cast<std::size_t>(joint)],
                                          joint, candidates, solutions, preload, {}))
      preload.figures.push_back(std::move(figure));
}

}  // namespace

ElasticPreload fit_joints(ElasticJob job, const std::string& name) {
  ElasticPreload preload = begin_preload(job, name);
  require_motion(job);
  JointsStage stage{std::move(job), {}, {}, {}, {}};
  collect_rows(stage, preload);
  choose_zeros(stage, preload);
  describe_rows(stage, preload);
  std::vector<int> orders = stage.job.orders;
  if (orders.empty())
    orders = choose_orders(stage.job, stage.all, stage.nuisance, preload.selection);
  const std::vector<ElasticCandidate> candidates = {
      linear_candidate(stage.all, stage.nuisance),
      poly_candidate(stage.job, stage.all, orders, stage.nuisance)};
  std::vector<LinearSolution> solutions;
  const std::vector<double> longest = longest_of(stage.all.elongations);
  for (const ElasticCandidate& candidate : candidates) {
    const std::vector<double>& given = stage.job.options.coefficients;
    const bool fitted = candidate.model == "linear" || given.empty();
    solutions.push_back(fitted ? solve_candidate(stage.all, candidate)
                               : solve_given(stage.all, candidate, given));
    if (fitted) add_profiles(stage.all, candidate, stage.job.options.robust_sd, solutions.back());
    ElasticFit& fit = preload.fits.emplace_back(
        make_fit(stage.job, candidate, solutions.back(), stage.all, stage.nuisance));
    for (int joint = 0; joint < stage.n_joints(); ++joint)
      if (!stage.nuisance[static_cast<std::size_t>(joint)].branches)
        fit.parameters.push_back(missing_friction(stage.job, joint));
    check_passive(fit, longest, {stage.job.rig().cables_given, preload.axes});
  }
  measure_joint_errors(stage.joints, stage.all, candidates, solutions, preload);
  select_joint_model(preload, stage.job.options.materiality);
  note_joints(stage, preload);
  note_imbalance(preload);
  if (stage.job.options.figures) draw(stage, candidates, solutions, preload);
  return preload;
}

}  // namespace cablefit

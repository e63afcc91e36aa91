#include "cablefit/elastic/elastic_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/elastic/bases/cable_bases.hpp"
#include "cablefit/elastic/checks/elastic_checks.hpp"
#include "cablefit/elastic/checks/misfit.hpp"
#include "cablefit/elastic/checks/preload_checks.hpp"
#include "cablefit/elastic/estimates/elastic_estimates.hpp"
#include "cablefit/elastic/figures/basis_figures.hpp"
#include "cablefit/elastic/figures/elastic_figures.hpp"
#include "cablefit/elastic/joints_fit.hpp"
#include "cablefit/elastic/models/line_scores.hpp"
#include "cablefit/elastic/models/model_errors.hpp"
#include "cablefit/elastic/zeros/log_zeros.hpp"
#include "cablefit/elastic/zeros/standstill.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/unused_rows.hpp"

namespace cablefit {
namespace {

constexpr int kZeroIterations = 6;

/// The data of one preload on the way to a result.
struct Stage1 {
  ElasticJob job;
  BlockedRows rows;
  Nuisance nuisance;

  std::span<const Nuisance> nuisances() const { return {&nuisance, 1}; }
};

/// The torque at zero deflection, by the constant of the straight line, is an encoder's zero rather
/// than a drive's offset. A curve with a kink at zero is far from its straight line there, so the
/// cables have to say the same. `line`: solution of the linear candidate.
bool zero_is_arbitrary(const Stage1& stage, const LinearSolution& line) {
  if (stage.job.options.zero != ZeroMode::automatic)
    return stage.job.options.zero == ZeroMode::theta_0;
  const auto& r = stage.rows.rows->r();
  const double n = static_cast<double>(stage.rows.rows->n_rows());
  const auto is_large = [&](double offset) {
    const double spread =
        (r.col(stage.rows.columns.tau) - offset * r.col(stage.rows.columns.offset)).norm() /
        std::sqrt(n);
    return std::abs(offset) > kArbitraryZero * std::sqrt(2.0) * spread;
  };
  if (!is_large(line.x(1))) return false;
  const ElasticCandidate curve =
      poly_candidate(stage.job, stage.rows, preliminary_orders(stage.job), stage.nuisances());
  return is_large(solve_plain(stage.rows, curve).x(static_cast<Eigen::Index>(curve.n_elastic)));
}

/// Gauss-Newton on theta_0: start where the straight line crosses zero, then let its own column
/// correct it together with everything else. Leaves `stage` with the rows about the last zero.
void find_zero(Stage1& stage, const LinearSolution& line) {
  const double stiffness = line.x(0);
  const double width = line.rms() / std::abs(stiffness);  // of the noise, in deflection
  double zero = stage.rows.transmission.theta_0(0) - line.x(1) / stiffness;
  Transmission preliminary = classical_spring(stage.job.basis);
  preliminary.linear_stiffness.setConstant(stiffness);
  for (int iteration = 0; iteration < kZeroIterations; ++iteration) {
    preliminary.theta_0 = Eigen::VectorXd::Constant(preliminary.n_joints, zero);
    stage.rows = collect_blocked(stage.job, zero, &preliminary);
    const ElasticCandidate curve =
        poly_candidate(stage.job, stage.rows, preliminary_orders(stage.job), stage.nuisances());
    const LinearSolution s = solve_plain(stage.rows, curve);
    const double step = s.x(static_cast<Eigen::Index>(curve.n_elastic));
    preliminary = fitted_transmission(curve, s.x);
    if (!std::isfinite(step) || std::abs(step) < 1e-3 * width) return;
    zero += std::clamp(step, -5 * width, 5 * width);
  }
}

void choose_zero(Stage1& stage, ElasticPreload& preload) {
  const ElasticOptions& options = stage.job.options;
  if (options.offset && options.zero != ZeroMode::theta_0) return;  // begin_preload says so
  stage.nuisance.theta_0 = options.zero == ZeroMode::theta_0;
  const LinearSolution line =
      solve_candidate(stage.rows, linear_candidate(stage.rows, stage.nuisances()));
  stage.nuisance.theta_0 = std::abs(line.x(0)) > 0 && zero_is_arbitrary(stage, line);
  if (!stage.nuisance.theta_0) {
    preload.decisions.push_back(
        {"zero", "offset", "the deflection's zero is known, the drive may have an offset"});
    return;
  }
  const bool given = options.zero != ZeroMode::automatic;
  preload.decisions.push_back(
      {"zero", "theta_0",
       given ? "given"
             : "the torque is far from zero at zero deflection: the encoder's zero is arbitrary"});
  find_zero(stage, line);
}

void look_at_branches(Stage1& stage, ElasticPreload& preload) {
  preload.both_branches = has_both_branches(stage.rows);
  stage.nuisance.branches = preload.both_branches;
  stage.nuisance.speed = preload.both_branches && speed_tells_more(stage.rows);
  if (!preload.both_branches)
    preload.warnings.emplace_back(
        "theta moves in one direction only: the motor's static friction is not "
        "separable from the elastic torque; stiffness and offset may be wrong by that "
        "torque, f_sm is not estimated; sweep up and down");
}

/// Refused rather than silently taken as 0.
void refuse_search(const Rig& rig) {
  for (std::size_t c = 0; c < rig.search_elongation.size(); ++c)
    if (rig.search_elongation[c])
      throw input_error({rig.path, 0, 0},
                        fmt::format("the initial elongation of cable '{}' has to be searched first",
                                    rig.transmission.cables[c].name),
                        "run 'cablefit elastic' or 'cablefit identify', or give a number");
  refuse_searched_radius(rig, "this fit");
}

/// What Fig. 4 compares the fitted cables with: the straight line, and cables of order 1.
std::vector<ComparedModel> simpler_models(const Stage1& stage, const ElasticPreload& preload) {
  std::vector<ComparedModel> models = {
      {"classical linear, K (theta - q)", preload.fits.front().transmission}};
  if (preload.fits.back().order == 1) return models;
  const std::vector<int> first(stage.job.basis.cables.size(), 1);
  const ElasticCandidate first_order =
      poly_candidate(stage.job, stage.rows, first, stage.nuisances());
  models.push_back({"cables of order 1",
                    fitted_transmission(first_order, solve_candidate(stage.rows, first_order).x)});
  return models;
}

ElasticPreload fit_preload(ElasticJob job, const std::string& name) {
  ElasticPreload preload = begin_preload(job, name);
  require_motion(job);
  Stage1 stage{std::move(job), {}, {}};
  stage.rows = collect_blocked(stage.job, 0, nullptr);
  require_rows(stage.rows, stage.job, name, 0);
  look_at_branches(stage, preload);
  choose_zero(stage, preload);

  std::vector<int> orders = stage.job.orders;
  if (orders.empty())
    orders = choose_orders(stage.job, stage.rows, stage.nuisances(), preload.selection);
  const std::vector<ElasticCandidate> candidates = {
      linear_candidate(stage.rows, stage.nuisances()),
      poly_candidate(stage.job, stage.rows, orders, stage.nuisances())};
  std::vector<LinearSolution> solutions;
  for (const ElasticCandidate& candidate : candidates) {
    const std::vector<double>& given = stage.job.options.coefficients;
    solutions.push_back(candidate.model == "linear" || given.empty()
                            ? solve_candidate(stage.rows, candidate)
                            : solve_given(stage.rows, candidate, given));
    if (candidate.model == "linear" || given.empty())
      add_profiles(stage.rows, candidate, stage.job.options.robust_sd, solutions.back());
    preload.fits.push_back(
        make_fit(stage.job, candidate, solutions.back(), stage.rows, stage.nuisances()));
    if (!preload.both_branches)
      preload.fits.back().parameters.push_back(missing_friction(stage.job, 0));
  }
  preload.counts = stage.rows.counts;
  preload.modes = stage.rows.modes;
  preload.windows = stage.rows.windows;
  if (std::string unused = unused_rows_warning(preload.windows, preload.counts); !unused.empty())
    preload.warnings.push_back(std::move(unused));
  measure_errors(stage.rows, candidates, solutions, preload);
  for (ElasticFit& fit : preload.fits)
    check_passive(fit, longest_of(stage.rows.elongations),
                  {stage.job.rig().cables_given, preload.axes});
  select_model(preload, stage.job.options.materiality);
  for (std::size_t k = 0; k < candidates.size(); ++k)
    if (preload.fits[k].model == preload.selected)
      preload.fits[k].misfit = find_misfit(stage.rows, candidates[k], solutions[k]);
  preload.scores =
      score_curves(stage.job, stage.rows, preload, candidates.back(), solutions.back());
  if (stage.job.options.bases)
    preload.bases = compare_bases(stage.job, stage.rows, candidates.back());
  const double left = note_log_zeros(stage.job, stage.rows, candidates, preload);
  note_loop(preload, left, stage.rows.plateaus);
  note_standstill(stage.job, stage.rows, candidates.back(), preload);
  note_closure(stage.rows.elongations, preload);
  note_imbalance(preload);
  if (stage.job.options.figures)
    preload.figures = elastic_figures(stage.job, stage.rows, 0, candidates, solutions, preload,
                                      simpler_models(stage, preload));
  if (stage.job.options.figures && preload.bases)
    for (Figure& figure : basis_figures(preload)) preload.figures.push_back(std::move(figure));
  return preload;
}

}  // namespace

ElasticResult fit_elastic(std::span<const LogSurvey> logs, const ElasticOptions& options) {
  ElasticResult result;
  for (const LogSurvey& log : logs) {
    result.inputs.push_back({log.plan.path, log.sha256, log.n_rows});
    if (!options.lines.empty())
      require_one_joint(log.plan, "scores of straight lines support one joint");
    if (options.bases) require_one_joint(log.plan, "a comparison of bases supports one joint");
    if (options.offset.value_or(0) != 0)
      require_one_joint(log.plan, "a given offset that is not 0 supports one joint");
    refuse_search(log.plan.rig);
    require_channel(log.plan, Channel::q, "the deflection theta - q");
    require_channel(log.plan, Channel::theta, "the deflection theta - q");
    require_channel(log.plan, Channel::tau, "the elastic torque");
  }
  result.warnings = input_warnings(logs);
  const std::vector<std::string> names = preload_names(logs, [&](const PartSurvey& part) {
    return (options.still || part.phase == Phase::blocked) &&
           (options.preload.empty() || options.preload == part.preload);
  });
  if (names.empty())
    throw input_error({logs.empty() ? "" : logs.front().plan.path, 0, 0},
                      options.preload.empty()
                          ? "no log has a blocked link (q moves in all of them)"
                          : fmt::format("no blocked log of preload '{}'", options.preload),
                      "give a blocked log, a 'phase' column, or --still to use the parts in which "
                      "the link rests");
  for (const std::string& name : names) {
    ElasticJob job = make_job(logs, options, name);
    result.preloads.push_back(job.basis.n_joints > 1 ? fit_joints(std::move(job), name)
                                                     : fit_preload(std::move(job), name));
  }
  return result;
}

}  // namespace cablefit

#include "cablefit/elastic/elastic_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/elastic/elastic_checks.hpp"
#include "cablefit/elastic/elastic_estimates.hpp"
#include "cablefit/elastic/elastic_figures.hpp"
#include "cablefit/elastic/model_errors.hpp"

namespace cablefit {
namespace {

constexpr double kArbitraryZero = 0.05;  // of the peak torque: a larger offset is an encoder zero
constexpr double kStillNoise = 4;        // counts or sd of noise that are no motion
constexpr int kZeroIterations = 6;
constexpr Eigen::Index kMinRows = 10;

/// The data of one preload on the way to a result.
struct Stage1 {
  ElasticJob job;
  BlockedRows rows;
  Nuisance nuisance;
};

int pilot_order(const Stage1& stage) {
  return stage.job.options.order > 0 ? stage.job.options.order : 2;
}

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
  const Candidate curve = poly_candidate(stage.job, stage.rows, pilot_order(stage), stage.nuisance);
  return is_large(solve_plain(stage.rows, curve).x(static_cast<Eigen::Index>(curve.n_elastic)));
}

/// Gauss-Newton on theta_0: start where the straight line crosses zero, then let its own column
/// correct it together with everything else. Leaves `stage` with the rows about the last zero.
void find_zero(Stage1& stage, const LinearSolution& line) {
  const double stiffness = line.x(0);
  const double width = line.rms() / std::abs(stiffness);  // of the noise, in deflection
  double zero = stage.rows.transmission.theta_0(0) - line.x(1) / stiffness;
  Transmission pilot;
  pilot.n_joints = stage.job.basis.n_joints;
  pilot.linear_stiffness = Eigen::VectorXd::Constant(pilot.n_joints, stiffness);
  for (int iteration = 0; iteration < kZeroIterations; ++iteration) {
    pilot.theta_0 = Eigen::VectorXd::Constant(pilot.n_joints, zero);
    stage.rows = collect_blocked(stage.job, zero, &pilot);
    const Candidate curve =
        poly_candidate(stage.job, stage.rows, pilot_order(stage), stage.nuisance);
    const LinearSolution s = solve_plain(stage.rows, curve);
    const double step = s.x(static_cast<Eigen::Index>(curve.n_elastic));
    pilot = fitted_transmission(curve, s.x);
    if (!std::isfinite(step) || std::abs(step) < 1e-3 * width) return;
    zero += std::clamp(step, -5 * width, 5 * width);
  }
}

void choose_zero(Stage1& stage, ElasticPreload& preload) {
  const LinearSolution line =
      solve_candidate(stage.rows, linear_candidate(stage.rows, stage.nuisance));
  stage.nuisance.theta_0 = std::abs(line.x(0)) > 0 && zero_is_arbitrary(stage, line);
  if (!stage.nuisance.theta_0) {
    preload.decisions.push_back(
        {"zero", "offset", "the deflection's zero is known, the drive may have an offset"});
    return;
  }
  const bool given = stage.job.options.zero != ZeroMode::automatic;
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
        "theta moves in one direction only: the motor's static friction cannot be told from the "
        "elastic "
        "torque; stiffness and offset may be off by it, f_sm is not estimated; sweep up and down");
}

void require_rows(const BlockedRows& rows, const std::string& preload) {
  if (rows.rows->n_rows() < kMinRows)
    throw Error(
        ErrorKind::not_identifiable,
        fmt::format(
            "preload '{:.40}': {} usable rows of a blocked link are too few ({} read; {} in "
            "pieces too short between gaps or changes, {} at their edges; after decimation {} "
            "at rest, {} not used); sweep the motor slowly up and down, several times",
            preload, rows.rows->n_rows(), rows.windows.rows_read, rows.windows.rows_too_short,
            rows.counts.rows_at_edges, rows.counts.rows_at_rest, rows.counts.rows_not_used));
  if (!(rows.rows->r().col(rows.columns.deflection).norm() > 0))
    throw Error(
        ErrorKind::not_identifiable,
        fmt::format(
            "preload '{:.40}': theta and q are the same, so there is no deflection; check which "
            "columns they are, or use 'cablefit dynamic --model rigid'",
            preload));
}

/// Whether a channel varies by more than its noise in any wanted part.
bool varies(const ElasticJob& job, Channel channel) {
  for (const LogSurvey& log : job.logs)
    for (const PartSurvey& part : log.parts) {
      const int k = log.plan.find(channel);
      if (k < 0 || !job.wanted(part)) continue;
      const ChannelSurvey& c = part.channels[static_cast<std::size_t>(k)];
      if (c.range() > kStillNoise * std::max(c.noise, c.quantum)) return true;
    }
  return false;
}

/// A motor that stands still, or a torque that never changes, says nothing about stiffness.
void require_motion(const ElasticJob& job) {
  const Place place{first_log_with(job.logs, job.wanted).plan.path, 0, 0};
  if (!varies(job, Channel::theta))
    throw input_error(place, "theta never moves while the link is blocked",
                      "sweep the motor slowly up and down, and check which column theta is");
  if (!varies(job, Channel::tau))
    throw input_error(place, "tau never changes", "check which column the torque is");
}

/// Refused rather than silently taken as 0.
void refuse_search(const Rig& rig) {
  for (std::size_t c = 0; c < rig.search_elongation.size(); ++c)
    if (rig.search_elongation[c])
      throw input_error({rig.path, 0, 0},
                        fmt::format("the initial elongation of cable '{}' is to be searched first",
                                    rig.transmission.cables[c].name),
                        "run 'cablefit elastic' or 'cablefit identify', or give a number");
}

/// f_sm was asked for and could not be told: say so by name.
void add_missing_friction(ElasticFit& fit, bool linear_motion) {
  Estimate e;
  e.name = e.symbol = "f_sm";
  e.unit = linear_motion ? "N" : "N m";
  e.not_identifiable = "theta moves in one direction only";
  fit.parameters.push_back(e);
}

ElasticPreload fit_preload(ElasticJob job, const std::string& name) {
  ElasticPreload preload;
  preload.name = name;
  preload.linear_motion = job.rig().linear_motion;
  preload.unit = preload.linear_motion ? "m" : "rad";
  preload.rig_path = job.rig().path;
  preload.decisions = job.settings.decisions;
  preload.warnings = job.settings.warnings;
  if (job.options.unconstrained)
    preload.decisions.push_back({"stiffness", "unconstrained", "given; cables may push"});

  require_motion(job);
  Stage1 stage{std::move(job), {}, {}};
  stage.rows = collect_blocked(stage.job, 0, nullptr);
  require_rows(stage.rows, name);
  look_at_branches(stage, preload);
  choose_zero(stage, preload);

  int order = std::max(1, stage.job.options.order);
  if (stage.job.options.order == 0 && !stage.job.orders_given)
    order = choose_order(stage.job, stage.rows, stage.nuisance, preload.selection);
  const std::vector<Candidate> candidates = {
      linear_candidate(stage.rows, stage.nuisance),
      poly_candidate(stage.job, stage.rows, order, stage.nuisance)};
  std::vector<LinearSolution> solutions;
  for (const Candidate& candidate : candidates) {
    solutions.push_back(solve_candidate(stage.rows, candidate));
    preload.fits.push_back(
        make_fit(stage.job, candidate, solutions.back(), stage.rows, stage.nuisance));
    if (!preload.both_branches) add_missing_friction(preload.fits.back(), preload.linear_motion);
  }
  preload.counts = stage.rows.counts;
  preload.windows = stage.rows.windows;
  measure_errors(stage.rows, candidates, solutions, preload);
  for (ElasticFit& fit : preload.fits)
    check_passive(fit, preload, {stage.job.rig().cables_given, preload.linear_motion});
  select_model(preload, stage.job.options.materiality);
  note_loop(preload, stage.rows.plateaus);
  note_closure(preload);
  if (stage.job.options.figures)
    preload.figures = elastic_figures(stage.job, stage.rows, candidates, solutions, preload);
  return preload;
}

}  // namespace

ElasticResult fit_elastic(std::span<const LogSurvey> logs, const ElasticOptions& options) {
  ElasticResult result;
  for (const LogSurvey& log : logs) {
    result.inputs.push_back({log.plan.path, log.sha256, log.n_rows});
    require_one_joint(log.plan);
    refuse_search(log.plan.rig);
    require_channel(log.plan, Channel::q, "the deflection theta - q");
    require_channel(log.plan, Channel::theta, "the deflection theta - q");
    require_channel(log.plan, Channel::tau, "the elastic torque");
  }
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
    result.preloads.push_back(fit_preload(make_job(logs, options, name), name));
  }
  return result;
}

}  // namespace cablefit

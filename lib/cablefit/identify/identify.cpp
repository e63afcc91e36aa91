#include "cablefit/identify/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/long_run.hpp"
#include "cablefit/identify/elongation_profile.hpp"
#include "cablefit/identify/identify_estimates.hpp"
#include "cablefit/identify/identify_figures.hpp"
#include "cablefit/identify/preload_jobs.hpp"
#include "cablefit/identify/recursive.hpp"
#include "cablefit/samples/agreement.hpp"

namespace cablefit {
namespace {

constexpr int kReweighings = 3;
constexpr double kSettled = 0.02;  // change of a weight that changes nothing
constexpr int kRestarts = 4;
constexpr double kDifferenceSd = 3;  // inertias that differ by more sd are no longer one

std::vector<PreloadFacts> preloads_of(std::span<const LogSurvey> logs,
                                      const IdentifyOptions& options) {
  std::vector<PreloadFacts> facts;
  for (const std::string& name : preload_names(logs, [&](const PartSurvey& part) {
         return options.preload.empty() || options.preload == part.preload;
       })) {
    PreloadFacts f;
    f.name = name;
    f.rig =
        first_log_with(logs, [&](const PartSurvey& part) { return part.preload == name; }).plan.rig;
    for (const LogSurvey& log : logs)
      for (const PartSurvey& part : log.parts)
        if (part.preload == name)
          (part.phase == Phase::blocked ? f.has_blocked : f.has_moving) = true;
    facts.push_back(std::move(f));
  }
  return facts;
}

void require_channels(std::span<const LogSurvey> logs) {
  for (const LogSurvey& log : logs) {
    require_one_joint(log.plan);
    require_channel(log.plan, Channel::q, "the deflection theta - q");
    require_channel(log.plan, Channel::theta, "the deflection theta - q");
    require_channel(log.plan, Channel::tau, "the torque balance of the motor");
  }
}

/// The elastic side first, from blocked logs where there are any: what the settings of moving logs
/// need, and where the full search starts.
JointPoint fit_first(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                     const std::vector<PreloadFacts>& facts,
                     const std::vector<JointRecord>& blocked, std::vector<PreloadJob> jobs,
                     JointFit& fit) {
  for (std::size_t j = 0; j < jobs.size(); ++j)
    jobs[j].records = {facts[j].has_blocked ? blocked[j]
                                            : first_moving_record(logs, options, facts[j])};
  fit =
      make_joint_fit(logs, std::move(jobs), false, options.unconstrained, options.samples.threads);
  return search_elongations(fit);
}

/// Weights by the residuals at the point and the point by the weights, until both stand.
JointPoint settle(JointFit& fit, JointPoint point) {
  for (int i = 0; i < kReweighings; ++i) {
    JointPoint full = evaluate(fit, {point.l_o}, true).front();
    JointProblem problem = joint_problem(fit.jobs, fit.layout, full.input(), fit.weights, {});
    reweigh(problem, full.solution);
    double change = 0;
    for (std::size_t b = 0; b < fit.weights.size(); ++b) {
      change = std::max(change, std::abs(problem.blocks[b].weight / fit.weights[b] - 1));
      fit.weights[b] = problem.blocks[b].weight;
    }
    point = polish(fit, point);
    if (change < kSettled) break;
  }
  return point;
}

/// "J_link 0.339, 0.328 (5.1 sd)" of every inertia that differs between preloads.
std::string different_inertias(const JointFit& fit, const JudgedPoint& judged) {
  std::string text;
  const auto& p = fit.layout.parameters;
  for (std::size_t a = 0; a < p.size(); ++a)
    for (std::size_t b = a + 1; b < p.size(); ++b) {
      if (p[a].name != p[b].name || p[a].unit != "kg m^2") continue;
      const auto i = static_cast<Eigen::Index>(a), k = static_cast<Eigen::Index>(b);
      const Eigen::MatrixXd& c = judged.covariance.covariance;
      const double sd = std::sqrt(std::max(0.0, c(i, i) + c(k, k) - 2 * c(i, k)));
      const double distance =
          std::abs(judged.point.solution.x(i) - judged.point.solution.x(k)) / sd;
      if (!(distance > kDifferenceSd)) continue;
      text += fmt::format("{}{} {:.4g} ({:.40}) and {:.4g} ({:.40}), {:.1f} sd apart",
                          text.empty() ? "" : "; ", p[a].name, judged.point.solution.x(i),
                          fit.jobs[static_cast<std::size_t>(p[a].preload)].name,
                          judged.point.solution.x(k),
                          fit.jobs[static_cast<std::size_t>(p[b].preload)].name, distance);
    }
  return text;
}

/// Shared where the preloads agree: one drive has one set of inertias.
JointPoint share_inertias(JointFit& fit, JointPoint point, IdentifyResult& result) {
  const JudgedPoint judged = judge_point(fit, evaluate(fit, {point.l_o}, true).front());
  const std::string differences = different_inertias(fit, judged);
  if (!differences.empty()) {
    result.decisions.push_back({"inertias", "per preload", differences});
    result.warnings.push_back("inertias differ between preloads, which one drive's should not: " +
                              differences + "; they are not shared");
    return point;
  }
  result.decisions.push_back({"inertias", "shared", "those of the preloads agree within 3 sd"});
  fit.layout = joint_layout(fit.jobs, false);
  return settle(fit, descend(fit, {{point.l_o}}).front());
}

JointFit full_fit(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                  std::vector<PreloadJob> jobs, const std::vector<JointRecord>& blocked,
                  const JointFit& first, const JointPoint& start,
                  std::vector<PreloadFacts>& facts) {
  int moving = 0;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    if (facts[j].has_blocked) jobs[j].records.push_back(blocked[j]);
    if (!facts[j].has_moving) continue;
    ++moving;
    const Transmission cables = fitted_cables(first.jobs[j], start.l_o[j], start.solution.x);
    jobs[j].records.push_back(
        moving_record(logs, options, cables,
                      reference_deflections(cables, first.elongations(j, start.l_o[j])), facts[j]));
  }
  return make_joint_fit(logs, std::move(jobs), moving > 1, options.unconstrained,
                        options.samples.threads);
}

/// The best point of the full problem, from where the first one ended if that is a place.
JointPoint fit_all(JointFit& fit, const JointFit& first, const JointPoint& start) {
  if (n_undetermined(first, start) > 0) return settle(fit, search_elongations(fit));
  const JointPoint begin = evaluate(fit, {start.l_o}).front();
  const std::vector<double> variances = own_variances(fit, begin);
  for (std::size_t e = 0; e < variances.size(); ++e)
    if (variances[e] > 0) fit.weights[e] = 1 / variances[e];
  return settle(fit, descend(fit, {{start.l_o}}).front());
}

/// Intervals of l_o are those of the profiles.
void take_intervals(const std::vector<ElongationProfile>& profiles, IdentifyResult& result) {
  for (const ElongationProfile& profile : profiles)
    for (IdentifyPreload& preload : result.preloads)
      for (Estimate& e : preload.parameters) {
        if (preload.name != profile.preload || e.name != profile.name) continue;
        if (std::isinf(profile.low) && std::isinf(profile.high)) {
          e.not_identifiable = "its profile likelihood stays flat over all elongations looked at";
          continue;
        }
        e.ci_low = std::isinf(profile.low) ? std::numeric_limits<double>::quiet_NaN() : profile.low;
        e.ci_high =
            std::isinf(profile.high) ? std::numeric_limits<double>::quiet_NaN() : profile.high;
      }
}

ElongationProfiles profiles_of(JointFit& fit, const JudgedPoint& judged) {
  std::vector<Eigen::Index> which;
  std::vector<double> t, scale;
  const Eigen::MatrixXd& honest = judged.covariance.covariance;
  for (Eigen::Index k = fit.layout.n_linear; k < judged.linearised.x.size(); ++k) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(judged.linearised.x.size(), k);
    if (!judged.linearised.determines(unit)) continue;
    which.push_back(k);
    scale.push_back(judged.linearised.solve_operator(k, k) / honest(k, k));
    t.push_back(t_quantile_975(judged.covariance.degrees_of_freedom(k)));
  }
  return profile_elongations(fit, judged.point, which, honest, t, scale);
}

/// The best point, with everything that judges it.
struct Profiled {
  JudgedPoint judged;
  std::vector<ElongationProfile> profiles;
};

/// A profile that leads below the point says where to search on.
Profiled judge_with_profiles(JointFit& fit, JointPoint point) {
  for (int i = 0; i < kRestarts; ++i) {
    JudgedPoint judged = judge_point(fit, evaluate(fit, {point.l_o}, true).front());
    ElongationProfiles found = profiles_of(fit, judged);
    if (!found.better) return {std::move(judged), std::move(found.profiles)};
    point = settle(fit, std::move(*found.better));
  }
  throw Error(ErrorKind::not_identifiable,
              "the initial elongations: every profile likelihood leads to another best place; give "
              "them in the rig file, or sweep until every cable goes slack");
}

}  // namespace

IdentifyResult identify(std::span<const LogSurvey> logs, const IdentifyOptions& options) {
  IdentifyResult result;
  require_channels(logs);
  for (const LogSurvey& log : logs)
    result.inputs.push_back({log.plan.path, log.sha256, log.n_rows});
  std::vector<PreloadFacts> facts = preloads_of(logs, options);
  const std::vector<PreloadJob> jobs = begin_jobs(logs, options, facts, result);
  std::vector<JointRecord> blocked(facts.size());
  for (std::size_t j = 0; j < facts.size(); ++j)
    if (facts[j].has_blocked)
      blocked[j] = blocked_record(logs, options, facts[j].has_moving, facts[j]);

  JointFit first;
  const JointPoint start = fit_first(logs, options, facts, blocked, jobs, first);
  JointFit fit = full_fit(logs, options, jobs, blocked, first, start, facts);
  const bool apart = fit.layout.find("J_link", kShared) < 0 && fit.layout.find("J_link", 0) >= 0;
  JointPoint point = fit_all(fit, first, start);
  if (apart) point = share_inertias(fit, std::move(point), result);
  Profiled found = judge_with_profiles(fit, std::move(point));
  const JudgedPoint& judged = found.judged;
  describe(fit, judged, facts, options, result);
  result.profiles = std::move(found.profiles);
  take_intervals(result.profiles, result);
  if (options.recursive) {
    const Eigen::MatrixXd& c =
        options.honest_sd ? judged.covariance.covariance : judged.covariance.white;
    result.trace = recursive_trace(fit, judged.point, c.diagonal().cwiseMax(0).cwiseSqrt());
  }
  if (options.figures) result.figures = identify_figures(logs, result);
  return result;
}

}  // namespace cablefit

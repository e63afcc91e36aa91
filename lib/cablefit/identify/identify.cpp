#include "cablefit/identify/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/dynamic/estimates/estimates.hpp"
#include "cablefit/identify/aliased_inertias.hpp"
#include "cablefit/identify/elastic_stage.hpp"
#include "cablefit/identify/elongations/joint_solution.hpp"
#include "cablefit/identify/elongations/radius_profile.hpp"
#include "cablefit/identify/equations/joint_radii.hpp"
#include "cablefit/identify/identify_floor.hpp"
#include "cablefit/identify/preload_records.hpp"
#include "cablefit/identify/results/identify_checks.hpp"
#include "cablefit/identify/results/identify_description.hpp"
#include "cablefit/identify/results/identify_estimates.hpp"
#include "cablefit/identify/results/identify_figures.hpp"
#include "cablefit/identify/results/recursive.hpp"
#include "cablefit/model/effects/effects_per_joint.hpp"
#include "cablefit/model/modes.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

void require_channels(std::span<const LogSurvey> logs) {
  for (const LogSurvey& log : logs) {
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

/// Moving logs show whether the drive holds its torque. Blocked logs have the same drive, also
/// those of a preload without moving ones.
JointRecord with_found_hold(JointRecord blocked, const IdentifyOptions& options,
                            const std::vector<PreloadFacts>& all, PreloadFacts& own) {
  if (options.samples.torque_hold.value_or(own.rig.torque_hold) != TorqueHold::automatic)
    return blocked;
  const PreloadFacts* shown = &own;
  for (const PreloadFacts& other : all)
    if (!shown->has_moving && other.has_moving) shown = &other;
  if (!shown->delay.held) return blocked;
  SignalSettings& signal = blocked.settings.signal;
  signal.torque_held = true;
  if (!(signal.torque_period > 0)) signal.torque_period = shown->delay.hold;
  own.decisions.push_back({"blocked: torque hold", "zoh", "as the moving logs show"});
  return blocked;
}

JointFit full_fit(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                  std::vector<PreloadJob> jobs, const std::vector<JointRecord>& blocked,
                  const JointFit& first, const JointPoint& start,
                  std::vector<PreloadFacts>& facts) {
  int moving = 0;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    if (!facts[j].has_moving) continue;
    ++moving;
    const Transmission cables = fitted_cables(first.jobs[j], start.l_o[j], start.solution.x);
    jobs[j].records.push_back(
        moving_record(logs, options, cables, deflections_of(first, j, start), facts[j]));
  }
  for (std::size_t j = 0; j < jobs.size(); ++j)
    if (facts[j].has_blocked)
      jobs[j].records.insert(jobs[j].records.begin(),
                             with_found_hold(blocked[j], options, facts, facts[j]));
  return make_joint_fit(logs, std::move(jobs), moving > 1, options.unconstrained,
                        options.samples.threads);
}

constexpr int kMostPasses = 10;
constexpr double kStill = 1e-3;  // of a nonlinear parameter

/// Moves the effects of a preload to where the fit has them; false: no nonlinear parameter moves.
bool move_effects(const JointFit& fit, const JointPoint& point, std::size_t job,
                  EffectsPerJoint& added) {
  bool any = false;
  for (const JointRecord& record : fit.jobs[job].records)
    for (const JointEquation& equation : record.equations)
      for (const DynamicParameter& p : equation.added) {
        const double found = point.solution.x(fit.layout.find(p.name, static_cast<int>(job)));
        Estimate* e = find_parameter(added, p.name);
        if (e == nullptr || !std::isfinite(found)) continue;
        e->value = p.is_nonlinear ? p.moved(found) : found;
        any =
            any || (p.is_nonlinear && std::abs(e->value - p.origin) > kStill * std::abs(p.origin));
      }
  return any;
}

/// The full fit. Where effects have nonlinear parameters, their columns are made anew about what
/// it finds until these stand still (Gauss-Newton).
JointPoint settled_fit(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                       const std::vector<PreloadJob>& jobs, const std::vector<JointRecord>& blocked,
                       const JointFit& first, const JointPoint& start,
                       std::vector<PreloadFacts>& facts, JointFit& fit) {
  for (int pass = 1;; ++pass) {
    std::vector<PreloadFacts> own = facts;
    fit = full_fit(logs, options, jobs, blocked, first, start, own);
    JointPoint point = fit_all(fit, first, start);
    bool any = false;
    for (std::size_t j = 0; j < facts.size(); ++j)
      any = move_effects(fit, point, j, facts[j].added) || any;
    if (any && pass < kMostPasses) continue;
    if (any)
      own.front().warnings.emplace_back(
          "the nonlinear parameters of the effects did not converge: the logs do not "
          "determine them well");
    facts = std::move(own);
    return point;
  }
}

constexpr int kMostRadiusPasses = 5;
constexpr double kStillRadius = 1e-4;  // relative: what settings are chosen by does not see it

/// The full fit. Settings of moving logs go by the elastic side, and that by the motor radii: where
/// these are searched and moved, they are chosen again.
JointPoint fit_with_settings(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                             std::vector<PreloadJob> jobs, const std::vector<JointRecord>& blocked,
                             std::vector<PreloadFacts>& facts, JointFit& fit) {
  for (int pass = 1;; ++pass) {
    std::vector<PreloadFacts> own = facts;
    JointFit first;
    const JointPoint start = fit_first(logs, options, own, blocked, jobs, first);
    JointPoint point = settled_fit(logs, options, jobs, blocked, first, start, own, fit);
    const Eigen::ArrayXd before = searched_radii(first), found = searched_radii(fit);
    const bool moved = ((found - before).abs() > kStillRadius * before.abs()).any();
    if (!moved || pass == kMostRadiusPasses) {
      if (moved)
        own.front().warnings.emplace_back(
            "the motor radii did not converge: the logs hardly determine them");
      facts = std::move(own);
      return point;
    }
    set_radii(found, jobs);
  }
}

/// Whether the blocked logs of one preload, without cables in the rig file, show a curve of cables
/// that are both taut at zero: only a search of l_o describes it.
bool curve_wants_search(std::span<const LogSurvey> logs, const IdentifyOptions& options) {
  ElasticOptions elastic;
  elastic.samples = options.samples;
  elastic.preload = options.preload;
  const auto is_blocked = [&](const PartSurvey& part) {
    return part.phase == Phase::blocked &&
           (options.preload.empty() || part.preload == options.preload);
  };
  if (preload_names(logs, is_blocked).size() != 1) return false;
  if (first_log_with(logs, is_blocked).plan.rig.cables_given) return false;
  const ElasticPreload stage1 =
      fit_elastic_stage(logs, elastic, ElongationMode::automatic).preloads.at(0);
  return !stage1.shape_doubt.empty() || is_preloaded(stage1.fits.back().transmission);
}

}  // namespace

IdentifyResult identify(std::span<const LogSurvey> logs, const IdentifyOptions& given) {
  IdentifyResult result;
  require_channels(logs);
  IdentifyOptions options = given;
  if (options.elongations == ElongationMode::automatic && !options.unconstrained &&
      curve_wants_search(logs, options)) {
    options.elongations = ElongationMode::search;
    options.search_reason = "the stiffness falls on both sides of zero";
  }
  for (const LogSurvey& log : logs)
    result.inputs.push_back({log.plan.path, log.sha256, log.n_rows});
  result.warnings = input_warnings(logs);
  std::vector<PreloadFacts> facts = preloads_of(logs, options);
  for (const PreloadFacts& f : facts) require_fittable(f.added, false, f.rig.transmission.cables);
  for (PreloadFacts& f : facts)
    if (any_effect(f.added) && f.has_blocked)
      f.warnings.emplace_back(
          "the effects of the model are fitted in the moving logs only: friction differs "
          "in a blocked sweep");
  const std::vector<PreloadJob> jobs = begin_jobs(logs, options, facts, result);
  std::vector<JointRecord> blocked(facts.size());
  for (std::size_t j = 0; j < facts.size(); ++j)
    if (facts[j].has_blocked)
      blocked[j] = blocked_record(logs, options, facts[j].has_moving, facts[j]);

  JointFit fit;
  JointPoint point = fit_with_settings(logs, options, jobs, blocked, facts, fit);
  const bool apart =
      std::any_of(fit.layout.parameters.begin(), fit.layout.parameters.end(),
                  [](const JointParameter& p) { return p.inertia && p.preload != kShared; });
  if (apart) point = share_inertias(fit, std::move(point), result);
  Profiled found = judge_with_profiles(fit, std::move(point));
  const JudgedPoint& judged = found.judged;
  for (std::size_t j = 0; j < fit.jobs.size(); ++j) require_explained(fit, judged, j);
  std::vector<Estimate> estimates = joint_estimates(fit, judged, found.profiles, options.robust_sd);
  profile_radii(fit, judged, estimates);
  for (const PreloadFacts& f : facts) refuse_dependent(f.added, estimates);
  add_method_floor(logs, options, fit, judged, facts, estimates);
  if (options.robust_sd) widen_aliased_inertias(logs, options, fit, judged, facts, estimates);
  describe(fit, judged, estimates, facts, options, result);
  result.profiles = std::move(found.profiles);
  if (options.recursive) result.trace = recursive_trace(fit, judged.point, estimates);
  if (options.figures) result.figures = identify_figures(logs, result);
  return result;
}

}  // namespace cablefit

#include "cablefit/prove/prove.hpp"

#include <optional>

#include "cablefit/base/error.hpp"
#include "cablefit/copies/simulated_copy.hpp"
#include "cablefit/prove/model_to_simulate.hpp"
#include "cablefit/prove/proof_runs.hpp"
#include "cablefit/prove/residual_colour.hpp"
#include "cablefit/prove/stage1_draw.hpp"

namespace cablefit {
namespace {

/// Everything that the runs of one fit share.
struct DynamicPlan {
  SimulatedCopy moving;
  std::optional<SimulatedCopy> blocked;  ///< none: stage 1 is drawn
  CopyDisturbance disturbance;
  DynamicOptions options;  ///< of the fit in each run
  const ProveStage1* stage1 = nullptr;
  const ElasticFit* elastic = nullptr;
};

/// What noise and rounding do not explain of the residuals is a disturbance.
CopyDisturbance disturbances_of(const std::map<std::string, ResidualColour>& measured,
                                const std::map<std::string, ResidualColour>& by_noise,
                                const Rig& rig, std::vector<std::string>& notes) {
  const auto n_joints = static_cast<std::size_t>(rig.n_joints());
  CopyDisturbance disturbance;
  disturbance.motor.resize(n_joints);
  disturbance.link.resize(n_joints);
  for (const auto& [name, colour] : measured) {
    Eigen::VectorXd left = colour.autocovariance;
    const auto noise = by_noise.find(name);
    const bool same_grid =
        noise != by_noise.end() && is_same_grid(noise->second.period, colour.period);
    if (same_grid) left -= noise->second.autocovariance;
    const ArModel model = fit_ar(left, colour.period, colour.n_values);
    auto& of_side = colour.side == Side::link ? disturbance.link : disturbance.motor;
    of_side[static_cast<std::size_t>(colour.joint)] = model;
    notes.push_back(disturbance_note(name + " equation", std::sqrt(colour.autocovariance(0)), model,
                                     torque_unit(rig.axes.of(colour.joint))));
  }
  return disturbance;
}

ProofRun run_once(const DynamicPlan& plan, std::uint64_t seed) {
  ProofRun run;
  try {
    Random disturbances(seed, kDisturbances), sensors(seed, kSensors), draws(seed, kStage1);
    ElasticResult elastic;
    if (plan.blocked) {
      const auto motions = run_copy(*plan.blocked, plan.disturbance, disturbances);
      elastic = fit_elastic(record_copy(*plan.blocked, motions, sensors), plan.stage1->options);
    } else if (plan.elastic != nullptr) {
      elastic = draw_stage1(*plan.stage1->result, plan.options.preload, *plan.elastic, draws);
    }
    const auto motions = run_copy(plan.moving, plan.disturbance, disturbances);
    const std::vector<LogSurvey> logs = record_copy(plan.moving, motions, sensors);
    run.parameters = fit_dynamic(logs, elastic, plan.options).preloads.at(0).fits.at(0).parameters;
  } catch (const Error& error) {
    run.failure = error.what();
  }
  return run;
}

PartFilter parts_of(Phase phase, const std::string& preload) {
  return [phase, preload](const PartSurvey& part) {
    return part.phase == phase && part.preload == preload;
  };
}

bool has_part(std::span<const LogSurvey> logs, const PartFilter& wanted) {
  return std::any_of(logs.begin(), logs.end(), [&](const LogSurvey& log) {
    return std::any_of(log.parts.begin(), log.parts.end(), wanted);
  });
}

/// What the low-pass of stage 2 lets through; 0: there is none.
double cutoff_of(const DynamicPreload& preload, std::span<const LogSurvey> logs,
                 const DynamicOptions& options) {
  if (options.samples.cutoff) return *options.samples.cutoff;
  const PartFilter wanted = parts_of(Phase::moving, preload.name);
  return moving_settings(logs, wanted, options.samples, preload.resonance).rows.signal.cutoff;
}

void add_blocked(const ProveStage1& stage1, const DynamicPreload& preload, const Model& model,
                 const CopyDrive& drive, DynamicPlan& plan) {
  const PartFilter wanted = parts_of(Phase::blocked, preload.name);
  if (stage1.logs.empty() || !has_part(stage1.logs, wanted)) {
    plan.moving.notes.emplace_back("stage 1 drawn from its covariance");
    return;
  }
  plan.blocked = make_copy(model, stage1.logs, wanted, drive);
  Random unused(0);
  choose_sensors(*plan.blocked, run_copy(*plan.blocked, {}, unused));
  plan.moving.notes.emplace_back("stage 1 rerun on simulated blocked logs");
}

DynamicPlan make_plan(std::span<const LogSurvey> logs, const ProveStage1& stage1,
                      const DynamicOptions& options, const ProveOptions& prove, const Model& model,
                      const DynamicPreload& preload, const DynamicFit& fit) {
  DynamicPlan plan;
  plan.options = options;
  plan.options.models = {fit.model};
  plan.options.method_floor = fit.method_floor;  // a property of the motion, which the runs share
  plan.options.preload = preload.name;
  plan.options.figures = false;
  plan.options.samples.threads = 1;
  plan.stage1 = &stage1;
  if (fit.elastic) plan.elastic = &*fit.elastic;
  const CopyDrive drive{.torque_held = preload.delay.held,
                        .torque_period = preload.delay.period,
                        .cutoff = cutoff_of(preload, logs, options)};
  plan.moving = make_copy(model, logs, parts_of(Phase::moving, preload.name), drive);
  for (std::string& note : plan.moving.notes) note = "controller: " + note;
  const ElasticResult none;
  const ElasticResult& elastic = stage1.result != nullptr ? *stage1.result : none;
  Random calibration(prove.seed, kCalibration);
  const auto quiet = run_copy(plan.moving, {}, calibration);
  choose_sensors(plan.moving, quiet);
  DynamicOptions colours = options;
  colours.samples.threads = prove.threads;
  const auto by_noise = residual_colours(record_copy(plan.moving, quiet, calibration), preload.name,
                                         elastic, fit, colours);
  plan.disturbance = disturbances_of(residual_colours(logs, preload.name, elastic, fit, colours),
                                     by_noise, model.rig, plan.moving.notes);
  if (plan.elastic != nullptr) add_blocked(stage1, preload, model, drive, plan);
  return plan;
}

const LogSurvey& log_of(std::span<const LogSurvey> logs, const std::string& preload) {
  return first_log_with(logs, parts_of(Phase::moving, preload));
}

}  // namespace

void prove_dynamic(std::span<const LogSurvey> logs, const ProveStage1& stage1,
                   const DynamicOptions& options, const ProveOptions& prove,
                   DynamicResult& result) {
  for (DynamicPreload& preload : result.preloads) {
    const Rig& rig = log_of(logs, preload.name).plan.rig;
    for (DynamicFit& fit : preload.fits) {
      std::string why_not;
      const Model model = model_to_simulate(fit, preload, rig, why_not);
      if (!why_not.empty()) {
        fit.warnings.push_back("not proved: " + why_not);
        continue;
      }
      const DynamicPlan plan = make_plan(logs, stage1, options, prove, model, preload, fit);
      fit.proof = prove_by_runs(fit.parameters, prove, plan.moving.notes,
                                [&plan](std::uint64_t seed) { return run_once(plan, seed); });
      widen(fit.parameters, *fit.proof);
    }
  }
}

}  // namespace cablefit

#include "cablefit/identify/preload_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/elastic/blocked_rows.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

constexpr double kWideBand = 0.15;  // of the rate: the widest band the differences allow
constexpr std::size_t kMinRows = 10;

PartFilter moving_parts(const std::string& preload) {
  return [preload](const PartSurvey& part) {
    return part.phase == Phase::moving && part.preload == preload;
  };
}

const Arm* arm_of(const PreloadFacts& facts) {
  return facts.rig.arm.kind != nullptr ? &facts.rig.arm : nullptr;
}

JointEquation equation_of(Side side, const ChosenSettings& settings, const PreloadFacts& facts) {
  const DynamicColumns columns = dynamic_columns(
      side, {}, ElasticDetail::coefficients, {0, 1, arm_of(facts)}, {facts.added, facts.cables});
  JointEquation equation;
  equation.base =
      dynamic_equation(columns, {}, settings.rows.signal.torque_held,
                       side == Side::link ? settings.rest_speed_q : settings.rest_speed_theta);
  if (side == Side::link) equation.base.cutoff = settings.cutoff_q;
  for (Eigen::Index k = 0; k < columns.n_effects; ++k) {
    const DynamicParameter& parameter = columns.parameters[static_cast<std::size_t>(k)];
    if (parameter.given)
      equation.given.push_back({parameter, k});
    else
      equation.own.push_back({parameter.name, k});
  }
  for (const AddedEffect& effect : columns.added)
    for (DynamicParameter& parameter : parameters_of(effect))
      if (!parameter.given) equation.added.push_back(std::move(parameter));
  equation.response = columns.torque;
  equation.motor_side = side == Side::motor;
  return equation;
}

}  // namespace

JointRecord moving_record_with(const ChosenSettings& settings, const PreloadFacts& facts) {
  return {moving_parts(facts.name),
          settings.rows,
          {equation_of(Side::link, settings, facts), equation_of(Side::motor, settings, facts)}};
}

JointRecord blocked_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                           bool moving, PreloadFacts& facts) {
  ElasticOptions elastic;
  elastic.samples = options.samples;
  elastic.order = 1;
  const ElasticJob job = make_job(logs, elastic, facts.name);
  const BlockedRows rows = collect_blocked(job, 0, nullptr);
  if (static_cast<std::size_t>(rows.rows->n_rows()) < kMinRows)
    throw Error(ErrorKind::not_identifiable,
                fmt::format("preload '{:.40}': {} usable rows of a blocked link are too few; sweep "
                            "the motor slowly up and down, several times",
                            facts.name, rows.rows->n_rows()));
  const bool both = has_both_branches(rows);
  if (!both)
    facts.warnings.emplace_back(
        "theta moves in one direction only while the link is blocked: the motor's static friction "
        "is not separable from the elastic torque; sweep up and down");
  JointEquation equation;
  equation.base = blocked_equation(job.basis, nullptr, !rows.plateaus, job.rest_speeds.front(),
                                   job.still_speeds.front());
  equation.own = {{"offset", rows.columns.offset}};
  if (both) equation.own.push_back({moving ? kBlockedFriction : "f_sm", rows.columns.direction});
  if (both && speed_tells_more(rows)) equation.own.push_back({kCreep, rows.columns.speed});
  equation.response = rows.columns.tau;
  for (const Decision& d : job.settings.decisions)
    facts.decisions.push_back({"blocked: " + d.name, d.value, d.reason});
  facts.warnings.insert(facts.warnings.end(), job.settings.warnings.begin(),
                        job.settings.warnings.end());
  return {job.wanted, job.settings.rows, {equation}};
}

JointRecord first_moving_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                                const PreloadFacts& facts) {
  const PartFilter wanted = moving_parts(facts.name);
  SampleOptions wide = options.samples;
  if (!wide.cutoff) wide.cutoff = kWideBand * sample_rates(logs, wanted).lowest;
  ChosenSettings settings = moving_settings(logs, wanted, wide, 0);
  settings.rows.signal.torque_period = facts.rig.torque_period;
  settings.rows.signal.torque_held =
      options.samples.torque_hold.value_or(facts.rig.torque_hold) == TorqueHold::zoh;
  return moving_record_with(settings, facts);
}

MovingJob::MovingJob(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                     const Transmission& fitted, const DeflectionRange& deflections,
                     const PreloadFacts& facts)
    : job{logs,  dynamic, facts.name, moving_parts(facts.name), {&elastic}, {"poly"},
          false, {},      {}} {
  job.arm = arm_of(facts);
  job.added = facts.added;
  elastic.model = "poly";
  elastic.transmission = fitted;
  dynamic.samples = options.samples;
  ElasticResult stage1;
  stage1.preloads.emplace_back();
  stage1.preloads.back().name = facts.name;
  stage1.preloads.back().deflection_low = deflections.low;
  stage1.preloads.back().deflection_high = deflections.high;
  choose_settings(job, found, stage1);
}

MovingJob::MovingJob(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                     const JointFit& fit, const JudgedPoint& judged, std::size_t at,
                     const PreloadFacts& facts)
    : MovingJob(logs, options,
                fitted_cables(fit.jobs[at], judged.point.l_o[at], judged.point.solution.x),
                reference_deflections(
                    fitted_cables(fit.jobs[at], judged.point.l_o[at], judged.point.solution.x),
                    fit.elongations(at, judged.point.l_o[at])),
                facts) {}

JointRecord moving_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                          const Transmission& fitted, const DeflectionRange& deflections,
                          PreloadFacts& facts) {
  for (std::string& warning : unloaded_warnings(logs, moving_parts(facts.name)))
    facts.warnings.push_back(std::move(warning));
  const MovingJob moving(logs, options, fitted, deflections, facts);
  facts.cables = std::make_shared<const Transmission>(fitted);
  facts.delay = moving.found.delay;
  facts.resonance = moving.found.resonance;
  facts.rate = sample_rates(logs, moving_parts(facts.name)).lowest;
  facts.cutoff = moving.job.settings.rows.signal.cutoff;
  for (const Decision& d : moving.job.settings.decisions)
    facts.decisions.push_back({"moving: " + d.name, d.value, d.reason});
  for (const auto* warnings : {&moving.found.warnings, &moving.job.settings.warnings})
    facts.warnings.insert(facts.warnings.end(), warnings->begin(), warnings->end());
  return moving_record_with(moving.job.settings, facts);
}

}  // namespace cablefit

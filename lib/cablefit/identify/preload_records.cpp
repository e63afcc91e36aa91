#include "cablefit/identify/preload_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/dynamic/rows/joint_settings.hpp"
#include "cablefit/dynamic/rows/requirements.hpp"
#include "cablefit/elastic/rows/blocked_rows.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/model/rig/searched_radius.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMinRows = 10;

PartFilter moving_parts(const std::string& preload) {
  return [preload](const PartSurvey& part) {
    return part.phase == Phase::moving && part.preload == preload;
  };
}

JointEquation equation_of(Side side, int joint, const DynamicJob& job, const PreloadFacts& facts) {
  const ChosenSettings& settings = job.settings_of(joint);
  const DynamicColumns columns = dynamic_columns(side, {}, ElasticDetail::coefficients,
                                                 {joint, job.n_joints(), facts.arm, facts.rig.axes},
                                                 {&facts.added, facts.cables});
  JointEquation equation;
  equation.base =
      dynamic_equation(columns, {}, job.settings.rows.signal.torque_held,
                       side == Side::link ? settings.rest_speed_q : settings.rest_speed_theta);
  if (side == Side::link)
    equation.base.cutoff = settings.cutoff_q;
  else if (job.n_joints() > 1)
    equation.base.cutoff = settings.rows.signal.cutoff;
  for (Eigen::Index k = 0; k < columns.n_effects; ++k) {
    const DynamicParameter& parameter = columns.parameters[static_cast<std::size_t>(k)];
    if (parameter.given)
      equation.given.push_back({parameter, k});
    else
      equation.own.push_back({parameter.name, k});
  }
  for (auto k = static_cast<std::size_t>(columns.first_added); k < columns.parameters.size(); ++k)
    if (!columns.parameters[k].given) equation.added.push_back(columns.parameters[k]);
  equation.response = columns.torque;
  equation.motor_side = side == Side::motor;
  equation.joint = joint;
  equation.searched_radius = searched_radii(facts.rig.transmission);
  return equation;
}

/// "preload 'low'", with the joint when there are several.
std::string place_of(const PreloadFacts& facts, int joint) {
  std::string place = fmt::format("preload '{:.40}'", facts.name);
  if (facts.rig.n_joints() > 1) place += fmt::format(", joint {}", joint + 1);
  return place;
}

/// "theta", or "theta2" of several joints.
std::string theta_of(const PreloadFacts& facts, int joint) {
  return facts.rig.n_joints() > 1 ? fmt::format("theta{}", joint + 1) : "theta";
}

/// The blocked equation of one joint. `moving`: see blocked_record().
JointEquation blocked_equation_of(const ElasticJob& job, const BlockedRows& rows, int joint,
                                  bool moving, PreloadFacts& facts) {
  const auto own = static_cast<std::size_t>(joint);
  if (static_cast<std::size_t>(rows.rows->n_rows()) < kMinRows)
    throw Error(ErrorKind::not_identifiable,
                fmt::format("{}: {} usable rows of a blocked link are too few; sweep the motor "
                            "slowly up and down, several times",
                            place_of(facts, joint), rows.rows->n_rows()));
  const bool both = has_both_branches(rows, joint);
  if (!both)
    facts.warnings.push_back(fmt::format(
        "{} moves in one direction only while the link is blocked: the motor's static friction "
        "is not separable from the elastic torque; sweep up and down",
        theta_of(facts, joint)));
  const auto named = [&](const char* name) {
    return joint_parameter_name(name, joint + 1, facts.rig.n_joints());
  };
  const BlockedColumns columns = rows.columns.of_joint(joint);
  JointEquation equation;
  equation.base = blocked_equation(job.basis, nullptr, !rows.plateaus, job.rest_speeds[own],
                                   job.still_speeds[own], joint);
  equation.base.name = named("blocked");
  equation.own = {{named("offset"), columns.offset}};
  if (both) equation.own.push_back({named(moving ? kBlockedFriction : "f_sm"), columns.direction});
  if (both && speed_tells_more(rows, joint)) equation.own.push_back({named(kCreep), columns.speed});
  equation.response = columns.tau;
  equation.blocked = true;
  equation.joint = joint;
  equation.searched_radius = searched_radii(facts.rig.transmission);
  return equation;
}

}  // namespace

JointRecord moving_record_with(const DynamicJob& job, const PreloadFacts& facts) {
  JointRecord record{moving_parts(facts.name), job.settings.rows, {}};
  for (int joint = 0; joint < job.n_joints(); ++joint)
    for (const Side side : {Side::link, Side::motor})
      record.equations.push_back(equation_of(side, joint, job, facts));
  return record;
}

JointRecord blocked_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                           bool moving, PreloadFacts& facts) {
  ElasticOptions elastic;
  elastic.samples = options.samples;
  elastic.order = 1;
  const ElasticJob job = make_job(logs, elastic, facts.name);
  const std::vector<BlockedRows> rows =
      collect_joints(job, Eigen::VectorXd::Zero(job.basis.n_joints), nullptr);
  JointRecord record{job.wanted, job.settings.rows, {}};
  for (int joint = 0; joint < job.basis.n_joints; ++joint)
    record.equations.push_back(
        blocked_equation_of(job, rows[static_cast<std::size_t>(joint)], joint, moving, facts));
  for (const Decision& d : job.settings.decisions)
    facts.decisions.push_back({"blocked: " + d.name, d.value, d.reason});
  facts.warnings.insert(facts.warnings.end(), job.settings.warnings.begin(),
                        job.settings.warnings.end());
  return record;
}

JointRecord first_moving_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                                const PreloadFacts& facts) {
  DynamicOptions dynamic;
  dynamic.samples = options.samples;
  DynamicJob job{logs, dynamic, facts.name, moving_parts(facts.name), {}, {}, false, {}, {}};
  require_motion(job);
  const SampleOptions wide = with_wide_band(options.samples, sample_rates(logs, job.wanted).lowest);
  choose_joint_settings(job, wide, std::vector<double>(static_cast<std::size_t>(job.n_joints())));
  job.settings.rows.signal.torque_period = facts.rig.torque_period;
  job.settings.rows.signal.torque_held =
      options.samples.torque_hold.value_or(facts.rig.torque_hold) == TorqueHold::zoh;
  return moving_record_with(job, facts);
}

MovingJob::MovingJob(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                     const Transmission& fitted, const std::vector<DeflectionRange>& deflections,
                     const PreloadFacts& facts)
    : job{logs,  dynamic, facts.name, moving_parts(facts.name), {&elastic}, {"poly"},
          false, {},      {}} {
  job.added = facts.added;
  elastic.model = "poly";
  elastic.transmission = fitted;
  dynamic.samples = options.samples;
  ElasticResult stage1;
  ElasticPreload& preload = stage1.preloads.emplace_back();
  preload.name = facts.name;
  preload.deflection_low = deflections.front().low;
  preload.deflection_high = deflections.front().high;
  for (const DeflectionRange& range : deflections) {
    ElasticJoint& joint = preload.joints.emplace_back();
    joint.deflection_low = range.low;
    joint.deflection_high = range.high;
  }
  require_motion(job);
  choose_settings(job, found, stage1);
}

MovingJob::MovingJob(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                     const JointFit& fit, const JudgedPoint& judged, std::size_t at,
                     const PreloadFacts& facts)
    : MovingJob(logs, options,
                fitted_cables(fit.jobs[at], judged.point.l_o[at], judged.point.solution.x),
                deflections_of(fit, at, judged.point), facts) {}

JointRecord moving_record(std::span<const LogSurvey> logs, const IdentifyOptions& options,
                          const Transmission& fitted,
                          const std::vector<DeflectionRange>& deflections, PreloadFacts& facts) {
  for (std::string& warning : unloaded_warnings(logs, moving_parts(facts.name)))
    facts.warnings.push_back(std::move(warning));
  const MovingJob moving(logs, options, fitted, deflections, facts);
  facts.cables = std::make_shared<const Transmission>(fitted);
  facts.delay = moving.found.delay;
  facts.resonance = moving.found.resonance;
  facts.rate = sample_rates(logs, moving_parts(facts.name)).lowest;
  facts.resonances.clear();
  facts.cutoffs.clear();
  for (int joint = 0; joint < moving.job.n_joints(); ++joint) {
    facts.resonances.push_back(moving.job.settings_of(joint).resonance);
    facts.cutoffs.push_back(moving.job.settings_of(joint).rows.signal.cutoff);
  }
  for (const Decision& d : moving.job.settings.decisions)
    facts.decisions.push_back({"moving: " + d.name, d.value, d.reason});
  for (const auto* warnings : {&moving.found.warnings, &moving.job.settings.warnings})
    facts.warnings.insert(facts.warnings.end(), warnings->begin(), warnings->end());
  return moving_record_with(moving.job, facts);
}

}  // namespace cablefit

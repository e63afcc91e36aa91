#include "cablefit/elastic/checks/preload_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/model/model.hpp"

namespace cablefit {
namespace {

constexpr double kStillNoise = 4;  // counts or sd of noise that are no motion
constexpr Eigen::Index kMinRows = 10;
constexpr double kReductionRounding = 1e-9;

/// Whether a channel varies by more than its noise in any wanted part.
bool varies(const ElasticJob& job, Channel channel, int joint) {
  for (const LogSurvey& log : job.logs)
    for (const PartSurvey& part : log.parts) {
      const int k = log.plan.find(channel, joint);
      if (k < 0 || !job.wanted(part)) continue;
      const ChannelSurvey& c = part.channels[static_cast<std::size_t>(k)];
      if (c.range() > kStillNoise * std::max(c.noise, c.quantum)) return true;
    }
  return false;
}

/// "theta", or "theta2" of several joints.
std::string channel_of(const ElasticJob& job, const char* name, int joint) {
  return job.basis.n_joints > 1 ? fmt::format("{}{}", name, joint + 1) : name;
}

/// "preload 'low'", with the joint when there are several.
std::string place_of(const ElasticJob& job, const std::string& preload, int joint) {
  std::string place = fmt::format("preload '{:.40}'", preload);
  if (job.basis.n_joints > 1) place += fmt::format(", joint {}", joint + 1);
  return place;
}

/// The classical spring has the reduction of the pulleys, where it has one.
void note_reduction(const ElasticJob& job, ElasticPreload& preload) {
  const Eigen::VectorXd reductions = job.basis.reductions();
  for (int joint = 0; joint < job.basis.n_joints; ++joint)
    if (std::abs(reductions(joint) - 1) > kReductionRounding)
      preload.decisions.push_back(
          {joint_parameter_name("reduction N", joint + 1, job.basis.n_joints),
           fmt::format("{:.6g}", reductions(joint)),
           "of the rig's pulleys, link radius over motor radius: the linear model is tau = K "
           "(theta - N q) on the motor, N times that on the link"});
}

}  // namespace

ElasticPreload begin_preload(const ElasticJob& job, const std::string& name) {
  ElasticPreload preload;
  preload.name = name;
  preload.axes = job.rig().axes.all();
  preload.unit = unit_for(preload.axes, "rad");
  preload.rig_path = job.rig().path;
  preload.rig_facts = elastic_facts(job.rig());
  preload.decisions = job.settings.decisions;
  preload.warnings = job.settings.warnings;
  if (job.options.unconstrained)
    preload.decisions.push_back(
        {"stiffness", "unconstrained", "given; a negative cable stiffness is allowed"});
  if (job.options.offset)
    preload.decisions.push_back(
        {"offset", fmt::format("{:g}", *job.options.offset), "given, not fitted"});
  note_reduction(job, preload);
  return preload;
}

void require_motion(const ElasticJob& job) {
  const Place place{first_log_with(job.logs, job.wanted).plan.path, 0, 0};
  for (int joint = 0; joint < job.basis.n_joints; ++joint) {
    const std::string theta = channel_of(job, "theta", joint);
    if (!varies(job, Channel::theta, joint))
      throw input_error(place, theta + " never moves while the link is blocked",
                        fmt::format("sweep the motor slowly up and down, and check which column "
                                    "{} is",
                                    theta));
    if (!varies(job, Channel::tau, joint))
      throw input_error(place, channel_of(job, "tau", joint) + " never changes",
                        "check which column holds the torque");
  }
}

void require_rows(const BlockedRows& rows, const ElasticJob& job, const std::string& preload,
                  int joint) {
  const std::string place = place_of(job, preload, joint);
  if (rows.rows->n_rows() < kMinRows)
    throw Error(
        ErrorKind::not_identifiable,
        fmt::format(
            "{}: {} usable rows of a blocked link are too few ({} read; {} in "
            "pieces too short between gaps or changes, {} at their edges; after decimation {} "
            "at rest, {} not used); sweep the motor slowly up and down, several times",
            place, rows.rows->n_rows(), rows.windows.rows_read, rows.windows.rows_too_short,
            rows.counts.rows_at_edges, rows.counts.rows_at_rest, rows.counts.rows_not_used));
  const Eigen::Index deflection = rows.columns.of_joint(joint).deflection;
  if (!(rows.rows->r().col(deflection).norm() > 0))
    throw Error(ErrorKind::not_identifiable,
                fmt::format("{}: theta and q are the same, so there is no deflection; check which "
                            "columns they are, or use 'cablefit dynamic --model rigid'",
                            place));
}

}  // namespace cablefit

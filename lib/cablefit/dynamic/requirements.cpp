#include "cablefit/dynamic/requirements.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

bool torque_changes(const DynamicJob& job, int joint) {
  for (const LogSurvey& log : job.logs) {
    const int k = log.plan.find(Channel::tau, joint);
    for (const PartSurvey& part : log.parts)
      if (k >= 0 && job.wanted(part) && part.channels[static_cast<std::size_t>(k)].range() > 0)
        return true;
  }
  return false;
}

void require_restoring(const ElasticFit& fit, const std::string& preload) {
  if (fit.transmission.cables.empty() && !(fit.transmission.linear_stiffness.minCoeff() > 0))
    throw Error(ErrorKind::not_identifiable,
                fmt::format("stage 1 of preload '{:.40}' has a negative stiffness: the sign of "
                            "tau, theta or q is turned "
                            "round; set it in the rig file and run 'cablefit elastic' again",
                            preload));
}

const ElasticFit& find_stage1(const ElasticResult& elastic, const std::string& preload,
                              const std::string& model) {
  for (const ElasticPreload& p : elastic.preloads) {
    if (p.name != preload) continue;
    if (const ElasticFit* fit = p.find(model)) return *fit;
    throw Error(ErrorKind::input, fmt::format("stage 1 has no '{}' fit for preload '{:.40}'; run "
                                              "'cablefit elastic' again",
                                              model, preload));
  }
  std::string names;
  for (const ElasticPreload& p : elastic.preloads) names += (names.empty() ? "" : ", ") + p.name;
  throw Error(
      ErrorKind::input,
      fmt::format("stage 1 has no preload '{:.40}', which the moving logs are of; it has {}; run "
                  "'cablefit elastic' on a blocked log of it, or name the preloads alike",
                  preload, names.empty() ? "none" : names));
}

}  // namespace

void require_channels(const LogPlan& plan, bool rigid) {
  require_channel(plan, Channel::tau, rigid ? "the rigid model" : "stage 2");
  if (rigid) {
    require_channel(plan, Channel::theta, "the rigid model");
    return;
  }
  require_channel(plan, Channel::q, "an elastic model",
                  "add it, map it in a rig file, or use --model rigid");
  require_channel(plan, Channel::theta, "an elastic model");
}

void require_torque(const DynamicJob& job) {
  const int n = job.n_joints();
  for (int joint = 0; joint < n; ++joint)
    if (!torque_changes(job, joint))
      throw input_error({job.first_log().plan.path, 0, 0},
                        fmt::format("tau{} never changes", n > 1 ? std::to_string(joint + 1) : ""),
                        "check which column the torque is");
}

void require_rows(const EquationRows& e, const std::string& preload) {
  if (e.counts.rows_used >= static_cast<std::size_t>(kRowsPerParameter * e.columns.n_effects))
    return;
  throw Error(
      ErrorKind::not_identifiable,
      fmt::format("preload '{}': only {} rows in motion on the {} side; record a longer or faster "
                  "motion, or lower --rest-speed",
                  preload, e.counts.rows_used, e.equation.name));
}

const ElasticFit& require_stage1(const ElasticResult& elastic, const std::string& preload,
                                 const std::string& model) {
  const ElasticFit& fit = find_stage1(elastic, preload, model);
  require_restoring(fit, preload);
  return fit;
}

}  // namespace cablefit

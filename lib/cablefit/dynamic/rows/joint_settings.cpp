#include "cablefit/dynamic/rows/joint_settings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/model/model.hpp"

namespace cablefit {
namespace {

/// The lower of two cut-offs, 0 being none.
double lower_cutoff(double a, double b) { return a > 0 && b > 0 ? std::min(a, b) : std::max(a, b); }

/// What all equations share: enough for the joint that needs most. The margin around rest is that
/// of the highest cut-off: an equation with a lower one widens it (equation_rows.hpp).
void take_most(RowSettings& all, const ChosenSettings& joint) {
  const RowSettings& own = joint.rows;
  if (own.signal.cutoff >= all.signal.cutoff) {
    const bool is_same = own.signal.cutoff == all.signal.cutoff;
    all.rest_margin = is_same ? std::max(all.rest_margin, own.rest_margin) : own.rest_margin;
  }
  all.signal.cutoff = std::max(all.signal.cutoff, own.signal.cutoff);
  all.decimate = std::min(all.decimate, own.decimate);
  all.drop_edge = std::max(all.drop_edge, own.drop_edge);
  all.rate = own.rate;
}

bool has(const std::vector<Decision>& decisions, const Decision& one) {
  return std::any_of(decisions.begin(), decisions.end(), [&](const Decision& other) {
    return other.name == one.name && other.value == one.value && other.reason == one.reason;
  });
}

/// The value that was taken of a choice that all equations share; empty: each has its own.
std::string value_taken(const std::string& choice, const RowSettings& all) {
  if (choice == "decimation") return std::to_string(all.decimate);
  if (choice == "edge rows") return std::to_string(all.drop_edge);
  return "";
}

/// Choices that all joints share, then those that differ, by joint.
std::vector<Decision> decisions_by_joint(const std::vector<ChosenSettings>& joints,
                                         const RowSettings& all) {
  std::vector<Decision> decisions;
  const int n = static_cast<int>(joints.size());
  for (int joint = 0; joint < n; ++joint)
    for (Decision one : joints[static_cast<std::size_t>(joint)].decisions) {
      const bool is_common =
          std::all_of(joints.begin(), joints.end(),
                      [&](const ChosenSettings& other) { return has(other.decisions, one); });
      const std::string taken = value_taken(one.name, all);
      if (!taken.empty() && one.value != taken) continue;
      if (!is_common && taken.empty()) one.name = joint_parameter_name(one.name, joint + 1, n);
      if (!has(decisions, one)) decisions.push_back(std::move(one));
    }
  return decisions;
}

ChosenSettings merged(const std::vector<ChosenSettings>& joints) {
  ChosenSettings all = joints.front();
  for (const ChosenSettings& joint : joints) {
    take_most(all.rows, joint);
    all.rows.lowest_cutoff = lower_cutoff(all.rows.lowest_cutoff,
                                          lower_cutoff(joint.rows.signal.cutoff, joint.cutoff_q));
  }
  all.decisions = decisions_by_joint(joints, all.rows);
  all.warnings.clear();
  for (std::size_t k = 0; k < joints.size(); ++k)
    for (const std::string& warning : joints[k].warnings)
      all.warnings.push_back(fmt::format("joint {}: {}", k + 1, warning));
  return all;
}

}  // namespace

void choose_joint_settings(DynamicJob& job, const SampleOptions& options,
                           const std::vector<double>& resonances) {
  const int n = job.n_joints();
  job.joint_settings.clear();
  for (int joint = 0; joint < n; ++joint)
    job.joint_settings.push_back(moving_settings(
        job.logs, job.wanted, options, resonances[static_cast<std::size_t>(joint)], joint));
  if (n > 1) {
    job.settings = merged(job.joint_settings);
    return;
  }
  job.settings = job.joint_settings.front();
  job.joint_settings.clear();
}

}  // namespace cablefit

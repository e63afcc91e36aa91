#include "cablefit/dynamic/checks/low_cutoff.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/dynamic/checks/systematic.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {
namespace {

constexpr double kNotSmall = 0.5;  // of the sd
constexpr const char* kMotorInertia = "J_motor";

bool is_low(double cutoff, double resonance) {
  return resonance > 0 && cutoff > 0 && cutoff < kEnoughResonances * resonance;
}

bool is_any_low(const DynamicJob& job) {
  for (int joint = 0; joint < job.n_joints(); ++joint) {
    const ChosenSettings& own = job.settings_of(joint);
    if (is_low(own.rows.signal.cutoff, own.resonance)) return true;
  }
  return false;
}

}  // namespace

std::string low_cutoff_warning(double cutoff, double resonance, const Estimate& j_motor,
                               double error, bool in_sd) {
  if (!is_low(cutoff, resonance) || !j_motor.not_identifiable.empty() || !(j_motor.sd > 0) ||
      !(std::abs(error) > kNotSmall * j_motor.sd))
    return {};
  return fmt::format(
      "the cut-off of {:.4g} Hz is below twice the free resonance under load, {:.3g} Hz: {} is "
      "wrong by about {:.2g} % ({:.2g} sd, {}), as a fit to a simulated copy without disturbances "
      "shows; record at a higher rate or with a finer encoder",
      cutoff, resonance, j_motor.name, 100 * std::abs(error / j_motor.value),
      std::abs(error) / j_motor.sd, in_sd ? "contained in the sd" : "not contained in the sd");
}

void note_low_cutoff(const EstimationTask& task, const Estimation& estimation, DynamicFit& fit) {
  const DynamicJob& job = task.job;
  if (job.rigid || !is_any_low(job)) return;
  const bool in_sd = !fit.method_floor.empty();
  const std::map<std::string, double> floor =
      in_sd ? fit.method_floor : measured_floor(task, estimation);
  for (int joint = 0; joint < job.n_joints(); ++joint) {
    const std::string name = joint_parameter_name(kMotorInertia, joint + 1, job.n_joints());
    const Estimate* const e = find_estimate(fit.parameters, name);
    const auto error = floor.find(name);
    if (e == nullptr || error == floor.end()) continue;
    const ChosenSettings& own = job.settings_of(joint);
    std::string warning =
        low_cutoff_warning(own.rows.signal.cutoff, own.resonance, *e, error->second, in_sd);
    if (!warning.empty()) fit.doubts.push_back(std::move(warning));
  }
}

}  // namespace cablefit

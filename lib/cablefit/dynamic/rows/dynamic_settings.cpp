#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "cablefit/dynamic/rows/delay_hold.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"
#include "cablefit/dynamic/rows/joint_settings.hpp"
#include "cablefit/dynamic/rows/torque_delay.hpp"
#include "cablefit/model/stiffness.hpp"
#include "cablefit/samples/rows/agreement.hpp"

namespace cablefit {
namespace {

// f0 of the elastic drive needs inertias, which are what is looked for. A first fit with a generous
// band gives them; the CAD values are never used.
double rough_resonance(double stiffness, double j_motor, double j_link) {
  if (!(j_link > 0) || !(j_motor > 0) || !(stiffness > 0)) return 0;
  return free_resonance(stiffness, j_motor, j_link);
}

/// The stiffness at the middle of the torque range used, for f0: of one joint (from 0), the others
/// at rest in the reference pose. `seen`: its deflections in stage 1.
template <typename Deflected>
double typical_stiffness(const ElasticFit& fit, const Deflected& seen, int joint) {
  const double deflection = 0.5 * std::max(-seen.deflection_low, seen.deflection_high);
  return 0.5 * (motor_stiffness(fit.transmission, joint, -deflection) +
                motor_stiffness(fit.transmission, joint, deflection));
}

const ElasticPreload* stage1_of(const ElasticResult& elastic, const std::string& preload) {
  for (const ElasticPreload& stage1 : elastic.preloads)
    if (stage1.name == preload) return &stage1;
  return nullptr;
}

/// Free resonance of every joint by a preliminary fit with the job's settings; 0: it lies beyond
/// half the rate, or no inertia comes out.
std::vector<double> preliminary_resonances(DynamicJob& job, const ElasticResult& elastic) {
  const double rate = sample_rates(job.logs, job.wanted).lowest;
  const int n = job.n_joints();
  job.links_alone = true;  // near enough
  const std::vector<EquationRows> preliminary = preliminary_equations(job);
  job.links_alone = false;
  const std::size_t last = job.elastic.size() - 1;
  const ElasticPreload* stage1 = stage1_of(elastic, job.preload);
  std::vector<double> resonances;
  for (int joint = 0; joint < n; ++joint) {
    const std::size_t link = 2 * static_cast<std::size_t>(joint);
    const double j_link = solve_equation(preliminary[link], job.elastic, last).x(0);
    const double j_motor = solve_equation(preliminary[link + 1], job.elastic, last).x(0);
    const ElasticFit& fit = *job.elastic[last];
    const double stiffness = stage1 == nullptr ? 0
                             : n == 1          ? typical_stiffness(fit, *stage1, joint)
                                      : typical_stiffness(fit, stage1->joints[link / 2], joint);
    const double f0 = rough_resonance(stiffness, j_motor, j_link);
    resonances.push_back(f0 < rate / 2 ? f0 : 0);
  }
  return resonances;
}

/// Noise of the encoders keeps some joint's cut-off below what its resonance asks for.
bool is_noise_limited(const DynamicJob& job) {
  for (int joint = 0; joint < job.n_joints(); ++joint) {
    const ChosenSettings& own = job.settings_of(joint);
    if (own.resonance > 0 && own.rows.signal.cutoff < own.resonance) return true;
  }
  return false;
}

/// Chooses the settings by the free resonances. The wide band of the preliminary fit lets encoder
/// noise in, which makes inertias too small and resonances too high: where the chosen cut-off shows
/// that, a second look goes by it.
std::vector<double> choose_by_resonances(DynamicJob& job, const ElasticResult& elastic) {
  const double rate = sample_rates(job.logs, job.wanted).lowest;
  choose_joint_settings(job, with_wide_band(job.options.samples, rate),
                        std::vector<double>(static_cast<std::size_t>(job.n_joints())));
  std::vector<double> resonances = preliminary_resonances(job, elastic);
  choose_joint_settings(job, job.options.samples, resonances);
  if (job.options.samples.cutoff || !is_noise_limited(job)) return resonances;
  const std::vector<double> second = preliminary_resonances(job, elastic);
  for (std::size_t k = 0; k < second.size(); ++k)
    if (second[k] > 0) resonances[k] = second[k];
  choose_joint_settings(job, job.options.samples, resonances);
  return resonances;
}

/// Of the joint that shows it best: all drives are taken to be of one kind.
TorqueDelay find_delay(const DynamicJob& job) {
  std::optional<TorqueDelay> best;
  const int n = job.n_joints();
  for (int joint = 0; joint < n; ++joint) {
    RowSettings rows = job.settings.rows;
    const ChosenSettings& own = job.settings_of(joint);
    rows.signal.cutoff = own.rows.signal.cutoff;
    TorqueDelay delay = estimate_torque_delay(
        job.logs, job.wanted, rows, own.rest_speed_theta, job.rigid ? Side::rigid : Side::motor,
        job.rigid ? nullptr : job.elastic.back(), {joint, n, nullptr, job.rig().axes});
    if (n > 1) delay.reason = fmt::format("joint {}: {}", joint + 1, delay.reason);
    if (!best || (delay.estimated && (!best->estimated || delay.sd < best->sd)))
      best = std::move(delay);
  }
  return *best;
}

}  // namespace

void choose_settings(DynamicJob& job, DynamicPreload& preload, const ElasticResult& elastic) {
  std::vector<double> resonances(static_cast<std::size_t>(job.n_joints()), 0.0);
  if (job.rigid)
    choose_joint_settings(job, job.options.samples, resonances);
  else
    resonances = choose_by_resonances(job, elastic);
  preload.resonance = *std::max_element(resonances.begin(), resonances.end());
  job.settings.rows.signal.torque_period = job.rig().torque_period;
  preload.delay = find_delay(job);
  const TorqueHold hold = job.options.samples.torque_hold.value_or(job.rig().torque_hold);
  std::string reason = preload.delay.reason;
  if (hold != TorqueHold::automatic) {
    const bool held = hold == TorqueHold::zoh;
    if (preload.delay.undecided)
      preload.delay.warning.clear();
    else if (preload.delay.estimated && preload.delay.warning.empty() &&
             (held != preload.delay.held || preload.delay.period > 0))
      preload.delay.warning = fmt::format("torque hold {} was given, but {}", held ? "zoh" : "none",
                                          preload.delay.reason);
    preload.delay.held = held;
    preload.delay.period = 0;
    reason = "given; " + reason;
  }
  if (preload.delay.period > 0) job.settings.rows.signal.torque_period = preload.delay.period;
  job.settings.decisions.push_back({"torque hold", name_of(hold_of(preload.delay)), reason});
  if (!preload.delay.warning.empty()) preload.warnings.push_back(preload.delay.warning);
  job.settings.rows.signal.torque_held = preload.delay.held;
}

}  // namespace cablefit

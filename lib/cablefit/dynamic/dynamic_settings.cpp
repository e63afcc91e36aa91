#include <fmt/format.h>

#include <cmath>

#include "cablefit/dynamic/dynamic_job.hpp"
#include "cablefit/dynamic/torque_delay.hpp"
#include "cablefit/model/modes.hpp"
#include "cablefit/samples/agreement.hpp"

namespace cablefit {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kPilotWindows = 8;
constexpr double kWideBand = 0.15;  // of the rate: the widest band the differences allow

// f0 of the elastic drive needs inertias, which are what is looked for. A first fit with a generous
// band gives them; the CAD values are never used.
double resonance(double stiffness, double j_link, double j_motor) {
  if (!(j_link > 0) || !(j_motor > 0) || !(stiffness > 0)) return 0;
  return std::sqrt(stiffness * (1 / j_motor + 1 / j_link)) / (2 * kPi);
}

/// The stiffness at the middle of the torque range used, for f0.
double typical_stiffness(const ElasticFit& fit, const ElasticPreload& preload) {
  if (fit.transmission.cables.empty()) return fit.transmission.linear_stiffness(0);
  double sum = 0;
  const double deflection = 0.5 * std::max(-preload.deflection_low, preload.deflection_high);
  for (const Cable& cable : fit.transmission.cables) {
    for (const double phi : {-deflection, deflection}) {
      const double r = cable.motor_map.front().radius(phi);
      sum += 0.5 * r * r * cable.stiffness(elongation_at(fit.transmission, cable, phi));
    }
  }
  return sum;
}

/// f0 of the elastic drive, 0 when it lies beyond half the rate.
double find_resonance(DynamicJob& job, const ElasticResult& elastic) {
  const RateRange rates = sample_rates(job.logs, job.wanted);
  const double rate = rates.lowest;
  SampleOptions wide = job.options.samples;
  if (!wide.cutoff) wide.cutoff = kWideBand * rate;
  job.settings = moving_settings(job.logs, job.wanted, wide, 0);
  const std::vector<EquationRows> pilot = pilot_equations(job, kPilotWindows);
  const std::size_t last = job.elastic.size() - 1;
  const double j_link = solve_equation(pilot[0], job.elastic, last).x(0);
  const double j_motor = solve_equation(pilot[1], job.elastic, last).x(0);
  for (const ElasticPreload& stage1 : elastic.preloads) {
    if (stage1.name != job.preload) continue;
    const double f0 = resonance(typical_stiffness(*job.elastic[last], stage1), j_link, j_motor);
    return f0 < rate / 2 ? f0 : 0;
  }
  return 0;
}

}  // namespace

void choose_settings(DynamicJob& job, DynamicPreload& preload, const ElasticResult& elastic) {
  preload.resonance = job.rigid ? 0 : find_resonance(job, elastic);
  job.settings = moving_settings(job.logs, job.wanted, job.options.samples, preload.resonance);
  job.settings.rows.signal.torque_period = job.rig().torque_period;
  preload.delay = estimate_torque_delay(
      job.logs, job.wanted, job.settings.rows, job.settings.rest_speed_theta,
      job.rigid ? Side::rigid : Side::motor, job.rigid ? nullptr : job.elastic.back());
  const TorqueHold hold = job.options.samples.torque_hold.value_or(job.rig().torque_hold);
  std::string reason = preload.delay.reason;
  if (hold != TorqueHold::automatic) {
    const bool held = hold == TorqueHold::zoh;
    if (preload.delay.estimated && held != preload.delay.held && preload.delay.warning.empty())
      preload.delay.warning = fmt::format("torque hold {} was given, but {}", held ? "zoh" : "none",
                                          preload.delay.reason);
    preload.delay.held = held;
    reason = "given; " + reason;
  }
  job.settings.decisions.push_back({"torque hold", preload.delay.held ? "zoh" : "none", reason});
  if (!preload.delay.warning.empty()) preload.warnings.push_back(preload.delay.warning);
  job.settings.rows.signal.torque_held = preload.delay.held;
}

}  // namespace cablefit

#include "cablefit/dynamic/method_floor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/copies/twin.hpp"
#include "cablefit/dynamic/fitted_model.hpp"
#include "cablefit/dynamic/log_copy.hpp"

namespace cablefit {
namespace {

// s; second order in the step: 1e-4 of the resonance's period costs nothing beside a filter.
constexpr double kStep = 100e-6;
constexpr double kAside = 16;  // encoder steps that a draw's motion is moved by, at most

/// The logs of the job, or stretches of them where they are long.
struct CopiedLogs {
  std::vector<LogSurvey> stretches;
  std::span<const LogSurvey> logs;
};

CopiedLogs logs_to_copy(const DynamicJob& job) {
  double all = 0;
  for (const LogSurvey& log : job.logs)
    for (const PartSurvey& part : log.parts)
      if (job.wanted(part)) all += static_cast<double>(part.n_rows);
  CopiedLogs out;
  if (all > kFloorRows)
    out.stretches = stretches_of(job.logs, job.wanted, kFloorRows / all,
                                 bridge_seconds(job.settings.rows.signal));
  out.logs = out.stretches.empty() ? job.logs : std::span<const LogSurvey>(out.stretches);
  return out;
}

/// Positions as the encoders show them, torques as they are.
void choose_encoders(Twin& twin, const std::vector<SimulationResult>& motions) {
  choose_sensors(twin, motions);
  for (std::size_t log = 0; log < twin.plans.size(); ++log)
    for (std::size_t k = 0; k < twin.plans[log].slots.size(); ++k) {
      const Channel channel = twin.plans[log].slots[k].channel;
      if (channel != Channel::q && channel != Channel::theta) twin.sensors[log][k] = {};
    }
}

/// All joints turned alike, so that the encoders round otherwise and the cables do not notice.
std::vector<SimulationResult> moved_aside(const Twin& twin, std::vector<SimulationResult> motions,
                                          Random& random) {
  for (std::size_t k = 0; k < motions.size(); ++k) {
    double quantum = 0;
    for (const TwinSensor& sensor : twin.sensors[twin.stretches[k].log])
      quantum = std::max(quantum, sensor.quantum);
    const double aside = kAside * quantum * random.uniform();
    motions[k].q += aside;
    motions[k].theta += aside;
  }
  return motions;
}

/// What the method finds in the copy, per equation; values only.
std::vector<LinearSolution> fit_copy(const DynamicJob& job, const std::vector<LogSurvey>& copy,
                                     std::size_t which) {
  DynamicOptions options = job.options;
  options.honest_sd = false;
  const DynamicJob own{copy,       options,   job.preload,  job.wanted,         job.elastic,
                       job.models, job.rigid, job.settings, job.joint_settings, job.arm};
  std::vector<EquationRows> equations = make_equations(own);
  collect_rows(own, equations);
  std::vector<LinearSolution> solutions;
  for (const EquationRows& e : equations)
    solutions.push_back(solve_equation(e, own.elastic, which));
  return solutions;
}

/// Squared differences, of parameters that both determine.
Eigen::VectorXd squared_error(const LinearSolution& found, const LinearSolution& truth) {
  Eigen::VectorXd error = (found.x - truth.x).cwiseAbs2();
  for (Eigen::Index k = 0; k < error.size(); ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (!found.not_identifiable[at].empty() || !truth.not_identifiable[at].empty()) error(k) = 0;
  }
  return error;
}

}  // namespace

MethodFloor method_floor(const DynamicJob& job, const std::vector<EquationRows>& equations,
                         const std::vector<LinearSolution>& solutions,
                         const std::vector<bool>& with_instruments, std::size_t which) {
  MethodFloor floor;
  if (job.arm != nullptr && job.arm->is_coupled()) {
    floor.note = "not measured: links that move each other are not simulated yet";
    return floor;
  }
  try {
    const CopiedLogs copied = logs_to_copy(job);
    const RowSettings& rows = job.settings.rows;
    Twin twin = make_twin(fitted_model(job, equations, solutions, which), copied.logs, job.wanted,
                          {rows.signal.torque_held, rows.signal.cutoff, true, kStep});
    Random random(1);
    const auto motions = run_twin(twin, {}, random, job.options.samples.threads);
    for (const LinearSolution& solution : solutions)
      floor.variance.push_back(Eigen::VectorXd::Zero(solution.x.size()));
    const auto add = [&](const std::vector<LinearSolution>& found, bool instruments, double share) {
      for (std::size_t k = 0; k < solutions.size(); ++k)
        if (with_instruments[k] == instruments)
          floor.variance[k] += share * squared_error(found[k], solutions[k]);
    };
    const auto any = [&](bool instruments) {
      return std::find(with_instruments.begin(), with_instruments.end(), instruments) !=
             with_instruments.end();
    };
    if (any(true)) add(fit_copy(job, record_twin(twin, motions, random), which), true, 1);
    choose_encoders(twin, motions);
    for (int draw = 0; draw < kFloorDraws && any(false); ++draw)
      add(fit_copy(job, record_twin(twin, moved_aside(twin, motions, random), random), which),
          false, 1.0 / kFloorDraws);
    floor.note = "fit of a simulated copy of the motion without disturbances";
  } catch (const Error& error) {
    floor = {{}, fmt::format("not measured: {}", error.what())};
  }
  return floor;
}

}  // namespace cablefit

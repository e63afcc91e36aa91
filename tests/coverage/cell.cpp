#include "tests/coverage/cell.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/dynamic/dynamic_fit.hpp"
#include "tests/support/drive_rig.hpp"
#include "tests/support/recorded_log.hpp"

namespace cablefit::coverage {
namespace {

constexpr double kWhite = 1e-9;            // s: no correlation from one row to the next
constexpr double kCorrelationShare = 200;  // of the log, as estimation-rules.md asks

/// Disturbances of about 5 % of the torque (20 N m rms), as the best rigid model
/// of a real drive leaves (EMPS: 5.4 %).
truth::DriveOptions options_of(const Cell& cell) {
  truth::DriveOptions options;
  options.duration = cell.duration;
  options.seed = cell.seed;
  options.quantum_theta = 2 * std::numbers::pi / std::exp2(cell.bits);
  options.open_loop = cell.loop != Loop::closed;
  options.on_sensor = cell.loop == Loop::open;
  options.disturbance_sd = cell.coloured ? 1.0 : 2.0;
  options.disturbance_time = cell.coloured ? cell.duration / kCorrelationShare : kWhite;
  options.kp = cell.stiff ? 1500 : 800;
  options.kd = cell.stiff ? 12 : 6;
  return options;
}

/// No numbers, for a run whose fit complained.
Estimate nothing(const char* name) {
  Estimate e;
  e.name = name;
  return e;
}

}  // namespace

std::vector<CellRow> run_cell(const Cell& cell) {
  const truth::Drive drive;
  const truth::DriveOptions options = options_of(cell);
  const std::vector<LogSurvey> logs = {
      test::survey_of(truth::simulate_drive(drive, options), test::drive_rig(options))};
  DynamicOptions fit;
  fit.models = {"rigid"};
  fit.estimator = cell.estimator;
  std::vector<Estimate> estimates;
  try {
    estimates = fit_dynamic(logs, {}, fit).preloads.at(0).fits.at(0).parameters;
  } catch (const Error&) {
    // Counted: a row without numbers.
  }
  std::vector<CellRow> rows;
  for (const auto& [name, truth] : {std::pair<const char*, double>{"J", drive.J},
                                    {"f_v", drive.f_v},
                                    {"f_s", drive.f_s},
                                    {"offset", drive.offset}}) {
    const Estimate* found = find_estimate(estimates, name);
    rows.push_back({cell.seed, truth, found != nullptr ? *found : nothing(name)});
  }
  return rows;
}

}  // namespace cablefit::coverage

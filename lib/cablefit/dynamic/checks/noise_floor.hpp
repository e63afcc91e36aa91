// How small a torque error can be at all. Internal to dynamic/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/dynamic/checks/judged_rows.hpp"

namespace cablefit {

/// rms of the residual per equation that the sensors' noise alone makes: the first windows of every
/// log are looked at a second time with white noise of the sensors' size on every channel (rig
/// file, else as the log shows it), and what that changes is measured. It goes through the same
/// filters, differences and elastic curve as everything else. `residuals[equation]`: combinations.
std::vector<double> sensor_floor(const DynamicJob& job, const std::vector<EquationRows>& equations,
                                 std::span<const LogSurvey> logs,
                                 const std::vector<Eigen::VectorXd>& residuals);

/// Where logs repeat each other: the same theta_ref from their beginning on.
struct Repeat {
  std::size_t first = 0, second = 0;  ///< numbers of logs
};
/// The first log with the same reference for every later one that has it. Logs with several wanted
/// parts are left out.
std::vector<Repeat> find_repeats(const DynamicJob& job, std::span<const LogSurvey> logs);

/// rms of what differs between the residuals of repeats at the same time, over root 2: no function
/// of the reference explains it. `rows` are of the logs that `repeats` counts. Null: too few rows.
std::optional<double> repeat_floor(const JudgedRows& rows, const std::vector<Repeat>& repeats,
                                   const Eigen::VectorXd& residual);

}  // namespace cablefit

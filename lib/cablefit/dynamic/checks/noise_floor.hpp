// Smallest possible torque error. Internal to dynamic/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cablefit/dynamic/checks/judged_rows.hpp"

namespace cablefit {

/// rms of the residual per equation from the sensors' noise alone. The first windows of every log
/// are read a second time with white noise of the sensors' size on every channel (rig file, else as
/// the log shows it). The change in the residual is the result. It passes the same filters,
/// differences and elastic curve as all other rows. `residuals[equation]`: combinations.
std::vector<double> sensor_floor(const DynamicJob& job, const std::vector<EquationRows>& equations,
                                 std::span<const LogSurvey> logs,
                                 const std::vector<Eigen::VectorXd>& residuals);

/// Logs that repeat each other: the same theta_ref from the beginning on.
struct Repeat {
  std::size_t first = 0, second = 0;  ///< numbers of logs
};
/// For every log with a reference that an earlier log has: the first such log. Logs with several
/// wanted parts are left out.
std::vector<Repeat> find_repeats(const DynamicJob& job, std::span<const LogSurvey> logs);

/// rms of the difference between the residuals of repeats at the same time, over root 2. No
/// function of the reference explains it. `rows` are of the logs that `repeats` numbers. Null: too
/// few rows.
std::optional<double> repeat_floor(const JudgedRows& rows, const std::vector<Repeat>& repeats,
                                   const Eigen::VectorXd& residual);

}  // namespace cablefit

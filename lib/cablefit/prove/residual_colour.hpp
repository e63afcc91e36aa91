// What a fit leaves of its equations on given logs, as autocovariances. Internal to prove/.
#pragma once

#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <string>

#include "cablefit/copies/coloured_noise.hpp"
#include "cablefit/dynamic/dynamic_fit.hpp"

namespace cablefit {

inline constexpr std::size_t kLags = 64;  ///< of an autocovariance

/// Of one equation: residual torque on the grid of the rows used.
struct ResidualColour {
  Side side = Side::motor;
  int joint = 0;
  Eigen::VectorXd autocovariance;  ///< (N m)^2, lags of `period`
  double period = 0;               ///< s, of the rows after decimation
  std::size_t n_values = 0;
};

/// Whether two periods are one: those of a copy's clock are made anew.
inline bool is_same_grid(double period, double other) {
  return std::abs(period - other) < 1e-6 * other;
}

/// "link equation: residual 0.17 N m rms; simulated disturbance: 0.01 N m rms, white".
std::string disturbance_note(const std::string& of, double residual, const ArModel& disturbance,
                             const std::string& unit);

/// The fit's residuals on logs of one preload, with the settings that stage 2 chooses for them. By
/// the name of the equation.
std::map<std::string, ResidualColour> residual_colours(std::span<const LogSurvey> logs,
                                                       const std::string& preload,
                                                       const ElasticResult& elastic,
                                                       const DynamicFit& fit,
                                                       const DynamicOptions& options);

}  // namespace cablefit

// Error of the estimates that filter, differences, sampling and rounding cause without any
// disturbance. No residual shows it, and a longer log does not reduce it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cablefit/copies/simulated_copy.hpp"
#include "cablefit/dynamic/rows/dynamic_job.hpp"

namespace cablefit {

/// Logs of the measured motion, simulated by a model without disturbances.
struct CopyDraw {
  std::vector<LogSurvey> logs;
  bool exact = false;  ///< exact positions; else with the noise and steps of the sensors
  double weight = 1;   ///< among the draws of its kind
  double share = 1;    ///< of the rows of the job
};

/// The copies of a job's motion: at most kFloorRows rows, in stretches over all logs. There is one
/// `exact` copy and kFloorDraws `rounded` ones, with fixed seeds. With torque noise there are two
/// rounded ones: the second has the noise of the first with the opposite sign, so that of the mean
/// error of both, errors linear in the noise cancel (antithetic variates, Hammersley & Morton
/// 1956).
class CopyDraws {
 public:
  /// Throws Error(not_identifiable) where the motion cannot be simulated. `job` must outlive it.
  /// `torque_noise`: N m, sd of the white noise on the torque of each joint; empty: torques are
  /// exact.
  CopyDraws(const DynamicJob& job, const Model& model, bool exact, bool rounded,
            std::vector<double> torque_noise = {});
  void for_each(const std::function<void(const CopyDraw&)>& use);

 private:
  void use_noisy_pair(const std::function<void(const CopyDraw&)>& use);

  bool rounded_, exact_;
  double share_ = 1;
  std::vector<double> torque_noise_;
  Random random_;
  SimulatedCopy copy_;
  std::vector<SimulationResult> motions_;
};

inline constexpr int kFloorDraws = 3;
inline constexpr double kFloorRows = 100000;
inline constexpr const char* kFloorNote =
    "fit of a simulated copy of the motion without disturbances";

/// Squared mean error over the draws of every effect's parameters, per equation, in the square of
/// their units. The scatter about that mean is not included: the covariance of the residual
/// contains it. Empty where the motion could not be simulated.
struct MethodFloor {
  std::vector<Eigen::VectorXd> variance;
  std::string note;  ///< how it was measured, or why it was not

  bool is_known() const { return !variance.empty(); }
};

/// Simulates the measured motion with model number `which` and the values of `solutions` (one per
/// equation), without disturbances, with sensors that round like those of the logs. It fits that
/// copy with the same filter, decimation and masks. The estimates differ from the simulated values
/// by the method alone. `with_instruments`, per equation: instruments exclude rounding, so the copy
/// then has exact positions.
MethodFloor method_floor(const DynamicJob& job, const std::vector<EquationRows>& equations,
                         const std::vector<LinearSolution>& solutions,
                         const std::vector<bool>& with_instruments, std::size_t which);

}  // namespace cablefit

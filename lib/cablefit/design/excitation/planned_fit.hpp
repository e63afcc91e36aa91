// How well `cablefit dynamic` would determine every parameter from a planned motion: the white sd
// from the sensors' noise, with its own filters, decimation and rows.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cablefit/design/excitation/excited_motion.hpp"
#include "cablefit/samples/rows/equation_rows.hpp"

namespace cablefit {

struct PlannedParameter {
  std::string equation;  ///< "motor[1]", or "links": all that move each other
  std::string name, unit;
  double value = 0;     ///< of the model
  double sd = 0;        ///< of the estimate's scatter to expect; infinite when not shown
  double floor = 0;     ///< what the method adds without any noise (filters, kinks), of either sign
  double sd_white = 0;  ///< by (25), which takes all noise for white
  /// sd and floor, root of the sum of squares: the error to expect.
  double error() const;
  /// error() over the size: the value; of a friction what makes a hundredth of the joint's torque
  /// (rms) where that is more; of what may be of either sign, as an offset, all of the torque.
  double relative = 0;
};

struct PlannedFit {
  std::vector<PlannedParameter> parameters;
  /// Why `cablefit dynamic` will refuse an inertia, whatever its sd; empty: it will not.
  std::string refused;
  double worst() const;  ///< the largest relative error
};

/// Settings are chosen once, from a first motion, so that motions of one length can be compared; so
/// are draws of the sensors' noise, which go through filters, derivatives and decimation and then
/// act on the rows of each motion: what they do to the estimates has the sd of their scatter, of
/// noise that a derivative made anything but white, too. Throws Error(input) when the rig does not
/// say how noisy its sensors are, and Error(not_identifiable) for a motion too short or too slow to
/// fit anything to.
class FitPlanner {
 public:
  /// The relative sd of an expected sd is 1 / sqrt(2 n_draws).
  FitPlanner(const Model& model, const ExcitedMotion& first, int n_draws, int threads);
  ~FitPlanner();
  FitPlanner(const FitPlanner&) = delete;
  FitPlanner& operator=(const FitPlanner&) = delete;

  /// On several threads at a time if need be.
  PlannedFit fit(const ExcitedMotion& motion) const;
  double cutoff() const;  ///< Hz

 private:
  struct Settings;
  struct PlannedRows {
    Eigen::MatrixXd rows;      ///< rows x columns, without noise
    Eigen::MatrixXd noise;     ///< rows x draws, N m
    Eigen::VectorXd residual;  ///< of the model's own values, without noise, N m
    std::string name = {};
    double torque = 0;  ///< N m, root of the sum of squares
  };
  PlannedRows planned_rows(const std::vector<std::size_t>& system, const RowBatch& batch,
                           const ExcitedMotion& motion) const;
  void add_system(const std::vector<std::size_t>& system, const RowBatch& batch,
                  const ExcitedMotion& motion, PlannedFit& planned) const;
  std::unique_ptr<Settings> settings_;
};

}  // namespace cablefit

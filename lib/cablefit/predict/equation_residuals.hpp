// Residuals of the equations of motion of a fitted model, along moving logs: the residual of a
// torque is the error of the prediction, or a contact. Internal to predict/.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "cablefit/model/model.hpp"
#include "cablefit/samples/rows/settings.hpp"

namespace cablefit {

/// Rows of one equation from one window, in order of time. Rows at rest are left out.
struct ResidualRows {
  std::size_t log = 0, part = 0;
  std::size_t equation = 0;
  const std::vector<double>& t;     ///< s
  const Eigen::VectorXd& torque;    ///< N m, measured: tau, or tau_load
  const Eigen::VectorXd& residual;  ///< N m, measured torque minus the model's
  std::size_t n_at_rest = 0;
};

/// One equation per joint and side.
struct ResidualEquation {
  Side side = Side::link;
  int joint = 0;  ///< from 0
};

class EquationResiduals {
 public:
  /// Filters and rest speeds are chosen from the logs as for a fit. `wanted`: parts, all moving.
  /// Throws Error for what the logs lack, and for what rows of an equation cannot have (an effect
  /// with a date, links that move each other).
  EquationResiduals(const Model& model, std::span<const LogSurvey> logs, const PartFilter& wanted,
                    const SampleOptions& samples);
  ~EquationResiduals();
  EquationResiduals(EquationResiduals&&) noexcept;
  EquationResiduals& operator=(EquationResiduals&&) noexcept;
  EquationResiduals(const EquationResiduals&) = delete;
  EquationResiduals& operator=(const EquationResiduals&) = delete;

  const std::vector<ResidualEquation>& equations() const;
  double row_seconds() const;  ///< between rows
  const std::vector<Decision>& decisions() const;

  /// All rows, log by log.
  void stream(const std::function<void(const ResidualRows&)>& sink) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace cablefit

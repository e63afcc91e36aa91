// Quantities computed from several estimates, with the sd that follows from theirs.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/base/parameter.hpp"
#include "cablefit/base/parameter_covariance.hpp"

namespace cablefit {

/// Estimates that are known together.
struct JointEstimates {
  std::vector<std::string> names;
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;     ///< robust; 0 of what is given
  double degrees_of_freedom = 1;  ///< for t quantiles

  /// Place of a name; -1 when it is not among them.
  Eigen::Index find(std::string_view name) const;
  /// Of those of `some` that are among them.
  ParameterCovariance covariance_of(const std::vector<std::string>& some) const;
};

struct DerivedQuantity {
  std::string name, symbol, unit;
  std::function<double(const Eigen::VectorXd&)> of;  ///< of JointEstimates::value
};

/// The quantity by the delta method, sd^2 = g' covariance g (Fisher 1922; Oehlert 1992), with the
/// gradient g by central differences of a hundredth of an sd. A quantity that is curved over less
/// than an sd has no such sd. sd_white is left out: `from` has the robust covariance only.
Estimate derive(const DerivedQuantity& quantity, const JointEstimates& from);

}  // namespace cablefit

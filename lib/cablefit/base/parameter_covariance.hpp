// The joint covariance of the parameters of a model or a result, by their names.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace cablefit {

/// matrix(i, j): covariance of parameters i and j, in the product of their units. Empty: not known.
struct ParameterCovariance {
  std::vector<std::string> parameters;
  Eigen::MatrixXd matrix;

  bool empty() const { return parameters.empty(); }
  /// The covariance of these parameters, in their order; nothing when one is missing here.
  std::optional<Eigen::MatrixXd> of(const std::vector<std::string>& some) const;
};

}  // namespace cablefit

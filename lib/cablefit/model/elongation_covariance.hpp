// Joint covariance of the initial elongations l_o that were searched.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "cablefit/model/model.hpp"

namespace cablefit {

struct ElongationCovariance {
  struct Of {
    std::string preload, name;  ///< the name as elongation_name()
  };
  std::vector<Of> of;
  Eigen::MatrixXd matrix;  ///< as many rows and columns; m^2 or rad^2

  bool empty() const { return of.empty(); }
};

/// Appends the result of another, independent search.
void add_independent(const ElongationCovariance& more, ElongationCovariance& all);

/// From every model that has the covariance of its l_o, with the sd that the model gives. The l_o
/// of different models count as independent, because a model file has no covariance between models.
ElongationCovariance elongation_covariance(std::span<const Model> models);

}  // namespace cablefit

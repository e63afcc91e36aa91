// Directions in which parameters cannot be told apart, in words.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace cablefit {

/// Per parameter why it is not determined; empty where it is. `null_directions`: parameters x
/// directions, columns of unit norm, in scaled parameters.
std::vector<std::string> name_null_directions(const Eigen::MatrixXd& null_directions,
                                              const std::vector<std::string>& names);

}  // namespace cablefit

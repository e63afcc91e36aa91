#include "cablefit/base/parameter_covariance.hpp"

#include <algorithm>

namespace cablefit {

std::optional<Eigen::MatrixXd> ParameterCovariance::of(const std::vector<std::string>& some) const {
  std::vector<Eigen::Index> places;
  for (const std::string& name : some) {
    const auto found = std::find(parameters.begin(), parameters.end(), name);
    if (found == parameters.end()) return std::nullopt;
    places.push_back(found - parameters.begin());
  }
  return matrix(places, places);
}

}  // namespace cablefit

#include "cablefit/estimate/fit/derived_quantity.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/fit/parameter_estimate.hpp"

namespace cablefit {
namespace {

constexpr double kStep = 0.01;  // sd: the gradient's own error is then 1e-4 of the curvature's

}  // namespace

Eigen::Index JointEstimates::find(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : found - names.begin();
}

ParameterCovariance JointEstimates::covariance_of(const std::vector<std::string>& some) const {
  ParameterCovariance out;
  std::vector<Eigen::Index> places;
  for (const std::string& name : some) {
    const Eigen::Index place = find(name);
    if (place < 0) continue;
    out.parameters.push_back(name);
    places.push_back(place);
  }
  out.matrix = covariance(places, places);
  return out;
}

Estimate derive(const DerivedQuantity& quantity, const JointEstimates& from) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(from.value.size());
  for (Eigen::Index k = 0; k < from.value.size(); ++k) {
    const double step = kStep * std::sqrt(from.covariance(k, k));
    if (!(step > 0)) continue;
    Eigen::VectorXd up = from.value, down = from.value;
    up(k) += step;
    down(k) -= step;
    gradient(k) = (quantity.of(up) - quantity.of(down)) / (up(k) - down(k));
  }
  Estimate e;
  e.name = quantity.name;
  e.symbol = quantity.symbol;
  e.unit = quantity.unit;
  e.value = quantity.of(from.value);
  e.sd = std::sqrt(std::max(0.0, gradient.dot(from.covariance * gradient)));
  set_interval(e, from.degrees_of_freedom);
  return e;
}

}  // namespace cablefit

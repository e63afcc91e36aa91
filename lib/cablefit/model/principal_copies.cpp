#include "cablefit/model/principal_copies.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "cablefit/base/covariance_root.hpp"
#include "cablefit/model/model_parameters.hpp"

namespace cablefit {
namespace {

// Up, down, and ever less: a parameter that is less sure than large leaves its bounds soon.
constexpr std::array<double, 6> kSteps = {1, -1, 0.3, -0.3, 0.1, -0.1};

/// The parameters of the model that its covariance knows, and their places in it.
struct Known {
  std::vector<ModelParameter> parameters;
  std::vector<Eigen::Index> places;
};

Known known_parameters(const Model& model) {
  const std::vector<std::string>& names = model.covariance.parameters;
  Known known;
  for (const ModelParameter& p : model_parameters(model)) {
    const auto found = std::find(names.begin(), names.end(), p.name);
    if (found == names.end()) continue;
    const Eigen::Index place = found - names.begin();
    if (!(model.covariance.matrix(place, place) > 0)) continue;
    known.parameters.push_back(p);
    known.places.push_back(place);
  }
  return known;
}

/// The model with its parameters moved by `step`; nothing when one leaves its bounds.
std::optional<Model> moved(const Model& model, const std::vector<ModelParameter>& parameters,
                           const Eigen::VectorXd& step) {
  Model copy = model;
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const ModelParameter& p = parameters[k];
    const double before = parameter_value(model, p);
    const double after = before + step(static_cast<Eigen::Index>(k));
    // What stands on a bound or beyond it already is not held against the copy.
    if ((after < p.lower && after < before) || (after > p.upper && after > before))
      return std::nullopt;
    if (is_inertia(model, p) && !(after > 0)) return std::nullopt;
    set_parameter_value(copy, p, after);
  }
  return copy;
}

}  // namespace

std::vector<MovedModel> principal_copies(const Model& model) {
  std::vector<MovedModel> copies;
  const Known known = known_parameters(model);
  if (known.places.empty()) return copies;
  const Eigen::MatrixXd axes = covariance_root(model.covariance.matrix(known.places, known.places));
  for (const auto& axis : axes.colwise()) {
    if (axis.isZero(0)) continue;
    for (const double by : kSteps) {
      auto copy = moved(model, known.parameters, by * axis);
      if (!copy) continue;
      copies.push_back({std::move(*copy), by});
      break;
    }
  }
  return copies;
}

}  // namespace cablefit

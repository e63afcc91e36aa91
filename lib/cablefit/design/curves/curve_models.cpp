#include "cablefit/design/curves/curve_models.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <utility>

#include "cablefit/base/error.hpp"
#include "cablefit/base/root.hpp"
#include "cablefit/model/stiffness.hpp"

namespace cablefit {
namespace {

// Gauss-Legendre, 5 nodes (Abramowitz & Stegun, table 25.4): exact up to degree 9, the square of a
// torque of order 4; on panels, anything smooth.
constexpr std::array<double, 5> kNodes = {-0.906179845938663993, -0.538469310105683091, 0,
                                          0.538469310105683091, 0.906179845938663993};
constexpr std::array<double, 5> kWeights = {0.236926885056189088, 0.478628670499366468,
                                            0.568888888888888889, 0.478628670499366468,
                                            0.236926885056189088};
constexpr int kPanels = 16;     // of each smooth piece
constexpr int kLookSteps = 64;  // per piece, for the largest error
constexpr double kGolden = 0.6180339887498949;
constexpr int kGoldenSteps = 60;

/// Nodes and weights over the range, weights that sum to 1.
struct Quadrature {
  std::vector<double> at, weight;
};

Quadrature quadrature(const JointCurve& curve, const WorkingRange& range) {
  Quadrature nodes;
  const std::vector<double> ends = smooth_pieces(curve, range.low, range.high);
  for (std::size_t k = 1; k < ends.size(); ++k)
    for (int panel = 0; panel < kPanels; ++panel) {
      const double half = (ends[k] - ends[k - 1]) / kPanels / 2;
      const double middle = ends[k - 1] + (2 * panel + 1) * half;
      for (std::size_t i = 0; i < kNodes.size(); ++i) {
        nodes.at.push_back(middle + half * kNodes[i]);
        nodes.weight.push_back(half * kWeights[i] / (range.high - range.low));
      }
    }
  return nodes;
}

/// The largest value of f between a and b, looked for around the best of a grid.
template <typename Function>
double largest_between(Function f, double a, double b, double& where) {
  int best = 0;
  for (int i = 1; i <= kLookSteps; ++i)
    if (f(a + (b - a) * i / kLookSteps) > f(a + (b - a) * best / kLookSteps)) best = i;
  double low = a + (b - a) * std::max(0, best - 1) / kLookSteps;
  double high = a + (b - a) * std::min(kLookSteps, best + 1) / kLookSteps;
  for (int i = 0; i < kGoldenSteps; ++i) {
    const double step = kGolden * (high - low);
    if (f(high - step) < f(low + step)) {
      low = high - step;
    } else {
      high = low + step;
    }
  }
  where = (low + high) / 2;
  for (const double end : {a, b})
    if (f(end) > f(where)) where = end;
  return f(where);
}

/// What the model makes of the torques on the range: the error of the deflection, where it gives
/// the torque at all.
double static_error_at(const CurveModel& model, const JointCurve& curve, double phi) {
  const double torque = curve.torque(phi);
  const double sign = phi < 0 ? -1 : 1;
  if (torque == 0) return 0;
  const auto found = root_outward([&](double at) { return sign * (model.torque(at) - torque); },
                                  sign * 1e-9, sign * kFarthest);
  return found ? std::abs(*found - phi) : std::abs(phi);
}

void measure_errors(const JointCurve& curve, const WorkingRange& range, CurveModel& model) {
  const Quadrature nodes = quadrature(curve, range);
  const auto error = [&](double phi) { return std::abs(model.torque(phi) - curve.torque(phi)); };
  double squares = 0;
  for (std::size_t i = 0; i < nodes.at.size(); ++i)
    squares += nodes.weight[i] * std::pow(error(nodes.at[i]), 2);
  model.rms_error = std::sqrt(squares);
  const std::vector<double> ends = smooth_pieces(curve, range.low, range.high);
  for (std::size_t k = 1; k < ends.size(); ++k) {
    double where = 0;
    const double largest = largest_between(error, ends[k - 1], ends[k], where);
    if (largest > model.max_error) {
      model.max_error = largest;
      model.at = where;
    }
    const auto static_error = [&](double phi) { return static_error_at(model, curve, phi); };
    for (int i = 0; i <= kLookSteps / 4; ++i)
      model.static_error =
          std::max(model.static_error,
                   static_error(ends[k - 1] + (ends[k] - ends[k - 1]) * i * 4 / kLookSteps));
  }
}

/// Columns scaled to unit norm, pivoted QR; a column of zeros gets 0.
Eigen::VectorXd least_squares(Eigen::MatrixXd columns, const Eigen::VectorXd& response) {
  Eigen::VectorXd scale = columns.colwise().norm();
  for (Eigen::Index j = 0; j < scale.size(); ++j) {
    if (scale(j) == 0) scale(j) = 1;
    columns.col(j) /= scale(j);
  }
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(columns);
  return solver.solve(response).cwiseQuotient(scale);
}

/// The joint's transmission with polynomial cables of this order, coefficients 0.
Transmission of_order(const Transmission& transmission, int order) {
  Transmission simpler = transmission;
  const CableLaw& polynomial = find_cable_law("polynomial");
  for (Cable& cable : simpler.cables) {
    cable.law = &polynomial;
    cable.order = order;
    cable.coefficients.assign(static_cast<std::size_t>(cable.n_coefficients()), 0.0);
  }
  return simpler;
}

}  // namespace

WorkingRange working_range(const JointCurve& curve, double torque) {
  const auto low = curve.deflection_at(-torque), high = curve.deflection_at(torque);
  if (low && high && *low < *high) return {*low, *high};
  throw Error(
      ErrorKind::input,
      fmt::format("the cables do not reach a torque of {:g} in both directions; lower --torque, "
                  "or check their coefficients",
                  torque));
}

CurveModel linear_spring(const JointCurve& curve, const WorkingRange& range) {
  const Quadrature nodes = quadrature(curve, range);
  double moment = 0, square = 0;
  for (std::size_t i = 0; i < nodes.at.size(); ++i) {
    moment += nodes.weight[i] * nodes.at[i] * curve.torque(nodes.at[i]);
    square += nodes.weight[i] * nodes.at[i] * nodes.at[i];
  }
  const double k = moment / square;
  CurveModel model;
  model.name = "linear";
  model.coefficients = {k};
  model.transmission = classical_spring(curve.transmission());
  model.transmission.linear_stiffness(curve.joint()) = k;
  model.joint = curve.joint();
  measure_errors(curve, range, model);
  return model;
}

CurveModel cables_of_order(const JointCurve& curve, const WorkingRange& range, int order) {
  const Quadrature nodes = quadrature(curve, range);
  Transmission simpler = of_order(curve.transmission(), order);
  const auto n = static_cast<Eigen::Index>(nodes.at.size());
  const auto n_cables = simpler.cables.size();
  const Eigen::Index per_cable = simpler.cables.front().n_coefficients();
  Eigen::MatrixXd columns(n, per_cable * static_cast<Eigen::Index>(n_cables));
  Eigen::VectorXd response(n);
  for (std::size_t c = 0; c < n_cables; ++c)
    for (Eigen::Index j = 0; j < per_cable; ++j) {
      double& coefficient = simpler.cables[c].coefficients[static_cast<std::size_t>(j)];
      coefficient = 1;
      const JointCurve alone(simpler, curve.joint());
      const Eigen::Index column = static_cast<Eigen::Index>(c) * per_cable + j;
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto k = static_cast<std::size_t>(i);
        columns(i, column) = std::sqrt(nodes.weight[k]) * alone.torque(nodes.at[k]);
      }
      coefficient = 0;
    }
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    response(i) = std::sqrt(nodes.weight[k]) * curve.torque(nodes.at[k]);
  }
  const Eigen::VectorXd x = least_squares(columns, response);
  for (std::size_t c = 0; c < n_cables; ++c)
    for (Eigen::Index j = 0; j < per_cable; ++j)
      simpler.cables[c].coefficients[static_cast<std::size_t>(j)] =
          x(static_cast<Eigen::Index>(c) * per_cable + j);
  CurveModel model;
  model.name = order == 1 ? "piecewise linear" : fmt::format("order {}", order);
  model.coefficients.assign(x.begin(), x.end());
  model.transmission = std::move(simpler);
  model.joint = curve.joint();
  measure_errors(curve, range, model);
  return model;
}

CurveModel cables_themselves(const JointCurve& curve) {
  CurveModel model;
  model.name = "cables";
  model.transmission = curve.transmission();
  model.joint = curve.joint();
  for (const Cable& cable : model.transmission.cables)
    model.coefficients.insert(model.coefficients.end(), cable.coefficients.begin(),
                              cable.coefficients.end());
  return model;
}

double CurveModel::torque(double phi) const { return JointCurve(transmission, joint).torque(phi); }

double CurveModel::stiffness(double phi) const { return motor_stiffness(transmission, joint, phi); }

std::vector<CurveModel> simpler_models(const JointCurve& curve, const WorkingRange& range,
                                       std::span<const int> orders) {
  std::vector<CurveModel> models = {linear_spring(curve, range)};
  for (const int order : orders) models.push_back(cables_of_order(curve, range, order));
  return models;
}

}  // namespace cablefit

#include "cablefit/refine/rows/physical_values.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace cablefit {
namespace {

constexpr int kNothingHeld = -1;

/// Least value of a column; minus infinity: any.
double least_of(const Design& design, Eigen::Index column, const Eigen::MatrixXd& total) {
  const Model& model = design.models.front();
  const ModelParameter& p = design.layout.parameters[static_cast<std::size_t>(column)];
  if (!is_inertia(model, p)) return 0;
  const double own = std::sqrt(total(1 + column, 1 + column));
  const double least = own > 0 ? kLeastTorque * std::sqrt(total(0, 0)) / own : 0;
  const auto cad = model.rig.cad.find(p.name);
  return cad != model.rig.cad.end() && cad->second > 0 ? std::max(least, cad->second) : least;
}

/// Of a spring, or of a cable where it becomes taut. One with pretension may never come near that
/// elongation, and what its curve would be there says nothing.
bool is_stiffness(const Model& model, const ModelParameter& p) {
  if (p.kind == ParameterKind::stiffness) return true;
  return p.kind == ParameterKind::coefficient && p.index == 0 &&
         !(model.transmission.cables[p.cable].initial_elongation > 0);
}

/// Where the fit is beyond what a robot can have: an inertia that is not positive, a friction or a
/// stiffness below 0.
bool is_beyond(const Design& design, Eigen::Index column, double value) {
  const ModelParameter& p = design.layout.parameters[static_cast<std::size_t>(column)];
  const Model& model = design.models.front();
  if (is_inertia(model, p)) return !(value > 0);
  const bool is_friction = p.kind == ParameterKind::effect && p.lower == 0;
  return value < 0 && (is_friction || is_stiffness(model, p));
}

/// The values of all other columns with those of `held` as they are in `x`.
void fit_others(const Eigen::MatrixXd& total, const std::vector<Eigen::Index>& held,
                Eigen::VectorXd& x) {
  std::vector<Eigen::Index> free, at;
  for (Eigen::Index k = 0; k < x.size(); ++k)
    if (std::find(held.begin(), held.end(), k) == held.end())
      free.push_back(k), at.push_back(1 + k);
  Eigen::VectorXd response = total.col(0);
  for (const Eigen::Index k : held) response -= total.col(1 + k) * x(k);
  const Eigen::MatrixXd a = total(at, at);
  const Eigen::VectorXd scale = a.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> llt(scale.asDiagonal() * a * scale.asDiagonal());
  x(free) = scale.cwiseProduct(llt.solve(scale.cwiseProduct(Eigen::VectorXd(response(at)))));
}

}  // namespace

Eigen::VectorXd physical_values(const Design& design, double block_seconds,
                                const KindLevels& levels, const Eigen::VectorXd& x,
                                std::vector<Eigen::Index>* on_bound) {
  Eigen::VectorXd values = x;
  std::vector<Eigen::Index> held;
  Eigen::MatrixXd total;
  for (;;) {
    Eigen::Index next = kNothingHeld;
    for (Eigen::Index k = 0; k < design.layout.n() && next == kNothingHeld; ++k)
      if (is_beyond(design, k, values(k)) && std::find(held.begin(), held.end(), k) == held.end())
        next = k;
    if (next == kNothingHeld) break;
    if (total.size() == 0) total = weighted_sum(block_grams(design, block_seconds), levels);
    values(next) = least_of(design, next, total);
    held.push_back(next);
    fit_others(total, held, values);
  }
  if (on_bound != nullptr) *on_bound = held;
  return values;
}

void take_physical(const Design& design, double block_seconds, const KindLevels& levels,
                   const Eigen::VectorXd& x, FinalFit& fit) {
  std::vector<Eigen::Index> held;
  fit.x = physical_values(design, block_seconds, levels, x, &held);
  for (const Eigen::Index column : held) {
    fit.covariance.row(column).setConstant(std::numeric_limits<double>::quiet_NaN());
    fit.covariance.col(column).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

}  // namespace cablefit

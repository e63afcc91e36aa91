#include "cablefit/refine/steps/elongation_error.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "cablefit/refine/rows/recorded_effects.hpp"

namespace cablefit {
namespace {

constexpr double kRounding = 1e-12;  // of the largest eigenvalue

/// The design with each l_o longer by `step`, and all rows made anew.
Design with_longer(Design design, const Eigen::VectorXd& x, const ElongationCovariance& known,
                   const Eigen::VectorXd& step) {
  for (std::size_t k = 0; k < known.of.size(); ++k)
    for (Model& model : design.models) {
      if (model.preload != known.of[k].preload) continue;
      for (Cable& cable : model.transmission.cables)
        if (elongation_name(cable) == known.of[k].name)
          cable.initial_elongation += step(static_cast<Eigen::Index>(k));
    }
  return rebuilt(design, x);
}

}  // namespace

std::vector<ValueChange> elongation_errors(const Design& design, const Eigen::VectorXd& x,
                                           const KindLevels& levels, double block_seconds,
                                           const ElongationCovariance& known) {
  std::vector<ValueChange> errors;
  if (known.empty() || design.models.front().transmission.cables.empty()) return errors;
  const auto here = change_to_fit(design, x, levels, block_seconds, is_unrecorded);
  if (!here) return errors;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(known.matrix);
  const Eigen::VectorXd& variance = eigen.eigenvalues();
  for (Eigen::Index axis = 0; axis < variance.size(); ++axis) {
    if (variance(axis) <= kRounding * variance.maxCoeff()) continue;
    const Design moved =
        with_longer(design, x, known, std::sqrt(variance(axis)) * eigen.eigenvectors().col(axis));
    auto change = change_to_fit(moved, x, levels, block_seconds, is_unrecorded);
    if (!change) continue;
    change->x -= here->x;
    change->shapes -= here->shapes;
    errors.push_back(*std::move(change));
  }
  return errors;
}

}  // namespace cablefit

#include "cablefit/refine/steps/elongation_error.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "cablefit/refine/rows/recorded_effects.hpp"
#include "cablefit/refine/rows/refined_model.hpp"

namespace cablefit {
namespace {

constexpr double kRounding = 1e-12;  // of the largest eigenvalue

/// Makes each l_o longer by `step`; false: the design has none of these cables.
bool lengthen(const ElongationCovariance& known, const Eigen::VectorXd& step, Design& design) {
  bool any = false;
  for (std::size_t k = 0; k < known.of.size(); ++k)
    for (Model& model : design.models) {
      if (model.preload != known.of[k].preload) continue;
      for (Cable& cable : model.transmission.cables) {
        if (elongation_name(cable) != known.of[k].name) continue;
        cable.initial_elongation += step(static_cast<Eigen::Index>(k));
        any = true;
      }
    }
  return any;
}

}  // namespace

void add_systematic(const ValueChange& error, FinalFit& fit) {
  Eigen::VectorXd all(error.x.size() + error.shapes.size());
  all << error.x, error.shapes;
  fit.covariance.topLeftCorner(all.size(), all.size()) += all * all.transpose();
}

bool add_elongation_errors(const Design& design, const Eigen::VectorXd& x, const KindLevels& levels,
                           const RefineBench& bench, FinalFit& fit) {
  const ElongationCovariance& known = bench.options.elongations;
  if (known.empty() || design.models.front().transmission.cables.empty()) return true;
  const auto change = [&](const Design& of) {
    return change_to_fit(of, x, levels, bench.scan.block_seconds, is_unrecorded);
  };
  const Design as_is = rebuilt(design, x);
  const auto here = change(as_is);
  if (!here) return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(known.matrix);
  const Eigen::VectorXd& variance = eigen.eigenvalues();
  for (Eigen::Index axis = 0; axis < variance.size(); ++axis) {
    if (variance(axis) <= kRounding * variance.maxCoeff()) continue;
    Design moved = as_is;
    if (!lengthen(known, std::sqrt(variance(axis)) * eigen.eigenvectors().col(axis), moved))
      continue;
    const auto there = change(rebuilt(moved, x));
    if (!there) return false;
    add_systematic({there->x - here->x, there->shapes - here->shapes}, fit);
  }
  return true;
}

}  // namespace cablefit

#include "cablefit/refine/steps/elongation_error.hpp"

#include "cablefit/base/covariance_root.hpp"
#include "cablefit/refine/rows/recorded_effects.hpp"
#include "cablefit/refine/rows/refined_model.hpp"

namespace cablefit {
namespace {

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
  const Eigen::MatrixXd axes = covariance_root(known.matrix);
  for (const auto& axis : axes.colwise()) {
    Design moved = as_is;
    if (axis.isZero(0) || !lengthen(known, axis, moved)) continue;
    const auto there = change(rebuilt(moved, x));
    if (!there) return false;
    add_systematic({there->x - here->x, there->shapes - here->shapes}, fit);
  }
  return true;
}

}  // namespace cablefit

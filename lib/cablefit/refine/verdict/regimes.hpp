// Location of the gap: the share of each equation's squared residual above its floor by speed,
// direction, position, deflection, load and time. Internal to refine/.
#pragma once

#include "cablefit/refine/refine_result.hpp"
#include "cablefit/refine/rows/evidence.hpp"

namespace cablefit {

/// The most prominent cells, in order; none where the residual is at its floor.
std::vector<Regime> find_regimes(const Design& design, const Eigen::VectorXd& x,
                                 const KindLevels& floor);

/// As above, by frequency: bands in which an equation's spectrum is above that of its floor.
/// `floor`: residual of a simulated recording under its own base fit, of any design.
std::vector<Regime> find_bands(const Design& design, const Eigen::VectorXd& x, const Design& floor,
                               const Eigen::VectorXd& x_floor);

/// Both lists as one. Those with much of the whole gap on few rows come first; only the most
/// informative are kept.
std::vector<Regime> ranked(std::vector<Regime> cells, std::vector<Regime> bands,
                           const Design& design, const Eigen::VectorXd& x, const KindLevels& floor);

}  // namespace cablefit

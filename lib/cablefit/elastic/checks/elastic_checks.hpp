// Checks of a stage-1 fit: negative cable stiffness, loops, preload, which model will
// do.
#pragma once

#include <span>

#include "cablefit/base/axes.hpp"
#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/elastic/models/passivity.hpp"
#include "cablefit/elastic/rows/elongation_range.hpp"

namespace cablefit {

/// Sets `passive` and warns where a cable pushes over the elongations that the rows reached: the
/// paper's (5) and (16). `longest`: elongation that each cable reached.
void check_passive(ElasticFit& fit, std::span<const double> longest, const ElongationUnit& unit);

/// Fills `selected` and `selection`: the simplest model whose largest error on held-out blocks is
/// within `materiality` (share of the peak torque) of the best one's. Significance is reported
/// beside it.
void select_model(ElasticPreload& preload, double materiality);

/// The same with several joints: the simplest model that will do for each of them.
void select_joint_model(ElasticPreload& preload, double materiality);

/// What a sweep up and down shows of one joint; N m.
struct LoopSeen {
  double half_width = 0, peak = 0, rms = 0;  ///< friction band, peak torque, what the fit leaves
  bool plateaus = false;
};
/// What is left beyond a constant friction band is large beside the peak torque.
bool depends_on_path(const LoopSeen& loop);
/// Warnings of a torque that depends on the path, and of plateaus.
std::vector<std::string> loop_warnings(const LoopSeen& loop, Axes axes);

/// Fills loop_half_width; warns when the torque depends on the path, and adds a loop as wide as
/// `left` to the misfit of the selected fit where that has none. `left`: N m rms, by that fit.
void note_loop(ElasticPreload& preload, double left, bool plateaus);

/// The curve of a pair of cables fitted with l_o = 0 looks like that of two taut ones (preload).
/// `ranges`: elongations that each cable reached.
bool looks_preloaded(const Transmission& transmission, std::span<const ElongationRange> ranges);
/// Warns of it.
void note_closure(std::span<const ElongationRange> ranges, ElasticPreload& preload);

/// A preload that is not in equilibrium, (8c), by the cables that were fitted; nothing where a
/// coefficient is not determined.
void note_imbalance(ElasticPreload& preload);

}  // namespace cablefit

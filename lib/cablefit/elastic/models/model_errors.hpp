// Errors of the candidates: order by held-out blocks, largest errors by a second look at the rows.
#pragma once

#include <string>
#include <vector>

#include "cablefit/elastic/models/candidates.hpp"

namespace cablefit {

/// Orders per cable: first the lowest of all cables that no higher one (up to options.max_order)
/// beats significantly on held-out blocks, by a paired test over blocks; then, cable after cable,
/// the lowest that this one does not beat. The reasons go to `words`.
std::vector<int> choose_orders(const ElasticJob& job, const BlockedRows& rows,
                               std::span<const Nuisance> nuisance, std::vector<std::string>& words);

/// Looks at the rows again: largest errors of every fit, in sample and on held-out blocks,
/// deflection range and peak torque. candidates[k], solutions[k] belong to preload.fits[k].
void measure_errors(const BlockedRows& rows, const std::vector<ElasticCandidate>& candidates,
                    const std::vector<LinearSolution>& solutions, ElasticPreload& preload);
/// The same for the rows of several joints, which `all` has together; fills the errors of every
/// joint and peak torques as well.
void measure_joint_errors(const std::vector<BlockedRows>& joints, const BlockedRows& all,
                          const std::vector<ElasticCandidate>& candidates,
                          const std::vector<LinearSolution>& solutions, ElasticPreload& preload);

}  // namespace cablefit

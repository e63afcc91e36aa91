// Motor radii that are searched: where they stand in the jobs of a fit, and where to start.
#pragma once

#include <span>
#include <vector>

#include "cablefit/identify/equations/joint_fit.hpp"

namespace cablefit {

/// Of one cable whose radius is searched; m, signed.
double searched_radius(const PreloadJob& job, std::size_t cable);

/// Cables whose motor radii change by one factor, as places among the radii of the layout: those on
/// one motor that may be stretched in the reference pose. Every searched radius is in one group.
std::vector<std::vector<Eigen::Index>> radius_groups(std::span<const PreloadJob> jobs);

/// Of the fit's jobs, in the order of the layout; m, signed.
Eigen::VectorXd searched_radii(const JointFit& fit);

void set_radii(const Eigen::VectorXd& radii, std::vector<PreloadJob>& jobs);

/// The fit with these radii instead; it has no rows.
JointFit with_radii(JointFit fit, const Eigen::VectorXd& radii);

/// The motor radii of the jobs where the logs show the reduction: a cable hardly stretches when the
/// links move far, r_m theta = h(q), so that a searched radius is the slope of h against theta.
/// Else they stay as the rig file has them. Throws Error(input) for a radius of the wrong sign, and
/// Error(not_identifiable) when no link moves from where it is blocked and no l_o is known: noise
/// of q would pass for its motion.
void start_radii(std::span<const LogSurvey> logs, std::vector<PreloadJob>& jobs);

/// The forces of the preload balance on each motor, S f = 0 (8c), as they do on the links, which
/// have known radii: all r_m on one motor change by one factor. Rows over all parameters of the
/// layout, l_o and r_m by their changes. None where every l_o of such cables is known to be 0 or
/// less.
Eigen::MatrixXd tie_rows(const PreloadJob& job, const JointLayout& layout);

/// Throws Error(input) where equilibrium ties a searched radius to one that is given, or the radii
/// to start from cannot balance.
void require_tied_radii(const PreloadJob& job, const std::string& rig_path);

}  // namespace cablefit

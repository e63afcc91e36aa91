// Where the motors of a rig would be on cables that do not stretch. Internal to weigh/.
#pragma once

#include <Eigen/Core>

#include "cablefit/samples/weigh/coarse_rows.hpp"

namespace cablefit::weighing {

/// theta = S^+ P^T q from the couplings at rest, joints x joints. Empty when the motors' radii do
/// not determine it.
Eigen::MatrixXd stiff_motors(const Rig& rig);

/// theta of joint `j` by this matrix and these positions of the links, samples.
Eigen::ArrayXd stiff_theta(const Eigen::MatrixXd& stiff, const CoarsePart& part, int j);

}  // namespace cablefit::weighing

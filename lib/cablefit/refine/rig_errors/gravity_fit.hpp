// The base fits of all joints with gravity along another direction. Internal to refine/.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "cablefit/model/model.hpp"
#include "cablefit/refine/null/null_draws.hpp"
#include "cablefit/refine/refine_options.hpp"
#include "cablefit/refine/rig_errors/common_columns.hpp"

namespace cablefit {

/// The rig's arm is a chain of joints with a weight.
bool has_gravity(const Rig& rig);
/// m/s^2, in the frame of the arm's base.
Eigen::Vector3d gravity_of(const Rig& rig);
/// The arm then has the base parameters that this direction asks for.
void set_gravity(Rig& rig, const Eigen::Vector3d& gravity);

/// A change of the direction of gravity, by its angles (rad) about the axes that the rows
/// determine: two, or one on an arm that moves in a plane, whose weights a lean out of the plane
/// only scales.
struct Tilt {
  Eigen::Matrix3Xd axes;  ///< unit vectors in the frame of the arm's base
  Eigen::VectorXd angles;
  Eigen::MatrixXd covariance;  ///< rad^2, by the scatter over blocks of time
  double dof = 1;              ///< of the t distributions of the angles

  Eigen::Vector3d turned(const Eigen::Vector3d& gravity) const;
};

enum class Angles { both, most_shown };

class GravityFit {
 public:
  /// `models`: of all joints, one per preload, with the masses of the arm.
  GravityFit(const std::vector<Model>& models, const RefineLogs& logs);

  /// Per joint; none: it has no base fit.
  const std::vector<std::optional<BaseFit>>& joints() const { return joints_; }

  /// The change that lets the residual of all joints fall most, to first order (Gauss-Newton). The
  /// linear parameters of every joint are fitted anew. Nothing where the rows do not determine each
  /// angle to within half a radian.
  std::optional<Tilt> tilt(Angles angles) const;

 private:
  CommonColumns columns_about(const Eigen::Matrix3Xd& axes) const;

  std::vector<Model> models_;
  std::vector<std::optional<BaseFit>> joints_;
};

}  // namespace cablefit

#include "cablefit/refine/rig_errors/gravity_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "cablefit/model/arm/serial_arm.hpp"
#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/bases/kept_joint.hpp"
#include "cablefit/refine/rows/kernel.hpp"

namespace cablefit {
namespace {

// Of errors that repeat in every block, over the scatter between blocks, as variances: smoothed
// motion has such errors, and no scatter shows them. By 12 simulated thumbs.
constexpr double kRepeated = 0.1;

/// Torque of the links' weights on the joint where gravity is this, N m at every sample.
Eigen::VectorXd weight_on(Model one, const SmoothMotion& motion, const Eigen::Vector3d& gravity) {
  SerialArm arm = *one.rig.arm.parameters.serial;
  arm.chain.gravity = gravity;
  one.rig.arm.parameters.serial = std::make_shared<const SerialArm>(std::move(arm));
  const Eigen::ArrayXXd rest = Eigen::ArrayXXd::Zero(motion.links.rows(), motion.links.cols());
  Eigen::VectorXd masses(static_cast<Eigen::Index>(one.arm.size()));
  for (std::size_t k = 0; k < one.arm.size(); ++k)
    masses(static_cast<Eigen::Index>(k)) = one.arm[k].value;
  return arm_columns(one, motion.links, rest, rest) * masses;
}

/// Torque per radian about each axis, in the rows of every stretch.
VariantColumns tilt_columns(const Design& design, const Eigen::Vector3d& gravity,
                            const Eigen::Matrix3Xd& axes) {
  VariantColumns all;
  for (std::size_t s = 0; s < design.rows.size(); ++s) {
    const StretchRows& rows = design.rows[s];
    const Model& one = design.models[design.stretches[s].model];
    auto& kinds = all.emplace_back();
    for (const KindRows& kind : rows.kinds) {
      Eigen::MatrixXd& columns =
          kinds.emplace_back(Eigen::MatrixXd::Zero(kind.base.rows(), axes.cols()));
      if (kind.kind != RowKind::link) continue;
      Eigen::MatrixXd torque(rows.motion->size(), axes.cols());
      for (Eigen::Index k = 0; k < axes.cols(); ++k)
        torque.col(k) = weight_on(one, *rows.motion, axes.col(k).cross(gravity));
      columns =
          apply_at(gaussian(design.smoothing_of(s).columns, rows.motion->period), torque, kind.at);
    }
  }
  return all;
}

std::optional<Tilt> tilt_about(Eigen::Matrix3Xd axes, const CommonColumns& columns) {
  constexpr double kMostSd = 0.5;    // rad
  constexpr double kOwnPart = 1e-6;  // of a column's square; less is rounding
  std::vector<Eigen::Index> all(static_cast<std::size_t>(axes.cols()));
  std::iota(all.begin(), all.end(), 0);
  const auto step = columns.step(all, kOwnPart);
  if (!step) return {};
  Tilt tilt{std::move(axes), step->change, {}, 1};
  const double n_blocks = step->n_blocks.minCoeff();
  tilt.covariance = (1 + kRepeated * n_blocks) * step->covariance;
  tilt.dof = n_blocks - static_cast<double>(tilt.angles.size());
  const bool is_determined = (tilt.covariance.diagonal().array() < kMostSd * kMostSd).all();
  if (!is_determined) return {};
  return tilt;
}

}  // namespace

bool has_gravity(const Rig& rig) {
  const SerialArm* arm = rig.arm.parameters.serial.get();
  return arm != nullptr && arm->chain.gravity.norm() > 0;
}

Eigen::Vector3d gravity_of(const Rig& rig) { return rig.arm.parameters.serial->chain.gravity; }

void set_gravity(Rig& rig, const Eigen::Vector3d& gravity) {
  SerialChain chain = rig.arm.parameters.serial->chain;
  chain.gravity = gravity;
  rig.arm.parameters.serial = serial_arm_of(std::move(chain));
}

Eigen::Vector3d Tilt::turned(const Eigen::Vector3d& gravity) const {
  const Eigen::Vector3d turn = axes * angles;
  if (!(turn.norm() > 0)) return gravity;
  return Eigen::AngleAxisd(turn.norm(), turn.normalized()) * gravity;
}

GravityFit::GravityFit(const std::vector<Model>& models, const RefineLogs& logs)
    : models_(models), joints_(base_fits_of(models, logs)) {}

CommonColumns GravityFit::columns_about(const Eigen::Matrix3Xd& axes) const {
  const Eigen::Vector3d gravity = gravity_of(models_.front().rig);
  const double block_seconds = ScanSettings{}.block_seconds;
  CommonColumns columns(axes.cols());
  for (const std::optional<BaseFit>& base : joints_)
    if (base) {
      const Design& design = base->design;
      columns.add_joint(extended(base->grams, design.rows, design.stretches,
                                 tilt_columns(design, gravity, axes), block_seconds),
                        base->levels, base->fit.x);
    }
  return columns;
}

std::optional<Tilt> GravityFit::tilt(Angles angles) const {
  const Eigen::Vector3d gravity = gravity_of(models_.front().rig);
  Eigen::Matrix3Xd axes(3, 2);
  axes.col(0) = gravity.unitOrthogonal();
  axes.col(1) = gravity.normalized().cross(axes.col(0));
  if (angles == Angles::most_shown) axes = axes * columns_about(axes).most_shown();
  return tilt_about(axes, columns_about(axes));
}

}  // namespace cablefit

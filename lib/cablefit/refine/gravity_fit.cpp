#include "cablefit/refine/gravity_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "cablefit/model/arm/serial_arm.hpp"
#include "cablefit/model/one_joint.hpp"
#include "cablefit/refine/kept_joint.hpp"
#include "cablefit/refine/rows/kernel.hpp"

namespace cablefit {
namespace {

// Of errors that repeat in every block, over the scatter between blocks, as variances: smoothed
// motion has such errors, and no scatter shows them. By 12 simulated thumbs.
constexpr double kRepeated = 0.1;

using Axes3 = Eigen::Matrix<double, 3, 2>;

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
                            const Axes3& axes) {
  VariantColumns all;
  for (std::size_t s = 0; s < design.rows.size(); ++s) {
    const StretchRows& rows = design.rows[s];
    const Model& one = design.models[design.stretches[s].model];
    auto& kinds = all.emplace_back();
    for (const KindRows& kind : rows.kinds) {
      Eigen::MatrixXd& columns = kinds.emplace_back(Eigen::MatrixXd::Zero(kind.base.rows(), 2));
      if (kind.kind != RowKind::link) continue;
      Eigen::MatrixXd torque(rows.motion->size(), 2);
      for (Eigen::Index k = 0; k < 2; ++k)
        torque.col(k) = weight_on(one, *rows.motion, axes.col(k).cross(gravity));
      columns =
          apply_at(gaussian(design.smoothing_of(s).columns, rows.motion->period), torque, kind.at);
    }
  }
  return all;
}

/// Of the two angles, without the parameters of the joints; summed over joints.
struct NormalEquations {
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();  ///< sum over blocks of right right'
  Eigen::Vector2d right = Eigen::Vector2d::Zero();    ///< right-hand side
  double squares = 0;                                 ///< of the two columns, weighted
  double n_blocks = 0;                                ///< with rows of a moving link
};

/// The part of the last two columns that is not made of those of the base.
void add_joint(const BaseFit& base, const BlockGrams& grams, NormalEquations& sum) {
  const Eigen::Index n = base.grams.n_columns;
  const Eigen::MatrixXd all = weighted_sum(grams, base.levels).bottomRightCorner(n + 2, n + 2);
  const Eigen::VectorXd scale = all.diagonal().unaryExpr(
      [](double square) { return square > 0 ? 1 / std::sqrt(square) : 1.0; });
  const Eigen::MatrixXd scaled = scale.asDiagonal() * all * scale.asDiagonal();
  Eigen::MatrixXd own(n + 2, 2);  // combination of columns
  own.topRows(n) = -scaled.topLeftCorner(n, n).ldlt().solve(scaled.topRightCorner(n, 2));
  own.bottomRows(2).setIdentity();
  own = scale.asDiagonal() * own * scale.tail(2).cwiseInverse().asDiagonal();
  sum.matrix += own.transpose() * all * own;
  sum.squares += all.diagonal().tail(2).sum();
  Eigen::VectorXd residual(n + 3);  // response minus columns
  residual << 1, -base.fit.x, 0, 0;
  for (const BlockGrams::Block& block : grams.blocks) {
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (std::size_t kind = 0; kind < block.gram.size(); ++kind)
      if (block.gram[kind].size() > 0)
        right += own.transpose() * block.gram[kind].bottomRows(n + 2) * residual /
                 (base.levels[kind] * base.levels[kind]);
    sum.right += right;
    sum.scatter += right * right.transpose();
    if (block.n_rows[static_cast<std::size_t>(RowKind::link)] > 0) sum.n_blocks += 1;
  }
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

std::optional<Tilt> GravityFit::tilt() const {
  constexpr double kMostSd = 0.5;    // rad
  constexpr double kOwnPart = 1e-6;  // of a column's square; less is rounding
  const Eigen::Vector3d gravity = gravity_of(models_.front().rig);
  Tilt tilt;
  tilt.axes.col(0) = gravity.unitOrthogonal();
  tilt.axes.col(1) = gravity.normalized().cross(tilt.axes.col(0));
  NormalEquations sum;
  const double block_seconds = ScanSettings{}.block_seconds;
  for (const std::optional<BaseFit>& base : joints_)
    if (base) {
      const Design& design = base->design;
      add_joint(*base,
                extended(base->grams, design.rows, design.stretches,
                         tilt_columns(design, gravity, tilt.axes), block_seconds),
                sum);
    }
  const double own = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(sum.matrix).eigenvalues()(0);
  if (!(own > kOwnPart * sum.squares)) return {};
  const Eigen::Matrix2d inverse = sum.matrix.inverse();
  tilt.angles = inverse * sum.right;
  tilt.covariance = (1 + kRepeated * sum.n_blocks) * inverse * sum.scatter * inverse;
  tilt.dof = std::max(1.0, sum.n_blocks - 2);
  const bool is_determined =
      tilt.angles.allFinite() && (tilt.covariance.diagonal().array() < kMostSd * kMostSd).all();
  if (!is_determined) return {};
  return tilt;
}

}  // namespace cablefit

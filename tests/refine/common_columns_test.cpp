// Values that several joints have in common against one least squares fit of all equations.
#include <Eigen/LU>
#include <Eigen/QR>
#include <catch2/catch.hpp>

#include "cablefit/base/random.hpp"
#include "cablefit/refine/rig_errors/common_columns.hpp"

namespace cablefit::test {
namespace {

constexpr Eigen::Index kRows = 40, kOwn = 2, kCommon = 2;
constexpr std::size_t kBlocks = 5;
constexpr double kLeastOwn = 1e-10;

/// Equations of one joint: response, own columns, common columns.
Eigen::MatrixXd random_rows(std::uint64_t seed) {
  Random random(seed, 1);
  Eigen::MatrixXd rows(kRows * static_cast<Eigen::Index>(kBlocks), 1 + kOwn + kCommon);
  for (Eigen::Index i = 0; i < rows.size(); ++i) rows(i) = random.normal();
  return rows;
}

struct OneJoint {
  Eigen::MatrixXd rows;
  double level = 1;
  BlockGrams grams = {};
  KindLevels levels = {};
  Eigen::VectorXd x = {};  ///< own values without the common ones
};

OneJoint one_joint(const Eigen::MatrixXd& rows, double level) {
  OneJoint joint{rows, level};
  joint.levels.fill(level);
  joint.grams.n_columns = rows.cols() - 1;
  for (std::size_t b = 0; b < kBlocks; ++b) {
    BlockGrams::Block& block = joint.grams.blocks.emplace_back();
    const Eigen::MatrixXd part = rows.middleRows(static_cast<Eigen::Index>(b) * kRows, kRows);
    block.gram[0] = part.transpose() * part;
    block.n_rows[0] = kRows;
  }
  joint.x = rows.middleCols(1, kOwn).colPivHouseholderQr().solve(rows.col(0));
  return joint;
}

std::optional<CommonStep> step_of(const std::vector<OneJoint>& joints,
                                  const std::vector<Eigen::Index>& which) {
  CommonColumns columns(kCommon);
  for (const OneJoint& joint : joints) columns.add_joint(joint.grams, joint.levels, joint.x);
  return columns.step(which, kLeastOwn);
}

TEST_CASE("common values are those of one fit of all joints", "[refine]") {
  const std::vector<OneJoint> joints{one_joint(random_rows(1), 0.5), one_joint(random_rows(2), 2)};
  const auto step = step_of(joints, {0, 1});
  REQUIRE(step);

  const Eigen::Index n = joints[0].rows.rows();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(2 * n, 2 * kOwn + kCommon);
  Eigen::VectorXd response(2 * n), before(2 * n);
  for (Eigen::Index j = 0; j < 2; ++j) {
    const OneJoint& joint = joints[static_cast<std::size_t>(j)];
    const auto own = joint.rows.middleCols(1, kOwn);
    all.block(j * n, j * kOwn, n, kOwn) = own / joint.level;
    all.block(j * n, 2 * kOwn, n, kCommon) = joint.rows.rightCols(kCommon) / joint.level;
    response.segment(j * n, n) = joint.rows.col(0) / joint.level;
    before.segment(j * n, n) = (joint.rows.col(0) - own * joint.x) / joint.level;
  }
  const Eigen::VectorXd values = all.colPivHouseholderQr().solve(response);
  const Eigen::VectorXd left = response - all * values;
  CHECK((step->change - values.tail(kCommon)).norm() < 1e-10);
  CHECK(step->fall == Approx(before.squaredNorm() - left.squaredNorm()).epsilon(1e-9));
  CHECK(step->n_blocks == Eigen::Vector2d::Constant(2 * kBlocks));

  // Sandwich: one score per joint and block, of the residual without the common values.
  const Eigen::MatrixXd inverse = (all.transpose() * all).inverse();
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(all.cols(), all.cols());
  for (Eigen::Index b = 0; b < 2 * static_cast<Eigen::Index>(kBlocks); ++b) {
    const Eigen::VectorXd score =
        all.middleRows(b * kRows, kRows).transpose() * before.segment(b * kRows, kRows);
    scatter += score * score.transpose();
  }
  const Eigen::MatrixXd covariance = inverse * scatter * inverse;
  CHECK((step->covariance - covariance.bottomRightCorner(kCommon, kCommon)).norm() <
        1e-10 * covariance.norm());
}

TEST_CASE("a common value that nothing shows is not determined", "[refine]") {
  Eigen::MatrixXd rows = random_rows(3);
  rows.rightCols(1).setZero();
  const std::vector<OneJoint> joints{one_joint(rows, 1)};
  CHECK(step_of(joints, {0}));
  CHECK_FALSE(step_of(joints, {1}));
  CHECK_FALSE(step_of(joints, {0, 1}));
}

TEST_CASE("the combination of common values that shows most is what the joints do not hide",
          "[refine]") {
  Eigen::MatrixXd rows = random_rows(6);
  rows.rightCols(1) = -0.75 * rows.col(1 + kOwn);  // together they are seen as 1, -0.75
  const OneJoint joint = one_joint(rows, 1);
  CommonColumns columns(kCommon);
  columns.add_joint(joint.grams, joint.levels, joint.x);
  const Eigen::VectorXd most = columns.most_shown();
  CHECK((most * most(0) / std::abs(most(0)) - Eigen::Vector2d(0.8, -0.6)).norm() < 1e-9);
}

TEST_CASE("common values are determined where another joint separates them", "[refine]") {
  Eigen::MatrixXd rows = random_rows(4);
  rows.rightCols(1) = 2 * rows.col(1 + kOwn);
  const std::vector<OneJoint> one{one_joint(rows, 1)};
  CHECK_FALSE(step_of(one, {0, 1}));
  CHECK(step_of({one[0], one_joint(random_rows(5), 1)}, {0, 1}));
  // What the joint's own columns stand for is not the common value's.
  rows.rightCols(1) = rows.col(1);
  CHECK_FALSE(step_of({one_joint(rows, 1)}, {1}));
}

}  // namespace
}  // namespace cablefit::test

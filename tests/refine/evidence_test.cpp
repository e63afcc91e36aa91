// Evidence from block Gram matrices is that of refitting without each block.
#include "cablefit/refine/rows/evidence.hpp"

#include <Eigen/QR>
#include <catch2/catch.hpp>

#include "cablefit/base/random.hpp"

using namespace cablefit;

namespace {

constexpr double kPeriod = 1.0 / 128, kBlock = 20 * kPeriod;  // s, exact: 20 rows

/// One stretch of random rows; the fourth column has no part in the response.
struct Rowful {
  std::vector<Stretch> stretches{1};
  std::vector<StretchRows> rows{1};

  explicit Rowful(int n) {
    stretches[0].recording.period = kPeriod;
    stretches[0].recording.theta = Eigen::ArrayXd::Zero(n);
    KindRows& kind = rows[0].kinds.emplace_back();
    kind.kind = RowKind::motor;
    kind.base.resize(n, 4);
    kind.response.resize(n);
    Random random(3);
    for (int i = 0; i < n; ++i) {
      kind.at.push_back(i);
      for (int k = 0; k < 4; ++k) kind.base(i, k) = random.normal();
      kind.response(i) =
          kind.base(i, 0) - 2 * kind.base(i, 1) + 1e3 * kind.base(i, 2) + 0.1 * random.normal();
    }
    kind.base.col(2) *= 1e3;  // badly scaled on purpose
    kind.response -= 999e-3 * kind.base.col(2);
  }
  const KindRows& only() const { return rows[0].kinds[0]; }
};

}  // namespace

TEST_CASE("held-out error is that of a refit without the block", "[refine]") {
  const Rowful data(200);
  const KindLevels levels{1, 0.5, 1};
  const auto fit = fit_blocks(block_grams(data.rows, data.stretches, kBlock), levels);
  REQUIRE(fit);
  REQUIRE(fit->held_out.size() >= 10);
  for (Eigen::Index b = 0; b < 10; ++b) {
    Eigen::MatrixXd a(180, 4);
    Eigen::VectorXd y(180);
    a << data.only().base.topRows(20 * b), data.only().base.bottomRows(180 - 20 * b);
    y << data.only().response.head(20 * b), data.only().response.tail(180 - 20 * b);
    const Eigen::VectorXd x = a.colPivHouseholderQr().solve(y);
    const Eigen::VectorXd left =
        data.only().response.segment(20 * b, 20) - data.only().base.middleRows(20 * b, 20) * x;
    CHECK(fit->held_out(b) == Approx(left.squaredNorm() / 0.25).epsilon(1e-6));
  }
}

TEST_CASE("grams extended by a column are those of all columns", "[refine]") {
  Rowful data(130);
  const BlockGrams all = block_grams(data.rows, data.stretches, kBlock);
  const VariantColumns last = {{data.only().base.rightCols(1)}};
  Rowful less = data;
  less.rows[0].kinds[0].base = data.only().base.leftCols(3).eval();
  const BlockGrams more = extended(block_grams(less.rows, less.stretches, kBlock), less.rows,
                                   less.stretches, last, kBlock);
  REQUIRE(more.n_columns == 4);
  for (std::size_t b = 0; b < all.blocks.size(); ++b)
    if (all.blocks[b].n_rows[1] > 0)
      CHECK((all.blocks[b].gram[1] - more.blocks[b].gram[1]).norm() <
            1e-12 * all.blocks[b].gram[1].norm());
}

TEST_CASE("columns that cannot be told apart are no fit", "[refine]") {
  Rowful data(100);
  data.rows[0].kinds[0].base.col(3) = 2 * data.rows[0].kinds[0].base.col(0);
  CHECK_FALSE(fit_blocks(block_grams(data.rows, data.stretches, kBlock), {1, 1, 1}));
}

TEST_CASE("the jackknife's covariance is that of refits without each block", "[refine]") {
  const Rowful data(200);
  const auto covariance =
      jackknife_covariance(block_grams(data.rows, data.stretches, kBlock), {1, 0.5, 1});
  REQUIRE(covariance);
  Eigen::MatrixXd without(4, 10);
  for (Eigen::Index b = 0; b < 10; ++b) {
    Eigen::MatrixXd a(180, 4);
    Eigen::VectorXd y(180);
    a << data.only().base.topRows(20 * b), data.only().base.bottomRows(180 - 20 * b);
    y << data.only().response.head(20 * b), data.only().response.tail(180 - 20 * b);
    without.col(b) = a.colPivHouseholderQr().solve(y);
  }
  without.colwise() -= without.rowwise().mean().eval();
  const Eigen::MatrixXd expected = 0.9 * without * without.transpose();
  for (Eigen::Index k = 0; k < 4; ++k)
    CHECK((*covariance)(k, k) == Approx(expected(k, k)).epsilon(1e-3));
}

TEST_CASE("what lies in one block has no jackknife", "[refine]") {
  Rowful data(100);
  data.rows[0].kinds[0].base.col(3).head(80).setZero();
  CHECK_FALSE(jackknife_covariance(block_grams(data.rows, data.stretches, kBlock), {1, 1, 1}));
}

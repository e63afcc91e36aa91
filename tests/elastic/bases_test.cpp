// Bases for the force of the cables: the atoms against other formulas, the held-out error against a
// fit by hand, the number of terms on curves of a known one, and the high preload of the paper.
#include "cablefit/elastic/bases/cable_bases.hpp"

#include <Eigen/QR>
#include <functional>
#include <numbers>

#include "cablefit/elastic/elastic_fit.hpp"
#include "tests/elastic/curves.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

/// Cox & de Boor's recursion (de Boor 1978, X (4)-(5)) on the knots 0, 1, 2, ...
double de_boor(int i, int order, double u) {
  if (order == 1) return u >= i && u < i + 1 ? 1 : 0;
  const double n = order - 1;
  return (u - i) / n * de_boor(i, order - 1, u) +
         (i + order - u) / n * de_boor(i + 1, order - 1, u);
}

TEST_CASE("the cubic B-spline is that of de Boor's recursion", "[elastic]") {
  for (int i = -40; i <= 40; ++i) {
    const double u = 0.0637 * i;
    INFO("u = " << u);
    CHECK_THAT(cubic_b_spline(u), Catch::WithinAbs(de_boor(0, 4, u + 2), 1e-15));
    // Partition of unity: its shifts by whole numbers add up to 1.
    double sum = 0;
    for (int shift = -5; shift <= 5; ++shift) sum += cubic_b_spline(u + shift);
    CHECK_THAT(sum, Catch::WithinAbs(1, 1e-14));
    // The derivative of a B-spline is the difference of two of an order less (X (15)).
    CHECK_THAT(cubic_b_spline_slope(u),
               Catch::WithinAbs(de_boor(0, 3, u + 2) - de_boor(1, 3, u + 2), 1e-14));
  }
  CHECK(cubic_b_spline(0) == Approx(2.0 / 3));
}

TEST_CASE("the Mexican hat is minus a Gaussian's second derivative", "[elastic]") {
  const auto gauss = [](double u) { return std::exp(-u * u / 2); };
  double area = 0, moment = 0;
  for (int i = -1000; i <= 1000; ++i) {
    const double u = 0.01 * i;
    area += 0.01 * mexican_hat(u);
    moment += 0.01 * u * mexican_hat(u);
    if (i % 50 != 0) continue;
    constexpr double kStep = 1e-3;  // second difference: 1e-6/12 times the fourth derivative, 3
    const double second = (gauss(u + kStep) - 2 * gauss(u) + gauss(u - kStep)) / (kStep * kStep);
    CHECK_THAT(mexican_hat(u), Catch::WithinAbs(-second, 1e-6));
    const double slope = (mexican_hat(u + kStep) - mexican_hat(u - kStep)) / (2 * kStep);
    CHECK_THAT(mexican_hat_slope(u), Catch::WithinAbs(slope, 5e-6));
  }
  CHECK(std::abs(area) < 1e-12);  // a wavelet: no mean, and here no first moment
  CHECK(std::abs(moment) < 1e-12);
  CHECK(mexican_hat(1) == 0);
}

TEST_CASE("every atom starts at 0, and those of a monotone basis never fall", "[elastic]") {
  constexpr double kLongest = 0.044;
  REQUIRE(cable_bases().front().name == "polynomial");
  for (const CableBasis& basis : cable_bases()) {
    const std::vector<BasisAtom> atoms = basis.atoms(kLongest, "mrad");
    for (const BasisAtom& atom : atoms) {
      INFO(basis.name << ": " << atom.name);
      CHECK(atom.force(0) == 0);
      double before = 0, steepest = 0;
      for (int i = 0; i <= 220; ++i)
        steepest = std::max(steepest, std::abs(atom.slope(kLongest * i / 220)));
      for (int i = 1; i <= 220; ++i) {
        const double l = kLongest * i / 220 - 1e-5, step = 1e-7;
        const double slope = (atom.force(l + step) - atom.force(l - step)) / (2 * step);
        CHECK(std::abs(slope - atom.slope(l)) <= 1e-6 * steepest);
        if (basis.monotone) CHECK(atom.force(l) >= before);
        if (basis.monotone) CHECK(atom.slope(l) >= 0);
        before = atom.force(l);
      }
    }
  }
}

/// Rows of one cable by hand: offset, powers of l up to 9, tau; the raw rows as well.
struct ByHand {
  BasisRows basis;
  std::vector<Eigen::MatrixXd> raw = std::vector<Eigen::MatrixXd>(kHeldOutBlocks);

  ByHand(std::uint64_t seed, const std::function<double(double)>& torque, double noise,
         Eigen::Index rows_per_block = 40) {
    for (const BasisAtom& atom : cable_bases().front().atoms(1, "mm"))
      basis.atoms.push_back({0, atom});
    basis.n_beside = 1;
    basis.blocks.assign(kHeldOutBlocks, StreamingQr(basis.n_columns()));
    basis.n_rows.assign(kHeldOutBlocks, rows_per_block);
    Normal normal(seed);
    for (std::size_t block = 0; block < raw.size(); ++block) {
      raw[block].resize(rows_per_block, basis.n_columns());
      for (Eigen::Index i = 0; i < rows_per_block; ++i) {
        const double l = (normal.uniform() + 1) / 2;
        raw[block](i, 0) = 1;
        for (std::size_t k = 0; k < basis.atoms.size(); ++k)
          raw[block](i, 1 + static_cast<Eigen::Index>(k)) = basis.atoms[k].atom.force(l);
        raw[block](i, basis.n_columns() - 1) = torque(l) + 0.4 + noise * normal();
      }
      basis.blocks[block].add(raw[block]);
    }
  }

  /// The held-out rms of the first `n` powers, fold by fold on the raw rows.
  double held_out_rms(Eigen::Index n) const {
    double sum = 0;
    for (Eigen::Index fold = 0; fold < kHeldOutFolds; ++fold) {
      Eigen::MatrixXd seen(0, basis.n_columns());
      for (Eigen::Index block = 0; block < kHeldOutBlocks; ++block) {
        if (block % kHeldOutFolds == fold) continue;
        const Eigen::MatrixXd& own = raw[static_cast<std::size_t>(block)];
        seen.conservativeResize(seen.rows() + own.rows(), Eigen::NoChange);
        seen.bottomRows(own.rows()) = own;
      }
      const Eigen::VectorXd x =
          seen.leftCols(1 + n).colPivHouseholderQr().solve(seen.rightCols(1).col(0));
      for (Eigen::Index block = fold; block < kHeldOutBlocks; block += kHeldOutFolds) {
        const Eigen::MatrixXd& own = raw[static_cast<std::size_t>(block)];
        sum += (own.rightCols(1).col(0) - own.leftCols(1 + n) * x).squaredNorm() /
               static_cast<double>(own.rows());
      }
    }
    return std::sqrt(sum / kHeldOutBlocks);
  }
};

double second_order_force(double l) { return 30 * l + 25 * l * l; }

TEST_CASE("the held-out error is that of blocks which a fit has not seen", "[elastic]") {
  const ByHand data(70, second_order_force, 0.3);
  const BasisChoice choice = choose_terms(data.basis, cable_bases().front());
  REQUIRE(choice.held_out_rms.size() >= 6);
  for (Eigen::Index n = 1; n <= 6; ++n) {
    INFO(n << " terms");
    CHECK_THAT(choice.held_out_rms[static_cast<std::size_t>(n) - 1],
               Catch::WithinRel(data.held_out_rms(n), 1e-7));
  }
}

/// The trap: without a sample in its first columns a block has its factor's rows further down, and
/// with fewer rows than columns they are not the first ones.
TEST_CASE("a factor has all rows of blocks that are short or lack a column", "[elastic]") {
  constexpr Eigen::Index kShort = 3;
  ByHand data(90, second_order_force, 0.3, kShort);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(data.basis.n_columns(), data.basis.n_columns());
  for (std::size_t block = 0; block < data.raw.size(); ++block) {
    data.raw[block].leftCols(static_cast<Eigen::Index>(block % 5)).setZero();
    data.basis.blocks[block] = StreamingQr(data.basis.n_columns());
    data.basis.blocks[block].add(data.raw[block]);
    if (block % kHeldOutFolds != 1) gram += data.raw[block].transpose() * data.raw[block];
  }
  const Eigen::MatrixXd r = factor_without(data.basis.folds(), 1);
  CHECK((r.transpose() * r - gram).norm() < 1e-13 * gram.norm());
}

// At most 5 % false additions, as for orders (order_test.cpp).
TEST_CASE("cross-validation adds no term to a polynomial", "[elastic]") {
  constexpr int kRuns = 200;
  int added = 0, missed = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const ByHand data(4000 + run, second_order_force, 0.3);
    const BasisChoice choice = choose_terms(data.basis, cable_bases().front());
    added += choice.atoms.size() > 2;
    missed += choice.atoms.size() < 2;
  }
  std::printf("  terms of a second-order curve: %d of %d with more, %d with fewer\n", added, kRuns,
              missed);
  CHECK(added <= kRuns / 20);
  CHECK(missed == 0);
}

ElasticPreload high_preload() {
  ElasticOptions options;
  options.bases = true;
  options.order = 2;
  return fit_elastic(std::vector<LogSurvey>{shipped("high/blocked.csv")}, options).preloads.at(0);
}

// The paper's outlook on its own case: with l_o = 0 the curve of the high preload bends where the
// other cable goes slack, which powers of l follow poorly.
TEST_CASE("few terms of another basis halve the error of a polynomial", "[elastic]") {
  const ElasticPreload preload = high_preload();
  REQUIRE(preload.bases.has_value());
  const BasisComparison& bases = *preload.bases;
  REQUIRE(bases.scores.size() == cable_bases().size());
  double best = std::numeric_limits<double>::infinity();
  for (const BasisScore& score : bases.scores) {
    std::printf("  %-12s %2d terms, held out %.4f, polynomial of as many %.4f, least k %.0f\n",
                score.basis.c_str(), score.n_terms, score.held_out_rms,
                bases.polynomial_rms(score.n_terms), score.lowest_secant);
    CHECK(score.held_out_rms > 0.8 * bases.floor);
    if (score.basis == "polynomial") continue;
    best = std::min(best, score.held_out_rms / bases.polynomial_rms(score.n_terms));
  }
  std::printf("  scatter about short lines %.4f\n", bases.floor);
  CHECK(best < 0.5);
  // The noise of the log is 0.3 N m at 500 Hz; a 10 Hz low-pass leaves 0.3 sqrt(10/250) = 0.06.
  CHECK_THAT(bases.floor, Catch::WithinAbs(0.06, 0.012));
  const BasisScore& monotone = bases.scores.back();
  CHECK(monotone.pulls);
  CHECK(monotone.lowest_secant >= 0);
  const std::vector<double>& stiffness = monotone.curve.stiffness;
  CHECK(*std::min_element(stiffness.begin(), stiffness.end()) >= 0);
  // The stiffness of the truth at rest: 3605 N m/rad.
  CHECK_THAT(stiffness[stiffness.size() / 2], Catch::WithinRel(3605.0, 0.05));
}

/// The printed high row of Table 1, K1_0 < 0: no cable pulls like that.
std::string printed_high_row() {
  std::string text = "t,q,theta,tau\n";
  for (int i = 0; i < 8000; ++i) {
    const double x = 4.0 * i / 8000 + 0.5, part = x - std::floor(x);
    const double p = 0.0138 * (2 * part - 1) * (static_cast<int>(x) % 2 == 0 ? 1 : -1);
    const double tau = p > 0 ? p * (-3894.7 + 3891.4 * p) : p * (11171.0 - 3094.9 * p);
    text += fmt::format("{:.2f},0,{:.9f},{:.6f}\n", 0.05 * i, p, tau);
  }
  return text;
}

TEST_CASE("a monotone basis pulls on a curve that pushes", "[elastic]") {
  ElasticOptions options;
  options.bases = true;
  options.order = 2;
  options.offset = 0;
  Bench bench;
  bench.add_text(printed_high_row());
  const BasisComparison bases = *fit_elastic(bench.logs(), options).preloads.at(0).bases;
  CHECK(!bases.scores.front().pulls);
  CHECK_THAT(bases.scores.front().lowest_secant, Catch::WithinRel(-3894.7, 0.01));
  CHECK(bases.scores.back().pulls);
  CHECK(bases.scores.back().lowest_secant >= 0);
}

}  // namespace

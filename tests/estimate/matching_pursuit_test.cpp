// Orthogonal matching pursuit finds planted atoms under noise; with coefficients >= 0 it ends at
// the non-negative least squares solution, whose conditions (Kuhn & Tucker) are checked directly.
#include "cablefit/estimate/solve/matching_pursuit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/columns.hpp"

namespace {

using namespace cablefit;

Eigen::MatrixXd random_dictionary(Eigen::Index rows, Eigen::Index atoms, std::uint64_t seed) {
  test::Normal normal(seed);
  Eigen::MatrixXd dictionary(rows, atoms);
  for (Eigen::Index j = 0; j < atoms; ++j)
    for (Eigen::Index i = 0; i < rows; ++i)
      dictionary(i, j) = normal() * (1 + static_cast<double>(j % 7));  // of different norms
  return dictionary;
}

struct Planted {
  std::vector<Eigen::Index> atoms = {3, 17, 40, 58};
  std::vector<double> x = {5, -4, 3, 2};

  Eigen::VectorXd in(const Eigen::MatrixXd& dictionary) const {
    Eigen::VectorXd y = Eigen::VectorXd::Zero(dictionary.rows());
    for (std::size_t k = 0; k < atoms.size(); ++k) y += x[k] * dictionary.col(atoms[k]);
    return y;
  }
};

TEST_CASE("the pursuit picks the planted atoms from a noisy dictionary", "[estimate]") {
  const Planted planted;
  int found = 0;
  constexpr int kRuns = 200;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const Eigen::MatrixXd dictionary = random_dictionary(200, 60, 900 + run);
    Eigen::VectorXd y = planted.in(dictionary);
    test::Normal normal(7000 + run);
    for (double& value : y) value += 2 * normal();
    const std::vector<SparseFit> path = matching_pursuit(dictionary, y, {.most_terms = 6});
    REQUIRE(path.size() == 6);
    std::vector<Eigen::Index> atoms = path[3].atoms;
    std::sort(atoms.begin(), atoms.end());
    found += atoms == planted.atoms;
    for (std::size_t n = 1; n < path.size(); ++n) CHECK(path[n].rss < path[n - 1].rss);
    // The coefficients are those of least squares on the atoms chosen, found otherwise.
    const Eigen::MatrixXd a = dictionary(Eigen::all, path[3].atoms);
    CHECK((a.transpose() * (y - a * path[3].x)).norm() < 1e-9 * (a.transpose() * y).norm());
  }
  // A wrong atom needs a chance correlation of 60 directions above that of a planted one: sd 2
  // against 2 times a column of norm 14 or more.
  CHECK(found >= kRuns - 2);
}

TEST_CASE("the pursuit ends where nothing is left", "[estimate]") {
  const Planted planted;
  const Eigen::MatrixXd dictionary = random_dictionary(200, 60, 5);
  const std::vector<SparseFit> path =
      matching_pursuit(dictionary, planted.in(dictionary), {.most_terms = 20});
  REQUIRE(path.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto place = std::find(planted.atoms.begin(), planted.atoms.end(), path[3].atoms[k]);
    REQUIRE(place != planted.atoms.end());
    CHECK_THAT(path[3].x(static_cast<Eigen::Index>(k)),
               Catch::WithinRel(planted.x[static_cast<std::size_t>(place - planted.atoms.begin())],
                                1e-10));
  }
  CHECK(matching_pursuit(dictionary, Eigen::VectorXd::Zero(200), {}).empty());
}

TEST_CASE("twins and empty atoms are not chosen beside their like", "[estimate]") {
  Eigen::MatrixXd dictionary = random_dictionary(50, 4, 6);
  dictionary.col(1) = -3 * dictionary.col(0);
  dictionary.col(3).setZero();
  const Eigen::VectorXd y = 2 * dictionary.col(0) + dictionary.col(2);
  Eigen::VectorXd noisy = y;
  test::Normal normal(8);
  for (double& value : noisy) value += 0.1 * normal();
  CHECK(matching_pursuit(dictionary, noisy, {.most_terms = 4}).size() == 2);
}

TEST_CASE("with coefficients >= 0 the pursuit meets the conditions of its optimum", "[estimate]") {
  Eigen::MatrixXd dictionary = random_dictionary(80, 12, 30).cwiseAbs();
  test::Normal normal(31);
  Eigen::VectorXd y = dictionary.col(2) + 2 * dictionary.col(7) - 0.5 * dictionary.col(9);
  for (double& value : y) value += normal();
  const std::vector<SparseFit> path =
      matching_pursuit(dictionary, y, {.most_terms = 12, .non_negative = true});
  REQUIRE(!path.empty());
  const SparseFit& last =
      *std::min_element(path.begin(), path.end(),
                        [](const SparseFit& a, const SparseFit& b) { return a.rss < b.rss; });
  CHECK(last.x.minCoeff() > 0);
  Eigen::VectorXd residual = y;
  for (std::size_t k = 0; k < last.atoms.size(); ++k)
    residual -= last.x(static_cast<Eigen::Index>(k)) * dictionary.col(last.atoms[k]);
  const Eigen::VectorXd gradient = dictionary.transpose() * residual;
  const double scale = (dictionary.transpose() * y).cwiseAbs().maxCoeff();
  CHECK(gradient.maxCoeff() < 1e-9 * scale);  // no atom would come in
  for (const Eigen::Index atom : last.atoms) CHECK(std::abs(gradient(atom)) < 1e-9 * scale);
}

}  // namespace

#include "cablefit/model/cables/bernstein.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit {
namespace {

double binomial(int n, int k) {
  double product = 1;
  for (int i = 1; i <= k; ++i) product = product * (n - k + i) / i;
  return product;
}

}  // namespace

Eigen::MatrixXd bernstein_rows(int degree, double from, double to) {
  Eigen::MatrixXd rows(degree + 1, degree + 1);
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; j <= degree; ++j) {
      // The blossom of l^j: elementary symmetric polynomial e_j of the arguments over its number of
      // terms; m of its factors are `to`.
      double sum = 0;
      for (int m = std::max(0, j - (degree - i)); m <= std::min(i, j); ++m)
        sum +=
            binomial(i, m) * std::pow(to, m) * binomial(degree - i, j - m) * std::pow(from, j - m);
      rows(i, j) = sum / binomial(degree, j);
    }
  return rows;
}

}  // namespace cablefit

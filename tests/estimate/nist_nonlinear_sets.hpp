// NIST Statistical Reference Datasets, nonlinear regression (www.itl.nist.gov/div898/strd): data,
// starts and certified values, in the public domain. Lanczos1 to 3 are a sum of exponentials to
// 13 digits, 6 digits and 4 decimals, and made here. That a fit of a set reproduces its certified
// sd to many digits proves that it was typed in right.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace cablefit::test {

struct NistNonlinearSet {
  std::string name;
  char difficulty;  ///< 'l'ower, 'a'verage, 'h'igher
  std::vector<double> x, y;
  std::vector<std::vector<double>> starts;
  std::vector<double> value, sd;  ///< certified
  double residual_sd;
  /// Of one row: the model's value, and its derivatives into d.
  double (*model)(const double* b, double x, double* d);
};

std::vector<NistNonlinearSet> nist_nonlinear_sets();

}  // namespace cablefit::test

// Stage 1 in an output-error fit: its coefficients are the prior, and the moving logs refine them.
#pragma once

#include <string>
#include <vector>

#include "cablefit/dynamic/output_error/output_error.hpp"
#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

/// Stage 1's coefficients with their robust covariance (Bayes' rule for two experiments: the rows
/// of stage 1 enter as their sufficient statistics). Coefficients that stage 1 has as exact or
/// could not determine are in `held`. A fit without covariance has all of them there.
struct Stage1Prior {
  GaussianPrior prior;
  std::vector<std::string> held;
};
Stage1Prior stage1_prior(const Model& model, const ElasticFit& stage1);

/// `stage1` with the coefficients, sd and covariance of an output-error fit that started from it.
/// `robust`: its robust sd, else the white one.
ElasticFit refined_stage1(const ElasticFit& stage1, const OutputErrorFit& fit, bool robust);

/// Largest change of a coefficient of stage 1 by the moving logs.
struct Stage1Shift {
  std::string name;  ///< of the coefficient with the largest change; empty: none is fitted
  double in_sd = 0;  ///< in sd of stage 1, signed
  double from = 0, to = 0;
};
Stage1Shift largest_shift(const GaussianPrior& prior, const OutputErrorFit& fit);

}  // namespace cablefit

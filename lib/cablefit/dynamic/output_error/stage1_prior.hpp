// Stage 1 in an output-error fit: what it knows goes in, what the moving logs add comes out.
#pragma once

#include <string>
#include <vector>

#include "cablefit/dynamic/output_error/output_error.hpp"
#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit {

/// Stage 1's coefficients with their robust covariance (Bayes' rule for two experiments: the rows
/// of stage 1 enter as their sufficient statistics). Those that stage 1 holds exactly or could not
/// determine are in `held`. Of a fit without covariance all are held.
struct Stage1Prior {
  GaussianPrior prior;
  std::vector<std::string> held;
};
Stage1Prior stage1_prior(const Model& model, const ElasticFit& stage1);

/// `stage1` with the coefficients, sd and covariance of an output-error fit that began with it.
/// `robust`: its sd, else the white one.
ElasticFit refined_stage1(const ElasticFit& stage1, const OutputErrorFit& fit, bool robust);

/// How far the moving logs pull the coefficients away from stage 1.
struct Stage1Shift {
  std::string name;  ///< of the one that is pulled furthest; empty: none is fitted
  double in_sd = 0;  ///< of stage 1, signed
  double from = 0, to = 0;
};
Stage1Shift largest_shift(const GaussianPrior& prior, const OutputErrorFit& fit);

}  // namespace cablefit

// Models of the blocked rows: which columns, under which names, and the solution of one.
#pragma once

#include <string>
#include <vector>

#include "cablefit/elastic/blocked_rows.hpp"
#include "cablefit/elastic/elastic_result.hpp"
#include "cablefit/estimate/least_squares.hpp"

namespace cablefit {

/// What is estimated beside the elastic coefficients.
struct Nuisance {
  bool theta_0 = false;   ///< the encoder zero instead of the drive's offset
  bool branches = false;  ///< f_sm
  bool speed = false;     ///< f_vm, which only keeps it out of f_sm
};

struct Candidate {
  std::string model;  ///< "linear", "poly"
  int order = 1;
  Transmission transmission;  ///< without coefficients
  std::vector<Eigen::Index> regressors;
  std::vector<std::string> names;
  std::vector<double> lower;
  std::vector<std::string> held;  ///< why a coefficient is not estimated; empty: it is
  std::size_t n_elastic = 0;      ///< elastic coefficients come first
};

Candidate linear_candidate(const BlockedRows& rows, const Nuisance& nuisance);
Candidate poly_candidate(const ElasticJob& job, const BlockedRows& rows, int order,
                         const Nuisance& nuisance);
LinearSolution solve_candidate(const BlockedRows& rows, const Candidate& candidate);
/// The candidate's transmission with the solution's coefficients.
Transmission fitted_transmission(const Candidate& candidate, const LinearSolution& solution);

}  // namespace cablefit

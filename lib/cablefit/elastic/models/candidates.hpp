// Models of the blocked rows: which columns, under which names, and the solution of one.
#pragma once

#include <string>
#include <vector>

#include "cablefit/elastic/models/passivity.hpp"
#include "cablefit/elastic/rows/blocked_rows.hpp"
#include "cablefit/estimate/fit/least_squares.hpp"

namespace cablefit {

/// What is estimated beside the elastic coefficients, of one joint.
struct Nuisance {
  bool theta_0 = false;   ///< the encoder zero instead of the drive's offset
  bool branches = false;  ///< f_sm
  bool speed = false;     ///< f_vm, which only keeps it out of f_sm
};

struct ElasticCandidate {
  std::string model;          ///< "linear", "poly"
  int order = 1;              ///< the highest
  Transmission transmission;  ///< without coefficients
  std::vector<Eigen::Index> regressors;
  std::vector<std::string> names;
  std::vector<double> lower;
  std::vector<std::string> held;  ///< why a coefficient is not estimated; empty: it is
  std::size_t n_elastic = 0;      ///< elastic coefficients come first
  PullConstraints pull;           ///< on the elastic coefficients; empty: cables may push
};

/// `nuisance`: one per joint.
ElasticCandidate linear_candidate(const BlockedRows& rows, std::span<const Nuisance> nuisance);
/// `orders`: per cable.
ElasticCandidate poly_candidate(const ElasticJob& job, const BlockedRows& rows,
                                std::span<const int> orders, std::span<const Nuisance> nuisance);

/// candidate.pull with a column per regressor.
Eigen::MatrixXd constraint_rows(const ElasticCandidate& candidate);
/// Whether a cable that may only pull has a negative stiffness. The constraints are slightly
/// stricter, so that a fit without a negative stiffness stays as it is.
bool breaks_constraints(const ElasticCandidate& candidate, const Eigen::VectorXd& x);
/// Plain least squares where every cable only pulls; constrained where a stiffness would be
/// negative.
LinearSolution solve_candidate(const BlockedRows& rows, const ElasticCandidate& candidate);
/// Fills solution.profile where bounds or constraints hold it.
void add_profiles(const BlockedRows& rows, const ElasticCandidate& candidate, bool robust,
                  LinearSolution& solution);
/// With these elastic coefficients, all of the candidate's; the rest is fitted.
LinearSolution solve_given(const BlockedRows& rows, const ElasticCandidate& candidate,
                           std::span<const double> coefficients);
/// Whether cables push or not.
LinearSolution solve_plain(const BlockedRows& rows, const ElasticCandidate& candidate);
/// The candidate's transmission with the coefficients that `x` starts with.
Transmission fitted_transmission(const ElasticCandidate& candidate, const Eigen::VectorXd& x);

}  // namespace cablefit

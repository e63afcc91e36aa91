#include "cablefit/elastic/models/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "cablefit/estimate/fit/profile_interval.hpp"
#include "cablefit/model/model.hpp"

namespace cablefit {
namespace {

constexpr double kTautShare = 0.02;  // of the largest elongation or slack

void add_nuisance(ElasticCandidate& candidate, const BlockedRows& rows, const Nuisance& nuisance,
                  int joint) {
  const BlockedColumns c = rows.columns.of_joint(joint);
  const auto add = [&](Eigen::Index column, const char* name, double lower) {
    candidate.regressors.push_back(column);
    candidate.names.push_back(joint_parameter_name(name, joint + 1, c.n_joints));
    candidate.lower.push_back(lower);
    candidate.held.emplace_back();
  };
  if (nuisance.theta_0 && candidate.model != "linear") {
    add(c.zero, "theta_0", -kUnbounded);
  } else if (nuisance.theta_0 || !rows.offset) {  // of a line, the constant is that of its zero
    add(c.offset, "offset", -kUnbounded);
  }
  if (nuisance.branches) add(c.direction, "f_sm", 0);
  if (nuisance.speed) add(c.speed, "f_vm", -kUnbounded);
}

void add_nuisances(ElasticCandidate& candidate, const BlockedRows& rows,
                   std::span<const Nuisance> nuisance) {
  for (int joint = 0; joint < rows.columns.n_joints; ++joint)
    add_nuisance(candidate, rows, nuisance[static_cast<std::size_t>(joint)], joint);
}

/// Stretched so little, against the way on either side of slack, that its coefficients would be
/// fitted to noise about its slack point.
bool hardly_taut(const ElongationRange& range) { return range.high < kTautShare * range.reach(); }

}  // namespace

ElasticCandidate linear_candidate(const BlockedRows& rows, std::span<const Nuisance> nuisance) {
  ElasticCandidate candidate;
  candidate.model = "linear";
  candidate.transmission = classical_spring(rows.transmission);
  const int n = rows.columns.n_joints;
  for (int joint = 0; joint < n; ++joint) {
    candidate.regressors.push_back(rows.columns.of_joint(joint).deflection);
    candidate.names.push_back(joint_parameter_name("K", joint + 1, n));
  }
  candidate.n_elastic = candidate.regressors.size();
  candidate.lower.assign(candidate.n_elastic, -kUnbounded);
  candidate.held.assign(candidate.n_elastic, "");
  add_nuisances(candidate, rows, nuisance);
  return candidate;
}

ElasticCandidate poly_candidate(const ElasticJob& job, const BlockedRows& rows,
                                std::span<const int> orders, std::span<const Nuisance> nuisance) {
  ElasticCandidate candidate;
  candidate.model = "poly";
  candidate.transmission = with_orders(rows.transmission, orders);
  Eigen::Index first = rows.columns.basis;
  std::vector<bool> fitted;
  for (std::size_t c = 0; c < rows.transmission.cables.size(); ++c) {
    const Cable& cable = candidate.transmission.cables[c];
    candidate.order = std::max(candidate.order, cable.order);
    const std::string held =
        hardly_taut(rows.elongations[c])
            ? fmt::format("cable {} was hardly ever taut in these logs", cable.name)
            : "";
    fitted.push_back(held.empty());
    for (int k = 0; k < cable.n_coefficients(); ++k) {
      candidate.regressors.push_back(first + k);
      candidate.names.push_back(coefficient_name(cable, k, job.rig().cables_given));
      candidate.lower.push_back(-kUnbounded);
      candidate.held.push_back(held);
    }
    first += rows.transmission.cables[c].n_coefficients();
  }
  candidate.n_elastic = candidate.regressors.size();
  add_nuisances(candidate, rows, nuisance);
  if (!job.options.unconstrained)
    candidate.pull = pull_constraints(candidate.transmission, fitted, longest_of(rows.elongations));
  return candidate;
}

Eigen::MatrixXd constraint_rows(const ElasticCandidate& candidate) {
  const Eigen::MatrixXd& pull = candidate.pull.rows;
  Eigen::MatrixXd rows =
      Eigen::MatrixXd::Zero(pull.rows(), static_cast<Eigen::Index>(candidate.regressors.size()));
  rows.leftCols(pull.cols()) = pull;
  return rows;
}

bool breaks_constraints(const ElasticCandidate& candidate, const Eigen::VectorXd& x) {
  if (candidate.pull.ranges.empty()) return false;
  const Transmission fitted = fitted_transmission(candidate, x);
  return std::any_of(candidate.pull.ranges.begin(), candidate.pull.ranges.end(),
                     [&](const PullRange& range) {
                       return find_push(fitted.cables[range.cable], range.longest).has_value();
                     });
}

LinearSolution solve_plain(const BlockedRows& rows, const ElasticCandidate& candidate) {
  return solve(*rows.rows, {candidate.regressors, candidate.names, candidate.lower,
                            rows.torque_response(), candidate.held});
}

LinearSolution solve_candidate(const BlockedRows& rows, const ElasticCandidate& candidate) {
  LinearSolution plain = solve_plain(rows, candidate);
  if (!breaks_constraints(candidate, plain.x)) return plain;
  return solve(*rows.rows, {candidate.regressors, candidate.names, candidate.lower,
                            rows.torque_response(), candidate.held, constraint_rows(candidate)});
}

void add_profiles(const BlockedRows& rows, const ElasticCandidate& candidate, bool robust,
                  LinearSolution& solution) {
  LinearProblem problem{candidate.regressors, candidate.names, candidate.lower,
                        rows.torque_response(), candidate.held};
  if (!solution.active_constraints.empty()) problem.constraints = constraint_rows(candidate);
  solution.profile = profile_intervals(*rows.rows, problem, solution, robust);
}

LinearSolution solve_given(const BlockedRows& rows, const ElasticCandidate& candidate,
                           std::span<const double> coefficients) {
  assert(coefficients.size() == candidate.n_elastic);
  LinearProblem problem{candidate.regressors, candidate.names, candidate.lower,
                        rows.torque_response(), candidate.held};
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    problem.response(candidate.regressors[k]) -= coefficients[k];
    problem.held[k] = "given";
  }
  LinearSolution s = solve(*rows.rows, problem);
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    s.x(static_cast<Eigen::Index>(k)) = coefficients[k];
    s.not_identifiable[k].clear();
  }
  return s;
}

Transmission fitted_transmission(const ElasticCandidate& candidate, const Eigen::VectorXd& x) {
  if (candidate.model != "linear") return with_coefficients(candidate.transmission, x);
  Transmission transmission = candidate.transmission;
  transmission.linear_stiffness = x.head(transmission.n_joints);
  return transmission;
}

}  // namespace cablefit

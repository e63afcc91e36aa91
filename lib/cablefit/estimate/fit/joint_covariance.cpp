#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "cablefit/estimate/fit/joint_least_squares.hpp"
#include "cablefit/estimate/solve/scaled_solve.hpp"
#include "cablefit/estimate/spread/long_run.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kMinCells = 8;  // fewer do not determine a correlation

/// W'rho of a cell of a block.
Eigen::RowVectorXd cell_score(const JointBlock& block, const GramCell& cell,
                              const Eigen::VectorXd& combination) {
  return (block.regressors.transpose() * (cell.gram * combination)).transpose();
}

double variance_of(const JointBlock& block, double rss) {
  return rss / std::max(1.0, static_cast<double>(block.rows->n_rows()));
}

/// (W'W)^-1 of the block alone, 0 where it determines nothing.
Eigen::MatrixXd own_inverse(const JointBlock& block, Eigen::Index& rank) {
  const Eigen::MatrixXd w = block.rows->r() * block.regressors;
  std::vector<Eigen::Index> used;
  for (Eigen::Index k = 0; k < w.cols(); ++k)
    if (w.col(k).norm() > 0) used.push_back(k);
  Eigen::MatrixXd own(std::max<Eigen::Index>(w.rows(), static_cast<Eigen::Index>(used.size())),
                      static_cast<Eigen::Index>(used.size()));
  own.setZero();
  for (std::size_t k = 0; k < used.size(); ++k)
    own.col(static_cast<Eigen::Index>(k)).head(w.rows()) = w.col(used[k]);
  const ScaledSolve solved = solve_scaled(own, Eigen::VectorXd::Zero(own.rows()));
  rank = own.cols() - solved.null_directions.cols();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(w.cols(), w.cols());
  for (std::size_t i = 0; i < used.size(); ++i)
    for (std::size_t j = 0; j < used.size(); ++j)
      inverse(used[i], used[j]) =
          solved.inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return inverse;
}

/// A time cell of a record: its influence on the estimates, and sum of weight w w' over its rows.
struct RecordCell {
  Eigen::RowVectorXd influence;
  Eigen::MatrixXd information;
};

/// By the cell's number.
std::map<Eigen::Index, RecordCell> cells_of(const JointProblem& problem,
                                            const JointSolution& solution, int record) {
  const Eigen::Index p = solution.x.size();
  std::map<Eigen::Index, RecordCell> cells;
  for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
    const JointBlock& block = problem.blocks[b];
    if (block.record != record) continue;
    for (const GramCell& cell : block.rows->cells()) {
      RecordCell& own = cells
                            .try_emplace(cell.id, RecordCell{Eigen::RowVectorXd::Zero(p),
                                                             Eigen::MatrixXd::Zero(p, p)})
                            .first->second;
      own.influence += block.weight * cell_score(block, cell, solution.combinations[b]) *
                       solution.solve_operator;
      own.information +=
          block.weight * (block.regressors.transpose() * cell.gram * block.regressors);
    }
  }
  return cells;
}

Eigen::MatrixXd white_of(const JointProblem& problem, const JointSolution& s, int record) {
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(s.x.size(), s.x.size());
  for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
    const JointBlock& block = problem.blocks[b];
    if (block.record != record) continue;
    const Eigen::MatrixXd w = block.rows->r() * block.regressors;
    middle += block.weight * block.weight * variance_of(block, s.rss[b]) * (w.transpose() * w);
  }
  return s.solve_operator * middle * s.solve_operator;
}

LongRunCovariance robust_of(const JointProblem& problem, const JointSolution& s, int record) {
  const auto cells = cells_of(problem, s, record);
  if (cells.size() < kMinCells) return {white_of(problem, s, record), 1, 1e6};
  const Eigen::Index first = cells.begin()->first, n = cells.rbegin()->first - first + 1;
  Eigen::MatrixXd series = Eigen::MatrixXd::Zero(n, s.x.size());
  std::vector<Eigen::MatrixXd> information(static_cast<std::size_t>(n));
  for (const auto& [id, cell] : cells) {
    series.row(id - first) = cell.influence;
    information[static_cast<std::size_t>(id - first)] = cell.information;
  }
  const FittedOut fitted = fitted_out(information, s.solve_operator);
  return interval_covariance(series, &fitted);
}

/// Never below the white variance, as for one equation (solution_covariance.cpp).
void grow_to(const Eigen::MatrixXd& white, Eigen::MatrixXd& covariance) {
  for (Eigen::Index k = 0; k < white.rows(); ++k) {
    if (covariance(k, k) >= white(k, k)) continue;
    const double grow =
        covariance(k, k) > 0 ? std::sqrt(white(k, k) / covariance(k, k)) : 0;  // a cut-off kernel
    covariance.row(k) *= grow;
    covariance.col(k) *= grow;
    covariance(k, k) = white(k, k);
  }
}

}  // namespace

double residual_inflation(const JointBlock& block, const Eigen::VectorXd& combination) {
  if (block.rows->cells().size() < kMinCells) return 1;
  Eigen::Index rank = 0;
  const Eigen::MatrixXd inverse = own_inverse(block, rank);
  const double rss = (block.rows->r() * combination).squaredNorm();
  if (rank == 0 || !(rss > 0)) return 1;
  const Eigen::MatrixXd influence = series_over_time(
      block.rows->cells(), inverse.cols(), [&](const GramCell& cell) -> Eigen::RowVectorXd {
        return cell_score(block, cell, combination) * inverse;
      });
  const Eigen::MatrixXd robust = long_run_covariance(influence).covariance;
  const double variance = variance_of(block, rss);
  double sum = 0;
  int counted = 0;
  for (Eigen::Index k = 0; k < inverse.rows(); ++k) {
    if (!(inverse(k, k) > 0)) continue;
    sum += robust(k, k) / (variance * inverse(k, k));
    ++counted;
  }
  return std::max(1.0, sum / counted);
}

void reweigh(JointProblem& problem, const JointSolution& solution) {
  for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
    JointBlock& block = problem.blocks[b];
    if (!(solution.rss[b] > 0)) continue;
    block.weight = 1 / (variance_of(block, solution.rss[b]) *
                        residual_inflation(block, solution.combinations[b]));
  }
}

JointCovariance joint_covariance(const JointProblem& problem, const JointSolution& s) {
  const Eigen::Index p = s.x.size();
  std::vector<int> records;
  for (const JointBlock& block : problem.blocks)
    if (std::find(records.begin(), records.end(), block.record) == records.end())
      records.push_back(block.record);
  JointCovariance out{Eigen::MatrixXd::Zero(p, p), Eigen::MatrixXd::Zero(p, p), {}};
  Eigen::VectorXd spread = Eigen::VectorXd::Zero(p);
  for (const int record : records) {
    Eigen::MatrixXd white = white_of(problem, s, record);
    LongRunCovariance robust = robust_of(problem, s, record);
    grow_to(white, robust.covariance);
    out.covariance += robust.covariance;
    out.white += white;
    spread += robust.covariance.diagonal().cwiseAbs2() / robust.degrees_of_freedom;
  }
  const double n = static_cast<double>(s.n_rows);
  const double small_sample = n / std::max(1.0, n - static_cast<double>(s.n_params));
  out.covariance *= small_sample;
  out.white *= small_sample;
  out.degrees_of_freedom = Eigen::VectorXd::Constant(p, std::max(1.0, n));
  for (Eigen::Index k = 0; k < p; ++k)
    if (spread(k) > 0)
      out.degrees_of_freedom(k) =
          std::max(2.0, std::pow(out.covariance(k, k) / small_sample, 2) / spread(k));
  return out;
}

}  // namespace cablefit

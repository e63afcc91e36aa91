#include "cablefit/elastic/checks/misfit.hpp"

#include <algorithm>
#include <cmath>

#include "cablefit/estimate/tests/binned_test.hpp"

namespace cablefit {
namespace {

constexpr double kLevel = 1e-3;
constexpr Eigen::Index kEdgeValues = 20000;

std::vector<double> edges_of(const BlockedRows& rows) {
  const Eigen::Index step = std::max<Eigen::Index>(1, rows.rows->n_rows() / kEdgeValues);
  std::vector<double> values;
  Eigen::Index row = 0;
  rows.archive->for_each([&](const Eigen::MatrixXd& r, std::span<const Eigen::Index>) {
    for (Eigen::Index i = 0; i < r.rows(); ++i, ++row)
      if (row % step == 0) values.push_back(r(i, rows.columns.deflection));
  });
  return bin_edges(std::move(values), kMisfitBins);
}

/// Sums over a bin of deflection, by direction of the motor: down, up.
struct Bin {
  double residual[2] = {0, 0}, n[2] = {0, 0}, deflection = 0;
};

MisfitPoint point_of(const Bin& bin) {
  const double n = bin.n[0] + bin.n[1];
  MisfitPoint point{bin.deflection / n, 0, 0};
  const auto mean = [&](std::size_t way) { return bin.residual[way] / bin.n[way]; };
  if (bin.n[0] > 0 && bin.n[1] > 0) {
    point.torque = (mean(0) + mean(1)) / 2;
    point.half_width = (mean(1) - mean(0)) / 2;
  } else {
    point.torque = mean(bin.n[0] > 0 ? 0 : 1);
  }
  return point;
}

/// Whether the means of the residual, or of the residual times the direction, are more than noise.
bool is_seen(const BinnedTest& test) {
  const BinnedTestResult result = test.of_fitted_rows();
  return result.is_possible && result.p_value < kLevel;
}

}  // namespace

ElasticMisfit find_misfit(const BlockedRows& rows, const ElasticCandidate& candidate,
                          const LinearSolution& solution) {
  const std::vector<double> edges = edges_of(rows);
  if (edges.empty()) return {};
  const std::vector<Eigen::Index>& used = candidate.regressors;
  const auto p = static_cast<Eigen::Index>(used.size());
  Eigen::Index last = 0;
  rows.archive->for_each([&](const Eigen::MatrixXd&, std::span<const Eigen::Index> numbers) {
    if (!numbers.empty()) last = std::max(last, numbers.back());
  });
  const Eigen::Index places = stretch_places(last);
  BinnedTest curve(edges, p, places), loop(edges, p, places);
  std::vector<Bin> bins(edges.size() + 1);
  rows.archive->for_each([&](const Eigen::MatrixXd& r, std::span<const Eigen::Index> numbers) {
    const Eigen::VectorXd residual = r * solution.residual_combination;
    const Eigen::VectorXd direction = r.col(rows.columns.direction);
    const Eigen::MatrixXd regressors = r(Eigen::all, used);
    curve.add(numbers, r.col(rows.columns.deflection), residual, regressors);
    loop.add(numbers, r.col(rows.columns.deflection), residual.cwiseProduct(direction),
             direction.asDiagonal() * regressors);
    for (Eigen::Index i = 0; i < r.rows(); ++i) {
      const double deflection = r(i, rows.columns.deflection);
      Bin& bin = bins[bin_of(deflection, edges)];
      const std::size_t way = direction(i) > 0 ? 1 : 0;
      bin.residual[way] += residual(i);
      bin.n[way] += 1;
      bin.deflection += deflection;
    }
  });
  const bool has_curve = is_seen(curve), has_loop = is_seen(loop);
  ElasticMisfit misfit;
  if (!has_curve && !has_loop) return misfit;
  for (const Bin& bin : bins) {
    if (!(bin.n[0] + bin.n[1] > 0)) continue;
    MisfitPoint point = point_of(bin);
    if (!has_curve) point.torque = 0;
    if (!has_loop) point.half_width = 0;
    misfit.points.push_back(point);
  }
  return misfit;
}

}  // namespace cablefit

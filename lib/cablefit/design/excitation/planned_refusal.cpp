#include "cablefit/design/excitation/planned_refusal.hpp"

#include <cmath>

#include "cablefit/design/excitation/scaled_solver.hpp"

namespace cablefit {
namespace {

// As estimates.cpp of dynamic/ refuses inertias (0.98 and 2/3), with some room.
constexpr double kPositionAlias = 0.95;
constexpr double kShiftRefused = 0.4;
constexpr double kShiftSd = 3;  // of that shift, so that no noise makes it as large

}  // namespace

std::string refusal_of(const Eigen::MatrixXd& rows, const DynamicColumns& c, Eigen::Index own,
                       const Eigen::VectorXd& response, double value, double noise) {
  const std::string& name = c.parameters[static_cast<std::size_t>(own)].name;
  std::vector<Eigen::Index> others, allowed;
  for (Eigen::Index j = 0; j < c.n_effects; ++j) {
    if (j != own) others.push_back(j);
    allowed.push_back(j);
  }
  others.push_back(c.position);
  allowed.push_back(c.position);
  for (std::size_t m = 0; m < c.elastic.size(); ++m)
    for (Eigen::Index j = 0; j < c.n_elastic[m]; ++j) allowed.push_back(c.elastic[m] + j);
  const Eigen::MatrixXd w = rows(Eigen::all, others);
  const ScaledSolver solver(w, kLeastRowsPlanned);
  if (!solver.determined()) return name + " is not determined";
  const Eigen::VectorXd column = rows.col(own);
  const double left = (column - w * solver.solve(column)).squaredNorm();
  if (1 - left / column.squaredNorm() > kPositionAlias)
    return name +
           " is not separable from stiffness: its acceleration follows position, as in one "
           "sine";
  // Cables that are never taut have columns of zeros.
  std::erase_if(allowed, [&](Eigen::Index j) { return rows.col(j).norm() == 0; });
  const Eigen::MatrixXd all = rows(Eigen::all, allowed);
  const ScaledSolver free(all, kLeastRowsPlanned);
  const std::string rests = name + " would depend on stage 1 alone";
  if (!free.determined()) return rests;
  const double alternative = free.solve(rows * response)(own);
  if (kShiftSd * noise * free.unit_sd()(own) > kShiftRefused * value) return rests;
  if (std::abs(alternative - value) > kShiftRefused * value) return rests;
  return "";
}

}  // namespace cablefit

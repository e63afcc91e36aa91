#include "cablefit/dynamic/estimates/joint_estimates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cablefit/dynamic/estimates/estimates.hpp"
#include "cablefit/elastic/estimates/elastic_quantities.hpp"
#include "cablefit/estimate/spread/long_run.hpp"
#include "cablefit/model/stiffness.hpp"

namespace cablefit {
namespace {

/// Sum of stage 1's basis columns that a coefficient multiplies has this sign in the response:
/// dynamic_response().
double sign_of(Side side) { return side == Side::link ? 1 : -1; }

/// All parts' influences side by side, a row for each stretch of time from the first to the last.
Eigen::MatrixXd side_by_side(const std::vector<EquationInfluence>& parts) {
  Eigen::Index columns = 0, from = 0, to = 0;
  for (const EquationInfluence& part : parts) {
    columns += part.influence.cols();
    if (part.cells.empty()) continue;
    from = to == 0 ? part.cells.front() : std::min(from, part.cells.front());
    to = std::max(to, part.cells.back() + 1);
  }
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(to - from, columns);
  Eigen::Index first = 0;
  for (const EquationInfluence& part : parts) {
    for (std::size_t c = 0; c < part.cells.size(); ++c)
      all.block(part.cells[c] - from, first, 1, part.influence.cols()) =
          part.influence.row(static_cast<Eigen::Index>(c));
    first += part.influence.cols();
  }
  return all;
}

/// Correlation of all parts' parameters by what the equations leave; between parts 0 where their
/// stretches of time are not the same.
Eigen::MatrixXd correlation_of(const std::vector<EquationInfluence>& parts) {
  const Eigen::MatrixXd series = side_by_side(parts);
  Eigen::MatrixXd c = interval_covariance(series).covariance;
  const Eigen::VectorXd sd = c.diagonal().cwiseMax(0).cwiseSqrt();
  for (Eigen::Index i = 0; i < c.rows(); ++i)
    for (Eigen::Index j = 0; j < c.cols(); ++j)
      c(i, j) = i == j ? 1 : sd(i) > 0 && sd(j) > 0 ? c(i, j) / (sd(i) * sd(j)) : 0;
  Eigen::Index first = 0;
  for (const EquationInfluence& part : parts) {
    const Eigen::Index n = part.influence.cols();
    if (part.cell_rows != parts.front().cell_rows) {
      const Eigen::MatrixXd own = c.block(first, first, n, n);
      c.middleRows(first, n).setZero();
      c.middleCols(first, n).setZero();
      c.block(first, first, n, n) = own;
    }
    first += n;
  }
  return c;
}

bool is_known(const Estimate* e) {
  return e != nullptr && e->not_identifiable.empty() && e->active_bound.empty() &&
         std::isfinite(e->value) && std::isfinite(e->sd);
}

}  // namespace

EquationInfluence influence_of(const RowStatistics& rows, const DynamicColumns& c,
                               const LinearSolution& s, const ElasticFit* stage1,
                               std::size_t which) {
  EquationInfluence out;
  for (Eigen::Index k = 0; k < c.n_effects; ++k)
    out.names.push_back(c.parameters[static_cast<std::size_t>(k)].name);
  out.cell_rows = rows.cell_rows();
  out.degrees_of_freedom = s.degrees_of_freedom;
  out.influence.resize(static_cast<Eigen::Index>(rows.cells().size()), c.n_effects);
  for (const GramCell& cell : rows.cells()) {
    const Eigen::VectorXd all = cell.gram * s.residual_combination;
    out.influence.row(static_cast<Eigen::Index>(out.cells.size())) =
        (s.solve_operator * (s.score_columns.transpose() * all)).head(c.n_effects);
    out.cells.push_back(cell.id);
  }
  if (stage1 == nullptr || stage1->covariance.rows() != c.n_elastic[which]) return out;
  out.sensitivity = sign_of(c.side) *
                    moved_by(rows, s, c.elastic[which], c.n_elastic[which]).topRows(c.n_effects);
  return out;
}

JointEstimates join_estimates(const DynamicFit& fit, const std::vector<EquationInfluence>& parts,
                              const ElasticFit* stage1) {
  const Eigen::Index n_elastic = stage1 == nullptr ? 0 : stage1->covariance.rows();
  std::vector<std::string> names;
  double dof = kUnbounded;
  for (const EquationInfluence& part : parts) {
    names.insert(names.end(), part.names.begin(), part.names.end());
    dof = std::min(dof, part.degrees_of_freedom);
  }
  const auto n = static_cast<Eigen::Index>(names.size());
  Eigen::MatrixXd sensitivity = Eigen::MatrixXd::Zero(n, n_elastic);
  Eigen::Index first = 0;
  for (const EquationInfluence& part : parts) {
    if (part.sensitivity.cols() == n_elastic)
      sensitivity.middleRows(first, part.sensitivity.rows()) = part.sensitivity;
    first += part.influence.cols();
  }
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n_elastic + n, n_elastic + n);
  Eigen::VectorXd value(n_elastic + n);
  JointEstimates all;
  if (n_elastic > 0) {
    covariance.topLeftCorner(n_elastic, n_elastic) = stage1->covariance;
    covariance.bottomLeftCorner(n, n_elastic) = sensitivity * stage1->covariance;
    covariance.topRightCorner(n_elastic, n) = stage1->covariance * sensitivity.transpose();
  }
  const Eigen::MatrixXd carried =
      n_elastic > 0 ? Eigen::MatrixXd(sensitivity * covariance.topRightCorner(n_elastic, n))
                    : Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd own(n);  // sd of what the equations themselves leave
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < n_elastic; ++k) {
    const Estimate& e = stage1->parameters[static_cast<std::size_t>(k)];
    all.names.push_back(e.name);
    value(k) = e.value;
    kept.push_back(k);
  }
  for (Eigen::Index k = 0; k < n; ++k) {
    const Estimate* e = find_estimate(fit.parameters, names[static_cast<std::size_t>(k)]);
    const bool known = is_known(e);
    own(k) = known ? std::sqrt(std::max(0.0, e->sd * e->sd - carried(k, k))) : 0;
    value(n_elastic + k) = known ? e->value : 0;
    if (!known) continue;
    all.names.push_back(e->name);
    kept.push_back(n_elastic + k);
  }
  covariance.bottomRightCorner(n, n) =
      Eigen::MatrixXd(own.asDiagonal() * correlation_of(parts) * own.asDiagonal()) + carried;
  all.value = value(kept);
  all.covariance = covariance(kept, kept);
  all.degrees_of_freedom = dof;
  return all;
}

std::vector<Estimate> drive_quantities(const JointEstimates& from, const Transmission* transmission,
                                       bool cable_space, Axes axes) {
  std::vector<Estimate> all;
  const Eigen::Index j_link = from.find("J_link"), j_motor = from.find("J_motor"),
                     f_v = from.find("f_v"), f_vm = from.find("f_vm"), f_s = from.find("f_s"),
                     f_sm = from.find("f_sm");
  if (transmission == nullptr || transmission->n_joints > 1) return all;
  const TransmissionOf changed = transmission_of(*transmission, cable_space, from);
  const auto stiffness = [changed](const Eigen::VectorXd& v) { return rest_stiffness(changed(v)); };
  all.push_back(derive({"K_rest", "K_rest", unit_for(axes, "N m/rad"), stiffness}, from));
  if (j_link >= 0 && j_motor >= 0)
    all.push_back(derive({"f_0", "f_0", "Hz",
                          [=](const Eigen::VectorXd& v) {
                            return free_resonance(stiffness(v), v(j_motor), v(j_link));
                          }},
                         from));
  if (j_link >= 0 && j_motor >= 0 && f_v >= 0 && f_vm >= 0)
    all.push_back(derive({"zeta", "zeta", "1",
                          [=](const Eigen::VectorXd& v) {
                            // The mode moves q and theta as 1/J_link and -1/J_motor.
                            const double a = 1 / v(j_link), b = 1 / v(j_motor);
                            const double rate = (v(f_v) * a * a + v(f_vm) * b * b) / (a + b);
                            return rate / (4 * std::numbers::pi *
                                           free_resonance(stiffness(v), v(j_motor), v(j_link)));
                          }},
                         from));
  if (f_s >= 0 && f_sm >= 0)
    all.push_back(derive({"f_dry", "f_s + f_sm", torque_unit(axes),
                          [=](const Eigen::VectorXd& v) { return v(f_s) + v(f_sm); }},
                         from));
  std::erase_if(all, [](const Estimate& e) {
    return !std::isfinite(e.value) || !std::isfinite(e.sd) || !(e.sd > 0);
  });
  return all;
}

}  // namespace cablefit

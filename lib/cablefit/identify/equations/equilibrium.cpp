#include "cablefit/identify/equations/equilibrium.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "cablefit/estimate/solve/constrained_least_squares.hpp"

namespace cablefit {
namespace {

constexpr double kBalanced = 1e-11;  // of pulleys of unit radius: rounding

using Values = std::array<double, kMaxCableOrder>;

void add_force(const Cable& cable, double gain, double l, Eigen::Index first,
               Eigen::Ref<Eigen::RowVectorXd> row) {
  Values values{};
  cable.law->basis(cable.shape(), l, values.data());
  for (int k = 0; k < cable.n_coefficients(); ++k)
    row(first + k) += gain * values[static_cast<std::size_t>(k)];
}

/// d force / d l_o, of cables about to be taut from above.
double slope_at(const Cable& cable, double l, const Eigen::VectorXd& coefficients,
                Eigen::Index first) {
  Values values{};
  cable.law->slope(cable.shape(), std::max(l, std::numeric_limits<double>::min()), values.data());
  double slope = 0;
  for (int k = 0; k < cable.n_coefficients(); ++k)
    slope += values[static_cast<std::size_t>(k)] * coefficients(first + k);
  return slope;
}

/// Columns of the coupling of some cables, each row of unit norm.
Eigen::MatrixXd pulls_of(const Transmission& transmission, const std::vector<Eigen::Index>& which) {
  Eigen::MatrixXd pulls = reference_coupling(transmission)(Eigen::all, which);
  for (Eigen::Index i = 0; i < pulls.rows(); ++i)
    if (pulls.row(i).norm() > 0) pulls.row(i).normalize();
  return pulls;
}

}  // namespace

Eigen::MatrixXd reference_coupling(const Transmission& transmission) {
  const Eigen::Index n = transmission.n_joints;
  Eigen::MatrixXd coupling(2 * n, static_cast<Eigen::Index>(transmission.cables.size()));
  for (std::size_t c = 0; c < transmission.cables.size(); ++c) {
    const auto at = static_cast<Eigen::Index>(c);
    coupling.col(at).head(n) = transmission.cables[c].motor_radii(transmission.reference_theta());
    coupling.col(at).tail(n) = transmission.cables[c].link_radii(transmission.reference_q());
  }
  return coupling;
}

Eigen::MatrixXd equilibrium_rows(const PreloadJob& job, int place, const Eigen::VectorXd& l_o,
                                 const JointLayout& layout,
                                 const std::optional<Eigen::VectorXd>& coefficients) {
  const Eigen::Index n_params =
      coefficients ? static_cast<Eigen::Index>(layout.parameters.size()) : layout.n_linear;
  const bool speaks = (l_o.array() > 0).any() || (l_o.array() >= 0).all();
  const Eigen::MatrixXd coupling = reference_coupling(job.transmission);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(speaks ? coupling.rows() : 0, n_params);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(n_params);
    Eigen::Index first = 0;
    for (std::size_t c = 0; c < job.transmission.cables.size(); ++c) {
      const Cable& cable = job.transmission.cables[c];
      const auto at = static_cast<Eigen::Index>(c);
      const double gain = coupling(i, at);
      if (l_o(at) > 0) add_force(cable, gain, l_o(at), first, row);
      const Eigen::Index column = layout.find(elongation_name(cable), place);
      if (coefficients && column >= 0 && l_o(at) >= 0)
        row(column) += gain * slope_at(cable, l_o(at), *coefficients, first);
      first += cable.n_coefficients();
    }
    rows.row(i) = row;
  }
  return rows;
}

bool can_balance(const Transmission& transmission, const Eigen::VectorXd& l_o) {
  std::vector<Eigen::Index> taut;
  for (Eigen::Index c = 0; c < l_o.size(); ++c)
    if (l_o(c) > 0) taut.push_back(c);
  if (taut.empty()) return true;
  const Eigen::MatrixXd pulls = pulls_of(transmission, taut);
  // Forces of any positive size: 1 + u with u >= 0, up to a factor.
  const Eigen::VectorXd ones = pulls.rowwise().sum();
  const Eigen::VectorXd more = non_negative_least_squares(pulls, -ones);
  return (ones + pulls * more).norm() < kBalanced;
}

std::vector<bool> balanced_cables(const Transmission& transmission, const Eigen::VectorXd& l_o) {
  std::vector<Eigen::Index> taut;
  for (Eigen::Index c = 0; c < l_o.size(); ++c)
    if (l_o(c) > 0) taut.push_back(c);
  std::vector<bool> balanced(static_cast<std::size_t>(l_o.size()), false);
  if (taut.empty()) return balanced;
  const Eigen::MatrixXd pulls = pulls_of(transmission, taut);
  for (std::size_t k = 0; k < taut.size(); ++k) {
    const Eigen::VectorXd own = pulls.col(static_cast<Eigen::Index>(k));
    const Eigen::VectorXd others = non_negative_least_squares(pulls, -own);
    balanced[static_cast<std::size_t>(taut[k])] = (own + pulls * others).norm() < kBalanced;
  }
  return balanced;
}

std::vector<std::vector<std::size_t>> cable_groups(const Transmission& transmission) {
  const auto n_joints = static_cast<std::size_t>(transmission.n_joints);
  std::vector<std::size_t> group(n_joints);  // of each joint, by the first joint of the group
  for (std::size_t k = 0; k < n_joints; ++k) group[k] = k;
  const auto first_joint = [&](const Cable& cable) {
    std::size_t k = 0;
    while (k + 1 < n_joints && !cable.passes(k)) ++k;
    return k;
  };
  for (const Cable& cable : transmission.cables)
    for (std::size_t k = 0; k < n_joints; ++k)
      if (cable.passes(k)) {
        const std::size_t from = std::max(group[k], group[first_joint(cable)]);
        const std::size_t to = std::min(group[k], group[first_joint(cable)]);
        std::replace(group.begin(), group.end(), from, to);
      }
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t first = 0; first < n_joints; ++first) {
    std::vector<std::size_t> cables;
    for (std::size_t c = 0; c < transmission.cables.size(); ++c)
      if (group[first_joint(transmission.cables[c])] == first) cables.push_back(c);
    if (!cables.empty()) groups.push_back(std::move(cables));
  }
  return groups;
}

}  // namespace cablefit

#include "cablefit/identify/equations/equilibrium.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "cablefit/estimate/solve/constrained_least_squares.hpp"

namespace cablefit {
namespace {

constexpr double kBalanced = 1e-11;  // of pulleys of unit radius: rounding

using Values = std::array<double, kMaxCableOrder>;

Eigen::VectorXd reference_gain(const Transmission& transmission, bool motor_side) {
  Eigen::VectorXd gain(static_cast<Eigen::Index>(transmission.cables.size()));
  for (std::size_t c = 0; c < transmission.cables.size(); ++c)
    gain(static_cast<Eigen::Index>(c)) =
        motor_side ? transmission.cables[c].motor_radii(transmission.reference_theta())(0)
                   : transmission.cables[c].link_radii(transmission.reference_q())(0);
  return gain;
}

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

}  // namespace

Eigen::MatrixXd equilibrium_rows(const PreloadJob& job, int place, const Eigen::VectorXd& l_o,
                                 const JointLayout& layout,
                                 const std::optional<Eigen::VectorXd>& coefficients) {
  const Eigen::Index n_params =
      coefficients ? static_cast<Eigen::Index>(layout.parameters.size()) : layout.n_linear;
  const bool speaks = (l_o.array() > 0).any() || (l_o.array() >= 0).all();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(speaks ? 2 : 0, n_params);
  for (Eigen::Index side = 0; side < rows.rows(); ++side) {
    const Eigen::VectorXd gain = reference_gain(job.transmission, side == 0);
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(n_params);
    Eigen::Index first = 0;
    for (std::size_t c = 0; c < job.transmission.cables.size(); ++c) {
      const Cable& cable = job.transmission.cables[c];
      const auto at = static_cast<Eigen::Index>(c);
      if (l_o(at) > 0) add_force(cable, gain(at), l_o(at), first, row);
      const Eigen::Index column = layout.find(elongation_name(cable), place);
      if (coefficients && column >= 0 && l_o(at) >= 0)
        row(column) += gain(at) * slope_at(cable, l_o(at), *coefficients, first);
      first += cable.n_coefficients();
    }
    rows.row(side) = row;
  }
  return rows;
}

bool can_balance(const Transmission& transmission, const Eigen::VectorXd& l_o) {
  std::vector<Eigen::Index> taut;
  for (Eigen::Index c = 0; c < l_o.size(); ++c)
    if (l_o(c) > 0) taut.push_back(c);
  if (taut.empty()) return true;
  Eigen::MatrixXd gain(2, l_o.size());
  gain << reference_gain(transmission, true).transpose(),
      reference_gain(transmission, false).transpose();
  Eigen::MatrixXd pulls = gain(Eigen::all, taut);
  for (Eigen::Index i = 0; i < 2; ++i)
    if (pulls.row(i).norm() > 0) pulls.row(i).normalize();
  // Forces of any positive size: 1 + u with u >= 0, up to a factor.
  const Eigen::VectorXd ones = pulls.rowwise().sum();
  const Eigen::VectorXd more = non_negative_least_squares(pulls, -ones);
  return (ones + pulls * more).norm() < kBalanced;
}

}  // namespace cablefit

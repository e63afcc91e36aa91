#include "cablefit/design/curves/equilibrium_preload.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/base/root.hpp"
#include "cablefit/estimate/solve/constrained_least_squares.hpp"
#include "cablefit/model/modes.hpp"

namespace cablefit {
namespace {

constexpr double kNoForce = 1e-9;  // of the largest tension: no tension at all
constexpr double kLongest = 1000;  // m; no cable comes near

/// Rows of S, then of P, in the reference pose: (8c) is this times f_o = 0.
Eigen::MatrixXd couplings(const Transmission& transmission) {
  const auto n = static_cast<Eigen::Index>(transmission.n_joints);
  Eigen::MatrixXd both(2 * n, static_cast<Eigen::Index>(transmission.cables.size()));
  both.topRows(n) =
      transmission.motor_coupling(transmission.reference_theta() + transmission.encoder_zero());
  both.bottomRows(n) = transmission.link_coupling(transmission.reference_q());
  return both;
}

/// Columns: orthonormal directions of tensions in equilibrium.
Eigen::MatrixXd balanced_directions(const Eigen::MatrixXd& couplings) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(couplings, Eigen::ComputeFullV);
  return svd.matrixV().rightCols(couplings.cols() - svd.rank());
}

/// The part of `f` that is in equilibrium.
Eigen::VectorXd projected(const Eigen::MatrixXd& couplings, const Eigen::VectorXd& f) {
  const Eigen::MatrixXd basis = balanced_directions(couplings);
  return basis * (basis.transpose() * f);
}

Eigen::VectorXd tensions_at_rest(const Transmission& transmission) {
  return transmission.tensions(transmission.reference_q(),
                               transmission.reference_theta() + transmission.encoder_zero());
}

bool all_pull(const Eigen::VectorXd& f) {
  return f.size() > 0 && f.minCoeff() > kNoForce * f.cwiseAbs().maxCoeff();
}

double elongation_with(const Cable& cable, double force) {
  if (!(force > 0)) return 0;
  const auto l = root_outward([&](double at) { return cable.force(at) - force; }, 1e-9, kLongest);
  if (l) return *l;
  throw Error(
      ErrorKind::input,
      fmt::format("cable {} does not reach a force of {:.3g} N; give it coefficients that grow "
                  "with its elongation",
                  in_quotes(cable.name), force));
}

}  // namespace

Eigen::VectorXd balanced_tensions(const Transmission& transmission) {
  const Eigen::MatrixXd both = couplings(transmission);
  Eigen::VectorXd f = projected(both, tensions_at_rest(transmission));
  if (!all_pull(f)) f = projected(both, Eigen::VectorXd::Ones(both.cols()));
  if (!all_pull(f))
    throw Error(ErrorKind::input,
                "no tensions of these cables are in equilibrium, (8c): they cannot be "
                "preloaded; route them so that each joint is pulled in both directions (n "
                "joints need n + 1 cables or more), or check the signs of the radii");
  return f / f.maxCoeff();
}

Transmission with_preload(const Transmission& transmission, double l_o) {
  const Eigen::VectorXd direction = balanced_tensions(transmission);
  Transmission preloaded = transmission;
  const double scale = preloaded.cables.front().force(l_o) / direction(0);
  if (l_o > 0 && !(scale > 0))
    throw Error(ErrorKind::input,
                fmt::format("cable {} does not pull when it is stretched by {:g}; a preload needs "
                            "coefficients above 0",
                            in_quotes(preloaded.cables.front().name), l_o));
  for (std::size_t k = 0; k < preloaded.cables.size(); ++k)
    preloaded.cables[k].initial_elongation =
        k == 0
            ? l_o
            : elongation_with(preloaded.cables[k], scale * direction(static_cast<Eigen::Index>(k)));
  return preloaded;
}

Transmission with_nearest_balance(const Transmission& transmission) {
  const Eigen::VectorXd now = tensions_at_rest(transmission);
  const Eigen::MatrixXd basis = balanced_directions(couplings(transmission));
  Eigen::VectorXd f = Eigen::VectorXd::Zero(now.size());
  if (basis.cols() > 0) f = basis * constrained_least_squares(basis, now, basis).x;
  Transmission balanced = transmission;
  for (std::size_t k = 0; k < balanced.cables.size(); ++k) {
    Cable& cable = balanced.cables[k];
    const double force = f(static_cast<Eigen::Index>(k));
    if (force > kNoForce * now.maxCoeff()) {
      cable.initial_elongation = elongation_with(cable, force);
    } else {
      cable.initial_elongation = std::min(cable.initial_elongation, 0.0);
    }
  }
  return balanced;
}

Transmission with_radii(const Transmission& transmission, double factor) {
  // A map times a factor: every kind is linear in its coefficients, or in its displacements.
  const auto scale = [factor](std::vector<DisplacementMap>& maps) {
    for (DisplacementMap& map : maps)
      for (std::vector<double>* values :
           {&map.parameters.coefficients, &map.parameters.displacement, &map.parameters.curvature})
        for (double& value : *values) value *= factor;
  };
  const auto scale_pairs = [factor](std::vector<PairMap>& maps) {
    for (PairMap& map : maps) map = cablefit::scaled(std::move(map), factor);
  };
  Transmission scaled = transmission;
  for (Cable& cable : scaled.cables) {
    scale(cable.motor_map);
    scale(cable.link_map);
    scale_pairs(cable.motor_pairs);
    scale_pairs(cable.link_pairs);
    cable.reference_displacement *= factor;
  }
  return scaled;
}

}  // namespace cablefit

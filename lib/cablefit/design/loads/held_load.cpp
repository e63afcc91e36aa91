#include "cablefit/design/loads/held_load.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "cablefit/base/error.hpp"

namespace cablefit {
namespace {

constexpr int kNewtonSteps = 400;
constexpr int kHalvings = 60;
constexpr double kBalance = 1e-10;   // of the torques: in equilibrium
constexpr double kSoft = 1e-9;       // of the stiffest direction: no cable holds it
constexpr double kRounding = 1e-14;  // of the terms of the potential
constexpr double kDecrease = 1e-4;   // of the predicted one (Armijo 1966)
constexpr double kHair = 1e-9;       // m (rad): just taut

/// The cables as they are, or as if slack ones could push.
struct CablesAt {
  const Transmission& transmission;
  Eigen::VectorXd theta;
  bool can_push;

  double slope(const Cable& cable, double l) const {
    return l > 0 || !can_push ? cable.stiffness(l) : cable.stiffness(kHair);
  }
  double force(const Cable& cable, double l) const {
    return l > 0 || !can_push ? cable.force(l) : cable.stiffness(kHair) * l;
  }
  double energy(const Cable& cable, double l) const {
    return l > 0 || !can_push ? cable.energy(l) : cable.stiffness(kHair) * l * l / 2;
  }
  template <typename Number>
  Eigen::VectorXd of_each(const Eigen::VectorXd& l, Number number) const {
    Eigen::VectorXd all(l.size());
    for (Eigen::Index i = 0; i < l.size(); ++i)
      all(i) = number(transmission.cables[static_cast<std::size_t>(i)], l(i));
    return all;
  }
};

double potential(const CablesAt& at, const Eigen::VectorXd& q, const Eigen::VectorXd& load) {
  const Eigen::VectorXd l = at.transmission.elongations(q, at.theta);
  return at.of_each(l, [&](const Cable& c, double x) { return at.energy(c, x); }).sum() -
         load.dot(q);
}

/// Torques that are not balanced, and the second derivatives of the potential.
struct Slope {
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
  double torques = 0;   ///< N m, sum of all that act: what rounding is a share of
  double stiffest = 0;  ///< N m/rad, of any joint with all cables just taut
};

Slope slope_of(const CablesAt& at, const Eigen::VectorXd& q, const Eigen::VectorXd& load) {
  const Eigen::VectorXd l = at.transmission.elongations(q, at.theta);
  const Eigen::MatrixXd p = at.transmission.link_coupling(q);
  const Eigen::VectorXd f = at.of_each(l, [&](const Cable& c, double x) { return at.force(c, x); });
  const Eigen::VectorXd k = at.of_each(l, [&](const Cable& c, double x) { return at.slope(c, x); });
  const Eigen::VectorXd taut =
      at.of_each(l, [](const Cable& c, double x) { return c.stiffness(std::max(x, kHair)); });
  Slope slope{-(p * f) - load, p * k.asDiagonal() * p.transpose(),
              (p.cwiseAbs() * f.cwiseAbs() + load.cwiseAbs()).maxCoeff(),
              (p.cwiseAbs2() * taut).maxCoeff()};
  const auto angle = [&](std::size_t joint) { return q(static_cast<Eigen::Index>(joint)); };
  for (Eigen::Index i = 0; i < f.size(); ++i)
    at.transmission.cables[static_cast<std::size_t>(i)].link_side().add_slopes(angle, -f(i),
                                                                               slope.hessian);
  return slope;
}

/// Where no cable holds the link, it moves as far as the stiffest direction would.
Eigen::VectorXd newton_step(const Slope& slope) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(slope.hessian);
  const double stiffest = slope.stiffest > 0 ? slope.stiffest : 1;
  Eigen::VectorXd lambda = eigen.eigenvalues();
  for (double& value : lambda)
    if (value < kSoft * stiffest) value = stiffest;
  return -(eigen.eigenvectors() *
           (eigen.eigenvectors().transpose() * slope.gradient).cwiseQuotient(lambda));
}

/// The step, halved until the potential falls; false: it does not, or what the step promises is
/// below the rounding of the potential.
bool descend(const CablesAt& at, const Slope& slope, const Eigen::VectorXd& load,
             Eigen::VectorXd& q) {
  Eigen::VectorXd step = newton_step(slope);
  const double before = potential(at, q, load);
  const double terms = std::abs(before) + 2 * std::abs(load.dot(q));
  if (-slope.gradient.dot(step) <= kRounding * terms) return false;
  for (int i = 0; i < kHalvings; ++i, step /= 2)
    if (potential(at, q + step, load) <= before + kDecrease * slope.gradient.dot(step)) {
      q += step;
      return true;
    }
  return false;
}

/// From the reference pose; false: the cables do not hold the load.
bool find_equilibrium(const CablesAt& at, const Eigen::VectorXd& load, Eigen::VectorXd& q) {
  q = at.transmission.reference_q();
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Slope slope = slope_of(at, q, load);
    if (slope.gradient.cwiseAbs().maxCoeff() <= kBalance * slope.torques) return true;
    if (descend(at, slope, load, q)) continue;
    q += newton_step(slope);  // beyond the last bits of the potential
    break;
  }
  const Slope last = slope_of(at, q, load);
  return last.gradient.cwiseAbs().maxCoeff() <= 1e3 * kBalance * last.torques;
}

Eigen::VectorXd equilibrium(const Transmission& transmission, const Eigen::VectorXd& load,
                            bool can_push) {
  const CablesAt at{transmission, transmission.reference_theta() + transmission.encoder_zero(),
                    can_push};
  Eigen::VectorXd q;
  if (find_equilibrium(at, load, q)) return q;
  std::string loads;
  for (const double torque : load)
    loads += fmt::format("{}{:g}", loads.empty() ? "" : ", ", torque);
  throw Error(ErrorKind::input,
              fmt::format("the cables do not hold a load of {}; give a smaller one, or cables that "
                          "pull against it",
                          loads));
}

/// -N (q - q without load) per joint.
Eigen::VectorXd deflection_from(const Transmission& transmission, const Eigen::VectorXd& rest,
                                const Eigen::VectorXd& q) {
  return -transmission.reductions().cwiseProduct(q - rest);
}

}  // namespace

HeldLoad hold_load(const Transmission& transmission, const Eigen::VectorXd& load) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(load.size());
  HeldLoad held;
  for (const Cable& cable : transmission.cables)
    held.initial_elongations.push_back(cable.initial_elongation);
  held.l_o = held.initial_elongations.front();
  held.load = load;
  held.q = equilibrium(transmission, load, false);
  held.deflection = deflection_from(transmission, equilibrium(transmission, none, false), held.q);
  held.without_slack = deflection_from(transmission, equilibrium(transmission, none, true),
                                       equilibrium(transmission, load, true));
  const Eigen::VectorXd theta = transmission.reference_theta() + transmission.encoder_zero();
  held.elongation = transmission.elongations(held.q, theta);
  held.tension = transmission.tensions(held.q, theta);
  return held;
}

double HeldLoad::slack_share() const {
  const double all = deflection.norm();
  return all > 0 ? std::max(0.0, 1 - without_slack.norm() / all) : 0;
}

}  // namespace cablefit

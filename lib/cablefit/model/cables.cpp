#include "cablefit/model/cables.hpp"

#include <fmt/core.h>

#include <array>
#include <cassert>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/model/cables/laws.hpp"

namespace cablefit {
namespace {

const std::vector<CableLaw>& table() {
  static const std::vector<CableLaw> kRows{laws::linear(), laws::polynomial()};
  return kRows;
}

/// sum_j coefficient_j values_j, with values from the law's basis or slope; 0 when slack.
double combine(const Cable& cable, double l, void (*values_of)(int, double, double*)) {
  if (!(l > 0)) return 0.0;
  std::array<double, kMaxCableOrder> values{};
  assert(cable.coefficients.size() == static_cast<std::size_t>(cable.n_coefficients()));
  values_of(cable.order, l, values.data());
  double sum = 0.0;
  for (std::size_t j = 0; j < cable.coefficients.size(); ++j) {
    sum += cable.coefficients[j] * values[j];
  }
  return sum;
}

Cable joint_space_cable(int number, int order, int joint, int n_joints) {
  Cable cable;
  cable.name = std::to_string(number);
  cable.law = &find_cable_law("polynomial");
  cable.order = order;
  cable.motor_radius = Eigen::VectorXd::Zero(n_joints);
  cable.motor_radius[joint] = number % 2 == 1 ? 1.0 : -1.0;
  cable.link_radius = cable.motor_radius;
  return cable;
}

}  // namespace

std::span<const CableLaw> cable_laws() { return table(); }

const CableLaw& find_cable_law(std::string_view name) {
  std::vector<std::string_view> known;
  for (const CableLaw& law : cable_laws()) {
    if (law.name == name) return law;
    known.push_back(law.name);
  }
  throw input_error({}, fmt::format("unknown cable law '{}'", name), suggestion(name, known));
}

double Cable::force(double l) const { return combine(*this, l, law->basis); }

double Cable::stiffness(double l) const { return combine(*this, l, law->slope); }

double Cable::secant(double l) const { return l > 0 ? force(l) / l : 0.0; }

std::string coefficient_name(const Cable& cable, int index, bool cable_space) {
  return cable_space ? fmt::format("k[{}]_{}", cable.name, index)
                     : fmt::format("K{}_{}", cable.name, index);
}

std::string coefficient_unit(int index, bool cable_space) {
  const std::string unit = cable_space ? "N/m" : "N m/rad";
  return index == 0 ? unit : fmt::format("{}^{}", unit, index + 1);
}

std::string elongation_name(const Cable& cable) { return fmt::format("l_o[{}]", cable.name); }

std::string_view elongation_unit(bool cable_space) { return cable_space ? "m" : "rad"; }

Eigen::VectorXd Transmission::encoder_zero() const {
  return theta_0.size() > 0 ? theta_0 : Eigen::VectorXd::Zero(n_joints);
}

Eigen::VectorXd Transmission::elongations(const Eigen::VectorXd& q,
                                          const Eigen::VectorXd& theta) const {
  Eigen::VectorXd l(static_cast<Eigen::Index>(cables.size()));
  for (Eigen::Index i = 0; i < l.size(); ++i) {
    const Cable& cable = cables[static_cast<std::size_t>(i)];
    l[i] = cable.motor_radius.dot(theta - encoder_zero()) - cable.link_radius.dot(q) +
           cable.initial_elongation;
  }
  return l;
}

void Transmission::torques(const Eigen::VectorXd& q, const Eigen::VectorXd& theta,
                           Eigen::VectorXd& link, Eigen::VectorXd& motor) const {
  if (cables.empty()) {
    link = linear_stiffness.cwiseProduct(theta - encoder_zero() - q);
    motor = link;
    return;
  }
  const Eigen::VectorXd l = elongations(q, theta);
  link.setZero(n_joints);
  motor.setZero(n_joints);
  for (Eigen::Index i = 0; i < l.size(); ++i) {
    const Cable& cable = cables[static_cast<std::size_t>(i)];
    const double f = cable.force(l[i]);
    link += f * cable.link_radius;
    motor += f * cable.motor_radius;
  }
}

Transmission antagonist_pairs(int n_joints, int order) {
  Transmission transmission;
  transmission.n_joints = n_joints;
  transmission.theta_0 = Eigen::VectorXd::Zero(n_joints);
  for (int joint = 0; joint < n_joints; ++joint) {
    for (int side = 1; side <= 2; ++side) {
      transmission.cables.push_back(joint_space_cable(2 * joint + side, order, joint, n_joints));
    }
  }
  return transmission;
}

Transmission antagonist_pair(int order) { return antagonist_pairs(1, order); }

}  // namespace cablefit

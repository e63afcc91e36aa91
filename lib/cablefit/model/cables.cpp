#include "cablefit/model/cables.hpp"

#include <fmt/core.h>

#include <array>
#include <cassert>

#include "cablefit/base/catalog.hpp"
#include "cablefit/model/cables/laws.hpp"

namespace cablefit {
namespace {

const std::vector<CableLaw>& cable_law_rows() {
  static const std::vector<CableLaw> kRows{laws::linear(), laws::polynomial(), laws::strand(),
                                           laws::spline()};
  return kRows;
}

/// sum_j coefficient_j values_j, with values from the law's basis, slope or energy; 0 when slack.
double combine(const Cable& cable, double l, void (*values_of)(const LawShape&, double, double*)) {
  if (!(l > 0)) return 0.0;
  std::array<double, kMaxCableOrder> values{};
  assert(cable.coefficients.size() == static_cast<std::size_t>(cable.n_coefficients()));
  values_of(cable.shape(), l, values.data());
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
  Eigen::VectorXd radius = Eigen::VectorXd::Zero(n_joints);
  radius[joint] = number % 2 == 1 ? 1.0 : -1.0;
  cable.motor_map = cable.link_map = round_pulleys(radius);
  return cable;
}

auto of(const Eigen::VectorXd& angle) {
  return [&angle](std::size_t k) { return angle[static_cast<Eigen::Index>(k)]; };
}

Eigen::VectorXd radii(const SideMaps& side, const Eigen::VectorXd& angle) {
  return Eigen::VectorXd::NullaryExpr(angle.size(), [&](Eigen::Index k) {
    return side.radius(static_cast<std::size_t>(k), of(angle));
  });
}

/// `value(cable)` of every cable.
template <typename Value>
Eigen::VectorXd per_cable(const std::vector<Cable>& cables, Value value) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(cables.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values[i] = value(cables[static_cast<std::size_t>(i)]);
  }
  return values;
}

/// Column i: `column(cable i)`.
template <typename Column>
Eigen::MatrixXd columns_of(const Transmission& transmission, Column column) {
  const auto n_cables = static_cast<Eigen::Index>(transmission.cables.size());
  Eigen::MatrixXd matrix(transmission.n_joints, n_cables);
  for (Eigen::Index i = 0; i < n_cables; ++i) {
    matrix.col(i) = column(transmission.cables[static_cast<std::size_t>(i)]);
  }
  return matrix;
}

/// phi of every joint.
Eigen::VectorXd spring_deflections(const Transmission& spring, const Eigen::VectorXd& q,
                                   const Eigen::VectorXd& theta) {
  Eigen::VectorXd phi(spring.n_joints);
  for (int joint = 0; joint < spring.n_joints; ++joint)
    phi(joint) = spring.deflections(joint, q.segment<1>(joint), theta.segment<1>(joint))(0);
  return phi;
}

Eigen::VectorXd or_zero(const Eigen::VectorXd& values, int n) {
  return values.size() > 0 ? values : Eigen::VectorXd::Zero(n);
}

}  // namespace

std::span<const CableLaw> cable_laws() { return cable_law_rows(); }

const CableLaw& find_cable_law(std::string_view name) {
  return find_row(cable_laws(), "cable law", name);
}

double Cable::elongation(const Eigen::VectorXd& q, const Eigen::VectorXd& theta) const {
  assert(motor_map.size() == static_cast<std::size_t>(theta.size()) && q.size() == theta.size());
  return motor_side().displacement(of(theta)) - link_side().displacement(of(q)) + shift();
}

Eigen::VectorXd Cable::motor_radii(const Eigen::VectorXd& theta) const {
  assert(motor_map.size() == static_cast<std::size_t>(theta.size()));
  return radii(motor_side(), theta);
}

Eigen::VectorXd Cable::link_radii(const Eigen::VectorXd& q) const {
  assert(link_map.size() == static_cast<std::size_t>(q.size()));
  return radii(link_side(), q);
}

double Cable::force(double l) const { return combine(*this, l, law->basis); }

double Cable::stiffness(double l) const { return combine(*this, l, law->slope); }

double Cable::energy(double l) const { return combine(*this, l, law->energy); }

double Cable::secant(double l) const { return l > 0 ? force(l) / l : 0.0; }

std::string coefficient_name(const Cable& cable, int index, bool cable_space) {
  return cable_space ? fmt::format("k[{}]_{}", cable.name, index)
                     : fmt::format("K{}_{}", cable.name, index);
}

std::string coefficient_unit(const CableLaw& law, int index, bool cable_space) {
  const std::string unit = cable_space ? "N/m" : "N m/rad";
  const int power = law.length_power(index);
  return power == 1 ? unit : fmt::format("{}^{}", unit, power);
}

std::string elongation_name(const Cable& cable) { return fmt::format("l_o[{}]", cable.name); }

std::string_view elongation_unit(bool cable_space) { return cable_space ? "m" : "rad"; }

Eigen::VectorXd Transmission::encoder_zero() const { return or_zero(theta_0, n_joints); }

Eigen::VectorXd Transmission::reference_q() const { return or_zero(reference.q, n_joints); }

Eigen::VectorXd Transmission::reference_theta() const { return or_zero(reference.theta, n_joints); }

Eigen::VectorXd Transmission::reductions() const {
  if (cables.empty())
    return linear_reduction.size() > 0 ? linear_reduction : Eigen::VectorXd::Ones(n_joints);
  const Eigen::MatrixXd p = link_coupling(reference_q());
  const Eigen::MatrixXd s = motor_coupling(reference_theta() + encoder_zero());
  const Eigen::ArrayXd products = s.cwiseProduct(p).rowwise().sum();
  const Eigen::ArrayXd squares = s.cwiseAbs2().rowwise().sum();
  return (products != 0).select(products / squares, 1.0);
}

Eigen::ArrayXd Transmission::deflections(int joint, const Eigen::Ref<const Eigen::ArrayXd>& q,
                                         const Eigen::Ref<const Eigen::ArrayXd>& theta) const {
  return theta - (encoder_zero()(joint) + reference_theta()(joint)) -
         reductions()(joint) * (q - reference_q()(joint));
}

Eigen::VectorXd Transmission::elongations(const Eigen::VectorXd& q,
                                          const Eigen::VectorXd& theta) const {
  const Eigen::VectorXd turned = theta - encoder_zero();
  return per_cable(cables, [&](const Cable& cable) { return cable.elongation(q, turned); });
}

Eigen::VectorXd Transmission::tensions(const Eigen::VectorXd& q,
                                       const Eigen::VectorXd& theta) const {
  const Eigen::VectorXd turned = theta - encoder_zero();
  return per_cable(cables,
                   [&](const Cable& cable) { return cable.force(cable.elongation(q, turned)); });
}

Eigen::MatrixXd Transmission::link_coupling(const Eigen::VectorXd& q) const {
  return columns_of(*this, [&](const Cable& cable) { return cable.link_radii(q); });
}

Eigen::MatrixXd Transmission::motor_coupling(const Eigen::VectorXd& theta) const {
  const Eigen::VectorXd turned = theta - encoder_zero();
  return columns_of(*this, [&](const Cable& cable) { return cable.motor_radii(turned); });
}

void Transmission::torques(const Eigen::VectorXd& q, const Eigen::VectorXd& theta,
                           Eigen::VectorXd& link, Eigen::VectorXd& motor) const {
  if (cables.empty()) {
    motor = linear_stiffness.cwiseProduct(spring_deflections(*this, q, theta));
    link = reductions().cwiseProduct(motor);
    return;
  }
  const Eigen::VectorXd f = tensions(q, theta);
  link = link_coupling(q) * f;
  motor = motor_coupling(theta) * f;
}

double Transmission::energy(const Eigen::VectorXd& q, const Eigen::VectorXd& theta) const {
  const Eigen::VectorXd turned = theta - encoder_zero();
  if (cables.empty()) {
    return 0.5 * linear_stiffness.dot(spring_deflections(*this, q, theta).cwiseAbs2());
  }
  return per_cable(cables,
                   [&](const Cable& cable) { return cable.energy(cable.elongation(q, turned)); })
      .sum();
}

Transmission classical_spring(const Transmission& cables) {
  Transmission spring = cables;
  spring.cables.clear();
  spring.linear_stiffness = Eigen::VectorXd::Zero(cables.n_joints);
  spring.linear_reduction = cables.reductions();
  return spring;
}

Transmission with_coefficients(Transmission transmission, const Eigen::VectorXd& x) {
  Eigen::Index next = 0;
  for (Cable& cable : transmission.cables) {
    cable.coefficients.assign(static_cast<std::size_t>(cable.n_coefficients()), 0.0);
    for (double& coefficient : cable.coefficients) coefficient = x(next++);
  }
  return transmission;
}

void set_reference(Transmission& transmission, const ReferencePose& pose) {
  transmission.reference = pose;
  const Eigen::VectorXd q = transmission.reference_q(), theta = transmission.reference_theta();
  for (Cable& cable : transmission.cables) {
    cable.reference_displacement =
        cable.motor_side().displacement(of(theta)) - cable.link_side().displacement(of(q));
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

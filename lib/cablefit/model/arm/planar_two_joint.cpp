// Two links in one plane. Link j has in its own frame (x along the link, origin on axis j) the
// first moments MX_j, MY_j, and about axis j the inertia ZZ_j; M2 is the mass of link 2. From
// Lagrange's equations with B = MX2 cos q2 - MY2 sin q2:
//   tau_1 = (ZZ1 + M2 L1^2) q1dd + ZZ2 (q1dd + q2dd) + L1 B (2 q1dd + q2dd)
//           + L1 dB/dq2 q2d (2 q1d + q2d) + g1
//   tau_2 = ZZ2 (q1dd + q2dd) + L1 B q1dd - L1 dB/dq2 q1d^2 + g2
//   U = gravity ((MX1 + M2 L1) sin q1 + MY1 cos q1 + MX2 sin(q1 + q2) + MY2 cos(q1 + q2)), g =
//   dU/dq
#include <cmath>

#include "cablefit/model/arm/kinds.hpp"
#include "cablefit/model/json_reading.hpp"

namespace cablefit::arms {
namespace {

/// Columns, in this order; the last two only where gravity acts.
enum Column : Eigen::Index { kZZ1, kZZ2, kMX2, kMY2, kMX1, kMY1 };

ArmParameters read(const JsonNode& node, const RigJoints& joints) {
  node.allow_only({"type", "length_1", "gravity", "horizontal"});
  if (joints.count != 2)
    throw node.at("type").error("a planar_two_joint arm on a rig of another number of joints",
                                "list two joints");
  ArmParameters parameters;
  parameters.length_1 = node.at("length_1").positive();
  parameters.gravity = number_or(node, "gravity", 0);
  parameters.horizontal = number_or(node, "horizontal", 0);
  return parameters;
}

std::vector<ArmEntry> entries(const ArmParameters& p) {
  return {{"length_1", p.length_1}, {"gravity", p.gravity}, {"horizontal", p.horizontal}};
}

std::vector<ParameterInfo> base_parameters(const ArmParameters& p) {
  std::vector<ParameterInfo> all = {{"ZZ1+M2*L1^2", "ZZ1+M2*L1^2", "kg m^2",
                                     "inertia about axis 1, link 2 as a mass on axis 2", 0},
                                    {"ZZ2", "ZZ2", "kg m^2", "inertia of link 2 about axis 2", 0},
                                    {"MX2", "MX2", "kg m", "first moment of link 2 along it"},
                                    {"MY2", "MY2", "kg m", "first moment of link 2 across it"}};
  if (p.gravity == 0) return all;
  all.push_back(
      {"MX1+M2*L1", "MX1+M2*L1", "kg m", "first moment of link 1 and of M2 along link 1"});
  all.push_back({"MY1", "MY1", "kg m", "first moment of link 1 across it"});
  return all;
}

void gravity_of_link_2(const ArmParameters& p, const Eigen::ArrayXd& angle,
                       Eigen::Ref<Eigen::MatrixXd> out) {
  out.col(kMX2).array() += p.gravity * angle.cos();
  out.col(kMY2).array() -= p.gravity * angle.sin();
}

void regressor(const ArmParameters& p, std::span<const Motion> links, int joint,
               Eigen::Ref<Eigen::MatrixXd> out) {
  const auto& v1 = links[0].velocity;
  const auto& v2 = links[1].velocity;
  const auto& a1 = links[0].acceleration;
  const Eigen::ArrayXd both = a1 + links[1].acceleration;
  const Eigen::ArrayXd cosine = links[1].position.cos(), sine = links[1].position.sin();
  // What multiplies B and dB/dq2 in this joint's equation.
  Eigen::ArrayXd by_b, by_slope;
  if (joint == 0) {
    by_b = p.length_1 * (a1 + both);
    by_slope = p.length_1 * v2 * (2 * v1 + v2);
  } else {
    by_b = p.length_1 * a1;
    by_slope = -p.length_1 * v1.square();
  }
  out.col(kZZ1).setZero();
  if (joint == 0) out.col(kZZ1) = a1;
  out.col(kZZ2) = both;
  out.col(kMX2) = by_b * cosine - by_slope * sine;
  out.col(kMY2) = -by_b * sine - by_slope * cosine;
  if (p.gravity == 0) return;
  const Eigen::ArrayXd first = links[0].position - p.horizontal;
  gravity_of_link_2(p, first + links[1].position, out);
  out.middleCols(kMX1, 2).setZero();
  if (joint != 0) return;
  out.col(kMX1) = p.gravity * first.cos();
  out.col(kMY1) = -p.gravity * first.sin();
}

/// In the plane of x and y, about z; of the masses only M2 has to do with torques, and the base
/// parameters hold it.
SerialChain chain(const ArmParameters& p, std::span<const double> base) {
  using enum LinkParameter;
  SerialChain chain;
  chain.joints.resize(2);
  chain.joints[1].origin = {p.length_1, 0, 0};
  chain.rig_joint = {0, 1};
  chain.gravity = {p.gravity * std::sin(p.horizontal), -p.gravity * std::cos(p.horizontal), 0};
  const auto put = [&](std::size_t link, LinkParameter which, Column column) {
    const auto k = static_cast<std::size_t>(column);
    if (k < base.size()) chain.joints[link].inertia(static_cast<Eigen::Index>(which)) = base[k];
  };
  put(0, ZZ, kZZ1);
  put(0, MX, kMX1);
  put(0, MY, kMY1);
  put(1, ZZ, kZZ2);
  put(1, MX, kMX2);
  put(1, MY, kMY2);
  return chain;
}

}  // namespace

ArmKind planar_two_joint() {
  return {.name = "planar_two_joint",
          .equation = "M(q) qdd + C(q, qd) + g(q) of two links in one plane, by base parameters",
          .source = "Khalil & Dombre 2004, ch. 9 (base parameters of a planar arm)",
          .read = read,
          .entries = entries,
          .base_parameters = base_parameters,
          .regressor = regressor,
          .chain = chain};
}

}  // namespace cablefit::arms

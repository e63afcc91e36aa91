// Torques that cables can make: closed forms, and brute force for a finger of
// three joints.
#include "cablefit/design/loads/torque_polytope.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "cablefit/design/curves/equilibrium_preload.hpp"
#include "tests/truth/parts.hpp"

namespace {

using namespace cablefit;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

constexpr double kExact = 1e-10;

/// Cables with these link radii, joints x cables; motors the same.
Transmission routed(const Eigen::MatrixXd& radii) {
  Transmission t;
  t.n_joints = static_cast<int>(radii.rows());
  t.linear_stiffness = Eigen::VectorXd::Zero(radii.rows());
  for (Eigen::Index i = 0; i < radii.cols(); ++i) {
    Cable cable = antagonist_pair(1).cables.front();
    cable.name = std::to_string(i + 1);
    cable.coefficients = {1e5};
    cable.motor_map = cable.link_map = round_pulleys(radii.col(i));
    t.cables.push_back(cable);
  }
  return t;
}

TorquePolytope polytope_of(const Eigen::MatrixXd& radii, double tension) {
  const Transmission t = routed(radii);
  return torque_polytope(t, "at rest", t.reference_q(), tension);
}

// Radii 0.05 and -0.04 m, up to 100 N: from -4 to 5 N m.
TEST_CASE("one joint of two cables has an interval of torques", "[design]") {
  Eigen::MatrixXd radii(1, 2);
  radii << 0.05, -0.04;
  const TorquePolytope p = polytope_of(radii, 100);
  CHECK(p.closure);
  CHECK(p.cone.cols() == 0);
  CHECK_THAT(p.largest(0, 1), WithinRel(5.0, kExact));
  CHECK_THAT(p.largest(0, -1), WithinRel(4.0, kExact));
  CHECK_THAT(p.largest_alone(0, -1), WithinRel(4.0, kExact));
  REQUIRE(p.vertices.cols() == 2);
  CHECK_THAT(p.vertices.minCoeff(), WithinRel(-4.0, kExact));
  radii << 0.05, 0.04;  // both pull one way
  const TorquePolytope one_way = polytope_of(radii, 100);
  CHECK_FALSE(one_way.closure);
  CHECK(one_way.cone.cols() == 1);
  CHECK(one_way.cone(0, 0) == -1);
}

// Columns (1, 0), (-1, 0), (1, 1), (-1, -1): the sum of segments from (-1, 0)
// to (1, 0) and from
// (-1, -1) to (1, 1): corners +-(2, 1) and +-(0, 1).
TEST_CASE("two joints of four cables have a parallelogram of torques", "[design]") {
  Eigen::MatrixXd radii(2, 4);
  radii << 1, -1, 1, -1, 0, 0, 1, -1;
  const TorquePolytope p = polytope_of(radii, 1);
  CHECK(p.closure);
  REQUIRE(p.vertices.cols() == 4);
  for (const Eigen::Vector2d& corner : {Eigen::Vector2d(2, 1), Eigen::Vector2d(0, 1),
                                        Eigen::Vector2d(-2, -1), Eigen::Vector2d(0, -1)}) {
    const double nearest =
        (p.vertices.colwise() - Eigen::VectorXd(corner)).colwise().norm().minCoeff();
    CHECK_THAT(nearest, WithinAbs(0, kExact));
  }
  CHECK_THAT(p.largest(0, 1), WithinRel(2.0, kExact));
  CHECK_THAT(p.largest_alone(0, 1), WithinRel(1.0, kExact));
  CHECK_THAT(p.largest(1, -1), WithinRel(1.0, kExact));
  CHECK_THAT(p.largest_alone(1, -1), WithinRel(1.0, kExact));
}

// Three cables in the plane, the third within the half plane of the others: a
// wedge.
TEST_CASE("cables without closure span a cone", "[design]") {
  Eigen::MatrixXd radii(2, 3);
  radii << 1, 0, 1, 0, 1, 1;
  const TorquePolytope p = polytope_of(radii, 1);
  CHECK_FALSE(p.closure);
  REQUIRE(p.cone.cols() == 2);
  CHECK_THAT((p.cone.transpose() * Eigen::Vector2d(1, 0)).minCoeff(), WithinAbs(-1, kExact));
  CHECK_THAT((p.cone.transpose() * Eigen::Vector2d(0, 1)).minCoeff(), WithinAbs(-1, kExact));
  CHECK_THAT(p.largest_alone(0, 1), WithinRel(1.0, kExact));
  CHECK_THAT(p.largest_alone(0, -1), WithinAbs(0, kExact));
}

// 20,000 random tensions within 0 .. 50 N lie below the support of 200
// directions; that of all 16 corners of the box of tensions is the support
// itself, and the vertices give the same.
TEST_CASE("the support of a finger of three joints is that of its tensions", "[design]") {
  Eigen::MatrixXd radii(3, 4);
  radii << 0.010, -0.012, 0.009, -0.011, 0.008, -0.007, -0.010, 0.004, 0.005, -0.003, 0.002, -0.006;
  const double tension = 50;
  const TorquePolytope p = polytope_of(radii, tension);
  truth::Random random = truth::stream(3, 1);
  Eigen::MatrixXd inside(3, 20000), corners(3, 16);
  for (auto torque : inside.colwise()) {
    Eigen::Vector4d f;
    for (double& one : f) one = tension * random.uniform();
    torque = radii * f;
  }
  for (int k = 0; k < 16; ++k)
    corners.col(k) = radii * Eigen::Vector4d(k & 1, (k >> 1) & 1, (k >> 2) & 1, k >> 3) * tension;
  for (int k = 0; k < 200; ++k) {
    Eigen::VectorXd d(3);
    for (double& one : d) one = random.normal();
    const double support = p.support(d);
    CHECK((d.transpose() * inside).maxCoeff() <= support * (1 + 1e-12));
    CHECK_THAT((d.transpose() * corners).maxCoeff(), WithinRel(support, kExact));
    CHECK_THAT((d.transpose() * p.vertices).maxCoeff(), WithinRel(support, kExact));
  }
  // Four generators in general position in space: 2 (C(3,0) + C(3,1) + C(3,2))
  // = 14 vertices.
  CHECK(p.vertices.cols() == 14);
  CHECK(p.normals.cols() == 12);
  // Alone: no torque beyond is made by any combination, and that one is on the
  // boundary.
  for (int joint = 0; joint < 3; ++joint)
    for (const int direction : {1, -1}) {
      const double alone = p.largest_alone(joint, direction);
      CHECK(alone <= p.largest(joint, direction) * (1 + 1e-12));
      const Eigen::VectorXd torque = direction * alone * Eigen::VectorXd::Unit(3, joint);
      double closest = 1e9;
      for (const auto& normal : p.normals.colwise()) {
        const Eigen::VectorXd d = normal;
        closest = std::min(closest, p.support(d) - d.dot(torque));
      }
      CHECK_THAT(closest, WithinAbs(0, 1e-9));
    }
}

// Equal linear cables k = 1e5 N/m on 50 mm, l_o = 2 mm: slack at 2 k r l_o = 20
// N m.
TEST_CASE("the first cable goes slack where the closed form says", "[design]") {
  Eigen::MatrixXd radii(1, 2);
  radii << 0.05, -0.05;
  const Transmission t = with_preload(routed(radii), 0.002);
  for (const double sign : {1.0, -1.0}) {
    const auto order = slack_order(t, Eigen::VectorXd::Constant(1, sign), 100);
    REQUIRE(order.size() == 1);
    CHECK(order[0].cable == (sign > 0 ? "1" : "2"));
    CHECK_THAT(order[0].load, WithinRel(20.0, 1e-7));
  }
}

}  // namespace

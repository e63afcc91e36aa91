// The sd of a design's numbers against closed forms.
#include <cmath>

#include "cablefit/design/curves/equilibrium_preload.hpp"
#include "cablefit/design/design_sweep.hpp"
#include "tests/conformance/transmissions.hpp"
#include "tests/simulate/benches.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;
using Catch::Matchers::WithinRel;

constexpr double kFirst = 1400, kSecond = 1600;  // N m/rad
constexpr double kSdFirst = 3, kSdSecond = 2, kCorrelation = 0.4;
constexpr double kPreload = 0.01;  // rad, l_o of the first cable

/// Two straight cables around one joint, friction at the motor and the link.
Model straight_cables() {
  Model model = spring_joint({0.3, 5, 3}, {0.01, 1, 2, 0}, 0);
  model.transmission = antagonist_pair(1);
  model.transmission.cables[0].coefficients = {kFirst};
  model.transmission.cables[1].coefficients = {kSecond};
  const double both = kCorrelation * kSdFirst * kSdSecond;
  model.covariance.parameters = {"K1_0", "K2_0"};
  model.covariance.matrix.resize(2, 2);
  model.covariance.matrix << kSdFirst * kSdFirst, both, both, kSdSecond * kSdSecond;
  return model;
}

DesignJoint design_at(const Model& model, double l_o) {
  DesignOptions options;
  options.torque = 10;
  options.l_o = {l_o};
  return sweep_design(model, options).points.at(0).joints.at(0);
}

TEST_CASE("a stiffness is as sure as the sum of its cables", "[design]") {
  const DesignJoint joint = design_at(straight_cables(), kPreload);
  REQUIRE(joint.sd);
  CHECK_THAT(joint.stiffness_zero, WithinRel(kFirst + kSecond, 1e-9));
  const double sd = std::sqrt(kSdFirst * kSdFirst + kSdSecond * kSdSecond +
                              2 * kCorrelation * kSdFirst * kSdSecond);
  CHECK_THAT(joint.sd->stiffness_zero, WithinRel(sd, 1e-6));
  CHECK_THAT(joint.sd->stiffness_high, WithinRel(sd, 1e-6));
}

TEST_CASE("a closure torque is as sure as the cables that make it", "[design]") {
  // The second cable is slack from phi = l_o2 = (K1 / K2) l_o1 on, the first from -l_o1: the least
  // torque is that of the smaller deflection, (K1 + K2) (K1 / K2) l_o1 (K1 < K2).
  const DesignJoint joint = design_at(straight_cables(), kPreload);
  CHECK_THAT(joint.closure_torque,
             WithinRel((kFirst + kSecond) * kFirst / kSecond * kPreload, 1e-9));
  const double by_first = (2 * kFirst + kSecond) / kSecond * kPreload;
  const double by_second = -kFirst * kFirst / (kSecond * kSecond) * kPreload;
  const double sd =
      std::sqrt(std::pow(by_first * kSdFirst, 2) + std::pow(by_second * kSdSecond, 2) +
                2 * kCorrelation * by_first * kSdFirst * by_second * kSdSecond);
  // Differences over an sd, 0.2 % of the stiffness, of a quadratic in it.
  REQUIRE(joint.sd);
  CHECK_THAT(joint.sd->closure_torque, WithinRel(sd, 0.005));
}

TEST_CASE("an efficiency that friction alone makes is as sure as friction", "[design]") {
  Model model = straight_cables();
  model.covariance.parameters = {"f_s"};
  model.covariance.matrix = Eigen::MatrixXd::Constant(1, 1, 0.01 * 0.01);
  model.transmission = with_preload(model.transmission, kPreload);  // where f_s was fitted
  const DesignJoint joint = design_at(model, kPreload);
  REQUIRE(joint.sd);
  // tau / (tau + f), tau = 10, f = 5
  CHECK_THAT(joint.sd->efficiency_driving, WithinRel(10.0 / (15 * 15) * 0.01, 0.001));
  CHECK(joint.sd->stiffness_zero == 0);
}

TEST_CASE("a model without a covariance says nothing of how sure it is", "[design]") {
  Model model = straight_cables();
  model.covariance = {};
  CHECK_FALSE(design_at(model, kPreload).sd);
}

}  // namespace

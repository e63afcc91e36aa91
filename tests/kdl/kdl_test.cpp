// Serial arms against numbers that KDL computed by its recursive Newton-Euler algorithm.
#include <Eigen/SVD>
#include <catch2/catch.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>

#include "cablefit/model/arm/arm_dynamics.hpp"
#include "cablefit/model/arm/serial_arm.hpp"
#include "cablefit/model/rig.hpp"
#include "tests/kdl/urdf_chain_of_kdl.hpp"
#include "tests/support/plain_arm.hpp"
#include "tests/support/serial_states.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit::test {
namespace {

KDL::JntArray joints_of(const Eigen::VectorXd& v) {
  KDL::JntArray array;
  array.data = v;
  return array;
}

Eigen::VectorXd kdl_torques(const KDL::Chain& chain, const Eigen::Vector3d& g,
                            const SerialState& at) {
  KDL::ChainIdSolver_RNE solver(chain, KDL::Vector(g(0), g(1), g(2)));
  KDL::JntArray torques(chain.getNrOfJoints());
  const KDL::Wrenches none(chain.getNrOfSegments(), KDL::Wrench::Zero());
  REQUIRE(solver.CartToJnt(joints_of(at.q), joints_of(at.qd), joints_of(at.qdd), none, torques) ==
          0);
  return torques.data;
}

Rig rig_of(const std::string& urdf, int n_joints, const std::string& more,
           const std::string& motion = "\"rotary\"") {
  const TempFolder folder;
  folder.write("arm.urdf", urdf);
  std::string joints = "{\"name\": \"1\"}";
  for (int j = 2; j <= n_joints; ++j) joints += fmt::format(", {{\"name\": \"{}\"}}", j);
  return read_rig(folder.write(
      "rig.json", fmt::format("{{\"joints\": [{}], \"motion\": {}, \"arm\": {{\"type\": \"urdf\", "
                              "\"file\": \"arm.urdf\"{}}}}}",
                              joints, motion, more)));
}

/// As the simulator has them.
Eigen::VectorXd simulated_torques(ArmDynamics& arm, const SerialState& at) {
  arm.evaluate(at.q.data(), at.qd.data());
  const Eigen::Index n = at.q.size();
  return Eigen::Map<const Eigen::MatrixXd>(arm.mass(), n, n) * at.qdd +
         Eigen::Map<const Eigen::VectorXd>(arm.bias(), n);
}

void compare(const KDL::Chain& chain, const Rig& rig) {
  const SerialArm& arm = *rig.arm.parameters.serial;
  const std::vector<double> described = rig.arm.described();
  const Eigen::VectorXd base = Eigen::Map<const Eigen::VectorXd>(
      described.data(), static_cast<Eigen::Index>(described.size()));
  ArmDynamics dynamics = arm_dynamics(rig.arm, described);
  SerialStates states(rig.n_joints(), 21);
  for (int trial = 0; trial < 50; ++trial) {
    const SerialState at = states.next();
    const Eigen::VectorXd torque = serial_torques(arm, base, at.q, at.qd, at.qdd);
    const Eigen::VectorXd expected = kdl_torques(chain, arm.chain.gravity, at);
    // Rounding of torques up to 1e3 N m, through factors known to 1e-12.
    CHECK((torque - expected).cwiseAbs().maxCoeff() < 1e-9);
    CHECK((simulated_torques(dynamics, at) - expected).cwiseAbs().maxCoeff() < 1e-9);
  }
}

TEST_CASE("torques are KDL's: seven joints") {
  const std::string urdf = urdf_text(seven_joints(), "seven");
  compare(kdl_chain(urdf, "base", "link7"), rig_of(urdf, 7, ""));
}

TEST_CASE("torques are KDL's: skew axes, links on fixed joints") {
  // Without the camera: KDL's chain leaves out what hangs beside it.
  std::string urdf = content_of(std::string(CABLEFIT_SOURCE) + "/tests/model/skew.urdf");
  const std::string camera =
      "<mass value=\"0.15\"/> <inertia ixx=\"3e-5\" ixy=\"0\" ixz=\"0\" "
      "iyy=\"3e-5\" iyz=\"0\" izz=\"3e-5\"/>";
  const auto at = urdf.find(camera);
  REQUIRE(at != std::string::npos);
  urdf.replace(at, camera.size(),
               "<mass value=\"0\"/> <inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\" "
               "izz=\"0\"/>");
  compare(kdl_chain(urdf, "world", "hand"), rig_of(urdf, 2, R"(, "gravity": [1, -2, 9])"));
  compare(kdl_chain(urdf, "table", "hand"), rig_of(urdf, 2, R"(, "base": "table")"));
}

TEST_CASE("torques are KDL's: joints that turn and joints that slide") {
  std::string urdf = urdf_text(seven_joints(), "seven");
  for (const std::string joint : {"\"joint1\"", "\"joint3\"", "\"joint6\""}) {
    const auto at = urdf.find("revolute", urdf.find(joint));
    urdf.replace(at, std::string("revolute").size(), "prismatic");
  }
  compare(kdl_chain(urdf, "base", "link7"),
          rig_of(urdf, 7, R"(, "gravity": [1, -2, 9])",
                 R"(["linear", "rotary", "linear", "rotary", "rotary", "linear", "rotary"])"));
}

TEST_CASE("torques are KDL's: sliding joints") {
  std::string urdf = content_of(std::string(CABLEFIT_SOURCE) + "/tests/model/skew.urdf");
  for (const std::string turning : {"\"continuous\"", "\"revolute\""})
    urdf.replace(urdf.find(turning), turning.size(), "\"prismatic\"");
  const KDL::Chain chain = kdl_chain(urdf, "world", "hand");
  const TempFolder folder;
  folder.write("arm.urdf", urdf);
  const Rig rig = read_rig(
      folder.write("rig.json", R"({"motion": "linear", "joints": [{"name": "1"}, {"name": "2"}],
                      "arm": {"type": "urdf", "file": "arm.urdf", "gravity": [1, -2, 9]}})"));
  // KDL leaves the camera out; it rides on link 1.
  const SerialArm& arm = *rig.arm.parameters.serial;
  std::vector<double> described = rig.arm.described();
  described[0] -= 0.15;
  const Eigen::VectorXd base = Eigen::Map<const Eigen::VectorXd>(described.data(), 2);
  ArmDynamics dynamics = arm_dynamics(rig.arm, described);
  SerialStates states(2, 22);
  for (int trial = 0; trial < 20; ++trial) {
    const SerialState at = states.next();
    CHECK((simulated_torques(dynamics, at) - kdl_torques(chain, arm.chain.gravity, at))
              .cwiseAbs()
              .maxCoeff() < 1e-9);
    CHECK(
        (serial_torques(arm, base, at.q, at.qd, at.qdd) - kdl_torques(chain, arm.chain.gravity, at))
            .cwiseAbs()
            .maxCoeff() < 1e-9);
  }
}

// The number of base parameters is the number of torque histories that arms of one kinematics can
// have: the rank of KDL's torques over more random inertias than there can be.
TEST_CASE("the rank is that of KDL's torques") {
  SerialStates random(10, 23);
  constexpr int kSamples = 30, kArms = 75;
  Eigen::MatrixXd histories(7 * kSamples, kArms);
  for (int k = 0; k < kArms; ++k) {
    PlainArm arm = seven_joints();
    for (PlainLink& link : arm.links) {
      const SerialState draw = random.next();
      link.mass = 1.5 + draw.q(0) / M_PI;
      link.centre = 0.05 * draw.q.segment<3>(1);
      const Eigen::Matrix3d root = 0.02 * Eigen::Map<const Eigen::Matrix3d>(draw.qd.data());
      link.inertia = root * root.transpose();
    }
    const KDL::Chain chain = kdl_chain(urdf_text(arm, "seven"), "base", "link7");
    SerialStates states(7, 24);  // the same motions for all
    for (int i = 0; i < kSamples; ++i)
      histories.col(k).segment<7>(7 * i) = kdl_torques(chain, arm.gravity, states.next());
  }
  const Eigen::VectorXd values = histories.colwise().normalized().jacobiSvd().singularValues();
  CHECK(values(42) > 1e-6 * values(0));
  CHECK(values(43) < 1e-12 * values(0));
}

}  // namespace
}  // namespace cablefit::test

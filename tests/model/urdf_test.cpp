// Arms from URDF files: what is read, and what is refused in which words. What a build without
// URDF says is tested in that build.
#include <array>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/arm/serial_arm.hpp"
#include "cablefit/model/arm/urdf_file.hpp"
#include "cablefit/model/file/writer.hpp"
#include "cablefit/model/rig.hpp"
#include "tests/support/message.hpp"
#include "tests/support/plain_arm.hpp"
#include "tests/support/serial_states.hpp"
#include "tests/support/temp_folder.hpp"

namespace cablefit::test {
namespace {

/// A rig of `n` joints beside a URDF.
class UrdfRig {
 public:
  explicit UrdfRig(const std::string& urdf) { folder.write("arm.urdf", urdf); }

  Rig read(int n_joints, const std::string& more = "", const std::string& motion = "") const {
    std::string joints;
    for (int j = 1; j <= n_joints; ++j)
      joints += fmt::format("{}{{\"name\": \"{}\"}}", j > 1 ? ", " : "", j);
    return read_rig(folder.write(
        "rig.json", fmt::format("{{\"joints\": [{}],{}\n \"arm\": {{\"type\": \"urdf\", \"file\": "
                                "\"arm.urdf\"{}}}}}",
                                joints, motion, more)));
  }
  std::string refused(int n_joints, const std::string& more = "",
                      const std::string& motion = "") const {
    return message_of([&] { read(n_joints, more, motion); }, folder.path());
  }
  TempFolder folder;
};

std::string skew_text() {
  return content_of(std::string(CABLEFIT_SOURCE) + "/tests/model/skew.urdf");
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

TEST_CASE("a build without URDF says so") {
  if (reads_urdf()) return;
  const UrdfRig rig("");
  CHECK(rig.refused(2) ==
        "rig.json:2:34: this cablefit was built without URDF; install libtinyxml2-dev and "
        "configure again, or give the chain by numbers with \"type\": \"serial\"");
}

TEST_CASE("an arm is read from its URDF") {
  if (!reads_urdf()) return;
  const PlainArm arm = seven_joints();
  const UrdfRig files(urdf_text(arm, "seven"));
  const Rig rig = files.read(7);
  CHECK(rig.arm.kind == &find_arm_kind("serial"));
  REQUIRE(rig.arm.parameters.serial != nullptr);
  const SerialArm& serial = *rig.arm.parameters.serial;
  CHECK(serial.chain.gravity == Eigen::Vector3d(0, 0, -9.80665));
  const std::vector<double> described = rig.arm.described();
  REQUIRE(described.size() == 43);
  const Eigen::VectorXd base = Eigen::Map<const Eigen::VectorXd>(described.data(), 43);
  SerialStates states(7, 8);
  for (int trial = 0; trial < 10; ++trial) {
    const auto [q, qd, qdd] = states.next();
    CHECK(
        (serial_torques(serial, base, q, qd, qdd) - arm.torques(q, qd, qdd)).cwiseAbs().maxCoeff() <
        1e-9);
  }
  // They stand beside the estimates as CAD values do, unless the rig file gives others.
  CHECK(rig.cad.at("ZZ7") == Approx(described.back()));
  CHECK(files.read(7, "", " \"cad\": {\"ZZ7\": 5},").cad.at("ZZ7") == 5);
  // A model file needs the URDF no more.
  const std::string text = model_file::rig_json(rig).dump();
  const Rig back = parse_rig(parse_json(text, "model.json"));
  CHECK(back.arm.described() == described);
  CHECK(model_file::rig_json(back).dump() == text);
}

TEST_CASE("part of a tree, in an order of the rig's own") {
  if (!reads_urdf()) return;
  const UrdfRig files(urdf_text(seven_joints(), "seven"));
  const auto first = [](const Rig& rig) { return rig.arm.base_parameters().front().name; };
  const Rig wrist = files.read(2, R"(, "base": "link5", "gravity": [0, 0, 0])");
  CHECK(first(wrist) == "ZZ1+0.0049*M2+YY2");
  const Rig swapped =
      files.read(2, R"(, "base": "link5", "gravity": [0, 0, 0], "joints": ["joint7", "joint6"])");
  CHECK(first(swapped) == "ZZ2+0.0049*M1+YY1");
  CHECK(swapped.arm.parameters.serial->chain.rig_joint == std::vector<int>{1, 0});
  const Rig shoulder = files.read(2, R"(, "tip": "link2")");
  CHECK(shoulder.arm.base_parameters().size() == 8);  // ZZ1 and seven of link 2
  // What hangs on the tip's joints rides along: 4.4 kg behind joint 2.
  CHECK(shoulder.arm.parameters.serial->chain.joints[1].inertia(0) == Approx(4.4));
}

TEST_CASE("fixed joints and what hangs on them are worked in") {
  if (!reads_urdf()) return;
  const SerialChain chain = UrdfRig(skew_text()).read(2).arm.parameters.serial->chain;
  CHECK(chain.joints[0].inertia(0) == Approx(1.65));  // upper, middle, camera
  CHECK(chain.joints[1].inertia(0) == Approx(1.1));   // fore, hand
  CHECK(chain.joints[0].axis == Eigen::Vector3d(0, 0.6, 0.8));
  // By hand: the hand stands at 0.2 + (0.02 cos 1, 0.02 sin 1).
  CHECK(chain.joints[1].inertia(1) == Approx(0.8 * 0.1 + 0.3 * (0.2 + 0.02 * std::cos(1.0))));
  CHECK(chain.joints[1].inertia(2) == Approx(0.3 * 0.02 * std::sin(1.0)));
}

TEST_CASE("a URDF that does not fit the rig is refused") {
  if (!reads_urdf()) return;
  const UrdfRig skew(skew_text());
  CHECK(skew.refused(3) ==
        "rig.json:2:34: the arm has 2 moving joint(s) (shoulder, elbow), the rig 3; list them as "
        "the rig's \"joints\", or name another \"base\" or \"tip\"");
  CHECK(skew.refused(2, R"(, "tip": "hnad")") ==
        "rig.json:2:53: unknown link 'hnad'; did you mean 'hand'?");
  CHECK(skew.refused(2, R"(, "base": "hand")") ==
        "rig.json:2:34: arm.urdf: no joint moves after link 'hand'; name another "
        "\"base\"");
  CHECK(skew.refused(2, R"(, "base": "fore", "tip": "upper")") ==
        "rig.json:2:69: arm.urdf: link 'upper' does not descend from link 'fore'; the "
        "base comes before the tip");
  CHECK(skew.refused(2, R"(, "joints": ["elbow", "sholder"])") ==
        "rig.json:2:66: unknown joint 'sholder'; did you mean 'shoulder'?");
  CHECK(skew.refused(2, R"(, "joints": ["elbow", "elbow"])") ==
        "rig.json:2:66: 'elbow' appears twice; name each joint once");
  CHECK(skew.refused(2, R"(, "joints": ["elbow"])") ==
        "rig.json:2:56: 1 joint(s), the arm has 2; name them all, in the rig's order");
  CHECK(skew.refused(2, R"(, "fiel": 1)") ==
        "rig.json:2:54: unknown key 'fiel' in 'arm'; did you mean 'file'?");
  CHECK(skew.refused(2, "", " \"motion\": \"linear\",") ==
        "rig.json:2:34: joint 'shoulder' turns, joint 1 of the rig slides; give \"motion\" in the "
        "rig file, of this joint \"rotary\"");
  const UrdfRig sliding(replaced(skew_text(), "type=\"revolute\"", "type=\"prismatic\""));
  CHECK(sliding.refused(2) ==
        "rig.json:2:34: joint 'elbow' slides, joint 2 of the rig turns; give \"motion\" in the rig "
        "file, of this joint \"linear\"");
}

TEST_CASE("a tree that branches needs a tip") {
  if (!reads_urdf()) return;
  const std::string jaw = R"(<link name="jaw"/><joint name="grip" type="revolute">
    <parent link="upper"/><child link="jaw"/></joint></robot>)";
  const UrdfRig files(replaced(skew_text(), "</robot>", jaw));
  CHECK(files.refused(2) ==
        "rig.json:2:34: arm.urdf: the tree branches, its ends are fore, jaw; name the arm's "
        "\"tip\"");
  CHECK(files.read(2, R"(, "tip": "fore")").n_joints() == 2);
}

TEST_CASE("sliding arms are read on linear rigs") {
  if (!reads_urdf()) return;
  std::string text = replaced(skew_text(), "type=\"revolute\"", "type=\"prismatic\"");
  text = replaced(text, "type=\"continuous\"", "type=\"prismatic\"");
  const Rig rig = UrdfRig(text).read(2, "", " \"motion\": \"linear\",");
  const auto base = rig.arm.base_parameters();
  REQUIRE(base.size() == 2);
  CHECK(base[0].name == "M1");
  CHECK(rig.arm.described()[0] == Approx(1.65));
  CHECK(rig.arm.described()[1] == Approx(1.1));
}

TEST_CASE("an inertia that no body has is refused with its link") {
  if (!reads_urdf()) return;
  const auto with = [](const char* mass, const char* ixx, const char* iyy, const char* izz) {
    return replaced(skew_text(),
                    R"(<mass value="0.15"/> <inertia ixx="3e-5" ixy="0" ixz="0" )"
                    R"(iyy="3e-5" iyz="0" izz="3e-5"/>)",
                    fmt::format(R"(<mass value="{}"/> <inertia ixx="{}" ixy="0" ixz="0" )"
                                R"(iyy="{}" iyz="0" izz="{}"/>)",
                                mass, ixx, iyy, izz));
  };
  const auto refused = [&](const std::string& text) {
    const std::string at = "rig.json:2:34: arm.urdf:36: link 'camera' has ";
    const std::string message = UrdfRig(text).refused(2);
    REQUIRE(message.substr(0, at.size()) == at);
    return message.substr(at.size());
  };
  const std::string again =
      "; export the inertia about the centre of mass again, in kg m^2; CAD programs differ in the "
      "sign of ixy, ixz and iyz";
  CHECK(refused(with("0.15", "-3e-5", "3e-5", "3e-5")) ==
        "a negative principal moment of inertia, -3e-05 kg m^2" + again);
  // In g mm^2, of one axis.
  CHECK(refused(with("0.15", "3e-5", "3e-5", "30")) ==
        "an impossible inertia: its largest principal moment, 30 kg m^2, is above the sum of the "
        "others, 3e-05 + 3e-05 kg m^2" +
            again);
  CHECK(refused(with("0", "3e-5", "3e-5", "3e-5")) ==
        "an inertia of up to 3e-05 kg m^2, but a mass of 0; give it its mass, or leave out its "
        "<inertial>");
  // A link of nothing, a point, a thin rod and a thin plate with rounded digits are bodies.
  for (const auto& [mass, ixx, iyy, izz] :
       {std::array{"0", "0", "0", "0"}, std::array{"0.15", "0", "0", "0"},
        std::array{"0.15", "0", "3e-5", "3e-5"},
        std::array{"0.15", "1.33e-5", "1.33e-5", "2.67e-5"}})
    CHECK(UrdfRig(with(mass, ixx, iyy, izz)).read(2).n_joints() == 2);
}

TEST_CASE("a file that is no URDF is refused at its line") {
  if (!reads_urdf()) return;
  const auto refused = [](const std::string& text) { return UrdfRig(text).refused(2); };
  const std::string at = "rig.json:2:34: ";
  CHECK(refused("<robot>\n<link name=\"a\">\n</robot>") ==
        at + "arm.urdf:2: not XML: mismatched element; is this file a URDF?");
  CHECK(refused("") == at + "arm.urdf: not XML: empty document; is this file a URDF?");
  CHECK(refused("{\"joints\": 2}") ==
        at + "arm.urdf:1: not XML: parsing text; is this file a URDF?");
  CHECK(refused("<sdf/>") ==
        at + "arm.urdf:1: no <robot>; is this file a URDF? xacro files have to be expanded first");
  std::string deep = "<robot>";
  for (int k = 0; k < 200000; ++k) deep += "<link>";
  CHECK(refused(deep) ==
        at + "arm.urdf:1: not XML: xml element depth exceeded; is this file a URDF?");
  CHECK(refused(std::string(5 << 20, ' ')) ==
        at + "arm.urdf: larger than 4 MB; a URDF names its meshes, it does not hold them");
  const auto skew_with = [&](const char* what, const char* by) {
    return refused(replaced(skew_text(), what, by)).substr(at.size());
  };
  CHECK(skew_with("link name=\"upper\"", "link") == "arm.urdf:15: <link> has no name");
  CHECK(skew_with("link name=\"upper\"", "link name=\"table\"") ==
        "arm.urdf:15: link 'table' appears twice");
  CHECK(skew_with("child link=\"upper\"", "child link=\"uper\"") ==
        "arm.urdf:12: unknown link 'uper'; did you mean 'upper'?");
  CHECK(skew_with("<mass value=\"1.3\"/>", "") == "arm.urdf:16: <inertial> has no <mass>");
  CHECK(skew_with("<mass value=\"1.3\"/>", "<mass value=\"1,3\"/>") ==
        "arm.urdf:17: value='1,3' is not 1 number");
  CHECK(skew_with("<mass value=\"1.3\"/>", "<mass value=\"-1\"/>") ==
        "arm.urdf:16: link 'upper' has a mass of -1 kg; a mass is positive");
  CHECK(skew_with("xyz=\"0.1 0 0.05\"", "xyz=\"0.1 0\"") ==
        "arm.urdf:13: xyz='0.1 0' is not 3 numbers");
  CHECK(skew_with("xyz=\"0.1 0 0.05\"", "xyz=\"0.1 0 nan\"") ==
        "arm.urdf:13: xyz='0.1 0 nan' is not 3 numbers");
  CHECK(skew_with("xyz=\"0 0.6 0.8\"", "xyz=\"0 0 0\"") == "arm.urdf:13: an axis of length 0");
  CHECK(skew_with("<child link=\"camera\"/>", "<child link=\"fore\"/>") ==
        "arm.urdf:40: link 'fore' has two parent joints; a URDF is a tree: every link "
        "has one parent");
  CHECK(skew_with("<parent link=\"upper\"/>", "<parent link=\"middle\"/>") ==
        "arm.urdf: some joints form a loop; a URDF is a tree: every link descends from "
        "the root");
  CHECK(skew_with("</robot>", "<link name=\"spare\"/></robot>") ==
        "arm.urdf: 2 links have no parent joint; a URDF is a tree: one link, the root, "
        "has no parent");
  CHECK(skew_with("name=\"elbow\" type=\"revolute\"", "name=\"elbow\" type=\"planar\"") ==
        "arm.urdf:40: joint 'elbow' is of type 'planar'; revolute, continuous, prismatic and fixed "
        "joints can be fitted");
  CHECK(skew_with("<axis xyz=\"1 0 0.2\"/>", "<mimic joint=\"shoulder\"/>") ==
        "arm.urdf:40: joint 'elbow' mimics another; only joints that move by themselves can be "
        "fitted");
  // No name of a file is followed anywhere, and none steers the terminal.
  CHECK(skew_with("child link=\"upper\"", "child link=\"\x1b[2J\"") ==
        "arm.urdf:12: unknown link '\\x1b[2J'; known: world, table, upper, middle, camera, fore, "
        "hand");
  const UrdfRig none("");
  std::filesystem::remove(none.folder.file("arm.urdf"));
  CHECK(none.refused(2) == at + "cannot read arm.urdf: No such file or directory");
}

}  // namespace
}  // namespace cablefit::test

// What a user gets to read for a wrong rig file: exact texts, as data.
#include <catch2/catch.hpp>
#include <string>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/rig.hpp"
#include "tests/support/message.hpp"

namespace {

using namespace cablefit;
using test::message_of;

struct BadRig {
  std::string json, message;
};

const BadRig kBadRigs[] = {
    {R"({"colums": {}})", "rig.json:1:12: unknown key 'colums'; did you mean 'columns'?"},
    {R"({"schema": "cablefit/model/1"})",
     "rig.json:1:12: schema 'cablefit/model/1'; expected 'cablefit/rig/1'"},
    {R"({"columns": {"thetta": "motor"}})",
     "rig.json:1:24: unknown channel 'thetta'; did you mean 'theta'?"},
    {"{\"columns\": {\n  \"q\": \"link\",\n  \"q2\": \"elbow\"}}",
     "rig.json:3:9: channel 'q2' is not of this rig; its joints are numbered 1 to 1"},
    {R"({"columns": {"tau": {"column": "i_q", "scale": 0}}})",
     "rig.json:1:48: scale is 0; leave it out for 1; -1 reverses the sign"},
    {R"({"columns": {"run": {"column": "r", "scale": 2}}})",
     "rig.json:1:21: channel 'run' holds text; give its column only, without scale, shift or unit"},
    {R"({"columns": {"theta": {"scale": 2}}})",
     "rig.json:1:23: missing key 'column' in 'columns.theta'; add it to this object"},
    {R"({"columns": {"theta": "motor [degg]"}})",
     "rig.json:1:23: unknown unit 'degg'; did you mean 'deg'?"},
    {R"({"motion": "linnear"})", "rig.json:1:12: unknown value 'linnear'; did you mean 'linear'?"},
    {R"({"torque_hold": true})",
     "rig.json:1:17: 'torque_hold' is true or false, not a text; write it in double quotes"},
    {R"({"torque_hold": "none", "torque_period": 0.001})",
     "rig.json:1:42: torque_period without a hold; use \"torque_hold\": \"zoh\" or drop it"},
    {R"({"load": {"type": "hanging_mas"}})",
     "rig.json:1:19: unknown load 'hanging_mas'; did you mean 'hanging_mass'?"},
    {R"({"load": {"type": "hanging_mass", "mass": -40, "radius": 0.1}})",
     "rig.json:1:43: 'load.mass' is -40, not positive; give a number above 0"},
    {R"({"load": {"type": "hanging_mass", "mass": 40, "radius": 0.1, "direction": 0.5}})",
     "rig.json:1:75: direction must be 1 or -1; 1: the weight turns the link towards larger q"},
    {R"({"load": {"type": "table", "q": [0, 2, 1], "torque": [1, 2, 3]}})",
     "rig.json:1:40: q must ascend; sort the points by q"},
    {R"({"load": {"type": "constant", "torque": 3}, "joints": [{"name": "a"}, {"name": "b"}]})",
     "rig.json:1:19: load 'constant' on a rig of 2 joints; log tau_load1, tau_load2, ... and use "
     "{\"type\": \"column\"}"},
    {R"({"controller": {"kd": 3}})",
     "rig.json:1:16: missing key 'kp' in 'controller'; add it to this object"},
    {R"({"controller": {"type": "lqr", "kp": 3}})",
     "rig.json:1:25: unknown value 'lqr'; known: pd, pid, cascade, open_loop"},
    {R"({"controller": {"type": "open_loop", "kp": 3}})",
     "rig.json:1:44: unknown key 'kp' in 'controller'; known: type"},
    {R"({"sensors": {"q": {"quantum": 0}}})",
     "rig.json:1:31: 'sensors.q.quantum' is 0, not positive; give a number above 0"},
    {R"({"sensors": {"q": {"noise": -0.1}}})",
     "rig.json:1:29: -0.1 is negative; expected 0 or more"},
    {R"({"sensors": {"phase": {}}})",
     "rig.json:1:23: channel 'phase' has no sensor; it holds text"},
    {R"({"motion": "linear", "load": {"type": "pendulum", "mass": 1, "length": 0.3}})",
     "rig.json:1:39: load 'pendulum' on a linear axis; its weight is a force: use {\"type\": "
     "\"constant\", \"torque\": N}"},
    {R"({"load": {"type": "hanging_mass", "mass": 1, "radius": 0.3}, "motion": "linear"})",
     "rig.json:1:19: load 'hanging_mass' on a linear axis; its weight is a force: use {\"type\": "
     "\"constant\", \"torque\": N}"},
    {R"({"cad": {"J_lnk": 0.3}})",
     "rig.json:1:19: unknown parameter 'J_lnk'; did you mean 'J_link'?"},
    {R"({"joints": [{"name": "a"}, {"name": "a"}]})",
     "rig.json:1:37: 'a' appears twice; give each its own name"},
    {R"({"joints": []})",
     "rig.json:1:12: expected a list with at least one item; write [{...}, ...]"},
    {R"({"cables": [{"name": "a", "motor_radius": [0.1, 0.2], "link_radius": 0.1}]})",
     "rig.json:1:43: 2 number(s), expected 1; give one per joint"},
    {R"({"cables": [{"name": "a", "motor_radius": 0, "link_radius": 0.1}]})",
     "rig.json:1:43: radius is 0; give the signed radius in m, negative where a "
     "positive motion slackens the cable"},
    {R"({"cables": [{"name": "a", "motor_radius": 1, "link_radius": 1, "law": "liner"}]})",
     "rig.json:1:71: unknown cable law 'liner'; did you mean 'linear'?"},
    {R"({"cables": [{"name": "a", "motor_radius": 1, "link_radius": 1, "order": 1.5}]})",
     "rig.json:1:73: order 1.5 of a polynomial cable; the order of a polynomial cable is a whole "
     "number from 1 to 9"},
    {R"({"cables": [{"name": "a", "motor_radius": 1, "link_radius": 1,
        "initial_elongation": "find"}]})",
     "rig.json:2:31: unknown initial_elongation 'find'; give a number in m, or \"search\" to "
     "estimate it"},
    {R"({"cables": [{"name": "a", "motor_radius": "0.02", "link_radius": 1}]})",
     "rig.json:1:43: neither a radius nor a displacement map; give the signed radius in m, or "
     "{\"type\": \"polynomial\", ...}"},
    {R"({"cables": [{"name": "a", "motor_radius": 1e300, "link_radius": 1}]})",
     "rig.json:1:43: a radius of 1e+300 m; give it in m"},
    {R"({"cables": [{"name": "a", "motor_radius": {"type": "polynomial", "coefficients": [1, 1e9]},
        "link_radius": 1}]})",
     "rig.json:1:43: a radius of -1e+09 m; give it in m"},
    {R"({"cables": [{"name": "a", "motor_radius": 1, "link_radius": 1,
        "initial_elongation": 5120}]})",
     "rig.json:2:31: an initial elongation of 5120 m; give it in m"},
    {R"({"cables": [{"name": "a", "motor_radius": {"type": "tabel"}, "link_radius": 1}]})",
     "rig.json:1:52: unknown displacement map 'tabel'; did you mean 'table'?"},
    {R"({"cables": [{"name": "a", "motor_radius": {"type": "polynomial", "coefficients": [0, 0]},
        "link_radius": 1}]})",
     "rig.json:1:82: no radius; give r_0, r_1, ... of the radius r_0 + r_1 x + ... in m"},
    {R"({"cables": [{"name": "a", "motor_radius": {"type": "table", "angle": [0],
        "displacement": [0]}, "link_radius": 1}]})",
     "rig.json:1:70: a table needs at least two points; give angle and displacement as lists"},
    {R"({"cables": [{"name": "a", "motor_radius": {"type": "table", "angle": [0, 1],
        "displacement": [0]}, "link_radius": 1}]})",
     "rig.json:2:25: angle and displacement have different lengths; one displacement per angle"},
    {R"({"cables": [{"name": "a", "motor_radius": {"type": "table", "angle": [0, 1, 1],
        "displacement": [0, 1, 2]}, "link_radius": 1}]})",
     "rig.json:1:77: angle must ascend; sort the points by angle"},
    {R"({"cables": [{"name": "a", "motor_radius": {"type": "table", "angle": [0, 1],
        "displacement": [3, 3]}, "link_radius": 1}]})",
     "rig.json:2:25: all displacements are the same; use the radius 0"},
    {R"({"cables": [{"name": "a", "motor_radius": {"type": "table", "angle": [0, 1e-200, 1],
        "displacement": [0, 1e200, 1]}, "link_radius": 1}]})",
     "rig.json:1:70: angles are too close together; no finite curve goes through these points"},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "cables": [{"name": "c", "motor_radius": [1, 1],
 "link_map": {"type": "guide"}}]})",
     "rig.json:2:23: unknown map of two joints 'guide'; did you mean 'guides'?"},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "cables": [{"name": "c", "motor_radius": [1, 1],
 "link_map": {"type": "polynomial", "joints": ["a"], "coefficients": [[0], [1]]}}]})",
     "rig.json:2:47: 1 joint(s), expected 2; name the joints of angle 1 and angle 2"},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "cables": [{"name": "c", "motor_radius": [1, 1],
 "link_map": {"type": "polynomial", "joints": ["a", "d"], "coefficients": [[0], [1]]}}]})",
     "rig.json:2:53: unknown joint 'd'; known: a, b"},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "cables": [{"name": "c", "motor_radius": [1, 1],
 "link_map": {"type": "polynomial", "joints": ["a", "a"], "coefficients": [[0], [1]]}}]})",
     "rig.json:2:53: both joints are the same; give a map of one joint in motor_radius or "
     "link_radius"},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "cables": [{"name": "c", "motor_radius": [1, 1],
 "link_map": {"type": "polynomial", "joints": ["a", "b"], "coefficients": [[0, 1], [1]]}}]})",
     "rig.json:2:84: 1 number(s), the first list has 2; give lists of one length"},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "cables": [{"name": "c", "motor_radius": [1, 1],
 "link_map": {"type": "polynomial", "joints": ["a", "b"], "coefficients": [[3]]}}]})",
     "rig.json:2:75: no radius; give c_ij of the sum of c_ij x1^i x2^j, one list per i, in m"},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "cables": [{"name": "c", "motor_radius": [1, 1],
 "link_map": {"type": "grid", "joints": ["a", "b"], "angle_1": [0, 1], "angle_2": [0, 1], "displacement": [[0, 1]]}}]})",
     "rig.json:2:107: 1 lists of 2 displacements, expected 2 of 2; one list per angle_1, with one "
     "displacement per angle_2"},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "cables": [{"name": "c", "motor_radius": [1, 1],
 "link_map": {"type": "grid", "joints": ["a", "b"], "angle_1": [0, 0], "angle_2": [0, 1], "displacement": [[0, 1], [1, 2]]}}]})",
     "rig.json:2:68: angle must ascend; sort the points by angle"},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "cables": [{"name": "c", "motor_radius": [1, 1],
 "link_map": {"type": "guides", "joints": ["a", "b"], "from": [1], "to": [1, 1], "length": 1}}]})",
     "rig.json:2:63: 1 number(s), expected 2; give [x, y] in m"},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "cables": [{"name": "c", "motor_radius": [1, 1],
 "link_map": {"type": "guides", "joints": ["a", "b"], "from": [2, 1], "to": [1, 1], "length": 1}}]})",
     "rig.json:2:14: the guides meet with both joints at 0; give two places of the tendon"},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "cables": [{"name": "c", "motor_radius": [1, 1],
 "link_map": {"type": "guides", "joints": ["a", "b"], "from": [2, 1], "to": [0, 0], "length": 1}}]})",
     "rig.json:2:77: the guide is on axis 2, which then moves no cable; give the map of joint 1 "
     "alone in motor_radius or link_radius"},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "motion": "linear", "cables": [{"name": "c",
 "motor_radius": [1, 1], "link_map": {"type": "guides", "joints": ["a", "b"], "from": [1, 1],
 "to": [1, 1], "length": 1}}]})",
     "rig.json:2:47: map 'guides' of joint 'a', which slides; it is of joints that turn: use "
     "\"grid\" or \"polynomial\""},
    {R"({"joints": [{"name": "a"}, {"name": "b"}], "motion": ["linear"], "cables": []})",
     "rig.json:1:54: 1 motion(s), expected 2; give one per joint"},
    {R"({"cables": [{"name": "a", "motor_radius": 1, "link_radius": 1, "law": "strand"}]})",
     "rig.json:1:13: missing key 'toe' in 'cables[0]'; add it to this object"},
    {R"({"cables": [{"name": "a", "motor_radius": 1, "link_radius": 1, "law": "strand", "toe": 0}]})",
     "rig.json:1:88: 'cables[0].toe' is 0, not positive; give a number above 0"},
    {R"({"cables": [{"name": "a", "motor_radius": 1, "link_radius": 1, "toe": 0.01}]})",
     "rig.json:1:71: a polynomial cable has no toe; use \"law\": \"strand\" or \"spline\", or drop "
     "it"},
    {R"({"cables": [{"name": "a", "motor_radius": 1, "link_radius": 1, "law": "strand", "toe": 1,
        "order": 5}]})",
     "rig.json:2:18: order 5 of a strand cable; the order of a strand cable is a whole number from "
     "1 to 4"},
    {R"({"reference_pose": {"q": 0}})",
     "rig.json:1:20: missing key 'theta' in 'reference_pose'; add it to this object"},
    {R"({"reference_pose": {"q": [0, 1], "theta": 0}})",
     "rig.json:1:26: 2 number(s), expected 1; give one per joint"},
    {R"({"columns": []})",
     "rig.json:1:13: 'columns' is an array, not an object; write it as {\"key\": value}"},
};

TEST_CASE("a wrong rig file says where and what to do") {
  for (const BadRig& bad : kBadRigs) {
    INFO(bad.json);
    CHECK(message_of([&] { (void)parse_rig(parse_json(bad.json, "rig.json")); }) == bad.message);
  }
}

}  // namespace

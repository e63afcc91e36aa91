// Results of several joints: written, read back, used, and what is refused of them.
#include <algorithm>
#include <set>

#include "cablefit/base/json/json_document.hpp"
#include "cablefit/model/effects/effect_names.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/report/documents/dynamic_document.hpp"
#include "cablefit/report/documents/elastic_document.hpp"
#include "cablefit/results/read/elastic_reader.hpp"
#include "cablefit/results/read_model.hpp"
#include "cablefit/results/write/dynamic_json.hpp"
#include "cablefit/results/write/elastic_json.hpp"
#include "tests/report/schema.hpp"
#include "tests/support/message.hpp"
#include "tests/support/plain_rigs.hpp"
#include "tests/support/recover.hpp"

namespace cablefit::test {
namespace {

/// Logs of two joints with three coupled cables.
class TwoJoints {
 public:
  explicit TwoJoints(const std::string& more = "") {
    const PlainRig plain = three_coupled_cables();
    bench.rig = read_rig(bench.folder().write("rig.json", rig_text(plain, more)));
    bench.add_text(blocked_log(plain, {0.1, 0.1}, 60, 81));
    bench.add_text(moving_log(plain, 6, 82));
  }
  Bench bench;
};

DynamicOptions both_models() {
  DynamicOptions options;
  options.models = {"linear", "poly"};
  return options;
}

TEST_CASE("results of several joints are read back as they were") {
  const TwoJoints two;
  ElasticOptions with_figures;
  with_figures.figures = true;
  const ElasticResult elastic = fit_elastic(two.bench.logs(), with_figures);
  const std::string text = elastic_json(elastic);
  CHECK(schema_errors("elastic", text) == "");
  const ElasticResult back = parse_elastic_result(parse_json(text, "elastic.json"));
  const ElasticPreload &was = elastic.preloads.at(0), &is = back.preloads.at(0);
  REQUIRE(is.joints.size() == 2);
  for (std::size_t j = 0; j < 2; ++j) {
    CHECK(is.joints[j].name == was.joints[j].name);
    CHECK(is.joints[j].deflection_low == was.joints[j].deflection_low);
    CHECK(is.joints[j].deflection_high == was.joints[j].deflection_high);
    CHECK(is.joints[j].peak_torque == was.joints[j].peak_torque);
    CHECK(is.joints[j].loop_half_width == was.joints[j].loop_half_width);
    CHECK(is.joints[j].weight == was.joints[j].weight);
    CHECK(is.joints[j].counts.rows_used == was.joints[j].counts.rows_used);
  }
  CHECK(elastic_json(back) == text);

  const DynamicResult dynamic = fit_dynamic(two.bench.logs(), elastic, both_models());
  const std::string result = dynamic_json(dynamic);
  CHECK(schema_errors("dynamic", result) == "");
  // Stage 2 from the file is stage 2 from memory.
  CHECK(dynamic_json(fit_dynamic(two.bench.logs(), back, both_models())) == result);

  // Both models as stage 1 reads them, and the one that fits as the simulation does.
  std::string choice;
  const Model model = parse_model(parse_json(result, "dynamic.json"), "", "poly", choice);
  const auto motor_torques_of = [](const Transmission& transmission) {
    Eigen::VectorXd link, motor;
    transmission.torques(Eigen::Vector2d(0.1, -0.05), Eigen::Vector2d(0.13, -0.01), link, motor);
    return motor;
  };
  for (const char* name : {"linear", "poly"})
    CHECK(motor_torques_of(was.find(name)->transmission) ==
          motor_torques_of(is.find(name)->transmission));
  CHECK(motor_torques_of(model.transmission) == motor_torques_of(was.find("poly")->transmission));
  REQUIRE(model.joints.size() == 2);
  CHECK(model.joints[1].link.front().parameters.front().value ==
        estimate(dynamic.preloads.at(0).fits.at(1).parameters, "J_link[2]").value);
}

TEST_CASE("a curve of coefficients that are not identifiable is read back whole") {
  const TwoJoints two;
  ElasticResult elastic = fit_elastic(two.bench.logs(), {});
  for (ElasticFit& fit : elastic.preloads.at(0).fits)
    if (fit.model == "poly")
      for (std::size_t k = 0; k < 2; ++k) {
        Estimate& e = fit.parameters.at(k);
        e.value = e.sd = e.ci_low = e.ci_high = std::nan("");
        e.not_identifiable = "is not separable from the other in these logs";
      }
  for (Estimate& e : elastic.preloads.at(0).fits.back().parameters)
    if (e.name == "offset[1]") e.not_identifiable = "is not separable from the curve in these logs";
  const std::string text = elastic_json(elastic);
  CHECK(schema_errors("elastic", text) == "");
  const ElasticResult back = parse_elastic_result(parse_json(text, "elastic.json"));
  for (std::size_t k = 0; k < 3; ++k) {
    const auto coefficients_of = [&](const ElasticResult& result) {
      return result.preloads.at(0).find("poly")->transmission.cables.at(k).coefficients;
    };
    CHECK(coefficients_of(back).front() > 0);
    CHECK(coefficients_of(back) == coefficients_of(elastic));
  }
  const DynamicResult moving = fit_dynamic(two.bench.logs(), back, both_models());
  const DynamicPreload& preload = moving.preloads.at(0);
  CHECK(estimate(preload.fits.at(1).parameters, "offset[1]").not_identifiable ==
        "stage 1 does not separate it from its curve");
  CHECK(estimate(preload.fits.at(1).parameters, "offset[2]").not_identifiable.empty());
  CHECK(
      std::any_of(preload.warnings.begin(), preload.warnings.end(), [](const std::string& warning) {
        return warning.starts_with("poly: stage 1 does not determine ");
      }));
  const std::string dynamic = dynamic_json(moving);
  CHECK(dynamic == dynamic_json(fit_dynamic(two.bench.logs(), elastic, both_models())));
  CHECK(schema_errors("dynamic", dynamic) == "");
  std::string choice;
  const Model model = parse_model(parse_json(dynamic, "dynamic.json"), "", "poly", choice);
  CHECK(model.transmission.cables.at(0).coefficients ==
        elastic.preloads.at(0).find("poly")->transmission.cables.at(0).coefficients);
}

TEST_CASE("a result without the curve of coefficients that are not separable is refused") {
  const TwoJoints two;
  ElasticResult elastic = fit_elastic(two.bench.logs(), {});
  for (ElasticFit& fit : elastic.preloads.at(0).fits)
    if (fit.model == "poly") {
      fit.parameters.at(0).value = std::nan("");
      fit.parameters.at(0).not_identifiable = "is not separable from the other in these logs";
    }
  std::string text = elastic_json(elastic);
  const std::size_t at = text.find("\"curve_coefficients\"");
  REQUIRE(at != std::string::npos);
  text.replace(at, 20, "\"curve_coefficient_\"");
  const std::string name = elastic.preloads.at(0).find("poly")->parameters.at(0).name;
  CHECK(message_of([&] { parse_elastic_result(parse_json(text, "elastic.json")); }, "")
            .find(name + " is not identifiable, and 'curve_coefficients' is missing") !=
        std::string::npos);
}

TEST_CASE("effects of several joints are read back on their joints") {
  const TwoJoints two;
  DynamicOptions options;
  options.models = {"poly"};
  options.effects = blank_effects({"quadratic_drag[link 2]"}, 2);
  const ElasticResult elastic = fit_elastic(two.bench.logs(), {});
  const std::string result = dynamic_json(fit_dynamic(two.bench.logs(), elastic, options));
  CHECK(schema_errors("dynamic", result) == "");
  const auto read = [](const std::string& text) {
    std::string choice;
    return parse_model(parse_json(text, "dynamic.json"), "", "poly", choice);
  };
  const Model model = read(result);
  CHECK(model.joints.at(0).added.empty());
  REQUIRE(model.joints.at(1).added.size() == 1);
  CHECK(model.joints[1].added[0].effect->name == "quadratic_drag");
  const auto refused = [&](const std::string& joint) {
    std::string text = result;
    const std::string was = R"("joint": 2)";
    const std::size_t at = text.find(was, text.find(R"("effects")"));
    REQUIRE(at != std::string::npos);
    text.replace(at, was.size(), joint);
    const std::string message = message_of([&] { (void)read(text); });
    return message.substr(message.find(' ') + 1);  // without the place
  };
  for (const char* joint : {"0", "3", "1.5", "-1"})
    CHECK(refused(R"("joint": )" + std::string(joint)) ==
          "not the number of a joint; expected 1 to 2");
  CHECK(refused(R"("event": null)") ==
        "missing key 'joint' in 'preloads[0].fits[0].effects[0]'; add it to this object");
}

TEST_CASE("reports of several joints have a row and figures per joint") {
  const TwoJoints two;
  ElasticOptions options;
  options.figures = true;
  const ElasticResult elastic = fit_elastic(two.bench.logs(), options);
  const Document document = elastic_document(elastic);
  const auto fits = std::find_if(document.tables.begin(), document.tables.end(),
                                 [](const Table& table) { return table.title == "Fits"; });
  REQUIRE(fits != document.tables.end());
  CHECK(fits->columns.at(2).title == "joint");
  REQUIRE(fits->rows.size() == 4);  // two models, two joints
  CHECK(fits->rows.at(3).at(2) == "2");
  for (const auto& row : fits->rows) CHECK(row.size() == fits->columns.size());
  std::set<std::string> sections;
  for (const Figure& figure : elastic.preloads.at(0).figures) sections.insert(figure.section);
  CHECK(sections == std::set<std::string>{"default, joint 1", "default, joint 2"});

  DynamicOptions dynamic = both_models();
  dynamic.figures = true;
  const DynamicResult result = fit_dynamic(two.bench.logs(), elastic, dynamic);
  std::set<std::string> groups;
  for (const Figure& figure : result.preloads.at(0).figures) groups.insert(figure.group);
  CHECK(groups == std::set<std::string>{"link[1] equation", "link[2] equation", "motor[1] equation",
                                        "motor[2] equation"});
  CHECK_FALSE(dynamic_document(result).tables.empty());
}

TEST_CASE("given link inertias are taken, not estimated") {
  const TwoJoints two(R"( "arm": {"type": "independent", "J_link": [0.05, 0.03]},)");
  const ElasticResult elastic = fit_elastic(two.bench.logs(), {});
  DynamicOptions options;
  const DynamicFit fit = fit_dynamic(two.bench.logs(), elastic, options).preloads.at(0).fits.at(0);
  CHECK(estimate(fit.parameters, "J_link[2]").value == 0.03);
  CHECK(estimate(fit.parameters, "J_link[2]").sd == 0);
  CHECK(fit.verdicts.at("J_link[2]") == "given");
  // What is given stands on the right side: its torque, 0.1 N m and more, is not left over.
  CHECK(fit.torque_error.at("link[1]").rms < 0.02);
  CHECK(fit.torque_error.at("link[2]").rms < 0.02);
  check_recovered(fit.parameters, {{"f_s[1]", 0.1}, {"f_s[2]", 0.06}, {"J_motor[2]", 0.004}}, 3);
}

TEST_CASE("what supports one joint says so") {
  const TwoJoints two;
  const std::string folder = two.bench.folder().path();
  const auto refused = [&](auto action) { return message_of(action, folder); };
  ElasticOptions offset;
  offset.offset = 0.1;
  CHECK(refused([&] { fit_elastic(two.bench.logs(), offset); }) ==
        "rig.json: the rig has 2 joints, and a given offset that is not 0 supports one joint; "
        "write one rig file per joint, with its own columns");
  DynamicOptions ratios;
  ratios.models = {"ratios"};
  CHECK(refused([&] { fit_dynamic(two.bench.logs(), {}, ratios); }) ==
        "rig.json: the rig has 2 joints, and --model ratios supports one joint; write one rig "
        "file per joint, with its own columns");
}

TEST_CASE("a result of a planar arm gives its model the base parameters") {
  const TwoJoints two(R"( "arm": {"type": "planar_two_joint", "length_1": 0.3},)");
  const ElasticResult elastic = fit_elastic(two.bench.logs(), {});
  const std::string text = dynamic_json(fit_dynamic(two.bench.logs(), elastic, {}));
  CHECK(schema_errors("dynamic", text) == "");
  std::string choice;
  const Model model =
      parse_model(parse_json(text, "dynamic.json"), "", "poly", choice, Completeness::as_it_is);
  REQUIRE(model.arm.size() == 4);
  CHECK(model.arm[0].name == "ZZ1+M2*L1^2");
  CHECK(model.joints[0].link.size() == 2);  // the frictions
}

TEST_CASE("logs that lack a joint, or in which one rests, are told by name") {
  const PlainRig plain = three_coupled_cables();
  Bench bench;
  bench.rig = read_rig(bench.folder().write("rig.json", rig_text(plain, "")));
  std::string text = "t,q1,theta1,theta2,tau1,tau2\n", still = "t,q1,q2,theta1,theta2,tau1,tau2\n";
  for (int i = 0; i < 400; ++i) {
    const double x = 0.1 * std::sin(0.05 * i);
    text += fmt::format("{:.2f},0,{:.6f},{:.6f},{:.6f},1\n", 0.01 * i, x, x, x);
    still += fmt::format("{:.2f},0,0,{:.6f},0.3,{:.6f},1\n", 0.01 * i, x, x);
  }
  const auto refused = [&] {
    return message_of([&] { fit_elastic(bench.logs(), {}); }, bench.folder().path());
  };
  bench.add_text(text);
  CHECK(refused() ==
        "log0.csv:1: missing column 'q2', needed for the deflection theta - q; add it, or map it "
        "in a rig file; columns are t, q1, theta1, theta2, tau1, tau2");
  Bench other;
  other.rig = bench.rig;
  other.add_text(still);
  CHECK(message_of([&] { fit_elastic(other.logs(), {}); }, other.folder().path()) ==
        "log0.csv: theta2 never moves while the link is blocked; sweep the motor slowly up and "
        "down, and check which column theta2 is");
}

}  // namespace
}  // namespace cablefit::test

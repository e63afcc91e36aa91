// A result of `cablefit dynamic` as a model.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include "cablefit/base/error.hpp"
#include "cablefit/model/model.hpp"
#include "cablefit/results/read_model.hpp"
#include "tests/support/message.hpp"
#include "tests/support/temp_folder.hpp"

namespace {

using namespace cablefit;
using test::message_of;
using test::TempFolder;

constexpr const char* kLinearFit = R"({"model": "linear", "estimator": "wls", "parameters": [
    {"name": "J_link", "unit": "kg m^2", "value": 0.408, "sd": 0.037, "rsd_percent": 9.1,
     "sd_white": 0.01, "ci95": [0.33, 0.48], "cad": 0.3},
    {"name": "f_v", "value": 3.854}, {"name": "f_s", "value": 2.378, "sd": null,
     "not_identifiable": "the link never reversed"},
    {"name": "J_motor", "value": 0.0228}, {"name": "f_vm", "value": 0.894},
    {"name": "f_sm", "value": 1.087}, {"name": "offset", "value": 0.0431}],
  "elastic": {"order": 1, "theta_0": 0.001, "offset": 0.2, "parameters": [
    {"name": "K", "unit": "N m/rad", "value": 1819.2, "sd": 4},
    {"name": "f_sm", "unit": "N m", "value": 1.2}]}})";

constexpr const char* kPolyFit = R"({"model": "poly", "parameters": [
    {"name": "J_link", "value": 0.339}, {"name": "f_v", "value": 5.601},
    {"name": "f_s", "value": 3.274}, {"name": "J_motor", "value": 0.0133},
    {"name": "f_vm", "value": 1.0654}, {"name": "f_sm", "value": 2.778},
    {"name": "offset", "value": 0.0286}],
  "elastic": {"order": 2, "theta_0": 0, "offset": 0, "parameters": [
    {"name": "K1_0", "value": 1367.7}, {"name": "K1_1", "value": 37844.1},
    {"name": "K2_0", "value": 1575.3}, {"name": "K2_1", "value": 29357.2},
    {"name": "l_o[2]", "value": 0.0047, "sd": 0.0001}]}})";

constexpr const char* kRigidFit = R"({"model": "rigid", "parameters": [
    {"name": "J", "value": 95}, {"name": "f_v", "value": 203}, {"name": "f_s", "value": 20},
    {"name": "offset", "value": -3}]})";

std::string result(const std::string& preloads) {
  return R"({"schema": "cablefit/dynamic/1", "cablefit_version": "1", "preloads": [)" + preloads +
         "]}";
}

std::string preload(const std::string& name, const std::string& fits,
                    const std::string& rig = "null") {
  return R"({"name": ")" + name + R"(", "rig": )" + rig + R"(, "fits": [)" + fits + "]}";
}

std::string both() { return fmt::format("{},{}", kLinearFit, kPolyFit); }

Model read(const std::string& text, const std::string& wanted_preload,
           const std::string& wanted_model, std::string* choice = nullptr) {
  const TempFolder folder;
  folder.write("rig.json", R"({"name": "the bench"})");
  std::string ignored;
  return read_model(folder.write("dynamic.json", text), wanted_preload, wanted_model,
                    choice ? *choice : ignored);
}

TEST_CASE("a result's linear fit is a model") {
  const Model model = read(result(preload("low", both(), "\"rig.json\"")), "low", "linear");
  CHECK(model.name == "linear");
  CHECK(model.preload == "low");
  CHECK(model.rig.name == "the bench");
  REQUIRE(model.joints.size() == 1);
  REQUIRE(model.joints[0].link.size() == 3);
  REQUIRE(model.joints[0].motor.size() == 4);
  const Estimate& inertia = model.joints[0].link[0].parameters[0];
  CHECK(inertia.value == 0.408);
  CHECK(inertia.sd == 0.037);
  CHECK(inertia.ci_high == 0.48);
  CHECK(inertia.unit == "kg m^2");
  CHECK(model.joints[0].link[2].parameters[0].not_identifiable == "the link never reversed");
  CHECK(model.transmission.cables.empty());
  CHECK(model.transmission.linear_stiffness[0] == 1819.2);
  CHECK(model.transmission.theta_0[0] == 0.001);
  REQUIRE(model.elastic.size() == 2);
  CHECK(model.elastic[0].sd == 4);
  CHECK(model.elastic[1].name == "f_sm");
}

TEST_CASE("a result's polynomial fit is a model") {
  const Model model = read(result(preload("low", both())), "low", "poly");
  CHECK(model.rig.path.empty());
  REQUIRE(model.transmission.cables.size() == 2);
  CHECK(model.transmission.cables[0].coefficients == std::vector<double>{1367.7, 37844.1});
  CHECK(model.transmission.cables[1].coefficients == std::vector<double>{1575.3, 29357.2});
  CHECK(model.transmission.cables[1].initial_elongation == 0.0047);
  CHECK(model.elastic.size() == 5);
}

TEST_CASE("a result's rigid fit is a model") {
  const Model model = read(result(preload("", kRigidFit)), "", "");
  CHECK(model.rigid);
  CHECK(model.joints[0].link.empty());
  CHECK(model.joints[0].motor.size() == 4);
}

TEST_CASE("a one-step fit lists the elastic parameters among the others") {
  std::string fit = kPolyFit;
  const auto elastic = fit.find("],\n  \"elastic\"");
  const auto list = fit.find("\"parameters\": [", elastic) + 15;
  fit = fit.substr(0, elastic) + "," + fit.substr(list, fit.size() - list - 2) + "}";
  const Model model = read(result(preload("low", fit)), "", "");
  CHECK(model.transmission.cables[1].coefficients == std::vector<double>{1575.3, 29357.2});
  CHECK(model.transmission.cables[1].initial_elongation == 0.0047);
}

TEST_CASE("what was not asked for is chosen, and said") {
  std::string choice;
  const std::string two = result(preload("low", both()) + "," + preload("high", both()));
  CHECK(read(two, "", "", &choice).name == "poly");
  CHECK(choice == "preload 'low' (of low, high), model 'poly' (of linear, poly)");
  CHECK(read(two, "high", "linear", &choice).preload == "high");
  CHECK(choice == "preload 'high', model 'linear'");
  CHECK(read(result(preload("low", kLinearFit)), "", "", &choice).name == "linear");
  CHECK(choice == "preload 'low', model 'linear'");
}

struct BadResult {
  std::string preload, model, replace, with, message;
};

const BadResult kBadResults[] = {
    {"lo", "", "", "", "dynamic.json:1:71: unknown preload 'lo'; did you mean 'low'?"},
    {"", "polly", "", "", "dynamic.json:1:109: unknown model 'polly'; did you mean 'poly'?"},
    {"", "", "\"f_v\", \"value\": 5.601", "\"f_v\", \"value\": null",
     "dynamic.json:2:66: 'f_v' has no value; fit it from other data, or give a value"},
    {"", "", "\"f_v\", \"value\": 5.601", "\"f_w\", \"value\": 5.601",
     "dynamic.json:2:41: parameter 'f_w' belongs to no effect; see `cablefit list effects`"},
    {"", "", "{\"name\": \"J_link\", \"value\": 0.339}, ", "",
     "dynamic.json:1:110: the link of joint '1' has no positive inertia; give its \"inertia\" a "
     "value above 0"},
    {"", "", "{\"name\": \"K2_0\", \"value\": 1575.3},", "",
     "dynamic.json:1:110: parameter 'K2_0' is missing; the fit's \"elastic\" object needs it"},
    {"", "", "\"rig\": null", "\"rig\": \"gone.json\"",
     "dynamic.json:1:95: no rig file 'gone.json'; paths are relative to this file, or to the "
     "current folder"},
    {"", "", "cablefit/dynamic/1", "cablefit/elastic/1",
     "dynamic.json:1:12: schema 'cablefit/elastic/1' is not a model; expected "
     "'cablefit/model/1', or 'cablefit/dynamic/1' as `cablefit dynamic` writes it"},
};

TEST_CASE("a result that is not a model says why") {
  for (const BadResult& bad : kBadResults) {
    std::string text = result(preload("low", kPolyFit));
    const auto at = text.find(bad.replace);
    REQUIRE(at != std::string::npos);
    text.replace(at, bad.replace.size(), bad.with);
    INFO(bad.preload << bad.model << bad.replace << " -> " << bad.with);
    const TempFolder folder;
    const std::string path = folder.write("dynamic.json", text);
    std::string choice;
    CHECK(message_of([&] { (void)read_model(path, bad.preload, bad.model, choice); },
                     folder.path().string()) == bad.message);
  }
}

TEST_CASE("a torque hold that the rig file leaves open is what stage 2 found") {
  const auto hold = [](const std::string& rig, const std::string& held) {
    std::string text = preload("low", kPolyFit, rig);
    text.insert(1, R"("torque_delay": {"held": )" + held + "}, ");
    return read(result(text), "", "").rig.torque_hold;
  };
  CHECK(hold("null", "true") == TorqueHold::zoh);
  CHECK(hold("null", "false") == TorqueHold::none);
  CHECK(hold(R"({"torque_hold": "none"})", "true") == TorqueHold::none);
}

}  // namespace

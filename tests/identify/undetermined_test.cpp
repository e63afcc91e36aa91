// Parameters that the logs do not determine are marked so everywhere: parameters, result file,
// trace and model file agree on each number.
#include <nlohmann/json.hpp>

#include "cablefit/identify/identify.hpp"
#include "cablefit/report/writers/trace_csv.hpp"
#include "cablefit/results/write/identify_json.hpp"
#include "tests/identify/simulated_rigs.hpp"
#include "tests/report/schema.hpp"
#include "tests/support/message.hpp"
#include "tests/support/plain_rigs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

// Both cables always taut and linear, blocked and moving: only K1_0 + K2_0 is in the logs.
TEST_CASE("what is not identifiable is so in every file", "[identify]") {
  truth::Rig rig = truth::Rig::low();
  rig.cable_1 = {{1900}, 0.2};
  rig.cable_2 = {{1700}, 0.38 / 1.7};
  PreloadedBench bench;
  bench.add("tight", blocked_log(rig, 5, 0.01));
  bench.add("tight", moving_log(rig, 6, 0));
  IdentifyOptions options;
  options.order = 1;
  options.elongations = ElongationMode::search;
  options.recursive = true;
  options.figures = true;
  const IdentifyResult r = identify(bench.logs(), options);
  const IdentifyPreload& p = r.preloads.at(0);
  CHECK(!p.model.has_value());
  CHECK(warns(p.warnings, "no model file: K1_0 is not identifiable"));
  CHECK(p.slack.empty());
  REQUIRE(r.trace.has_value());
  for (std::size_t k = 0; k < r.trace->names.size(); ++k) {
    const bool is_coefficient = r.trace->names[k].starts_with("K");
    for (const TracePoint& point : r.trace->points)
      if (is_coefficient) CHECK((std::isnan(point.value[k]) && std::isnan(point.sd[k])));
    if (!is_coefficient) CHECK(std::isfinite(r.trace->points.back().value[k]));
  }
  const std::string text = identify_json(r);
  CHECK(schema_errors("identify", text) == "");
  for (const auto& cable : nlohmann::json::parse(text)["preloads"][0]["cables"])
    CHECK(cable["initial_elongation"].is_null());
  for (const Figure& figure : r.figures) CHECK(figure.group != "cables");
}

// Reweighing must not drift to weights for which one row at the end of the sweep separates the
// cables.
TEST_CASE("cables in closure stay open however often they are weighed", "[identify]") {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    PlainRig rig;
    rig.joints = {PlainJoint{}};
    rig.joints[0].sweep = 0.0135;
    rig.cables = {{"a", {round_map(0.05)}, {round_map(0.05)}, {5e5}, 1e-3},
                  {"b", {round_map(-0.05)}, {round_map(-0.05)}, {4e5}, 1.25e-3}};
    Bench bench;
    bench.rig = read_rig(bench.folder().write("rig.json", rig_text(rig, "")));
    bench.add_text(blocked_log(rig, {0}, 30, seed));
    IdentifyOptions options;
    options.elongations = ElongationMode::search;
    const IdentifyResult r = identify(bench.logs(), options);
    for (const char* name : {"k[a]_0", "k[b]_0"})
      CHECK(estimate(r.parameters, name)
                .not_identifiable.find("determined is 0.0025 k[a]_0 + 0.0025 k[b]_0 = 22") !=
            std::string::npos);
  }
}

// The intervals of l_o in the model file are those of the profiles.
TEST_CASE("the model has the intervals of the profiles", "[identify]") {
  PreloadedBench bench;
  bench.add("high", blocked_log(truth::Rig::high(), 15));
  bench.add("high", moving_log(truth::Rig::high(), 16, 20));
  IdentifyOptions options;
  options.elongations = ElongationMode::search;
  const IdentifyResult r = identify(bench.logs(), options);
  REQUIRE(r.preloads.at(0).model.has_value());
  REQUIRE(r.profiles.size() == 2);
  for (const ElongationProfile& profile : r.profiles) {
    const Estimate& e = estimate(r.preloads[0].model->elastic, profile.name);
    // What the method itself is off by is part of the interval and of no profile.
    CHECK(e.ci_low <= profile.low);
    CHECK(e.ci_high >= profile.high);
    CHECK(e.ci_high - e.ci_low < 1.5 * (profile.high - profile.low));
  }
}

/// Cable 2 hangs loose: the spring pulls with it, and its coefficient would be negative.
TEST_CASE("a coefficient that its bound holds has an interval", "[identify]") {
  PreloadedBench bench;
  truth::Rig rig = truth::Rig::low();
  rig.cable_1 = {{1500}, 0};
  rig.cable_2 = {{-40}, 0};
  bench.add("odd", blocked_log(rig, 25));
  IdentifyOptions options;
  options.order = 1;
  for (const bool robust : {true, false}) {
    options.robust_sd = robust;
    const IdentifyResult r = identify(bench.logs(), options);
    const Estimate& e = estimate(r.parameters, "K2_0");
    CHECK(e.active_bound == "cable 2 only pulls");
    CHECK(e.value == 0);
    CHECK(e.sd > 0);
    CHECK(e.sd_white > 0);
    CHECK((robust ? e.sd >= e.sd_white : e.sd == e.sd_white));
    CHECK(e.ci_low == 0);
    // Honest: by profile, the shorter the further beyond the bound the free estimate lies. White:
    // t of many degrees of freedom is 1.96.
    CHECK(e.profiled == robust);
    CHECK(e.ci_high > (robust ? 0 : 1.9 * e.sd));
    CHECK(e.ci_high < 2.1 * e.sd);
    REQUIRE(r.active_bounds.size() == 1);
    CHECK(r.active_bounds[0].starts_with("cable 2: k(l) >= 0 at l = "));
    CHECK(std::any_of(r.warnings.begin(), r.warnings.end(), [](const std::string& warning) {
      return warning.starts_with(
                 "not used: plain least squares gives a negative cable stiffness; ") &&
             warning.ends_with("; --unconstrained gives the plain fit");
    }));
  }
}

TEST_CASE("a cable that is never taut says so", "[identify]") {
  PreloadedBench bench;
  truth::Rig rig = truth::Rig::low();
  rig.cable_2.initial_elongation = -0.2;
  bench.rig.transmission.cables[1].initial_elongation = -0.2;
  bench.rig.cables_given = true;
  bench.add("loose", blocked_log(rig, 35, 0.03));
  const IdentifyResult r = identify(bench.logs(), {});
  for (const char* name : {"k[2]_0", "k[2]_1"})
    CHECK(estimate(r.parameters, name).not_identifiable == "cable 2 was never taut in these logs");
  CHECK(estimate(r.parameters, "k[1]_0").not_identifiable.empty());
}

// Of l_o[1] and l_o[2] nothing is known, and offset has nothing to do with it.
TEST_CASE("only what moves along is named", "[identify]") {
  PreloadedBench bench;
  truth::Rig rig = truth::Rig::low();
  rig.cable_1 = {{1900}, 0.03};
  rig.cable_2 = {{1700}, 0.057 / 1.7};
  bench.add("tight", blocked_log(rig, 5, 0.01));
  bench.add("also", blocked_log(rig, 6, 0.01));
  IdentifyOptions options;
  options.order = 1;
  options.elongations = ElongationMode::search;
  const IdentifyResult r = identify(bench.logs(), options);
  const std::string why = estimate(r.parameters, "K1_0").not_identifiable;
  INFO(why);
  CHECK(why.starts_with("is not separable from K2_0"));
  CHECK(why.find("offset") == std::string::npos);
  CHECK(why.find("f_sm") == std::string::npos);
}

TEST_CASE("traces and profiles of a linear axis have its units", "[identify]") {
  PreloadedBench bench;
  bench.rig.axes = JointAxes({Axes::linear});
  bench.add("a,\"b\"", blocked_log(truth::Rig::low(), 45));
  bench.add("=c", blocked_log(stretched(5e-3), 46));
  IdentifyOptions options;
  options.recursive = true;
  const IdentifyResult r = identify(bench.logs(), options);
  for (const ElongationProfile& profile : r.profiles) CHECK(profile.unit == "m");
  const std::string csv = trace_csv(*r.trace);
  CHECK(csv.starts_with("rows,record,K1_0 (all) [N/m],sd K1_0 (all) [N/m],"));
  CHECK(csv.find("\"offset (a,\"\"b\"\") [N]\"") != std::string::npos);
  CHECK(csv.find("\n871,\"a,\"\"b\"\", blocked\",") == std::string::npos);
  CHECK(csv.find("rad") == std::string::npos);
  CHECK(csv.find(",'=c, blocked") == std::string::npos);  // a comma needs quotes
  CHECK(csv.find("\"'=c, blocked\"") != std::string::npos);
}

}  // namespace

// The factor of a torque column is checked by a known load; without one, a check says so.
#include "cablefit/samples/check.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

std::string log_text(double load) {
  std::string text = "t,q,theta,current,load\n";
  for (int i = 0; i < 2000; ++i) {
    const double t = 0.001 * i, q = 0.3 * std::sin(6 * t);
    text += fmt::format("{:.3f},{:.6f},{:.6f},{:.5f},{}\n", t, q, q + 1e-3 * std::sin(6 * t),
                        5 * std::sin(6 * t) - load / 0.5, load);
  }
  return text;
}

std::vector<std::string> warnings_of(const std::string& rig, double load) {
  Bench bench = bench_of(rig);
  bench.add_text(log_text(load));
  return check_logs(bench.logs(), {}).warnings;
}

const std::string kScaled = R"({"columns": {"tau": {"column": "current", "scale": 0.5})";

TEST_CASE("a torque that was scaled without a known load is told", "[check]") {
  const std::string told =
      "tau is 0.5 times column 'current', and no log has a known load to check this factor: if it "
      "is wrong, so are all stiffnesses, inertias and frictions; record a log with a known load";
  CHECK(warnings_of(kScaled + "}}", 0) == std::vector<std::string>{told});
  // A column of zeros is no load.
  CHECK(warnings_of(kScaled + R"(, "tau_load": "load"}})", 0) == std::vector<std::string>{told});
}

TEST_CASE("a torque that a load can weigh, or that was not scaled, is not told", "[check]") {
  CHECK(warnings_of(kScaled + R"(, "tau_load": "load"}})", 3).empty());
  CHECK(warnings_of(kScaled + R"(}, "load": {"type": "constant", "torque": 3}})", 3).empty());
  CHECK(warnings_of(R"({"columns": {"tau": "current"}})", 0).empty());
  CHECK(warnings_of(R"({"columns": {"tau": {"column": "current", "scale": -1}}})", 0).empty());
}

}  // namespace

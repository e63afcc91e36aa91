// What a log of several joints is good for.
#include "cablefit/samples/check.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

const std::string kTwoJoints = R"({"joints": [{"name": "1"}, {"name": "2"}])";

/// A log whose joints have these channels; `still`: the second joint does not move.
std::string log_text(const std::vector<std::string>& channels, bool still) {
  std::string text = "t";
  for (const std::string& channel : channels) text += fmt::format(",{0}1,{0}2", channel);
  text += "\n";
  for (int i = 0; i < 2000; ++i) {
    const double s = std::sin(0.006 * i);
    text += fmt::format("{:.3f}", 0.001 * i);
    for (std::size_t k = 0; k < channels.size(); ++k)
      text += fmt::format(",{:.6f},{:.6f}", 0.3 * s, still ? 0.1 : 0.2 * s);
    text += "\n";
  }
  return text;
}

std::vector<std::string> good_for(const std::vector<std::string>& channels, bool still = false) {
  Bench bench = bench_of(kTwoJoints + "}");
  bench.add_text(log_text(channels, still));
  return check_logs(bench.logs(), {}).logs.front().parts.front().identifies;
}

TEST_CASE("several joints without links are good for rigid drives", "[check]") {
  CHECK(good_for({"theta", "tau"}) == std::vector<std::string>{"rigid"});
  CHECK(good_for({"q", "tau"}) == std::vector<std::string>{"rigid"});
}

TEST_CASE("several joints with links are good for both", "[check]") {
  CHECK(good_for({"q", "theta", "tau"}) == std::vector<std::string>{"dynamic", "rigid"});
}

TEST_CASE("a joint without torque or motion is good for nothing", "[check]") {
  CHECK(good_for({"q", "theta"}).empty());
  CHECK(good_for({"theta", "tau"}, true).empty());
}

}  // namespace

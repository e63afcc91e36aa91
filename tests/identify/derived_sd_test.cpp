// Derived quantities have the error of the parameters that they are made of, the method's own
// included.
#include "cablefit/identify/identify.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

// A cable goes slack where the deflection takes back its l_o.
TEST_CASE("where a cable goes slack is as sure as its l_o", "[identify]") {
  IdentifyOptions options;
  options.elongations = ElongationMode::search;
  const std::vector<LogSurvey> logs{shipped("high/blocked.csv"), shipped("high/moving_load30.csv")};
  const IdentifyPreload found = identify(logs, options).preloads.at(0);
  for (const std::string cable : {"[1]", "[2]"}) {
    const Estimate& l_o = estimate(found.parameters, "l_o" + cable);
    const Estimate& slack = estimate(found.derived, "phi_slack" + cable);
    CHECK(std::abs(slack.value) == Approx(l_o.value).epsilon(1e-9));
    // By a numerical derivative.
    CHECK(slack.sd == Approx(l_o.sd).epsilon(1e-5));
  }
}

}  // namespace

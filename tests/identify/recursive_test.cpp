// R-LSA: the trace ends at the direct fit, and its band shrinks on the way.
#include "cablefit/identify/results/recursive.hpp"

#include "cablefit/report/writers/trace_csv.hpp"
#include "tests/identify/simulated_rigs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

TEST_CASE("recursive least squares ends at the direct answer", "[identify]") {
  const std::vector<LogSurvey> logs = {shipped("low/blocked.csv"), shipped("low/moving_load30.csv"),
                                       shipped("high/blocked.csv"),
                                       shipped("high/moving_load-40.csv")};
  IdentifyOptions options;
  options.recursive = true;
  const IdentifyResult r = identify(logs, options);
  REQUIRE(r.trace.has_value());
  const RecursiveTrace& trace = *r.trace;
  const TracePoint& end = trace.points.back();
  REQUIRE(trace.points.size() > 300);  // two records of two preloads
  std::size_t compared = 0;
  for (std::size_t k = 0; k < trace.names.size(); ++k) {
    INFO(trace.names[k] << " (" << trace.preloads[k] << ")");
    const Estimate* direct = find_estimate(r.parameters, trace.names[k]);
    for (const IdentifyPreload& preload : r.preloads)
      if (preload.name == trace.preloads[k])
        direct = find_estimate(preload.parameters, trace.names[k]);
    if (direct == nullptr) continue;  // f_vm_blocked is not reported
    ++compared;
    // Both by QR of the same rows in another order; the condition number of the scaled columns is
    // about 100, so ten digits and more are left.
    CHECK_THAT(end.value[k], Catch::WithinRel(direct->value, 1e-9));
    CHECK_THAT(end.sd[k], Catch::WithinRel(direct->sd, 1e-12));
    const TracePoint& early = trace.points[trace.points.size() / 2];
    CHECK((std::isnan(early.sd[k]) || early.sd[k] >= end.sd[k]));
  }
  CHECK(compared == 4 + 2 * 8);
  // Of the high preload nothing is known before its logs come.
  const auto offset_high = static_cast<std::size_t>(
      std::find(trace.preloads.begin(), trace.preloads.end(), "high") - trace.preloads.begin());
  CHECK(std::isnan(trace.points.front().value[offset_high]));
  const std::string csv = trace_csv(trace);
  CHECK(csv.starts_with("rows,record,K1_0 (all) [N m/rad],sd K1_0 (all) [N m/rad],"));
  CHECK(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) ==
        trace.points.size() + 1);
}

}  // namespace

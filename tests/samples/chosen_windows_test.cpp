// Windows that are chosen are those that all windows have, whether the other samples are read or
// not.
#include "cablefit/samples/survey/chosen_windows.hpp"

#include <vector>

#include "tests/samples/rows_of_logs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

std::vector<Window> every_third(const LogSurvey& log, bool at_once) {
  std::vector<Window> windows;
  int n = 0;
  const auto chosen = [&](const WindowPlace&) { return n++ % 3 == 1; };
  const auto keep = [&](const Window& window) { windows.push_back(window); };
  if (at_once) {
    for_chosen_windows(log, kAllParts, 10, 0, chosen, keep);
  } else {
    for_each_window(log, kAllParts, 0, 10, 0, [&](Window&& window) {
      if (chosen(window)) keep(window);
      return true;
    });
  }
  return windows;
}

void check_same(const LogSurvey& log) {
  const std::vector<Window> found = every_third(log, true), expected = every_third(log, false);
  REQUIRE(found.size() == expected.size());
  REQUIRE(!found.empty());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Window &a = found[k], &b = expected[k];
    CHECK((a.part == b.part && a.segment == b.segment && a.period == b.period && a.t0 == b.t0));
    CHECK((a.begin == b.begin && a.end == b.end && a.first == b.first));
    CHECK((a.starts_segment == b.starts_segment && a.ends_segment == b.ends_segment));
    CHECK(a.rows_before == b.rows_before);
    CHECK(a.data == b.data);
  }
}

/// Rows [from, to) moved in time, s.
Columns moved(Columns log, std::size_t from, std::size_t to, double by) {
  for (std::size_t i = from; i < to; ++i) log.columns[0].second[i] += by;
  return log;
}

TEST_CASE("chosen windows are those of all windows", "[samples]") {
  const Eigen::Index n = 5 * kWindowRows;
  const auto n_rows = static_cast<std::size_t>(n);
  for (const Eigen::Index more : {-1, 0, 1, 17}) {
    Bench bench;
    check_same(bench.add_text(noisy_log(n + more, 6000).csv()));
  }
  const Columns steady = noisy_log(n, 6001);
  Bench late, gap, lost;
  check_same(late.add_text(moved(steady, 3000, 3001, 2e-4).csv()));     // one row late
  check_same(gap.add_text(moved(steady, 20000, n_rows, 0.5).csv()));    // a gap
  check_same(lost.add_text(moved(steady, 20000, n_rows, 2e-3).csv()));  // two rows lost
}

}  // namespace

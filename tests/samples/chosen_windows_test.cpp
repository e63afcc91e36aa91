// Windows that are chosen are those that all windows have, whether the other samples are read or
// not.
#include "cablefit/samples/survey/chosen_windows.hpp"

#include <vector>

#include "tests/samples/rows_of_logs.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

struct Chosen {
  std::vector<Window> windows;
  WindowCounts counts;
};

Chosen every_nth(const LogSurvey& log, int n, Eigen::Index halo, bool at_once) {
  Chosen out;
  int k = 0;
  const auto chosen = [&](const WindowPlace&) { return k++ % n == n / 2; };
  const auto keep = [&](Window&& window) {
    out.windows.push_back(std::move(window));
    return true;
  };
  out.counts = at_once ? for_chosen_windows(log, kAllParts, halo, 10, 0, chosen, keep)
                       : for_each_window(log, kAllParts, halo, 10, 0, [&](Window&& window) {
                           return !chosen(window) || keep(std::move(window));
                         });
  return out;
}

void check_same(const LogSurvey& log, int n, Eigen::Index halo) {
  const Chosen at_once = every_nth(log, n, halo, true), one_by_one = every_nth(log, n, halo, false);
  CHECK(at_once.counts.rows_out == one_by_one.counts.rows_out);
  CHECK(at_once.counts.segments == one_by_one.counts.segments);
  const std::vector<Window>&found = at_once.windows, &expected = one_by_one.windows;
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

void check_same(const LogSurvey& log) {
  check_same(log, 3, 0);
  check_same(log, 2, 200);
  check_same(log, 1, 40);  // windows side by side have rows in common
}

/// Rows [from, to) moved in time, s.
Columns moved(Columns log, std::size_t from, std::size_t to, double by) {
  for (std::size_t i = from; i < to; ++i) log.columns[0].second[i] += by;
  return log;
}

TEST_CASE("chosen windows are those of all windows", "[samples]") {
  const Eigen::Index n = 5 * kWindowRows;
  const auto n_rows = static_cast<std::size_t>(n);
  for (const Eigen::Index more : {-1, 0, 1, 17, 40, 41, 200, 201}) {
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

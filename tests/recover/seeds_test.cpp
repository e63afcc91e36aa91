// Both stages on simulated logs of many seeds, counted up from one base: bias, and sd against the
// scatter that really occurs.
#include "tests/recover/both_stages.hpp"
#include "tests/support/monte_carlo.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr std::uint64_t kBaseSeed = 1000;

std::vector<RunTable> many_runs(const truth::Rig& rig, const NamedValues& truth, int n_runs) {
  std::vector<RunTable> tables;
  for (const auto& [name, value] : truth) tables.push_back({name, value, {}, {}, 0, 0});
  std::uint64_t seed = kBaseSeed;
  for (int run = 0; run < n_runs; ++run) {
    const std::vector<Estimate> found = both_stages(rig, seed);
    for (RunTable& table : tables) table.add(estimate(found, table.name));
  }
  return tables;
}

int n_runs() { return full_monte_carlo() ? 200 : 20; }

/// A mean within 1 % of the truth, or within three standard errors of it (the offset is a tenth of
/// the torque's noise: no log determines it to one per cent), or within `floor`.
void check_mean(const RunTable& t, double floor = 0) {
  INFO(t.name << ": mean " << t.mean() << " +- " << t.standard_error() << ", true " << t.truth);
  CHECK(std::abs(t.bias()) < std::max({0.01 * std::abs(t.truth), 3 * t.standard_error(), floor}));
}

/// The scatter of n runs is known to 1/sqrt(2 (n - 1)) of itself: it may be three of those too
/// large.
double smallest_ratio() { return 1 / (1 + 3 / std::sqrt(2.0 * (n_runs() - 1))); }

TEST_CASE("20 seeds at low preload: unbiased, with honest sd", "[recover][monte-carlo]") {
  NamedValues truth = dynamic_truth(truth::Rig::low());
  const NamedValues cables = elastic_truth(truth::Rig::low());
  truth.insert(truth.end(), cables.begin(), cables.end());
  const std::vector<RunTable> tables = many_runs(truth::Rig::low(), truth, n_runs());
  RunTable::print_header("both stages, low preload, 40 s blocked and 2 x 8 s moving");
  double covered = 0;
  for (const RunTable& t : tables) {
    t.print();
    check_mean(t);
    INFO(t.name << ": mean sd / scatter " << t.mean_sd() / t.scatter());
    CHECK(t.mean_sd() > smallest_ratio() * t.scatter());
    covered += t.share_two_sd() / static_cast<double>(tables.size());
  }
  std::printf("    within 2 sd, all parameters: %.1f %%\n", 100 * covered);
  // 95.4 % expected. Eleven parameters, of which about five are independent: a share over 100
  // independent estimates has an sd of 2.1 %, three of them.
  CHECK(covered > 0.954 - 3 * 0.021);
}

// Stage 1 does not know l_o and follows the curve with polynomials to within 1 N m (0.6 % of the
// peak torque): that, not noise, is what stage 2 is off by. Means stay within 1 %, the offset
// (0.0186 N m) within 0.05 N m of the truth; its sd contains the curve's and covers. J_link is 0.2
// % low at an sd of 0.1 %, so its interval covers only every second time: printed, not asserted.
TEST_CASE("20 seeds at high preload: within one per cent", "[recover][monte-carlo]") {
  const std::vector<RunTable> tables =
      many_runs(truth::Rig::high(), dynamic_truth(truth::Rig::high()), n_runs());
  RunTable::print_header("both stages, high preload, 40 s blocked and 2 x 8 s moving");
  for (const RunTable& t : tables) {
    t.print();
    check_mean(t, t.name == "offset" ? 0.05 : 0);
    CHECK(t.mean_sd() > smallest_ratio() * t.scatter());
  }
}

}  // namespace

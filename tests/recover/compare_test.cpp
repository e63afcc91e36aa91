// `compare` on campaigns that differ by noise only, and by one real change.
#include "cablefit/campaign/compare/compare.hpp"

#include "tests/recover/both_stages.hpp"
#include "tests/support/monte_carlo.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

constexpr std::uint64_t kBaseSeed = 50000;
constexpr double kChange = 3.6;  // sd of the difference

int n_pairs() { return full_monte_carlo() ? 500 : 40; }

RecordedResult result_of(std::vector<Estimate> estimates, int number) {
  RecordedResult result;
  result.inputs = {{"log", std::to_string(number), 0}};
  EstimateSet set{"stage 2", "low", "poly", "wls"};
  set.torque_scale = 4;
  // Of stage 2 alone, as Table 2 has it.
  std::erase_if(estimates, [](const Estimate& e) { return e.name.front() == 'K'; });
  set.estimates = std::move(estimates);
  result.sets = {set};
  return result;
}

struct Pair {
  RecordedResult first, second;
};

const std::vector<Pair>& pairs() {
  static const std::vector<Pair> all = [] {
    std::vector<Pair> made;
    std::uint64_t seed = kBaseSeed;
    for (int k = 0; k < n_pairs(); ++k)
      made.push_back({result_of(both_stages(truth::Rig::low(), seed), 2 * k),
                      result_of(both_stages(truth::Rig::low(), seed), 2 * k + 1)});
    return made;
  }();
  return all;
}

double share(int n) { return static_cast<double>(n) / n_pairs(); }

// 3.29 sd of a binomial share: 99.9 % of all runs.
double band(double p) { return 3.29 * std::sqrt(p * (1 - p) / n_pairs()); }

TEST_CASE("nothing changed: at most 5 % of pairs differ anywhere", "[recover][monte-carlo]") {
  int different = 0;
  for (const Pair& pair : pairs())
    different += compare(pair.first, pair.second, {}).count(Sameness::different) > 0;
  std::printf("    pairs without a change called different: %.1f %%\n", 100 * share(different));
  CHECK(share(different) <= 0.05 + band(0.05));
}

// Sidak's 5 % over seven parameters is 2.69 sd; what is 3.6 sd away passes it in Phi(0.91) = 82 %.
TEST_CASE("a change of 3.6 sd is found in 80 %", "[recover][monte-carlo]") {
  int found = 0, wrong = 0;
  for (std::size_t k = 0; k < pairs().size(); ++k) {
    Pair pair = pairs()[k];
    auto& estimates = pair.second.sets.front().estimates;
    const std::size_t at = k % estimates.size();
    const double sd = std::hypot(estimates[at].sd, pair.first.sets.front().estimates[at].sd);
    estimates[at].value += kChange * sd;
    estimates[at].ci_low += kChange * sd;
    estimates[at].ci_high += kChange * sd;
    const CompareResult result = compare(pair.first, pair.second, {});
    for (const ComparedParameter& p : result.parameters) {
      const bool is_changed = p.name == estimates[at].name;
      (is_changed ? found : wrong) += p.sameness == Sameness::different;
    }
  }
  std::printf("    changes of %.1f sd found: %.1f %%\n", kChange, 100 * share(found));
  CHECK(share(found) >= 0.80 - band(0.82));
  CHECK(share(wrong) <= 0.05 + band(0.05));
}

}  // namespace

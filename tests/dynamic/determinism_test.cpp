// The same bits from run to run and whatever the number of threads, both stages.
#include <cstring>

#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

void append(std::vector<double>& all, const std::vector<Estimate>& estimates) {
  for (const Estimate& e : estimates)
    all.insert(all.end(), {e.value, e.sd, e.sd_white, e.ci_low, e.ci_high});
}

std::vector<double> elastic_numbers(const ElasticResult& result) {
  std::vector<double> all;
  for (const ElasticPreload& p : result.preloads) {
    all.insert(all.end(), {p.deflection_low, p.deflection_high, p.peak_torque, p.loop_half_width});
    for (const ElasticFit& f : p.fits) {
      append(all, f.parameters);
      all.insert(all.end(), {f.offset, f.rms_error, f.max_abs_error, f.held_out_rms, f.held_out_max,
                             f.condition, f.effective_rows});
      all.insert(all.end(), f.covariance.data(), f.covariance.data() + f.covariance.size());
    }
  }
  return all;
}

std::vector<double> dynamic_numbers(const DynamicResult& result) {
  std::vector<double> all;
  for (const DynamicPreload& p : result.preloads) {
    all.insert(all.end(), {p.resonance, p.delay.seconds, p.delay.sd});
    for (const DynamicFit& f : p.fits) {
      append(all, f.parameters);
      for (const auto& [name, e] : f.torque_error)
        all.insert(all.end(), {e.rms, e.max_abs, e.relative});
      for (const auto* map : {&f.weight, &f.condition, &f.effective_rows})
        for (const auto& [name, value] : *map) all.push_back(value);
    }
  }
  return all;
}

struct Numbers {
  std::vector<double> elastic, dynamic;
};

Numbers numbers(int threads) {
  const std::vector<LogSurvey> blocked = {shipped("high/blocked.csv")};
  const std::vector<LogSurvey> moving = {shipped("high/moving_load30.csv"),
                                         shipped("high/moving_load-40.csv")};
  ElasticOptions first;
  first.samples.threads = threads;
  DynamicOptions second;
  second.samples.threads = threads;
  second.models = {"linear", "poly"};
  const ElasticResult elastic = fit_elastic(blocked, first);
  return {elastic_numbers(elastic), dynamic_numbers(fit_dynamic(moving, elastic, second))};
}

// memcmp: NaN equals NaN, and -0 does not equal 0.
bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST_CASE("results have the same bits for any number of threads and every run", "[dynamic]") {
  const Numbers one = numbers(1);
  REQUIRE(one.elastic.size() > 50);
  REQUIRE(one.dynamic.size() > 80);
  for (const int threads : {1, 2, 3}) {
    const Numbers again = numbers(threads);
    INFO(threads << " threads");
    CHECK(same_bits(one.elastic, again.elastic));
    CHECK(same_bits(one.dynamic, again.dynamic));
  }
}

}  // namespace

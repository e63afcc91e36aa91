// A link without a load: its equation has nothing but the elastic torque on the other side.
#include "tests/recover/both_stages.hpp"
#include "tests/support/recover.hpp"

namespace {

using namespace cablefit;
using namespace cablefit::test;

DynamicFit fit_without_load(const std::string& model, unsigned seed) {
  Bench bench;
  truth::BlockedOptions blocked;
  blocked.duration = 40;
  blocked.seed = seed;
  bench.add(truth::simulate_blocked(truth::Rig::low(), blocked));
  truth::MovingOptions moving;
  moving.duration = 10;
  moving.seed = seed + 1;
  bench.add(truth::simulate_moving(truth::Rig::low(), moving));
  DynamicOptions options;
  options.models = {model};
  const ElasticResult stage1 = fit_elastic(bench.logs().first(1), {});
  return fit_dynamic(bench.logs().last(1), stage1, options).preloads.at(0).fits.at(0);
}

TEST_CASE("J_link of a link without a load is determined by stage 1", "[recover]") {
  NamedValues truth = dynamic_truth(truth::Rig::low());
  std::erase_if(truth, [](const auto& named) { return named.first != "J_link"; });
  for (const unsigned seed : {501U, 503U, 505U})
    check_recovered(fit_without_load("poly", seed).parameters, truth, 3);
}

TEST_CASE("a straight spring does not determine J_link of a link without a load", "[recover]") {
  const DynamicFit linear = fit_without_load("linear", 507);
  const std::string& why = estimate(linear.parameters, "J_link").not_identifiable;
  INFO(why);
  CHECK(why.starts_with("sensitive to the stiffness model: "));
  CHECK(why.ends_with("with a free position-dependent torque; record a log with a known load"));
}

}  // namespace

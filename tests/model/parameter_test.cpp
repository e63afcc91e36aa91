#include "cablefit/base/parameter.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace {

using namespace cablefit;

TEST_CASE("the relative sd is that of the value's size, or none") {
  Estimate estimate;
  CHECK(std::isnan(estimate.rsd_percent()));
  estimate.value = -4;
  CHECK(std::isnan(estimate.rsd_percent()));
  estimate.sd = 0.2;
  CHECK(estimate.rsd_percent() == 5);
  estimate.value = 0;
  CHECK(std::isnan(estimate.rsd_percent()));
}

TEST_CASE("find_estimate goes by name") {
  std::vector<Estimate> estimates(2);
  estimates[0].name = "J_link";
  estimates[1].name = "f_v";
  CHECK(find_estimate(estimates, "f_v") == &estimates[1]);
  CHECK(find_estimate(estimates, "f_s") == nullptr);
}

}  // namespace

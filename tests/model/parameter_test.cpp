#include "cablefit/base/parameter.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace {

using namespace cablefit;

TEST_CASE("linear_unit turns torques, inertias and angles into forces, masses and lengths") {
  CHECK(linear_unit("rad") == "m");
  CHECK(linear_unit("rad/s") == "m/s");
  CHECK(linear_unit("rad/s^2") == "m/s^2");
  CHECK(linear_unit("N m") == "N");
  CHECK(linear_unit("kg m^2") == "kg");
  CHECK(linear_unit("N m s/rad") == "N s/m");
  CHECK(linear_unit("N m/rad") == "N/m");
  CHECK(linear_unit("N m/rad^2") == "N/m^2");
  CHECK(linear_unit("s") == "s");
  CHECK(linear_unit("") == "");
}

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

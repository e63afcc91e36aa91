// A cut-off near the resonance is worth a word where it puts J_motor off by more than half an sd.
#include "cablefit/dynamic/checks/low_cutoff.hpp"

#include <catch2/catch.hpp>

namespace {

using namespace cablefit;

Estimate j_motor() {
  Estimate e;
  e.name = "J_motor";
  e.value = 0.013;
  e.sd = 0.0001;
  return e;
}

TEST_CASE("the error of J_motor is told with its size and its method", "[dynamic]") {
  CHECK(low_cutoff_warning(150, 80, j_motor(), 0.00008, true) ==
        "the cut-off of 150 Hz is below twice the free resonance under load, 80 Hz: J_motor is "
        "wrong by about 0.62 % (0.8 sd, contained in the sd), as a fit to a simulated copy "
        "without disturbances shows; record at a higher rate or with a finer encoder");
  const std::string white = low_cutoff_warning(150, 80, j_motor(), 0.0003, false);
  CHECK(white.find("2.3 % (3 sd, not contained in the sd)") != std::string::npos);
}

TEST_CASE("an error that is small beside the sd needs no word", "[dynamic]") {
  CHECK(low_cutoff_warning(150, 80, j_motor(), 0.00004, true).empty());
  CHECK(low_cutoff_warning(160, 80, j_motor(), 0.0003, true).empty());  // twice: enough
  CHECK(low_cutoff_warning(0, 80, j_motor(), 0.0003, true).empty());    // no filter
  CHECK(low_cutoff_warning(150, 0, j_motor(), 0.0003, true).empty());   // rigid
  Estimate unknown = j_motor();
  unknown.not_identifiable = "the motor does not accelerate";
  CHECK(low_cutoff_warning(150, 80, unknown, 0.0003, true).empty());
}

}  // namespace

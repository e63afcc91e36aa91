#include "cablefit/base/axes.hpp"

#include <catch2/catch.hpp>

namespace {

using namespace cablefit;

TEST_CASE("units of joints that slide: forces, masses and lengths") {
  CHECK(unit_for(Axes::linear, "rad") == "m");
  CHECK(unit_for(Axes::linear, "mrad") == "mm");
  CHECK(unit_for(Axes::linear, "rad/s") == "m/s");
  CHECK(unit_for(Axes::linear, "rad/s^2") == "m/s^2");
  CHECK(unit_for(Axes::linear, "N m") == "N");
  CHECK(unit_for(Axes::linear, "kg m^2") == "kg");
  CHECK(unit_for(Axes::linear, "N m s/rad") == "N s/m");
  CHECK(unit_for(Axes::linear, "N m/rad") == "N/m");
  CHECK(unit_for(Axes::linear, "N m/rad^2") == "N/m^2");
  CHECK(unit_for(Axes::linear, "s") == "s");
  CHECK(unit_for(Axes::linear, "") == "");
}

TEST_CASE("units of joints that turn, and of a rig with both") {
  CHECK(unit_for(Axes::rotary, "N m/rad") == "N m/rad");
  CHECK(unit_for(Axes::mixed, "N m/rad") == "N m/rad or N/m");
  CHECK(unit_for(Axes::mixed, "N/m") == "N/m");
  CHECK(unit_for(Axes::mixed, "s") == "s");
}

TEST_CASE("a rig of several joints has axes of one kind or both") {
  CHECK(JointAxes().all() == Axes::rotary);
  CHECK(JointAxes().of(6) == Axes::rotary);
  CHECK(JointAxes({Axes::linear, Axes::linear}).all() == Axes::linear);
  CHECK(JointAxes({Axes::rotary, Axes::rotary}) == JointAxes());
  const JointAxes both({Axes::rotary, Axes::linear});
  CHECK(both.all() == Axes::mixed);
  CHECK(both.of(0) == Axes::rotary);
  CHECK(both.of(1) == Axes::linear);
}

}  // namespace

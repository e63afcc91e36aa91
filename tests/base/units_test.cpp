#include "cablefit/base/units.hpp"

#include <catch2/catch.hpp>
#include <numbers>
#include <string>

#include "tests/support/message.hpp"

namespace cablefit {
namespace {

using test::message_of;

constexpr double kPi = std::numbers::pi;
constexpr Dimension kNumber{0, 0, 0, 0};
constexpr Dimension kPerSecond{0, 0, -1, 0};
constexpr Dimension kTorque{2, 1, -2, 0};
constexpr Dimension kInertia{2, 1, 0, 0};

struct Case {
  const char* text;
  double scale;
  Dimension dimension;
};

std::string unit_message(const std::string& text) {
  return message_of([&] { parse_unit(text); });
}

}  // namespace

TEST_CASE("units are read as people write them") {
  const Case c = GENERATE(values<Case>({
      {"", 1, kNumber},
      {"  ", 1, kNumber},
      {"-", 1, kNumber},
      {"1", 1, kNumber},
      {"%", 0.01, kNumber},
      {"rad", 1, kNumber},
      {"mrad", 1e-3, kNumber},
      {"deg", kPi / 180, kNumber},
      {"mdeg", kPi / 180e3, kNumber},
      {"°", kPi / 180, kNumber},
      {"grad", kPi / 200, kNumber},
      {"rev", 2 * kPi, kNumber},
      {"turn", 2 * kPi, kNumber},
      {"s", 1, {0, 0, 1, 0}},
      {"ms", 1e-3, {0, 0, 1, 0}},
      {"us", 1e-6, {0, 0, 1, 0}},
      {"\u00b5s", 1e-6, {0, 0, 1, 0}},
      {"\u03bcs", 1e-6, {0, 0, 1, 0}},
      {"min", 60, {0, 0, 1, 0}},
      {"h", 3600, {0, 0, 1, 0}},
      {"mm", 1e-3, {1, 0, 0, 0}},
      {"kg", 1, {0, 1, 0, 0}},
      {"mA", 1e-3, {0, 0, 0, 1}},
      {"V", 1, {2, 1, -3, -1}},
      {"kW", 1e3, {2, 1, -3, 0}},
      {"J", 1, kTorque},
      {"kN", 1e3, {1, 1, -2, 0}},
      {"Hz", 1, kPerSecond},
      {"kHz", 1e3, kPerSecond},
      {"1/s", 1, kPerSecond},
      {"s^-1", 1, kPerSecond},
      {"s-1", 1, kPerSecond},
      {"rpm", kPi / 30, kPerSecond},
      {"rev/min", kPi / 30, kPerSecond},
      {"deg/s", kPi / 180, kPerSecond},
      {"°/s", kPi / 180, kPerSecond},
      {"rad/s^2", 1, {0, 0, -2, 0}},
      {"rad/s2", 1, {0, 0, -2, 0}},
      {"m/s²", 1, {1, 0, -2, 0}},
      {"m/s/s", 1, {1, 0, -2, 0}},
      {"m s⁻²", 1, {1, 0, -2, 0}},
      {"N m", 1, kTorque},
      {"Nm", 1, kTorque},
      {"N*m", 1, kTorque},
      {"N.m", 1, kTorque},
      {"N·m", 1, kTorque},
      {"N-m", 1, kTorque},
      {"mNm", 1e-3, kTorque},
      {"mN m", 1e-3, kTorque},
      {"kNm", 1e3, kTorque},
      {"Nmm", 1e-3, kTorque},
      {"Ncm", 1e-2, kTorque},
      {"N / m", 1, {0, 1, -2, 0}},
      {"Nm/rad", 1, kTorque},
      {"Nms/rad", 1, {2, 1, -1, 0}},
      {"N m/(rad/s)", 1, {2, 1, -1, 0}},
      {"N m/(rad/s)^2", 1, {2, 1, 0, 0}},
      {"Nm/A", 1, {2, 1, -2, -1}},
      {"kg m^2", 1, kInertia},
      {"kgm2", 1, kInertia},
      {"kg·m²", 1, kInertia},
      {"g cm^2", 1e-7, kInertia},
      {"gcm2", 1e-7, kInertia},
      {"Vs", 1, {2, 1, -2, -1}},
  }));
  INFO(c.text);
  const Unit unit = parse_unit(c.text);
  // Scales are products of a few rounded factors: within 8 units in the last place.
  CHECK_THAT(unit.scale, Catch::Matchers::WithinRel(c.scale, 8 * 2.3e-16));
  CHECK(unit.dimension == c.dimension);
}

TEST_CASE("an unknown unit is named, with a near match") {
  CHECK(unit_message("degr") == "unknown unit 'degr'; did you mean 'deg'?");
  CHECK(unit_message("rads/s") == "unknown unit 'rads' in 'rads/s'; did you mean 'rad'?");
  CHECK(unit_message("foo") ==
        "unknown unit 'foo'; known: m, g, s, min, h, Hz, A, V, W, J, N, rad, deg, °, grad, rev, "
        "turn, rpm, %");
  CHECK(unit_message("N lightyear").starts_with("unknown unit 'lightyear' in 'N lightyear'; "));
}

TEST_CASE("a unit that breaks the grammar is shown") {
  const std::string hint = "; write it as N m, rad/s or m/s^2";
  CHECK(unit_message("m/") == "unit 'm/' lacks a unit at its end" + hint);
  CHECK(unit_message("m//s") == "unit 'm//s' lacks a unit at '/s'" + hint);
  CHECK(unit_message("m^") == "unit 'm^' has no integer after '^'" + hint);
  CHECK(unit_message("m^x") == "unit 'm^x' has no integer after '^'" + hint);
  CHECK(unit_message("m^10") == "unit 'm^10' has an exponent beyond 9" + hint);
  CHECK(unit_message("m^99999999999") == "unit 'm^99999999999' has an exponent beyond 9" + hint);
  CHECK(unit_message("m⁻") == "unit 'm⁻' has a sign without an exponent" + hint);
  CHECK(unit_message("s -1") == "unit 's -1' lacks a unit at '-1'" + hint);
  CHECK(unit_message("10 N") == "unit '10 N' lacks a unit at '0 N'" + hint);
  CHECK(unit_message("2 N") == "unit '2 N' lacks a unit at '2 N'" + hint);
  CHECK(unit_message("N/(m") == "unit 'N/(m' lacks a ')'" + hint);
  CHECK(unit_message("m)") == "unit 'm)' has ')' out of place" + hint);
  CHECK(unit_message("m\x01") == "unit 'm\\x01' lacks a unit at '\\x01'" + hint);
  CHECK(unit_message(std::string(65, '(')) ==
        "unit '" + std::string(60, '(') + "...' is too long; write it as N m or rad/s");
}

}  // namespace cablefit

#include "cablefit/report/parts/numbers.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <limits>

namespace {

using namespace cablefit;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Printed {
  double value, sd;
  const char* value_text;
  const char* sd_text;
};

TEST_CASE("a value is printed to the second digit of its sd") {
  const Printed cases[] = {
      {1367.7123, 1.234, "1367.7", "1.2"},
      {0.0133129, 0.0000304, "0.013313", "0.000030"},
      {0.9962, 0.0996, "1.00", "0.10"},  // 0.0996 to two digits is 0.10
      {5.6, 0.42, "5.60", "0.42"},
      {-292374.4, 15722.6, "-292000", "16000"},
      {1.99e7, 1256347, "1.99e+07", "1.3e+06"},
      {-6.157e10, 6.1e9, "-6.16e+10", "6.1e+09"},
      {3.2e-7, 1.1e-8, "3.20e-07", "1.1e-08"},
      {0.05, 0.12, "0.05", "0.12"},
      {0, 0.5, "0.00", "0.50"},
      {1819.2345, kNan, "1819", "-"},
      {1819.2345, 0, "1819", "0"},
      {kNan, 1, "-", "1.0"},
  };
  for (const Printed& c : cases) {
    INFO(c.value << " +- " << c.sd);
    CHECK(value_text(c.value, c.sd) == c.value_text);
    if (c.value == c.value) CHECK(sd_text(c.value, c.sd) == c.sd_text);
  }
}

TEST_CASE("significant digits") {
  CHECK(significant(0.5062, 3) == "0.506");
  CHECK(significant(19.34, 3) == "19.3");
  CHECK(significant(152.3, 2) == "150");
  CHECK(significant(0, 3) == "0");
  CHECK(significant(kNan, 3) == "-");
  CHECK(significant(1e-7, 2) == "1.0e-07");
}

TEST_CASE("exact numbers read back as the same bits") {
  for (const double value : {1.0 / 3, 1e-300, 6.02214076e23, -0.1, 20000.0}) {
    CHECK(std::strtod(exact(value).c_str(), nullptr) == value);
  }
  CHECK(exact(kNan).empty());
}

}  // namespace

// An estimate as a result file has it.
#pragma once

#include <string>

#include "cablefit/base/parameter.hpp"

namespace cablefit::test {

/// With the interval that 20 degrees of freedom make: t = 2.0859634472658648 (R: qt(.975, 20)).
inline Estimate recorded_estimate(const std::string& name, double value, double sd) {
  Estimate e;
  e.name = name;
  e.unit = "N m";
  e.value = value;
  e.sd = sd;
  e.ci_low = value - 2.0859634472658648 * sd;
  e.ci_high = value + 2.0859634472658648 * sd;
  return e;
}

}  // namespace cablefit::test

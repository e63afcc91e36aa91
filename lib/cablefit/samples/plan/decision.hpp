// A choice for the reports: "cutoff", "126 Hz", "2 f0, f0 = 63 Hz from the elastic fit".
#pragma once

#include <string>

namespace cablefit {

struct Decision {
  std::string name, value, reason;
};

}  // namespace cablefit

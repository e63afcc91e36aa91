// Small results made by hand, for the tests of reports.
#pragma once

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/elastic/elastic_result.hpp"

namespace cablefit::test {

/// With a 95 % interval of 2 sd, and sd_white = sd / 4.
Estimate estimate(const std::string& name, const std::string& unit, double value, double sd);

/// One preload, linear and polynomial of the given order per cable, on the default rig.
ElasticPreload elastic_preload(const std::string& name, int order_1, int order_2);

/// Preloads "low" (orders 2 and 2) and "high" (orders 2 and 1).
ElasticResult elastic_result();

/// One preload with linear and poly; poly has a parameter at its bound and one not identifiable.
DynamicPreload dynamic_preload(const std::string& name);
DynamicResult dynamic_result();

}  // namespace cablefit::test

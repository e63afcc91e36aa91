// A campaign as JUnit XML, which CI servers show as tests: one suite per cell, in it the fit and
// every gate.
#pragma once

#include <string>

#include "cablefit/campaign/batch.hpp"

namespace cablefit {

std::string junit_xml(const BatchResult& result);

}  // namespace cablefit

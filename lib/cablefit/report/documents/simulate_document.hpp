// Simulations beside their logs as a report: gaps per signal, what was simulated and how, cables.
#pragma once

#include "cablefit/report/parts/document.hpp"
#include "cablefit/simulate/simulate_result.hpp"

namespace cablefit {

Document simulate_document(const SimulateResult& result);

}  // namespace cablefit

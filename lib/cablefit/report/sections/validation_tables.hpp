// How a fit does on logs, as tables. Internal to report/.
#pragma once

#include <string>
#include <vector>

#include "cablefit/dynamic/dynamic_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// Per preload, model and equation the error on held-out logs, and the condition under which the
/// model fails most; as details all conditions with rows, errors and baselines, and the residual
/// tests. Nothing when no log was validated on.
std::vector<Table> validation_tables(const DynamicResult& result);

/// Residual tests on the logs that were fitted, a line per equation; no rows: none were made.
Table residual_summary(const DynamicResult& result);
/// The same, a line per test.
Table residual_table(const DynamicResult& result);

/// "deflection (1.5 N m rms), load (...)": on what the residual depends, or that nothing was seen.
std::string depends_text(const JudgedEquation& e, const std::string& unit);

/// A line for every equation that fails, with the condition under which it is worst.
std::vector<std::string> validation_warnings(const DynamicPreload& preload);

/// Rows for the tidy table.
void add_validation_rows(Table& table, const DynamicPreload& preload);

}  // namespace cablefit

// Friction against the preload, and the fitted preloads side by side. Internal to report/.
#pragma once

#include "cablefit/design/design_result.hpp"
#include "cablefit/report/parts/document.hpp"

namespace cablefit {

/// "known from l_o 0 to 6.1 mrad, ...": where the friction of a sweep comes from. Empty: none is
/// known.
std::string friction_text(const DesignResult& result);

/// Tables: fitted preloads as they are, the lines through them, friction along the sweep.
void add_friction_tables(const DesignResult& result, Document& document);

/// Rows of the tidy table.
void add_friction_rows(const DesignResult& result, Document& document);

}  // namespace cablefit

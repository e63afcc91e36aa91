// JSON logs as records: an array of them, [{"t": 0, "q": 1}, {"t": 1e-3, "q": 2}], or one a line.
#pragma once

#include <memory>

#include "cablefit/log/json/json_table.hpp"

namespace cablefit {

std::unique_ptr<JsonLayout> make_records_layout(JsonTable& table);
/// For records that no array holds.
std::unique_ptr<JsonLayout> make_lines_layout(JsonTable& table);

}  // namespace cablefit

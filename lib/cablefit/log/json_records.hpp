// JSON logs as an array of records: [{"t": 0, "q": 1}, {"t": 1e-3, "q": 2}].
#pragma once

#include <memory>

#include "cablefit/log/json_table.hpp"

namespace cablefit {

std::unique_ptr<JsonLayout> make_records_layout(JsonTable& table);

}  // namespace cablefit

// JSON logs as channels: {"sample_rate": 1000, "channels": {"q": [0, 1], "tau": [..]}}.
#pragma once

#include <memory>

#include "cablefit/log/json/json_table.hpp"

namespace cablefit {

std::unique_ptr<JsonLayout> make_channels_layout(JsonTable& table);

}  // namespace cablefit

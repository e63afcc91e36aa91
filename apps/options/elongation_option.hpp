// --l-o: whether initial elongations are looked for.
#pragma once

#include <CLI/App.hpp>

#include "cablefit/identify/identify.hpp"

namespace cablefit::apps {

void add_elongation_option(CLI::App& app, ElongationMode& mode);

}  // namespace cablefit::apps

// --draws, of all commands that search for missing effects.
#pragma once

#include <CLI/App.hpp>

#include "cablefit/refine/refine_options.hpp"

namespace cablefit::apps {

void add_draws_option(CLI::App& app, RefineOptions& refine);

}  // namespace cablefit::apps

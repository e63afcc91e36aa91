#include "options/draws_option.hpp"

#include "options/command_line.hpp"

namespace cablefit::apps {

void add_draws_option(CLI::App& app, RefineOptions& refine) {
  constexpr double kLeast = 4, kMost = 100000;
  add_whole(
      app, "--draws", "N", {kLeast, kMost},
      [&refine](long n) { refine.n_draws = static_cast<std::size_t>(n); },
      "simulated data sets without any effect, at most, for the p-values [24]");
}

}  // namespace cablefit::apps

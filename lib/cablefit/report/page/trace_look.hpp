// How a trace is drawn, the same by plotly and as SVG. Series differ in dashes and symbols as well
// as in colour, for readers and printers without colours.
#pragma once

#include <cstddef>
#include <string>

#include "cablefit/figure/figure.hpp"

namespace cablefit {

struct TraceLook {
  std::string colour;     ///< of page.css: "series-1"
  double width = 1.4;     ///< px, of the line
  std::string dash = {};  ///< "8px,3px"; empty: solid
  std::string symbol = "circle";
  /// How many symbols the line has: 0: none, kEveryPoint: one at each point.
  std::size_t n_symbols = 0;
};

inline constexpr std::size_t kEveryPoint = 1u << 20;

TraceLook look_of(const Figure& figure, std::size_t trace_number);

}  // namespace cablefit

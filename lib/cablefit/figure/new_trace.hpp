// A trace to begin with.
#pragma once

#include <string>
#include <utility>

#include "cablefit/figure/figure.hpp"

namespace cablefit {

/// Without points yet. `series`: kMeasured, kReference, or whose colour it has.
inline Trace new_trace(std::string name, TraceStyle style, int series) {
  Trace trace;
  trace.name = std::move(name);
  trace.style = style;
  trace.series = series;
  return trace;
}

}  // namespace cablefit

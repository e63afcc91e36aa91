#include "cablefit/report/page/trace_look.hpp"

#include <algorithm>
#include <array>

namespace cablefit {
namespace {

constexpr std::size_t kSeries = 7;
constexpr std::size_t kFewPoints = 16;     // may have no neighbour to be joined with
constexpr std::size_t kDensePoints = 600;  // on which dashes cannot be seen
constexpr std::size_t kSymbolsOfLine = 9;
constexpr std::array<const char*, kSeries> kDashes{
    "1px,2px", "", "9px,3px", "3px,3px", "9px,3px,2px,3px", "14px,4px", "14px,4px,2px,4px"};
constexpr std::array<const char*, kSeries> kSymbols{"circle", "square", "diamond", "triangle-up",
                                                    "x",      "cross",  "star"};

bool is_line(const Trace& trace) { return trace.style == TraceStyle::line && trace.series >= 0; }

/// Whether it has to differ from others by more than a colour.
bool has_several_lines(const Figure& figure) {
  return std::count_if(figure.traces.begin(), figure.traces.end(), is_line) > 1;
}

/// Whether the series has a trace of this style before.
bool is_repeated(const Figure& figure, std::size_t k) {
  const Trace& trace = figure.traces[k];
  return std::any_of(figure.traces.begin(), figure.traces.begin() + static_cast<std::ptrdiff_t>(k),
                     [&](const Trace& other) {
                       return other.series == trace.series && other.style == trace.style;
                     });
}

std::string colour_of(const Figure& figure, std::size_t k) {
  const Trace& trace = figure.traces[k];
  if (trace.style == TraceStyle::broad) return "below";
  if (trace.series < 0) return "reference";
  if (trace.style == TraceStyle::points && is_repeated(figure, k)) return "again";
  return "series-" + std::to_string(static_cast<std::size_t>(trace.series) % kSeries);
}

}  // namespace

TraceLook look_of(const Figure& figure, std::size_t trace_number) {
  const Trace& trace = figure.traces[trace_number];
  const auto series = static_cast<std::size_t>(std::max(0, trace.series)) % kSeries;
  TraceLook look{colour_of(figure, trace_number)};
  look.symbol = kSymbols[series];
  switch (trace.style) {
    case TraceStyle::broad:
      look.width = 4;
      break;
    case TraceStyle::dashed:
      look.width = 1.2;
      look.dash = trace.series > 1 ? "2px,3px" : "5px,4px";
      break;
    case TraceStyle::area:
      look.width = 1;
      break;
    case TraceStyle::steps:
      look.width = 1.5;
      look.dash = kDashes[series];
      break;
    case TraceStyle::points:
      if (look.colour == "again") look.symbol = "x";
      break;
    case TraceStyle::interval:
      break;
    case TraceStyle::line:
      if (trace.y.size() < kFewPoints) look.n_symbols = kEveryPoint;
      if (!has_several_lines(figure)) break;
      if (trace.y.size() < kDensePoints) look.dash = kDashes[series];
      if (look.n_symbols == 0) look.n_symbols = kSymbolsOfLine;
      break;
  }
  return look;
}

}  // namespace cablefit

#include "cablefit/samples/rows/unused_rows.hpp"

#include <fmt/format.h>

namespace cablefit {
namespace {

constexpr double kShortStretch = 200;  // rows; shorter on average: gaps cut them

}  // namespace

std::string unused_rows_warning(const WindowCounts& windows, const RowCounts& rows) {
  const auto all = static_cast<double>(windows.rows_read);
  const auto edges = static_cast<double>(rows.rows_at_edges);
  const auto too_short = static_cast<double>(windows.rows_too_short);
  if (!(all > 0) || edges + too_short <= kUnusedNoted * all) return "";
  const bool many_gaps =
      too_short > 0 || all < kShortStretch * static_cast<double>(windows.segments);
  return fmt::format(
      "{:.0f} % of the rows are not used: {:.0f} % lie at the edges of {} stretches without a gap, "
      "{:.0f} % in stretches too short for the filter; {}",
      100 * (edges + too_short) / all, 100 * edges / all, windows.segments, 100 * too_short / all,
      many_gaps ? "record without gaps, or raise --cutoff" : "record longer logs");
}

}  // namespace cablefit

#include "cablefit/report/writers/trace_csv.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/report/parts/escape.hpp"

namespace cablefit {
namespace {

std::string cell(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{:.17g}", value);
}

}  // namespace

std::string trace_csv(const RecursiveTrace& trace) {
  std::string text = "rows,record";
  for (std::size_t k = 0; k < trace.names.size(); ++k) {
    const std::string name =
        fmt::format("{} ({}) [{}]", trace.names[k], trace.preloads[k], trace.units[k]);
    text += ',' + csv_cell(name) + ',' + csv_cell("sd " + name);
  }
  text += '\n';
  for (const TracePoint& point : trace.points) {
    text += fmt::format("{},{}", point.n_rows, csv_cell(point.record));
    for (std::size_t k = 0; k < trace.names.size(); ++k)
      text += ',' + cell(point.value[k]) + ',' + cell(point.sd[k]);
    text += '\n';
  }
  return text;
}

}  // namespace cablefit

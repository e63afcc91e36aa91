#include "cablefit/samples/weigh/finding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/quote.hpp"

namespace cablefit {

std::string weighed_name(const LogPlan& plan, Channel channel, int joint) {
  std::string name(channel_name(channel));
  return plan.rig.n_joints() > 1 ? name + std::to_string(joint + 1) : name;
}

namespace {

std::string column_name(const LogPlan& plan, Channel channel, int joint) {
  const int k = plan.find(channel, joint);
  return k < 0
             ? weighed_name(plan, channel, joint)
             : shortened(plan.header.columns[plan.slots[static_cast<std::size_t>(k)].column].name);
}

}  // namespace

double nice_factor(double measured) {
  constexpr double kNear = 0.01;
  const double size = std::abs(measured), larger = size < 1 ? 1 / size : size;
  const double whole = std::round(larger);
  if (whole < 2 || std::abs(larger / whole - 1) > kNear) return measured;
  return std::copysign(size < 1 ? 1 / whole : whole, measured);
}

std::string mending_line(const LogPlan& plan, Channel channel, int joint, double factor) {
  const std::string name = weighed_name(plan, channel, joint);
  const auto mapped = plan.rig.columns.find(name);
  const ColumnMapping mapping = mapped == plan.rig.columns.end() ? ColumnMapping{} : mapped->second;
  std::string more;
  if (mapping.shift != 0) more += fmt::format(", \"shift\": {:g}", mapping.shift * factor);
  if (!mapping.unit.empty()) more += fmt::format(", \"unit\": \"{}\"", mapping.unit);
  return fmt::format(
      "write \"{}\": {{\"column\": \"{}\", \"scale\": {:.4g}{}}} in the rig file's columns", name,
      column_name(plan, channel, joint), mapping.scale * factor, more);
}

std::string measured_line(const LogPlan& plan, Channel channel, int joint, double factor,
                          std::optional<double> error, std::string_view what) {
  constexpr double kLeastPercent = 0.1;  // a log without noise does not make it exact
  const double percent = std::max(kLeastPercent, 100 * error.value_or(0));
  const std::string size =
      error ? fmt::format("known to within {:.{}f} %", percent, percent < 0.95 ? 1 : 0)
            : std::string("only an estimate");
  return fmt::format("look up the exact {}, the measured one is {}; {}", what, size,
                     mending_line(plan, channel, joint, nice_factor(factor)));
}

std::string mending_unit(const LogPlan& plan, Channel channel, int joint, std::string_view unit) {
  return fmt::format(
      "write \"{}\": {{\"column\": \"{}\", \"unit\": \"{}\"}} in the rig file's columns",
      weighed_name(plan, channel, joint), column_name(plan, channel, joint), unit);
}

std::uint64_t line_of_row(const LogPlan& plan, std::size_t row) {
  const auto reader = open_planned(plan);
  reader->select(plan.numeric_columns(), plan.text_columns());
  LogChunk chunk;
  for (std::size_t n_before = 0; reader->next(chunk); n_before += chunk.n_rows)
    if (row < n_before + chunk.n_rows) return chunk.lines[row - n_before];
  return 0;
}

}  // namespace cablefit

#include "cablefit/samples/survey/memory_log.hpp"

#include <fmt/format.h>

#include "cablefit/base/error.hpp"
#include "cablefit/log/column_header.hpp"
#include "cablefit/samples/survey/recorded.hpp"

namespace cablefit {
namespace {

LogHeader header_of(const std::string& name, std::span<const MemoryColumn> columns) {
  LogHeader header;
  header.path = name;
  for (std::size_t k = 0; k < columns.size(); ++k)
    header.columns.push_back(to_column_header(columns[k].name, {name, 0, k + 1}));
  check_names(header.columns, {name, 0, 0});
  return header;
}

std::size_t require_rows(const std::string& name, std::span<const MemoryColumn> columns) {
  const std::size_t n = columns.empty() ? 0 : columns.front().values.size();
  for (const MemoryColumn& column : columns)
    if (column.values.size() != n)
      throw input_error({name},
                        fmt::format("column '{}' has {} values, '{}' has {}", column.name,
                                    column.values.size(), columns.front().name, n),
                        "one value per row in every column");
  if (n < kFewestRows)
    throw input_error({name}, fmt::format("{} rows", n),
                      fmt::format("a log has at least {}", kFewestRows));
  for (const MemoryColumn& column : columns)
    for (std::size_t i = 0; i < n; ++i)
      if (!std::isfinite(column.values[i]))
        throw input_error({name, i + 1, 0}, fmt::format("column '{}' is not finite", column.name),
                          "leave the row out");
  return n;
}

Eigen::Map<const Eigen::VectorXd> values_of(const MemoryColumn& column) {
  return {column.values.data(), static_cast<Eigen::Index>(column.values.size())};
}

/// Integral over time from 0, by trapezoids.
void integrate(const Eigen::VectorXd& t, Eigen::Ref<Eigen::VectorXd> values) {
  double sum = 0, before = values(0);
  values(0) = 0;
  for (Eigen::Index i = 1; i < values.size(); ++i) {
    const double now = values(i);
    sum += (t(i) - t(i - 1)) * (now + before) / 2;
    before = now;
    values(i) = sum;
  }
}

Eigen::VectorXd time_of(const LogPlan& plan, const Eigen::VectorXd& stamps) {
  const double origin = plan.time_origin(stamps(0));
  return plan.time_factor * (stamps.array() - origin).matrix();
}

}  // namespace

LogSurvey survey_memory(const std::string& name, std::span<const MemoryColumn> columns,
                        const Rig& rig, double rate) {
  const auto n = static_cast<Eigen::Index>(require_rows(name, columns));
  Reading reading;
  reading.rate = rate;
  const LogPlan plan = plan_columns(header_of(name, columns), rig, reading);
  RecordedPart part;
  part.preload = rig.preload.empty() ? "default" : rig.preload;
  part.phase_given = false;
  part.rows.resize(n, static_cast<Eigen::Index>(plan.slots.size()) + 1);
  part.rows.col(0) = plan.time_column ? time_of(plan, values_of(columns[*plan.time_column]))
                                      : Eigen::VectorXd::LinSpaced(
                                            n, 0, static_cast<double>(n - 1) / plan.sample_rate);
  for (std::size_t k = 0; k < plan.slots.size(); ++k) {
    const Slot& slot = plan.slots[k];
    auto column = part.rows.col(static_cast<Eigen::Index>(k) + 1);
    column = (slot.factor * values_of(columns[slot.column]).array() + slot.shift).matrix();
    if (slot.integrated) integrate(part.rows.col(0), column);
  }
  LogSurvey log = survey_recorded(plan, {part});
  log.parts.front().phase = phase_by_motion(log.parts.front(), plan);
  return log;
}

}  // namespace cablefit

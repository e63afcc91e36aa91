#include "cablefit/samples/plan/plan_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/log/column_header.hpp"
#include "cablefit/samples/plan/unit_suffix.hpp"

namespace cablefit::plan_parts {
namespace {

/// Of a column that is called as the channel, maybe with a unit behind it: tau_mNm, and tau_mA,
/// which is refused later.
std::optional<std::size_t> find_channel_column(const LogHeader& header, std::string_view channel,
                                               const Dimension& dimension) {
  if (const auto column = find_column(header, channel)) return column;
  for (std::size_t k = 0; k < header.columns.size(); ++k) {
    const std::string& name = header.columns[k].name;
    const auto suffixed = split_unit_suffix(name, dimension);
    if (suffixed && suffixed->stem == channel) return k;
    if (is_torque(dimension) && channel == "tau" && stem_of_current(name) == channel) return k;
  }
  return std::nullopt;
}

/// Some count turns in Hz and others radians; the same holds for 1/min.
bool is_unclear_speed(const std::string& unit) {
  return unit.ends_with("Hz") || unit == "1/min" || unit == "min^-1" || unit == "min-1";
}

/// Whether two units measure the same in another scale. Where one of them is no clear unit the rig
/// file is there to say what is meant.
bool contradict(const std::string& written, const std::string& given) {
  if (written == "-" || written == "1" || written == "1/s" || is_unclear_speed(written))
    return false;
  try {
    const Unit a = parse_unit(written), b = parse_unit(given);
    return a.dimension == b.dimension && std::abs(a.scale - b.scale) > 1e-9 * std::abs(b.scale);
  } catch (const Error&) {
    return false;
  }
}

/// The rig file's unit is that of the scaled values: a scale may convert the header's unit to it, a
/// sign cannot. The single letter of q_m or theta_s may stand for a motor or a side.
void require_one_unit(LogPlan& plan, const ColumnHeader& cell, const ColumnMapping& mapping,
                      const Dimension& dimension) {
  const WrittenUnit written = written_unit(cell, dimension);
  if (mapping.unit.empty() || written.unit.empty() || std::abs(mapping.scale) != 1) return;
  if (written.by_name && written.unit.size() == 1) return;
  if (!contradict(written.unit, mapping.unit)) return;
  refuse_untrusted(plan,
                   input_error(cell.place,
                               fmt::format("{} says {}, the rig file {}",
                                           written.by_name ? "the column's name" : "the header",
                                           shortened(written.unit), shortened(mapping.unit)),
                               "correct the one that is wrong"));
}

}  // namespace

std::optional<std::size_t> find_column(const LogHeader& header, std::string_view name) {
  const auto place_of = [&](auto is_it) -> std::optional<std::size_t> {
    const auto found = std::find_if(header.columns.begin(), header.columns.end(), is_it);
    if (found == header.columns.end()) return std::nullopt;
    return static_cast<std::size_t>(found - header.columns.begin());
  };
  if (const auto place = place_of([&](const ColumnHeader& c) { return c.name == name; }))
    return place;
  const ColumnHeader cell = to_column_header(name, {});
  if (cell.unit.empty()) return std::nullopt;
  return place_of(
      [&](const ColumnHeader& c) { return c.name == cell.name && c.unit == cell.unit; });
}

std::uint64_t header_line(const LogHeader& header) {
  return header.columns.empty() ? 1 : std::max<std::uint64_t>(1, header.columns.front().place.line);
}

std::string names_of(const LogHeader& header) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min<std::size_t>(header.columns.size(), 20); ++k)
    names.push_back(shortened(header.columns[k].name));
  return fmt::format("{}{}", fmt::join(names, ", "), header.columns.size() > 20 ? ", ..." : "");
}

std::optional<Error> absent_column(const LogHeader& header, const Rig& rig,
                                   const std::string& channel) {
  const auto mapped = rig.columns.find(channel);
  if (mapped == rig.columns.end() || find_column(header, mapped->second.column)) return {};
  std::vector<std::string_view> known;
  for (const ColumnHeader& c : header.columns) known.push_back(c.name);
  return input_error({header.path, header.columns.empty() ? 1 : header.columns[0].place.line, 0},
                     fmt::format("no column '{}', which the rig file names for {}",
                                 mapped->second.column, channel),
                     suggestion(mapped->second.column, known));
}

std::optional<std::size_t> column_of(const LogHeader& header, const Rig& rig,
                                     const std::string& channel,
                                     const std::optional<Dimension>& dimension) {
  if (const auto error = absent_column(header, rig, channel)) throw Error(*error);
  const auto mapped = rig.columns.find(channel);
  if (mapped != rig.columns.end()) return find_column(header, mapped->second.column);
  return dimension ? find_channel_column(header, channel, *dimension)
                   : find_column(header, channel);
}

bool is_current_unit(const std::string& text) { return text == "A" || text == "mA"; }

Unit checked_unit(const std::string& text, const Place& place, const Dimension& expected,
                  std::string_view what, std::string_view quantity) {
  Unit unit;
  try {
    unit = parse_unit(text);
  } catch (const Error& error) {
    throw Error(ErrorKind::input, fmt::format("{}: {}: {}", to_string(place), what, error.what()));
  }
  if (unit.dimension != expected)
    throw input_error(place, fmt::format("unit '{}' of {} is not {}'s", text, what, quantity),
                      is_current_unit(text) ? "for a current give the torque constant as \"scale\" "
                                              "(N m/A) and \"unit\": \"N m\" in the rig file"
                                            : "correct the unit in the header or in the rig file");
  return unit;
}

void require_clear_speed(const std::string& unit, const Place& place, const std::string& column) {
  if (!is_unclear_speed(unit)) return;
  throw input_error(place,
                    fmt::format("unit '{}' of column {} may be turns or radians a second",
                                shortened(unit), in_quotes(column)),
                    "write rev/s, rpm or rad/s in the header or in the rig file");
}

void require_torque(const ColumnHeader& cell, const ColumnMapping& mapping,
                    const std::string& channel) {
  if (mapping.scale != 1 || !is_current_name(cell.name)) return;
  throw input_error(
      cell.place,
      fmt::format("column {} is a current by its name, {} a torque", in_quotes(cell.name), channel),
      fmt::format("give the torque constant: \"{}\": {{\"column\": \"{}\", "
                  "\"scale\": {}, \"unit\": \"N m\"}} in the rig file's columns",
                  channel, cell.name, is_milliampere_name(cell.name) ? "0.000083" : "0.083"));
}

ColumnMapping mapping_of(const Rig& rig, const std::string& channel) {
  const auto mapped = rig.columns.find(channel);
  return mapped == rig.columns.end() ? ColumnMapping{} : mapped->second;
}

WrittenUnit written_unit(const ColumnHeader& cell, const Dimension& dimension) {
  if (!cell.unit.empty()) return {cell.unit, false};
  const auto suffixed = split_unit_suffix(cell.name, dimension);
  return suffixed ? WrittenUnit{std::string(suffixed->unit), true} : WrittenUnit{};
}

void refuse_untrusted(LogPlan& plan, const Error& error) {
  if (!plan.reading.trust_units) throw Error(error);
  plan.trusted.emplace_back(error.what());
}

std::string unit_of(LogPlan& plan, const ColumnHeader& cell, const ColumnMapping& mapping,
                    const Dimension& dimension) {
  require_one_unit(plan, cell, mapping, dimension);
  if (!mapping.unit.empty()) return mapping.unit;
  const WrittenUnit written = written_unit(cell, dimension);
  if (written.by_name)
    plan.decisions.push_back(
        {"unit of column " + in_quotes(cell.name), written.unit, "by the end of its name"});
  return written.unit;
}

}  // namespace cablefit::plan_parts

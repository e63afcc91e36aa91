#include "cablefit/samples/channels.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/base/units.hpp"
#include "cablefit/samples/unit_suffix.hpp"

namespace cablefit {
namespace {

// A row of the table of channels: name and dimension (m, kg, s, A) on a rotary and a linear axis.
struct ChannelInfo {
  Channel channel;
  std::string_view name;
  std::string_view quantity;
  Dimension rotary, linear;
};

constexpr Dimension kNumber{0, 0, 0, 0}, kLength{1, 0, 0, 0}, kTime{0, 0, 1, 0};
constexpr Dimension kRate{0, 0, -1, 0}, kSpeed{1, 0, -1, 0};
constexpr Dimension kTorque{2, 1, -2, 0}, kForce{1, 1, -2, 0};

constexpr std::array<ChannelInfo, 6> kInfo = {{
    {Channel::q, "q", "a position", kNumber, kLength},
    {Channel::theta, "theta", "a position", kNumber, kLength},
    {Channel::w, "w", "a velocity", kRate, kSpeed},
    {Channel::tau, "tau", "a torque", kTorque, kForce},
    {Channel::tau_load, "tau_load", "a torque", kTorque, kForce},
    {Channel::theta_ref, "theta_ref", "a position", kNumber, kLength},
}};

const ChannelInfo& info_of(Channel channel) {
  return *std::find_if(kInfo.begin(), kInfo.end(),
                       [&](const ChannelInfo& row) { return row.channel == channel; });
}

std::optional<std::size_t> find_column(const LogHeader& header, std::string_view name) {
  for (std::size_t k = 0; k < header.columns.size(); ++k)
    if (header.columns[k].name == name) return k;
  return std::nullopt;
}

/// Of a column that is called as the channel, maybe with a unit behind it: tau_mNm.
std::optional<std::size_t> find_channel_column(const LogHeader& header, std::string_view channel,
                                               const Dimension& dimension) {
  if (const auto column = find_column(header, channel)) return column;
  for (std::size_t k = 0; k < header.columns.size(); ++k) {
    const auto suffixed = split_unit_suffix(header.columns[k].name, dimension);
    if (suffixed && suffixed->stem == channel) return k;
  }
  return std::nullopt;
}

std::string names_of(const LogHeader& header) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min<std::size_t>(header.columns.size(), 20); ++k)
    names.push_back(shortened(header.columns[k].name));
  return fmt::format("{}{}", fmt::join(names, ", "), header.columns.size() > 20 ? ", ..." : "");
}

// The column a channel is read from: the rig file's when it names one, else the channel's own name.
std::optional<std::size_t> column_of(const LogHeader& header, const Rig& rig,
                                     const std::string& channel,
                                     const std::optional<Dimension>& dimension = {}) {
  const auto mapped = rig.columns.find(channel);
  if (mapped == rig.columns.end())
    return dimension ? find_channel_column(header, channel, *dimension)
                     : find_column(header, channel);
  if (const auto column = find_column(header, mapped->second.column)) return column;
  std::vector<std::string_view> known;
  for (const ColumnHeader& c : header.columns) known.push_back(c.name);
  throw input_error({header.path, header.columns.empty() ? 1 : header.columns[0].place.line, 0},
                    fmt::format("no column '{}', which the rig file names for {}",
                                mapped->second.column, channel),
                    suggestion(mapped->second.column, known));
}

// The controller names the column of its reference itself; on a rig of several joints the joint's
// number follows the name. A log need not have it.
std::optional<std::size_t> reference_column(const LogHeader& header, const Rig& rig, int joint) {
  if (!rig.controller) return std::nullopt;
  const std::string& name = rig.controller->reference;
  return find_column(header, rig.n_joints() == 1 ? name : fmt::format("{}{}", name, joint + 1));
}

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
                      "correct the unit in the header or in the rig file");
  return unit;
}

/// Hertz count turns to some and radians to others, and so does what is told a minute.
void require_clear_speed(const std::string& unit, const Place& place, const std::string& column) {
  const bool per_minute = unit == "1/min" || unit == "min^-1" || unit == "min-1";
  if (!unit.ends_with("Hz") && !per_minute) return;
  throw input_error(place,
                    fmt::format("unit '{}' of column {} may be turns or radians a second",
                                shortened(unit), cablefit::quoted(column)),
                    "write rev/s, rpm or rad/s in the header or in the rig file");
}

/// A current is no torque until the motor's constant makes it one.
void require_torque(const ColumnHeader& cell, const ColumnMapping& mapping,
                    const std::string& channel) {
  if (mapping.scale != 1 || !is_current_name(cell.name)) return;
  throw input_error(cell.place,
                    fmt::format("column {} is a current by its name, {} a torque",
                                cablefit::quoted(cell.name), channel),
                    fmt::format("give the torque constant: \"{}\": {{\"column\": \"{}\", "
                                "\"scale\": 0.083, \"unit\": \"N m\"}} in the rig file's columns",
                                channel, cell.name));
}

ColumnMapping mapping_of(const Rig& rig, const std::string& channel) {
  const auto mapped = rig.columns.find(channel);
  return mapped == rig.columns.end() ? ColumnMapping{} : mapped->second;
}

/// The unit that a column is in: of the rig file, else of the header, else by the column's name,
/// which is told. Empty: none is given.
std::string unit_of(LogPlan& plan, const ColumnHeader& cell, const ColumnMapping& mapping,
                    const Dimension& dimension) {
  if (!mapping.unit.empty()) return mapping.unit;
  if (!cell.unit.empty()) return cell.unit;
  const auto suffixed = split_unit_suffix(cell.name, dimension);
  if (!suffixed) return {};
  plan.decisions.push_back({"unit of column " + cablefit::quoted(cell.name),
                            std::string(suffixed->unit), "by the end of its name"});
  return std::string(suffixed->unit);
}

void require_no_dates(const ColumnHeader& cell) {
  if (!cell.is_date) return;
  throw input_error(cell.place,
                    "column " + cablefit::quoted(cell.name) + " holds dates, not numbers",
                    "name another column for it in the rig file");
}

Slot make_slot(LogPlan& plan, const ChannelInfo& info, int joint, std::size_t column,
               const std::string& channel) {
  Slot slot{info.channel, joint, column, 1, 0};
  const ColumnHeader& cell = plan.header.columns[column];
  require_no_dates(cell);
  const ColumnMapping mapping = mapping_of(plan.rig, channel);
  const Dimension& dimension = plan.rig.linear_motion ? info.linear : info.rotary;
  const std::string unit = unit_of(plan, cell, mapping, dimension);
  double unit_scale = 1;
  if (info.channel == Channel::w) require_clear_speed(unit, cell.place, cell.name);
  if (unit.empty() && (dimension == kTorque || dimension == kForce))
    require_torque(cell, mapping, channel);
  if (!unit.empty())
    unit_scale = checked_unit(unit, cell.place, dimension, "column " + cablefit::quoted(cell.name),
                              info.quantity)
                     .scale;
  slot.factor = mapping.scale * unit_scale;
  slot.shift = mapping.shift * unit_scale;
  slot.has_unit = !unit.empty();
  return slot;
}

/// The rate of rows that a user, the rig file or the log gives; 0: none of them.
double given_rate(const LogPlan& plan) {
  if (plan.reading.rate > 0) return plan.reading.rate;
  if (plan.rig.sample_rate > 0) return plan.rig.sample_rate;
  return plan.header.sample_rate.value_or(0);
}

void resolve_time(LogPlan& plan) {
  plan.time_column = column_of(plan.header, plan.rig, "t", kTime);
  plan.sample_rate = given_rate(plan);
  // A rate that somebody gives for this log stands for its time column too.
  const bool replaces = plan.reading.rate > 0 || plan.rig.sample_rate > 0;
  if (replaces && plan.time_column) {
    plan.decisions.push_back(
        {"clock", fmt::format("{:g} Hz", plan.sample_rate), "given; column 't' is not read"});
    plan.time_column.reset();
  }
  if (!plan.time_column) {
    if (plan.sample_rate > 0) return;
    throw input_error(
        {plan.path, 1, 0}, "no column 't' and no sample rate",
        fmt::format("name the time column 't' or map it in the rig file, or give the rate by "
                    "--rate HZ or \"sample_rate\" in the rig file; columns are {}",
                    names_of(plan.header)));
  }
  const ColumnHeader& cell = plan.header.columns[*plan.time_column];
  const ColumnMapping mapping = mapping_of(plan.rig, "t");
  if (cell.is_date) return;
  const std::string unit = unit_of(plan, cell, mapping, kTime);
  if (!unit.empty())
    plan.time_factor = checked_unit(unit, cell.place, kTime, "column 't'", "a time").scale;
  plan.time_factor *= mapping.scale;
}

// A rigid drive has one position, whatever the log calls it, and a speed tells it but for its zero.
void complete_theta(LogPlan& plan, int joint) {
  if (plan.has(Channel::theta, joint)) return;
  const int q = plan.find(Channel::q, joint), w = plan.find(Channel::w, joint);
  if (q >= 0 && plan.has(Channel::tau, joint)) {
    plan.slots[static_cast<std::size_t>(q)].channel = Channel::theta;
    plan.q_is_theta = true;
  } else if (q < 0 && w >= 0) {
    Slot theta = plan.slots[static_cast<std::size_t>(w)];
    theta.channel = Channel::theta;
    theta.integrated = true;
    plan.slots.push_back(theta);
  }
}

int first_without(const LogPlan& plan, Channel channel, bool measured) {
  for (int joint = 0; joint < plan.rig.n_joints(); ++joint)
    if (measured ? !plan.has_measured(channel, joint) : !plan.has(channel, joint)) return joint;
  return -1;
}

Error missing_channel(const LogPlan& plan, Channel channel, int joint, std::string_view why,
                      std::string_view hint) {
  // Of a lone position it is the other one that is missing.
  if (channel == Channel::q && plan.q_is_theta) channel = Channel::theta;
  std::string name(channel_name(channel));
  if (plan.rig.n_joints() > 1) name += std::to_string(joint + 1);
  return input_error(
      {plan.path, plan.header.columns.empty() ? 1 : plan.header.columns[0].place.line, 0},
      fmt::format("missing column '{}', needed for {}", name, why),
      fmt::format("{}; columns are {}", hint, names_of(plan.header)));
}

}  // namespace

std::string_view channel_name(Channel channel) { return info_of(channel).name; }

bool LogPlan::has_for_all(Channel channel) const {
  for (int joint = 0; joint < rig.n_joints(); ++joint)
    if (!has(channel, joint)) return false;
  return true;
}

bool LogPlan::has_measured(Channel channel, int joint) const {
  const int k = find(channel, joint);
  return k >= 0 && !slots[static_cast<std::size_t>(k)].integrated;
}

int LogPlan::find(Channel channel, int joint) const {
  for (std::size_t k = 0; k < slots.size(); ++k)
    if (slots[k].channel == channel && slots[k].joint == joint) return static_cast<int>(k);
  return -1;
}

LogPlan plan_log(const std::string& path, const Rig& rig, const Reading& reading) {
  LogPlan plan;
  plan.path = path;
  plan.rig = rig;
  plan.reading = reading;
  plan.stamp = stamp_of(path);
  plan.header = open_log(path, reading.text())->header();
  resolve_time(plan);
  for (int joint = 0; joint < rig.n_joints(); ++joint)
    for (const ChannelInfo& info : kInfo) {
      const std::string indexed = fmt::format("{}{}", info.name, joint + 1);
      const bool plain_first = rig.n_joints() == 1;
      std::string channel = plain_first ? std::string(info.name) : indexed;
      const Dimension& dimension = rig.linear_motion ? info.linear : info.rotary;
      auto column = column_of(plan.header, rig, channel, dimension);
      if (!column && plain_first)
        column = column_of(plan.header, rig, channel = indexed, dimension);
      if (!column && info.channel == Channel::theta_ref)
        column = reference_column(plan.header, rig, joint);
      if (column) plan.slots.push_back(make_slot(plan, info, joint, *column, channel));
    }
  for (int joint = 0; joint < rig.n_joints(); ++joint) complete_theta(plan, joint);
  plan.preload_column = column_of(plan.header, rig, "preload");
  plan.phase_column = column_of(plan.header, rig, "phase");
  plan.run_column = column_of(plan.header, rig, "run");
  if (plan.slots.empty())
    throw input_error(
        {path, 1, 0}, "no column is called q, theta, w, tau or tau_load",
        fmt::format("rename columns or write a rig file that maps them; columns are {}",
                    names_of(plan.header)));
  return plan;
}

std::vector<std::size_t> LogPlan::numeric_columns() const {
  std::vector<std::size_t> columns;
  if (time_column) columns.push_back(*time_column);
  for (const Slot& slot : slots) columns.push_back(slot.column);
  return columns;
}

std::vector<std::size_t> LogPlan::text_columns() const {
  std::vector<std::size_t> columns;
  for (const auto& column : {preload_column, phase_column, run_column})
    if (column) columns.push_back(*column);
  return columns;
}

std::unique_ptr<MendedLog> open_planned(const LogPlan& plan, Sha256* digest) {
  return std::make_unique<MendedLog>(open_log(plan.path, plan.reading.text(), digest),
                                     plan.reading.mending, plan.time_column);
}

void require_unchanged(const LogPlan& plan) {
  if (stamp_of(plan.path) == plan.stamp) return;
  throw input_error({plan.path}, "changed while it was being read",
                    "run again once nothing writes to it any more");
}

void require_channel(const LogPlan& plan, Channel channel, std::string_view why,
                     std::string_view hint) {
  const int joint = first_without(plan, channel, false);
  if (joint >= 0) throw missing_channel(plan, channel, joint, why, hint);
}

void require_measured(const LogPlan& plan, Channel channel, std::string_view why,
                      std::string_view hint) {
  const int joint = first_without(plan, channel, true);
  if (joint >= 0) throw missing_channel(plan, channel, joint, why, hint);
}

void require_one_joint(const LogPlan& plan, std::string_view what) {
  if (plan.rig.n_joints() == 1) return;
  throw input_error({plan.rig.path, 0, 0},
                    fmt::format("the rig has {} joints, and {}", plan.rig.n_joints(), what),
                    "write one rig file per joint, with its own columns");
}

}  // namespace cablefit

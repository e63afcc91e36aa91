#include "cablefit/samples/plan/channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "cablefit/base/quote.hpp"
#include "cablefit/log/column_header.hpp"
#include "cablefit/samples/plan/plan_parts.hpp"

namespace cablefit {

using namespace plan_parts;

namespace {

// A row of the table of channels: name and dimension (m, kg, s, A) on a rotary and a linear axis.
struct ChannelInfo {
  Channel channel;
  std::string_view name;
  std::string_view quantity;
  Dimension rotary, linear;
};

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

/// Whether the controller names another column than theta_ref, and the rig file's columns do not.
bool names_own_reference(const Rig& rig, const std::vector<std::string>& names) {
  if (!rig.controller || rig.controller->reference == Controller{}.reference) return false;
  return std::none_of(names.begin(), names.end(),
                      [&](const std::string& name) { return rig.columns.contains(name); });
}

void require_no_dates(const ColumnHeader& cell) {
  if (!cell.is_date) return;
  throw input_error(cell.place, "column " + in_quotes(cell.name) + " holds dates, not numbers",
                    "name another column for it in the rig file");
}

Slot make_slot(LogPlan& plan, const ChannelInfo& info, int joint, std::size_t column,
               const std::string& channel) {
  Slot slot{info.channel, joint, column, 1, 0};
  const ColumnHeader& cell = plan.header.columns[column];
  require_no_dates(cell);
  const ColumnMapping mapping = mapping_of(plan.rig, channel);
  const Dimension& dimension = plan.rig.axes.of(joint) == Axes::linear ? info.linear : info.rotary;
  const std::string unit = unit_of(plan, cell, mapping, dimension);
  double unit_scale = 1;
  if (info.channel == Channel::w) require_clear_speed(unit, cell.place, cell.name);
  if (unit.empty() && is_torque(dimension)) require_torque(cell, mapping, channel);
  if (!unit.empty())
    unit_scale =
        checked_unit(unit, cell.place, dimension, "column " + in_quotes(cell.name), info.quantity)
            .scale;
  slot.factor = mapping.scale * unit_scale;
  slot.shift = mapping.shift * unit_scale;
  slot.has_unit = !unit.empty();
  return slot;
}

/// What a blocked log can do without.
bool is_optional(Channel channel) {
  return channel == Channel::tau_load || channel == Channel::theta_ref;
}

/// Finds the channel's column: on a rig of one joint q or q1, else q1, q2, ...
void resolve_channel(LogPlan& plan, const ChannelInfo& info, int joint) {
  const Rig& rig = plan.rig;
  const Dimension& dimension = rig.axes.of(joint) == Axes::linear ? info.linear : info.rotary;
  std::vector<std::string> names = {fmt::format("{}{}", info.name, joint + 1)};
  if (rig.n_joints() == 1) names.insert(names.begin(), std::string(info.name));
  if (info.channel == Channel::theta_ref && names_own_reference(rig, names)) {
    if (const auto column = find_column(plan.header, reference_name(rig, joint)))
      plan.slots.push_back(make_slot(plan, info, joint, *column, names.back()));
    return;  // a column theta_ref is not the one that the controller follows
  }
  for (const std::string& name : names) {
    if (auto absent = absent_column(plan.header, rig, name); absent && is_optional(info.channel)) {
      if (!plan.absent) plan.absent.emplace(*absent);
      return;
    }
    if (const auto column = column_of(plan.header, rig, name, dimension)) {
      plan.slots.push_back(make_slot(plan, info, joint, *column, name));
      return;
    }
  }
}

// A rigid drive has one position, under any name in the log. A speed gives it except for its zero.
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
  const FileStamp stamp = stamp_of(path);
  LogHeader header = open_log(path, reading.text())->header();
  header.path = path;
  LogPlan plan = plan_columns(std::move(header), rig, reading);
  plan.stamp = stamp;
  return plan;
}

LogPlan plan_columns(LogHeader header, const Rig& rig, const Reading& reading) {
  LogPlan plan;
  plan.path = header.path;
  plan.rig = rig;
  plan.reading = reading;
  plan.header = std::move(header);
  resolve_time(plan);
  for (int joint = 0; joint < rig.n_joints(); ++joint)
    for (const ChannelInfo& info : kInfo) resolve_channel(plan, info, joint);
  for (int joint = 0; joint < rig.n_joints(); ++joint) complete_theta(plan, joint);
  plan.preload_column = column_of(plan.header, rig, "preload");
  plan.phase_column = column_of(plan.header, rig, "phase");
  plan.run_column = column_of(plan.header, rig, "run");
  if (plan.slots.empty())
    throw input_error(
        {plan.path, header_line(plan.header), 0},
        "no column is called q, theta, w, tau or tau_load",
        fmt::format(
            "rename columns or map them in a rig file ('cablefit init' writes one); columns are {}",
            names_of(plan.header)));
  return plan;
}

std::string reference_name(const Rig& rig, int joint) {
  const std::string& name = rig.controller->reference;
  if (rig.n_joints() == 1) return name;
  const ColumnHeader cell = to_column_header(name, {});
  return fmt::format("{}{}{}", cell.name, joint + 1,
                     cell.unit.empty() ? "" : fmt::format(" [{}]", cell.unit));
}

std::string missing_reference(const LogPlan& plan) {
  if (!plan.rig.controller || plan.has_for_all(Channel::theta_ref)) return "";
  return fmt::format(
      "no reference {} in the log",
      in_quotes(reference_name(plan.rig, first_without(plan, Channel::theta_ref, false))));
}

double LogPlan::time_origin(double first) const {
  constexpr double kEpoch = 1e8;  // s: no log has run for three years
  return std::abs(first * time_factor) > kEpoch ? first : 0;
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
                    "run again when no program writes to it");
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

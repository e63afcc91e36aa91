// How a plan finds columns and their units. Internal to channels.cpp and plan_clock.cpp.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "cablefit/base/units.hpp"
#include "cablefit/samples/plan/channels.hpp"

namespace cablefit::plan_parts {

inline constexpr Dimension kNumber{0, 0, 0, 0}, kLength{1, 0, 0, 0}, kTime{0, 0, 1, 0};
inline constexpr Dimension kRate{0, 0, -1, 0}, kSpeed{1, 0, -1, 0};
inline constexpr Dimension kTorque{2, 1, -2, 0}, kForce{1, 1, -2, 0};

inline bool is_torque(const Dimension& dimension) {
  return dimension == kTorque || dimension == kForce;
}

/// The column of this name, which may come with its unit, as the header has it: "theta [deg]".
std::optional<std::size_t> find_column(const LogHeader& header, std::string_view name);

/// The first names of a log's columns, for messages.
std::string names_of(const LogHeader& header);
/// The line of its first column.
std::uint64_t header_line(const LogHeader& header);

/// Where the rig file maps the channel to a column that is not there: the error that says so.
std::optional<Error> absent_column(const LogHeader& header, const Rig& rig,
                                   const std::string& channel);

/// The column a channel is read from: the rig file's when it names one, else that of the channel's
/// own name, with a unit of `dimension` behind it or not. Throws absent_column().
std::optional<std::size_t> column_of(const LogHeader& header, const Rig& rig,
                                     const std::string& channel,
                                     const std::optional<Dimension>& dimension = {});

/// What the rig file says of a channel; the default where it says nothing.
ColumnMapping mapping_of(const Rig& rig, const std::string& channel);

/// Throws Error(input) at `place` for no unit, and one of another dimension: `what` has to be
/// `quantity`.
Unit checked_unit(const std::string& text, const Place& place, const Dimension& expected,
                  std::string_view what, std::string_view quantity);

/// Throws Error(input) where 1/s may be turns or radians.
void require_clear_speed(const std::string& unit, const Place& place, const std::string& column);

/// Throws Error(input) for a current without the constant that makes it a torque.
void require_torque(const ColumnHeader& cell, const ColumnMapping& mapping,
                    const std::string& channel);

/// The unit that the log itself gives a column. Empty: it gives none.
struct WrittenUnit {
  std::string unit;
  bool by_name = false;  ///< by the end of the column's name, else in the header
};
WrittenUnit written_unit(const ColumnHeader& cell, const Dimension& dimension);

/// The unit that a column is in: of the rig file, else of the header, else by the column's name,
/// which is reported. Empty: none is given. Refuses units that contradict each other.
std::string unit_of(LogPlan& plan, const ColumnHeader& cell, const ColumnMapping& mapping,
                    const Dimension& dimension);

/// What cannot be right is refused, unless the user trusts the units.
void refuse_untrusted(LogPlan& plan, const Error& error);

/// The log's time column, or the rate that stands for it. Throws Error(input) for neither and for a
/// contradiction.
void resolve_time(LogPlan& plan);

}  // namespace cablefit::plan_parts

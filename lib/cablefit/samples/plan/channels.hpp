// From columns as written to channels in SI: which column feeds which channel of which joint, with
// what unit, sign and scale. The only place that converts.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cablefit/base/files/input_file.hpp"
#include "cablefit/log/log_reader.hpp"
#include "cablefit/model/rig.hpp"
#include "cablefit/samples/plan/decision.hpp"
#include "cablefit/samples/plan/reading.hpp"

namespace cablefit {

enum class Channel { q, theta, w, tau, tau_load, theta_ref };
inline constexpr std::array kChannels = {Channel::q,   Channel::theta,    Channel::w,
                                         Channel::tau, Channel::tau_load, Channel::theta_ref};
std::string_view channel_name(Channel channel);

/// One numeric channel of one joint and the column it is read from: SI = factor * raw + shift.
/// Of an `integrated` one that is the rate, and the values are its integral over time, from 0.
struct Slot {
  Channel channel = Channel::q;
  int joint = 0;
  std::size_t column = 0;  ///< index into the log's header
  double factor = 1;
  double shift = 0;
  bool integrated = false;
  bool has_unit = false;  ///< the rig file, the header or the column's name gives one
};

/// How one log is read. `slots` are the columns of every sample block, in this order.
struct LogPlan {
  std::string path;
  FileStamp stamp;  ///< of the file that everything here was read from
  Rig rig;
  Reading reading = {};
  LogHeader header;
  std::vector<Slot> slots;
  std::optional<std::size_t> time_column;
  double time_factor = 1;
  double sample_rate = 0;  ///< Hz, where there is no time column
  std::optional<std::size_t> preload_column, phase_column, run_column;
  bool q_is_theta = false;  ///< the log's only position, q, is taken for a rigid drive's
  /// The rig file maps tau_load or theta_ref to a column that is not there. A blocked log needs
  /// neither, and which logs are blocked shows in the survey only.
  std::optional<Error> absent;
  std::vector<std::string> trusted;  ///< contradictions accepted by --trust-units
  std::vector<Decision> decisions;   ///< where reading differs from the text of the log

  /// What is taken off all of the time column, in its unit, when this is its first value: all of a
  /// clock that counts from an epoch, so that tables and plots begin near 0; else nothing.
  double time_origin(double first) const;
  /// Position of a channel among `slots`, or -1.
  int find(Channel channel, int joint = 0) const;
  bool has(Channel channel, int joint = 0) const { return find(channel, joint) >= 0; }
  bool has_for_all(Channel channel) const;                  ///< of every joint
  bool has_measured(Channel channel, int joint = 0) const;  ///< and not as an integral
  /// To select in the reader: time first when there is a column of it, then the slots.
  std::vector<std::size_t> numeric_columns() const;
  /// The preload, phase and run columns, those that there are.
  std::vector<std::size_t> text_columns() const;
};

/// Opens the log, reads its header and resolves every channel by the rig file or by name. Of one
/// joint a lone w is integrated to theta, and without theta a q beside tau is read as it. Throws
/// Error(input) at the header cell for a unit of the wrong kind or another one than the rig file's,
/// for a time column with another rate than the one given, for a mapped column that is not there,
/// when there is neither t nor a sample rate, and when no channel is found at all.
LogPlan plan_log(const std::string& path, const Rig& rig, const Reading& reading = {});

/// The same of columns that come from elsewhere; the plan has no stamp.
LogPlan plan_columns(LogHeader header, const Rig& rig, const Reading& reading = {});

/// A pass over the log as its plan wants it read. `digest` as of open_log().
std::unique_ptr<MendedLog> open_planned(const LogPlan& plan, Sha256* digest = nullptr);

/// A log is read several times. Throws Error(input) when its file was written to or replaced since
/// it was planned: later passes use the results of earlier ones.
void require_unchanged(const LogPlan& plan);

/// What `pass` over the log returns. A log that changed meanwhile is reported as that, whatever the
/// pass ran into.
template <typename Pass>
auto undisturbed(const LogPlan& plan, Pass pass) {
  require_unchanged(plan);
  try {
    auto result = pass();
    require_unchanged(plan);
    return result;
  } catch (const Error&) {
    require_unchanged(plan);
    throw;
  }
}

/// Throws Error(input) "missing column 'q' ..." when the log lacks a channel the caller needs.
/// With several joints: of every joint.
void require_channel(const LogPlan& plan, Channel channel, std::string_view why,
                     std::string_view hint = "add it, or map it in a rig file");

/// The same where an integral does not suffice, because its zero is unknown.
void require_measured(const LogPlan& plan, Channel channel, std::string_view why,
                      std::string_view hint = "add it, or map it in a rig file");

/// For code that handles one joint only. Throws Error(input) for a rig with more; `what` names what
/// does not: "'--zero theta_0' supports one joint".
void require_one_joint(const LogPlan& plan, std::string_view what = "fits support one joint");

}  // namespace cablefit

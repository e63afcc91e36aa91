// Converts columns as written to channels in SI: which column gives which channel of which joint,
// with its unit, sign and scale. No other file converts.
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

/// One numeric channel of one joint and its column: SI = factor * raw + shift. With `integrated`
/// the column is the rate, and the values are its integral over time, from 0.
struct Slot {
  Channel channel = Channel::q;
  int joint = 0;
  std::size_t column = 0;  ///< index into the log's header
  double factor = 1;
  double shift = 0;
  bool integrated = false;
  bool has_unit = false;  ///< the rig file, the header or the column's name gives a unit
};

/// How one log is read. `slots` are the columns of every block of samples, in this order.
struct LogPlan {
  std::string path;
  FileStamp stamp;  ///< of the file from which the plan was made
  Rig rig;
  Reading reading = {};
  LogHeader header;
  std::vector<Slot> slots;
  std::optional<std::size_t> time_column;
  double time_factor = 1;
  double sample_rate = 0;  ///< Hz, where there is no time column
  std::optional<std::size_t> preload_column, phase_column, run_column;
  bool q_is_theta = false;  ///< q, the only position in the log, is taken as theta of a rigid drive
  /// The rig file maps tau_load or theta_ref to a column that does not exist. A blocked log needs
  /// neither, but only the survey shows which logs are blocked.
  std::optional<Error> absent;
  std::vector<std::string> trusted;  ///< contradictions accepted by --trust-units
  std::vector<Decision> decisions;   ///< where the values used differ from the text of the log

  /// The offset subtracted from the time column, in its unit; `first` is the column's first value.
  /// A clock that counts from an epoch loses all of it, so that tables and plots begin near 0.
  /// Other clocks lose nothing.
  double time_origin(double first) const;
  /// Position of a channel among `slots`, or -1.
  int find(Channel channel, int joint = 0) const;
  bool has(Channel channel, int joint = 0) const { return find(channel, joint) >= 0; }
  bool has_for_all(Channel channel) const;                  ///< of every joint
  bool has_measured(Channel channel, int joint = 0) const;  ///< the same, but not as an integral
  /// The columns to select in the reader: time first when there is a time column, then the slots.
  std::vector<std::size_t> numeric_columns() const;
  /// Those of the preload, phase and run columns that exist.
  std::vector<std::size_t> text_columns() const;
};

/// Opens the log, reads its header and finds every channel by the rig file or by name. With one
/// joint a lone w is integrated to theta, and without theta a q beside tau is read as theta. Throws
/// Error(input) at the header cell for a unit of the wrong kind or different from the rig file's,
/// and for a time column with another rate than the given one. Also for a mapped column that does
/// not exist, without t and sample rate, and when no channel is found.
LogPlan plan_log(const std::string& path, const Rig& rig, const Reading& reading = {});

/// As above, for columns from another source; the plan has no stamp.
LogPlan plan_columns(LogHeader header, const Rig& rig, const Reading& reading = {});

/// Opens the log for a pass, with the reading options of its plan. `digest` as in open_log().
std::unique_ptr<MendedLog> open_planned(const LogPlan& plan, Sha256* digest = nullptr);

/// Throws Error(input) when the file was written to or replaced after it was planned. A log is read
/// several times, and later passes use the results of earlier ones.
void require_unchanged(const LogPlan& plan);

/// The result of `pass` over the log. If the log changed meanwhile, the error states that, not the
/// error of the pass.
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

/// Throws Error(input) "missing column 'q' ..." when the log lacks a required channel. With several
/// joints every joint must have it.
void require_channel(const LogPlan& plan, Channel channel, std::string_view why,
                     std::string_view hint = "add it, or map it in a rig file");

/// As above, where an integral is not sufficient because its zero is unknown.
void require_measured(const LogPlan& plan, Channel channel, std::string_view why,
                      std::string_view hint = "add it, or map it in a rig file");

/// The column that a joint's controller reads its reference from, as the rig file and the joint's
/// number name it: "cmd2", with its unit "cmd2 [deg]". The rig has a controller.
std::string reference_name(const Rig& rig, int joint);

/// "no reference 'cmd2' in the log", of the first joint without one; empty: every joint has one, or
/// the rig has no controller.
std::string missing_reference(const LogPlan& plan);

/// For code that supports one joint only. Throws Error(input) for a rig with more. `what` names the
/// unsupported part: "'--zero theta_0' supports one joint".
void require_one_joint(const LogPlan& plan, std::string_view what = "fits support one joint");

}  // namespace cablefit

#include "cablefit/dynamic/checks/judged_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cablefit/base/divided_up.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/observed.hpp"
#include "cablefit/samples/rows/row_stream.hpp"

namespace cablefit {
namespace {

constexpr double kMostCutoff = 0.45;  // as for --cutoff
// The drive is off when its torque stays below this share of its largest for so many rows.
constexpr double kOffShare = 2e-3;
constexpr Eigen::Index kOffRows = 10;

struct Watched {
  Observed observed;
  bool tested = false;
};

double largest_torque(std::span<const LogSurvey> logs, int joint) {
  double largest = 0;
  for (const LogSurvey& log : logs) {
    const int k = log.plan.find(Channel::tau, joint);
    for (const PartSurvey& part : log.parts) {
      if (k < 0) continue;
      const ChannelSurvey& c = part.channels[static_cast<std::size_t>(k)];
      largest = std::max({largest, std::abs(c.min), std::abs(c.max)});
    }
  }
  return largest;
}

/// 1: the drive gives power; -1: it takes power; kDriveOff: neither, for a while.
Eigen::ArrayXd drive_state(const JointSignals& s, double least_torque) {
  if (s.tau.size() != s.thetad.size()) return {};
  Eigen::ArrayXd state = (s.tau * s.thetad >= 0).select(Eigen::ArrayXd::Ones(s.tau.size()), -1.0);
  Eigen::Index quiet = 0;
  for (Eigen::Index i = 0; i < s.tau.size(); ++i) {
    quiet = std::abs(s.tau(i)) < least_torque ? quiet + 1 : 0;
    if (quiet == kOffRows) state.segment(i + 1 - kOffRows, kOffRows).setConstant(kDriveOff);
    if (quiet > kOffRows) state(i) = kDriveOff;
  }
  return state;
}

std::vector<Watched> watched_of(const DynamicJob& job, const EquationRows& e) {
  const auto joint = static_cast<std::size_t>(e.columns.place.joint);
  const bool link = e.columns.side == Side::link;
  const Axes axes = job.rig().axes.of(e.columns.place.joint);
  const std::string length = unit_for(axes, "rad");
  const double least = kOffShare * largest_torque(job.logs, e.columns.place.joint);
  std::vector<Watched> all;
  const auto watch = [&](std::string_view name, const std::string& unit, bool tested, auto value) {
    all.push_back(
        {{std::string(name), unit,
          [joint, value](const Signals& s) -> Eigen::ArrayXd { return value(s.joints[joint]); }},
         tested});
  };
  using S = const JointSignals&;
  watch(kVelocity, length + "/s", true, [link](S s) { return link ? s.qd : s.thetad; });
  watch("direction", "", true,
        [link](S s) -> Eigen::ArrayXd { return (link ? s.qd : s.thetad).sign(); });
  watch("position q", length, true, [](S s) { return s.q; });
  watch("position theta", length, true, [](S s) { return s.theta; });
  if (e.columns.deflection >= 0)
    watch("deflection", length, true, [](S s) -> Eigen::ArrayXd { return s.theta - s.q; });
  watch(kLoad, torque_unit(axes), true, [](S s) { return s.tau_load; });
  watch(kDrive, "", false, [least](S s) { return drive_state(s, least); });
  return all;
}

JudgedRows empty_rows(std::size_t place, const EquationRows& e,
                      const std::vector<Watched>& watched) {
  JudgedRows out;
  out.equation = place;
  out.n_own = e.columns.count;
  Eigen::Index column = out.n_own;
  for (const Watched& one : watched)
    out.variables.push_back({one.observed.name, one.observed.unit, column++, one.tested});
  out.log = column;
  return out;
}

/// The job's settings in the rows of a log with another rate.
RowSettings settings_for(const DynamicJob& job, const LogSurvey& log, const PartFilter& wanted) {
  RowSettings settings = job.settings.rows;
  const double own = sample_rates({&log, 1}, wanted).lowest;
  const double ratio = own / sample_rates(job.logs, job.wanted).lowest;
  if (settings.signal.cutoff >= kMostCutoff * own)
    throw input_error(
        {log.plan.path, 0, 0},
        fmt::format("its rate of {:.4g} Hz is too low for the fit's cut-off of {:.4g} "
                    "Hz",
                    own, settings.signal.cutoff),
        "fit again with a lower --cutoff, or validate on a faster log");
  const auto scaled = [ratio](auto rows) {
    return static_cast<decltype(rows)>(std::lround(ratio * static_cast<double>(rows)));
  };
  settings.decimate = std::max(1, scaled(settings.decimate));
  settings.drop_edge = std::max(kDifferenceEdge, scaled(settings.drop_edge));
  settings.rest_margin = scaled(settings.rest_margin);
  settings.rate = own;
  return settings;
}

/// Every so many windows are looked at.
std::size_t stride_of(const LogSurvey& log, std::size_t most_windows) {
  if (most_windows == 0) return 1;
  const auto n_windows =
      divided_up(static_cast<Eigen::Index>(log.n_rows), static_cast<Eigen::Index>(kWindowRows));
  return static_cast<std::size_t>(
      std::max<Eigen::Index>(1, divided_up(n_windows, static_cast<Eigen::Index>(most_windows))));
}

void append(JudgedRows& to, const EquationBatch& batch, std::size_t log, Eigen::Index offset) {
  const Eigen::Index n = batch.rows.rows();
  if (n == 0) return;
  EquationBatch more{Eigen::MatrixXd(n, batch.rows.cols() + 1), batch.numbers, {}, {}};
  more.rows << batch.rows, Eigen::VectorXd::Constant(n, static_cast<double>(log));
  for (Eigen::Index& number : more.numbers) number += offset;
  to.last_number = more.numbers.back();
  to.n_rows += n;
  to.rows->append(more);
}

}  // namespace

const JudgedVariable& JudgedRows::variable(std::string_view name) const {
  return *std::find_if(variables.begin(), variables.end(),
                       [&](const JudgedVariable& v) { return v.name == name; });
}

std::vector<JudgedRows> judged_rows(const DynamicJob& job,
                                    const std::vector<EquationRows>& equations,
                                    std::span<const LogSurvey> logs, std::size_t most_windows) {
  std::vector<JudgedRows> all;
  std::vector<Equation> plain;
  for (std::size_t k = 0; k < equations.size(); ++k) {
    const std::vector<Watched> watched = watched_of(job, equations[k]);
    std::vector<Observed> observed;
    for (const Watched& one : watched) observed.push_back(one.observed);
    plain.push_back(with_observed(equations[k].equation, observed));
    all.push_back(empty_rows(k, equations[k], watched));
  }
  Eigen::Index offset = 0;
  for (std::size_t log = 0; log < logs.size(); ++log) {
    for (JudgedRows& rows : all) rows.first_number.push_back(offset);
    if (std::none_of(logs[log].parts.begin(), logs[log].parts.end(), job.wanted)) continue;
    const std::size_t stride = stride_of(logs[log], most_windows);
    const WindowFilter keep = [stride](const WindowPlace& window) {
      return static_cast<std::size_t>(window.begin / kWindowRows) % stride == 0;
    };
    stream_rows(
        {&logs[log], 1}, job.wanted, settings_for(job, logs[log], job.wanted), plain,
        job.options.samples.threads, [](RowBatch batch) { return batch; },
        [&](const RowBatch& batch) {
          std::size_t k = 0;
          for (JudgedRows& rows : all) append(rows, batch.equations[k++], log, offset);
        },
        keep);
    for (const JudgedRows& rows : all) offset = std::max(offset, rows.last_number + 1);
  }
  return all;
}

}  // namespace cablefit

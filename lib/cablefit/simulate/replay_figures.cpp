#include "cablefit/simulate/replay_figures.hpp"

#include <fmt/format.h>

#include <array>

namespace cablefit {
namespace {

std::string part_text(const PartSurvey& part) {
  std::string text = part.preload + ", " + std::string(to_string(part.phase));
  return part.run.empty() ? text : text + ", run " + part.run;
}

/// Where a channel is found among measured and simulated rows.
struct Compared {
  Channel channel;
  const char* kind;
  const char* unit;
  Eigen::ArrayXXd ReplayedRows::*measured;
  Eigen::ArrayXXd SimulationResult::*simulated;
  Eigen::ArrayXXd SimulationBand::*band;
};

const Compared& compared_of(Channel channel) {
  static const std::array<Compared, 3> kCompared = {
      {{Channel::q, "link position", "rad", &ReplayedRows::q, &SimulationResult::q,
        &SimulationBand::q},
       {Channel::theta, "motor position", "rad", &ReplayedRows::theta, &SimulationResult::theta,
        &SimulationBand::theta},
       {Channel::tau, "motor torque", "N m", &ReplayedRows::tau, &SimulationResult::tau,
        &SimulationBand::tau}}};
  for (const Compared& one : kCompared)
    if (one.channel == channel) return one;
  return kCompared.front();
}

}  // namespace

ReplayFigures::ReplayFigures(const LogSurvey& log, const PartSurvey& part, bool closed_loop)
    : time_(
          {&log, 1}, [&](const PartSurvey& p) { return &p == &part; }, 1),
      section_(log.plan.path),
      group_(part_text(part)) {
  for (int joint = 0; joint < log.plan.rig.n_joints(); ++joint) {
    add_signal(log, Channel::q, joint);
    add_signal(log, Channel::theta, joint);
    if (closed_loop) add_signal(log, Channel::tau, joint);
  }
}

void ReplayFigures::add_signal(const LogSurvey& log, Channel channel, int joint) {
  if (!log.plan.has(channel, joint)) return;
  const Compared& one = compared_of(channel);
  const bool many = log.plan.rig.n_joints() > 1;
  const std::string unit = unit_for(log.plan.rig.axes.of(joint), one.unit);
  signals_.push_back({std::string(channel_name(channel)) + (many ? std::to_string(joint + 1) : ""),
                      one.kind, unit, one.measured, one.simulated, joint, one.band,
                      time_.new_line(), time_.new_line(), time_.new_line(), time_.new_close_up(),
                      time_.new_close_up(), time_.new_line(), time_.new_line()});
}

void ReplayFigures::add(const ReplayedRows& rows) {
  for (Signal& signal : signals_) {
    const Eigen::ArrayXXd& measured = rows.*signal.measured;
    const Eigen::ArrayXXd& simulated = rows.simulated.*signal.simulated;
    if (signal.joint >= measured.cols() || signal.joint >= simulated.cols()) continue;
    for (Eigen::Index i = 0; i < simulated.rows(); ++i) {
      const double t = rows.t0 + static_cast<double>(i) * rows.period;
      signal.measured_line.add(t, measured(i, signal.joint));
      signal.simulated_line.add(t, simulated(i, signal.joint));
      if (time_.in_close_up(t)) {
        signal.near_measured.add(t, measured(i, signal.joint));
        signal.near_simulated.add(t, simulated(i, signal.joint));
      }
      const double gap = simulated(i, signal.joint) - measured(i, signal.joint);
      signal.gap_line.add(t, gap);
      signal.explained.add(measured(i, signal.joint), gap);
    }
    if (!rows.band.empty()) add_band(rows, signal);
  }
  has_band_ = has_band_ || !rows.band.empty();
}

void ReplayFigures::add_band(const ReplayedRows& rows, Signal& signal) const {
  const auto half_width = (rows.band.*signal.band).col(signal.joint);
  for (Eigen::Index i = 0; i < half_width.size(); ++i) {
    const double t = rows.t0 + static_cast<double>(i) * rows.period;
    signal.band_above.add(t, half_width(i));
    signal.band_below.add(t, -half_width(i));
  }
}

Figure ReplayFigures::blank(const Signal& signal) const {
  Figure figure;
  figure.section = section_;
  figure.group = group_;
  figure.x = time_.axis();
  figure.y = {signal.kind + " " + signal.name, signal.unit};
  figure.wide = true;
  return figure;
}

std::vector<Figure> ReplayFigures::figures() const {
  std::vector<Figure> figures;
  const auto draw = [](Figure& figure, const ThinnedLine& line, const std::string& name, int series,
                       TraceStyle style = TraceStyle::line) {
    figure.traces.push_back({name, style, series, {}, {}, {}, {}, {}});
    line.draw(figure.traces.back());
  };
  for (const Signal& signal : signals_) {
    Figure both = blank(signal);
    both.title = "Measured and simulated " + signal.name;
    both.rank = FigureRank::main;
    both.caption = "Explained: share of the variance.";
    draw(both, signal.measured_line, "measured", kMeasured, TraceStyle::broad);
    draw(both, signal.simulated_line,
         fmt::format("simulated, {} explained", signal.explained.about_mean()), 2);
    Figure near = blank(signal);
    near.title = both.title + ", close-up";
    near.caption = "Row by row, in the middle of the log.";
    near.rank = FigureRank::detail;
    draw(near, signal.near_measured, "measured", kMeasured, TraceStyle::broad);
    draw(near, signal.near_simulated, "simulated", 2);
    Figure gap = blank(signal);
    gap.title = "Gap of " + signal.name;
    gap.caption = "Simulated minus measured.";
    gap.y.title = "gap of " + signal.name;
    draw(gap, signal.gap_line, "simulated - measured", 2);
    if (has_band_) {
      gap.caption += " Band: 95 %, from the covariance of the parameters, without sensor noise.";
      draw(gap, signal.band_above, "band of the parameters, above", kReference, TraceStyle::dashed);
      draw(gap, signal.band_below, "below", kReference, TraceStyle::dashed);
    }
    figures.push_back(std::move(both));
    if (!near.traces.front().x.empty()) figures.push_back(std::move(near));
    figures.push_back(std::move(gap));
  }
  return figures;
}

}  // namespace cablefit

#include "cablefit/samples/check_figures.hpp"

#include <array>

#include "cablefit/samples/rows/time_axis.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kMinRows = 2;

/// Channels of one unit share a plot.
struct ChannelGroup {
  const char* title;
  const char* axis;
  const char* unit;
  std::vector<Channel> channels;
};

const std::array<ChannelGroup, 3>& groups() {
  static const std::array<ChannelGroup, 3> kGroups = {
      {{"Positions", "position", "rad", {Channel::theta_ref, Channel::theta, Channel::q}},
       {"Velocity", "velocity", "rad/s", {Channel::w}},
       {"Torques", "torque", "N m", {Channel::tau, Channel::tau_load}}}};
  return kGroups;
}

/// One line on its way: the column of the log and the figure it belongs to.
struct Line {
  Eigen::Index slot;
  std::size_t figure;
  std::string name;
  int series;
  ThinnedLine thinned;
};

std::string part_name(const PartSurvey& part) {
  std::string name = part.preload;
  if (!part.run.empty()) name += ", run " + part.run;
  return name + ", " + std::string(to_string(part.phase));
}

class PartFigures {
 public:
  PartFigures(const LogSurvey& log, const PartSurvey& part) {
    const TimeAxis time(
        {&log, 1}, [&](const PartSurvey& p) { return &p == &part; }, 1);
    const int n_joints = log.plan.rig.n_joints();
    for (int joint = 0; joint < n_joints; ++joint)
      for (const ChannelGroup& group : groups()) add_group(log, part, time, group, joint);
  }

  void add(const Window& window) {
    for (Eigen::Index i = window.begin; i < window.end; ++i) {
      const double t = window.t0 + static_cast<double>(i) * window.period;
      for (Line& line : lines_) line.thinned.add(t, window.data(i - window.first, line.slot));
    }
  }

  std::vector<Figure> figures() const {
    std::vector<Figure> figures = figures_;
    for (const Line& line : lines_) {
      Trace trace{line.name, TraceStyle::line, line.series, {}, {}, {}, {}, {}};
      line.thinned.draw(trace);
      figures[line.figure].traces.push_back(std::move(trace));
    }
    return figures;
  }

 private:
  void add_group(const LogSurvey& log, const PartSurvey& part, const TimeAxis& time,
                 const ChannelGroup& group, int joint) {
    const std::string suffix = log.plan.rig.n_joints() > 1 ? std::to_string(joint + 1) : "";
    const std::size_t first_line = lines_.size();
    for (const Channel channel : group.channels) {
      const int slot = log.plan.find(channel, joint);
      if (slot < 0) continue;
      const int series = static_cast<int>(lines_.size() - first_line);
      lines_.push_back({slot, figures_.size(), std::string(channel_name(channel)) + suffix, series,
                        time.new_line()});
    }
    if (lines_.size() == first_line) return;
    Figure figure;
    figure.section = log.plan.path;
    figure.group = part_name(part);
    figure.title = std::string(group.title) + (suffix.empty() ? "" : " of joint " + suffix);
    figure.x = time.axis();
    figure.y = {group.axis, unit_for(log.plan.rig.axes.of(joint), group.unit)};
    figure.wide = true;
    figures_.push_back(std::move(figure));
  }

  std::vector<Figure> figures_;
  std::vector<Line> lines_;
};

}  // namespace

std::vector<Figure> check_figures(const LogSurvey& log) {
  std::vector<PartFigures> parts;
  for (const PartSurvey& part : log.parts) parts.emplace_back(log, part);
  for_each_window(
      log, [](const PartSurvey&) { return true; }, 0, kMinRows, 0.0,
      [&](Window&& window) {
        parts[window.part].add(window);
        return true;
      });
  std::vector<Figure> figures;
  for (const PartFigures& part : parts)
    for (Figure& figure : part.figures()) figures.push_back(std::move(figure));
  return figures;
}

}  // namespace cablefit

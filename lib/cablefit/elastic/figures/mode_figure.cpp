#include "cablefit/elastic/figures/mode_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cablefit/figure/contour.hpp"
#include "cablefit/figure/regions.hpp"
#include "cablefit/model/modes.hpp"

namespace cablefit {
namespace {

constexpr Eigen::Index kGrid = 121;  // places each way
constexpr int kLeastDepth = 3;       // of a region with room for a word, places

std::vector<std::size_t> cables_of(const Transmission& transmission, std::size_t joint) {
  std::vector<std::size_t> moved;
  for (std::size_t c = 0; c < transmission.cables.size(); ++c) {
    const Cable& cable = transmission.cables[c];
    if (cable.passes(joint)) moved.push_back(c);
  }
  return moved;
}

/// Way of q that moves the cables as far as one unit of theta, about the reference pose.
double ways_of_q(const Transmission& transmission, Eigen::Index joint) {
  double most = 0;
  for (const Cable& cable : transmission.cables) {
    const double link = cable.link_radii(transmission.reference_q())(joint);
    const double motor = cable.motor_radii(transmission.reference_theta())(joint);
    if (link != 0) most = std::max(most, std::abs(motor / link));
  }
  return most > 0 ? most : 1;
}

Eigen::VectorXd places(double middle, double width) {
  return Eigen::VectorXd::LinSpaced(kGrid, middle - width / 2, middle + width / 2);
}

/// Which cables are slack, as a number per node and in words per number.
struct Kinds {
  Eigen::ArrayXXi of_node;
  std::vector<std::string> names;
};

Kinds kinds_of(const ModeMap& map, const Transmission& transmission,
               const std::vector<std::size_t>& cables) {
  Kinds kinds{Eigen::ArrayXXi(map.q.size(), map.theta.size()), {}};
  for (Eigen::Index i = 0; i < map.q.size(); ++i)
    for (Eigen::Index j = 0; j < map.theta.size(); ++j) {
      std::string name;
      for (const std::size_t c : cables)
        if (!map.taut(c, i, j))
          name += (name.empty() ? "slack: " : ", ") + transmission.cables[c].name;
      if (name.empty()) name = "all taut";
      const auto found = std::find(kinds.names.begin(), kinds.names.end(), name);
      kinds.of_node(i, j) = static_cast<int>(found - kinds.names.begin());
      if (found == kinds.names.end()) kinds.names.push_back(name);
    }
  return kinds;
}

/// Lines of every other cable are dashed, so that two that coincide are both seen.
std::vector<Trace> slack_lines(const ModeMap& map, const Transmission& transmission,
                               const std::vector<std::size_t>& cables) {
  std::vector<Trace> lines;
  for (const std::size_t c : cables) {
    Trace line{fmt::format("cable {} goes slack", transmission.cables[c].name),
               c % 2 == 0 ? TraceStyle::line : TraceStyle::dashed,
               static_cast<int>(c) + 1,
               {},
               {},
               {},
               {},
               {}};
    draw_zero_lines(map.q, map.theta, map.elongation[c], line);
    if (!line.x.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

Trace closure_area(const ModeMap& map, const std::vector<std::size_t>& cables) {
  Trace area{"all taut: force closure", TraceStyle::area, kReference, {}, {}, {}, {}, {}};
  Eigen::MatrixXd least = map.elongation[cables.front()];
  for (const std::size_t c : cables) least = least.cwiseMin(map.elongation[c]);
  draw_positive_area(map.q, map.theta, least, area);
  return area;
}

std::string caption(const Transmission& transmission, bool in_one_place) {
  std::string text =
      "Which of the fitted cables are slack where: force closure while all are taut, force "
      "disclosure elsewhere.";
  if (transmission.n_joints > 1)
    text += " Cables that this joint moves; the others hold their reference pose.";
  if (in_one_place) text += " The link was blocked in one place; q is shown about it.";
  return text;
}

}  // namespace

Figure mode_figure(const Transmission& transmission, int joint, ChannelRange q, ChannelRange theta,
                   Axes axes) {
  const double way = ways_of_q(transmission, joint) * theta.width();
  const bool in_one_place = q.width() < way / 2;
  ReferencePose pose{transmission.reference_q(),
                     transmission.reference_theta() + transmission.encoder_zero()};
  const ModeMap map =
      mode_map(transmission, joint, places(q.middle(), in_one_place ? way : q.width()),
               places(theta.middle(), theta.width()), pose);
  const std::vector<std::size_t> cables = cables_of(transmission, static_cast<std::size_t>(joint));
  Figure figure;
  figure.title = "Force closure and disclosure over q and theta";
  figure.caption = caption(transmission, in_one_place);
  figure.wide = true;
  const std::string unit = unit_for(axes, "rad");
  figure.x = {"link position q", unit};
  figure.y = {"motor position theta", unit};
  if (Trace area = closure_area(map, cables); !area.x.empty())
    figure.traces.push_back(std::move(area));
  for (Trace& line : slack_lines(map, transmission, cables))
    figure.traces.push_back(std::move(line));
  const Kinds kinds = kinds_of(map, transmission, cables);
  figure.notes = region_notes(map.q, map.theta, kinds.of_node, kinds.names, kLeastDepth);
  return figure;
}

}  // namespace cablefit

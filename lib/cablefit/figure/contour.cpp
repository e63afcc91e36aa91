#include "cablefit/figure/contour.hpp"

#include <array>
#include <map>
#include <set>
#include <utility>

#include "cablefit/base/parameter.hpp"

namespace cablefit {
namespace {

struct Node {
  Eigen::Index i, j;
};
/// Edge of a cell: its lower left node, and whether it goes along y.
struct Edge {
  Eigen::Index i, j;
  bool upright;
  auto operator<=>(const Edge&) const = default;
};
/// Pieces of lines, each from an edge to another one. No two begin, or end, on the same edge.
using Pieces = std::map<Edge, Edge>;

/// A line enters a cell where going around it counter-clockwise comes from positive to negative
/// values, and so has the positive ones to its left. In a saddle these are joined.
void add_pieces(const Eigen::MatrixXd& values, Eigen::Index i, Eigen::Index j, Pieces& pieces) {
  const std::array<Node, 4> corners = {{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
  const std::array<Edge, 4> edges = {
      {{i, j, false}, {i + 1, j, true}, {i, j + 1, false}, {i, j, true}}};
  const auto positive = [&](std::size_t k) {
    const Node node = corners.at(k % 4);
    return values(node.i, node.j) > 0;
  };
  for (std::size_t k = 0; k < 4; ++k) {
    if (!positive(k) || positive(k + 1)) continue;
    std::size_t end = k + 1;
    while (positive(end) || !positive(end + 1)) ++end;
    pieces.emplace(edges.at(k), edges.at(end % 4));
  }
}

Pieces pieces_of(const Eigen::MatrixXd& values) {
  Pieces pieces;
  for (Eigen::Index i = 0; i + 1 < values.rows(); ++i)
    for (Eigen::Index j = 0; j + 1 < values.cols(); ++j) add_pieces(values, i, j, pieces);
  return pieces;
}

/// Takes the pieces that follow each other from `edge` on; the edges on the way.
std::vector<Edge> take_line(Pieces& pieces, Edge edge) {
  std::vector<Edge> line = {edge};
  for (auto next = pieces.find(edge); next != pieces.end(); next = pieces.find(edge)) {
    edge = next->second;
    line.push_back(edge);
    pieces.erase(next);
  }
  return line;
}

/// Open lines from their beginnings, then closed ones from anywhere.
std::vector<std::vector<Edge>> lines_of(Pieces pieces) {
  std::set<Edge> beginnings;
  for (const auto& [from, to] : pieces) beginnings.insert(from);
  for (const auto& [from, to] : pieces) beginnings.erase(to);
  std::vector<std::vector<Edge>> lines;
  for (const Edge& edge : beginnings) lines.push_back(take_line(pieces, edge));
  while (!pieces.empty()) lines.push_back(take_line(pieces, pieces.begin()->first));
  return lines;
}

double crossing(double a, double b, double value_a, double value_b) {
  return a + (b - a) * value_a / (value_a - value_b);
}

/// The values with -1 all around, beyond an edge of no width.
Eigen::MatrixXd framed(const Eigen::MatrixXd& values) {
  Eigen::MatrixXd wider = Eigen::MatrixXd::Constant(values.rows() + 2, values.cols() + 2, -1);
  wider.block(1, 1, values.rows(), values.cols()) = values;
  return wider;
}
Eigen::VectorXd framed(const Eigen::VectorXd& places) {
  Eigen::VectorXd wider(places.size() + 2);
  wider << places(0), places, places(places.size() - 1);
  return wider;
}

}  // namespace

void draw_zero_lines(const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                     const Eigen::MatrixXd& values, Trace& trace) {
  const auto add = [&](double at_x, double at_y) {
    trace.x.push_back(at_x);
    trace.y.push_back(at_y);
  };
  for (const std::vector<Edge>& line : lines_of(pieces_of(values))) {
    if (!trace.x.empty()) add(kNotKnown, kNotKnown);
    for (const Edge& edge : line) {
      const Node end{edge.upright ? edge.i : edge.i + 1, edge.upright ? edge.j + 1 : edge.j};
      const double a = values(edge.i, edge.j), b = values(end.i, end.j);
      add(crossing(x(edge.i), x(end.i), a, b), crossing(y(edge.j), y(end.j), a, b));
    }
  }
}

void draw_positive_area(const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                        const Eigen::MatrixXd& values, Trace& trace) {
  draw_zero_lines(framed(x), framed(y), framed(values), trace);
}

}  // namespace cablefit

#include "cablefit/report/sections/polytope_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cablefit/report/parts/document_parts.hpp"
#include "cablefit/report/parts/numbers.hpp"

namespace cablefit {
namespace {

constexpr int kTorqueDigits = 4;
constexpr double kRoundOff = 1e-9;  // of a torque: 0

std::string torque_text(double value) {
  return significant(std::abs(value) < kRoundOff ? 0 : value, kTorqueDigits);
}

/// "(1, -2)"
std::string vector_text(const Eigen::VectorXd& v) {
  std::string text;
  for (const double value : v)
    text += fmt::format("{}{:.4g}", text.empty() ? "" : ", ", value == 0 ? 0.0 : value);
  return "(" + text + ")";
}

std::string columns_text(const Eigen::MatrixXd& m) {
  std::string text;
  for (const auto& column : m.colwise()) text += (text.empty() ? "" : " ") + vector_text(column);
  return text;
}

Table torque_table(const DesignResult& result, const TorquePolytope& p, const std::string& torque) {
  Table table;
  table.title = fmt::format("Torques that the cables can make {} [{}]", p.where, torque);
  table.columns = {{"", "joint", "", true},
                   {"others as they come", "least", ""},
                   {"others as they come", "largest", ""},
                   {"others 0", "least", ""},
                   {"others 0", "largest", ""}};
  for (int j = 0; j < p.q.size(); ++j)
    table.rows.push_back({std::to_string(j + 1), torque_text(-p.largest(j, -1)),
                          torque_text(p.largest(j, 1)), torque_text(-p.largest_alone(j, -1)),
                          torque_text(p.largest_alone(j, 1))});
  table.notes = {fmt::format("each cable from 0 to {:g} {}; {} vertices, {} facets",
                             result.largest_tension, result.cable_space ? "N" : torque,
                             p.vertices.cols(), p.normals.cols())};
  if (p.closure)
    table.notes.push_back("force closure: some tensions above 0 make any torque");
  else if (p.normals.cols() == 0)
    table.notes.push_back("NO force closure: the cables do not move every joint");
  else
    table.notes.push_back(fmt::format("NO force closure: nothing along {}", columns_text(p.cone)));
  return table;
}

Table vertex_table(const TorquePolytope& p) {
  Table table;
  table.title = "Vertices of these torques " + p.where;
  for (int j = 0; j < p.q.size(); ++j)
    table.columns.push_back({"", fmt::format("tau_l{}", j + 1), ""});
  for (const auto& vertex : p.vertices.colwise()) {
    std::vector<std::string> row;
    for (const double value : vertex) row.push_back(torque_text(value));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table slack_table(const DesignResult& result, const std::string& torque) {
  Table table;
  table.title = "Which cable goes slack first";
  table.columns = {{"", "load along", "", true}, {"", "cables, and load", torque, true}};
  for (const SlackOrder& order : result.slack_orders) {
    std::string text;
    for (const SlackLoad& slack : order.cables)
      text +=
          fmt::format("{}{} at {}", text.empty() ? "" : ", ", slack.cable, torque_text(slack.load));
    table.rows.push_back({vector_text(order.direction), text.empty() ? "none" : text});
  }
  table.notes = {"a load on the links, motors held at rest"};
  return table;
}

/// Of two joints: the outline.
Figure polytope_figure(const TorquePolytope& p, const std::string& torque) {
  Figure figure;
  figure.section = "Torques that the cables can make";
  figure.title = "Torques of both joints " + p.where;
  figure.caption = "Inside the outline every tension is between 0 and the largest.";
  figure.x = {"tau_l1", torque};
  figure.y = {"tau_l2", torque};
  Trace outline;
  outline.name = "torques";
  outline.series = 1;
  for (Eigen::Index k = 0; k <= p.vertices.cols(); ++k) {
    outline.x.push_back(p.vertices(0, k % p.vertices.cols()));
    outline.y.push_back(p.vertices(1, k % p.vertices.cols()));
  }
  figure.traces.push_back(std::move(outline));
  return figure;
}

}  // namespace

void add_polytopes(const DesignResult& result, Document& document) {
  const std::string torque = torque_unit(result.axes);
  std::vector<Figure> figures;
  for (const TorquePolytope& p : result.polytopes) {
    add_table(document, torque_table(result, p, torque));
    add_detail(document, vertex_table(p));
    if (p.q.size() == 2) figures.push_back(polytope_figure(p, torque));
  }
  if (!result.slack_orders.empty()) add_table(document, slack_table(result, torque));
  add_figures(document, figures);
}

}  // namespace cablefit

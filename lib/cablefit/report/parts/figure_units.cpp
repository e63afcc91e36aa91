#include "cablefit/report/parts/figure_units.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "cablefit/base/axes.hpp"
#include "cablefit/report/parts/numbers.hpp"

namespace cablefit {
namespace {

bool is_small(const FigureAxis& axis) {
  constexpr std::array<std::string_view, 3> kSmall{"deflection", "initial elongation", "gap of"};
  return (axis.unit == "rad" || axis.unit == "m") &&
         std::any_of(kSmall.begin(), kSmall.end(),
                     [&](std::string_view begin) { return axis.title.starts_with(begin); });
}

void scale(std::vector<double>& values) {
  for (double& value : values) value *= kMilli;
}

void show_x_in_milli(Figure& figure) {
  figure.x.unit = "m" + figure.x.unit;
  for (Trace& trace : figure.traces) scale(trace.x);
  for (Mark& mark : figure.marks) mark.x *= kMilli;
  for (Note& note : figure.notes) note.x *= kMilli;
}

void show_y_in_milli(Figure& figure) {
  figure.y.unit = "m" + figure.y.unit;
  for (Trace& trace : figure.traces)
    for (auto* values : {&trace.y, &trace.low, &trace.high}) scale(*values);
  for (Note& note : figure.notes) note.y *= kMilli;
}

}  // namespace

Figure in_table_units(Figure figure) {
  if (is_small(figure.x)) show_x_in_milli(figure);
  if (is_small(figure.y)) show_y_in_milli(figure);
  return figure;
}

}  // namespace cablefit

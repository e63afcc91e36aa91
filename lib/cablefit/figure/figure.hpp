// A plot as plain data: its content, not its style. Fits make figures when requested, and report/
// renders them. Other programs can draw the same data.
#pragma once

#include <string>
#include <vector>

namespace cablefit {

struct FigureAxis {
  std::string title;         ///< "deflection theta - q"
  std::string unit;          ///< printed in brackets; may be empty
  bool logarithmic = false;  ///< of y only; values up to 0 are not drawn
};

enum class TraceStyle {
  line,      ///< points joined in order; a NaN breaks the line
  broad,     ///< a wide line for measured data: its edges stay visible under other lines
  dashed,    ///< a dashed line for a reference
  points,    ///< a cloud
  steps,     ///< a histogram's outline, x at the middle of the bins
  interval,  ///< points with a bar from low to high
  area,      ///< filled outlines; a NaN starts the next one
};

/// Decides the colour of a trace. Models count from 1, with the same number on every figure of a
/// report.
inline constexpr int kMeasured = 0;
inline constexpr int kReference = -1;

struct Trace {
  std::string name;
  TraceStyle style = TraceStyle::line;
  int series = kMeasured;
  std::vector<double> x, y;         ///< of one length, in the units of the axes
  std::vector<double> low, high;    ///< only for TraceStyle::interval, as long as y
  std::vector<std::string> labels;  ///< instead of x: names along the axis
};

/// A dotted line across the plot with a label, such as where a log begins.
struct Mark {
  double x = 0;
  std::string text;
};

/// A label within the plot, such as the name of a region.
struct Note {
  double x = 0, y = 0;  ///< the middle of the label
  std::string text;
};

/// How soon a report shows a figure.
enum class FigureRank {
  main,    ///< first of all: measurement and model
  shown,   ///< with the results
  detail,  ///< a diagnostic, folded until the reader opens it
};

struct Figure {
  std::string section;  ///< heading above its figures: the preload, or the log
  std::string group;    ///< heading below that: "motor equation"; may be empty
  std::string title;
  std::string caption;  ///< what to look for, and how points were thinned out
  FigureAxis x, y;
  std::vector<Trace> traces;
  std::vector<Mark> marks;
  std::vector<Note> notes;
  bool wide = false;  ///< over the full width, as for signals over time
  FigureRank rank = FigureRank::shown;
};

}  // namespace cablefit

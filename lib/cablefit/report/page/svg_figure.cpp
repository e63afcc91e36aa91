#include "cablefit/report/page/svg_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "cablefit/report/page/html_text.hpp"
#include "cablefit/report/page/trace_look.hpp"

namespace cablefit {
namespace {

// Little wider than the plot on a phone (about 350 px), so that texts keep their size there.
constexpr double kWidth = 400, kHeight = 300;
constexpr double kLeft = 64, kRight = 12, kBottom = 46;
constexpr double kLegendRow = 18, kCharacter = 7.2;  // px, of 12 px text
constexpr double kLowestLegend = 90;
constexpr int kTicksAcross = 5, kTicksUp = 6;

/// A colour of page.css, and what it is where that is not there.
std::string colour(const std::string& name) {
  static const std::vector<std::pair<std::string, std::string>> kPrint = {
      {"series-0", "#30353c"},  {"series-1", "#d55e00"}, {"series-2", "#0072b2"},
      {"series-3", "#009e73"},  {"series-4", "#cc79a7"}, {"series-5", "#e69f00"},
      {"series-6", "#56b4e9"},  {"below", "#b4bac3"},    {"again", "#9aa2ad"},
      {"reference", "#7a828d"}, {"grid", "#e6e9ed"},     {"ink", "#1a1d21"}};
  for (const auto& [known, value] : kPrint)
    if (known == name) return fmt::format("var(--{},{})", name, value);
  return "currentColor";
}

/// A range of data on its way to pixels.
struct Scale {
  double low = 0, high = 1, from = 0, to = 1;
  double operator()(double value) const {
    return from + (value - low) / (high - low) * (to - from);
  }
};

struct Extent {
  double low = INFINITY, high = -INFINITY;
  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  /// With some room; something even for no or one value.
  Scale scale(double from, double to, double room) const {
    if (!(high >= low)) return {0, 1, from, to};
    const double largest = std::max(std::abs(low), std::abs(high));
    // Rounding is no range, and has no ticks.
    const double span = high - low > 1e-9 * largest ? high - low : std::max(1.0, largest);
    return {low - room * span, high + room * span, from, to};
  }
};

/// Round numbers between the ends.
std::vector<double> ticks_of(const Scale& scale, int n) {
  const double rough = (scale.high - scale.low) / n;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double nice : {1.0, 2.0, 5.0})
    if (nice * power >= rough) {
      step = nice * power;
      break;
    }
  const double first = std::ceil(scale.low / step);
  std::vector<double> ticks;
  for (int k = 0; k <= 2 * n && (first + k) * step <= scale.high; ++k)
    ticks.push_back((first + k) * step);
  return ticks;
}

/// Logarithms of 1, 2 and 5 times powers of ten; over many decades of the powers alone.
std::vector<double> log_ticks_of(const Scale& scale) {
  constexpr double kFewDecades = 2.5;
  const bool is_long = scale.high - scale.low > kFewDecades;
  std::vector<double> ticks;
  for (double power = std::floor(scale.low); power <= scale.high; ++power)
    for (const double nice : {1.0, 2.0, 5.0})
      if (const double tick = power + std::log10(nice);
          tick >= scale.low && tick <= scale.high && (nice == 1 || !is_long))
        ticks.push_back(tick);
  return ticks;
}

/// With as many digits as distinguish it from its neighbours.
std::string tick_text(double value, double step) {
  const double largest = std::max(std::abs(value), step);
  const int digits = 2 + static_cast<int>(std::floor(std::log10(largest / step)));
  std::string text = fmt::format("{:.{}g}", value, std::clamp(digits, 6, 15));
  return text.starts_with('-') ? "−" + text.substr(1) : text;
}

std::string text_at(double x, double y, const char* anchor, const std::string& text,
                    const char* more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>", x, y, anchor,
                     more, html_text(text));
}

std::string axis_text(const FigureAxis& axis) {
  return pretty_symbols(axis.title) +
         (axis.unit.empty() ? "" : " [" + pretty_unit(axis.unit) + "]");
}

/// 6 px wide, around its middle.
std::string symbol_at(std::string_view symbol, double x, double y) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kShapes{
      {{"square", "m-3-3h6v6h-6z"},
       {"diamond", "m0-4l4 4l-4 4l-4-4z"},
       {"triangle-up", "m0-4l4 7h-8z"},
       {"x", "m-3-3l6 6m0-6l-6 6"},
       {"cross", "m-4 0h8m-4-4v8"},
       {"star", "m-4 0h8m-6-3.5l4 7m0-7l-4 7"}}};
  std::string_view shape = "m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0";
  for (const auto& [name, path] : kShapes)
    if (name == symbol) shape = path;
  return fmt::format("M{:.1f} {:.1f}{}", x, y, shape);
}

/// The first characters of a long name, `longest` (> 1) bytes or fewer.
std::string short_label(const std::string& label, std::size_t longest) {
  if (label.size() <= longest) return label;
  std::size_t end = longest - 1;
  while (end > 0 && (static_cast<unsigned char>(label[end]) & 0xC0u) == 0x80u) --end;
  return label.substr(0, end) + "…";
}

class Drawing {
 public:
  explicit Drawing(const Figure& figure) : figure_(figure) {
    for (const Trace& trace : figure.traces)
      for (const std::string& label : trace.labels)
        if (std::find(labels_.begin(), labels_.end(), label) == labels_.end())
          labels_.push_back(label);
    const std::string legend = draw_legend();
    Extent x, y;
    for (std::size_t k = 0; k < figure.traces.size(); ++k) {
      for (std::size_t i = 0; i < figure.traces[k].y.size(); ++i) x.add(x_of(k, i));
      for (const auto* values :
           {&figure.traces[k].y, &figure.traces[k].low, &figure.traces[k].high})
        for (const double value : *values) y.add(drawn_y(value));
    }
    for (const Mark& mark : figure.marks) x.add(mark.x);
    x_ = labels_.empty()
             ? x.scale(kLeft, kWidth - kRight, 0)
             : Scale{-0.5, static_cast<double>(labels_.size()) - 0.5, kLeft, kWidth - kRight};
    y_ = y.scale(kHeight - kBottom, top_, 0.05);
    draw_axes();
    draw_marks();
    for (std::size_t k = 0; k < figure.traces.size(); ++k) draw_trace(k);
    svg_ += legend;
  }

  std::string whole() const {
    return fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:g} {:g}\" role=\"img\" "
        "style=\"font:12px sans-serif;fill:{}\"><title>{}</title>{}</svg>",
        kWidth, kHeight, colour("ink"), html_text(pretty_symbols(figure_.title)), svg_);
  }

 private:
  double drawn_y(double value) const { return figure_.y.logarithmic ? std::log10(value) : value; }
  double y_at(double value) const { return y_(drawn_y(value)); }

  std::string tick_text_up(const std::vector<double>& ticks, std::size_t k) const {
    if (figure_.y.logarithmic) return fmt::format("{:.3g}", std::pow(10, ticks[k]));
    return tick_text(ticks[k], step_of(ticks));
  }

  static double step_of(const std::vector<double>& ticks) {
    return ticks.size() > 1 ? ticks[1] - ticks[0] : 1;
  }

  /// Bars of several traces at one name stand beside each other.
  double x_of(std::size_t k, std::size_t i) const {
    const Trace& trace = figure_.traces[k];
    if (trace.labels.empty()) return trace.x[i];
    const auto place = std::find(labels_.begin(), labels_.end(), trace.labels[i]) - labels_.begin();
    const double middle = (static_cast<double>(figure_.traces.size()) - 1) / 2;
    return static_cast<double>(place) + 0.12 * (static_cast<double>(k) - middle);
  }

  void draw_axes() {
    const double bottom = kHeight - kBottom, right = kWidth - kRight;
    const std::string grid =
        fmt::format("<path style=\"stroke:{};fill:none\" d=\"", colour("grid"));
    std::string lines, words;
    const std::vector<double> across = ticks_of(x_, kTicksAcross);
    const std::vector<double> up =
        figure_.y.logarithmic ? log_ticks_of(y_) : ticks_of(y_, kTicksUp);
    for (std::size_t k = 0; k < up.size(); ++k) {
      lines += fmt::format("M{:.1f} {:.1f}H{:.1f}", kLeft, y_(up[k]), right);
      words += text_at(kLeft - 6, y_(up[k]) + 4, "end", tick_text_up(up, k));
    }
    if (labels_.empty())
      for (const double tick : across) {
        lines += fmt::format("M{:.1f} {:.1f}V{:.1f}", x_(tick), top_, bottom);
        words += text_at(x_(tick), bottom + 16, "middle", tick_text(tick, step_of(across)));
      }
    for (std::size_t k = 0; k < labels_.size(); ++k) {  // in two rows
      words += text_at(x_(static_cast<double>(k)), bottom + 16 + (k % 2 == 0 ? 0.0 : 12.0),
                       "middle", short_label(labels_[k], longest_label()));
    }
    words += text_at((kLeft + right) / 2, kHeight - 6, "middle", axis_text(figure_.x));
    const double middle = (top_ + bottom) / 2;
    words += text_at(14, middle, "middle", axis_text(figure_.y),
                     fmt::format(" transform=\"rotate(-90 14 {:.1f})\"", middle).c_str());
    svg_ += grid + lines + "\"/>" +
            fmt::format("<path style=\"stroke:{};fill:none\" d=\"M{:.1f} {:.1f}V{:.1f}H{:.1f}\"/>",
                        colour("reference"), kLeft, top_, bottom, right) +
            words;
  }

  /// So that neighbours in one of two rows do not touch.
  std::size_t longest_label() const {
    const double room = 2 * (kWidth - kRight - kLeft) / static_cast<double>(labels_.size());
    return static_cast<std::size_t>(std::clamp(room / kCharacter - 1, 3.0, 14.0));
  }

  void draw_marks() {
    for (const Mark& mark : figure_.marks)
      svg_ += fmt::format(
          "<path style=\"stroke:{};stroke-dasharray:1 3\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>",
          colour("reference"), x_(mark.x), top_, kHeight - kBottom);
  }

  /// The line; points of the same place (half a pixel) once.
  std::string path_of(std::size_t k) const {
    const Trace& trace = figure_.traces[k];
    const bool steps = trace.style == TraceStyle::steps;
    std::string path;
    bool is_open = false;
    double last_x = NAN, last_y = NAN;
    for (std::size_t i = 0; i < trace.y.size(); ++i) {
      const double x = std::round(2 * x_(x_of(k, i))) / 2, y = std::round(2 * y_at(trace.y[i])) / 2;
      if (!std::isfinite(x) || !std::isfinite(y)) {
        is_open = false;
        continue;
      }
      if (is_open && x == last_x && y == last_y) continue;
      if (steps && is_open)
        path += fmt::format("H{:g}V{:g}", (x + last_x) / 2, y);
      else
        path += fmt::format("{}{:g} {:g}", is_open ? "L" : "M", x, y);
      is_open = true;
      last_x = x;
      last_y = y;
    }
    return path;
  }

  std::string cloud_of(std::size_t k) const {
    std::set<std::pair<int, int>> seen;
    std::string path;
    const Trace& trace = figure_.traces[k];
    for (std::size_t i = 0; i < trace.y.size(); ++i) {
      const double x = x_(x_of(k, i)), y = y_at(trace.y[i]);
      if (!std::isfinite(x) || !std::isfinite(y)) continue;
      const std::pair place(static_cast<int>(x), static_cast<int>(y));
      if (seen.insert(place).second) path += fmt::format("M{} {}h0", place.first, place.second);
    }
    return path;
  }

  /// Symbols of every point, or of some that are evenly spread.
  std::string symbols_of(std::size_t k, const TraceLook& look) const {
    const Trace& trace = figure_.traces[k];
    const std::size_t n = look.n_symbols;
    const std::size_t every = n >= trace.y.size() ? 1 : trace.y.size() / n;
    std::string path;
    for (std::size_t i = every / 2; i < trace.y.size(); i += every) {
      const double x = x_(x_of(k, i)), y = y_at(trace.y[i]);
      if (std::isfinite(x) && std::isfinite(y)) path += symbol_at(look.symbol, x, y);
    }
    return path;
  }

  void draw_trace(std::size_t k) {
    const Trace& trace = figure_.traces[k];
    TraceLook look = look_of(figure_, k);
    if (trace.style == TraceStyle::points) {
      svg_ += fmt::format(
          "<path style=\"stroke:{};stroke-width:2.4;stroke-linecap:round;opacity:.65\" d=\"{}\"/>",
          colour(look.colour), cloud_of(k));
      return;
    }
    if (trace.style == TraceStyle::interval) {
      std::string bars;
      for (std::size_t i = 0; i < trace.y.size(); ++i)
        if (std::isfinite(y_at(trace.low[i])) && std::isfinite(y_at(trace.high[i])))
          bars += fmt::format("M{:.1f} {:.1f}V{:.1f}", x_(x_of(k, i)), y_at(trace.low[i]),
                              y_at(trace.high[i]));
      svg_ += stroke(look, bars, "none");
      look.n_symbols = kEveryPoint;
    } else {
      svg_ += stroke(look, path_of(k), trace.style == TraceStyle::area ? colour("grid") : "none");
    }
    if (look.n_symbols > 0)
      svg_ += fmt::format("<path style=\"stroke:{0};fill:{0}\" d=\"{1}\"/>", colour(look.colour),
                          symbols_of(k, look));
  }

  static std::string stroke(const TraceLook& look, const std::string& path,
                            const std::string& fill) {
    const std::string dash =
        look.dash.empty() ? "" : fmt::format(";stroke-dasharray:{}", look.dash);
    return fmt::format(
        "<path style=\"stroke:{};stroke-width:{:g};fill:{};stroke-linejoin:round{}\" d=\"{}\"/>",
        colour(look.colour), look.width, fill, dash, path);
  }

  /// Names in as many rows as they need; says how much room is left below them.
  std::string draw_legend() {
    std::string legend;
    double x = kLeft, y = 14;
    for (std::size_t k = 0; k < figure_.traces.size(); ++k) {
      const std::string name = pretty_symbols(figure_.traces[k].name);
      if (name.empty()) continue;
      const double width = 34 + kCharacter * static_cast<double>(name.size());
      if (x > kLeft && x + width > kWidth) {
        x = kLeft;
        y += kLegendRow;
      }
      if (y > kLowestLegend) {  // the plot needs the room
        legend += text_at(kLeft, y, "start", fmt::format("+ {} more", figure_.traces.size() - k));
        break;
      }
      TraceLook look = look_of(figure_, k);
      const bool has_line = figure_.traces[k].style != TraceStyle::points;
      if (has_line) legend += stroke(look, fmt::format("M{:g} {:g}h24", x, y - 4), "none");
      if (!has_line || look.n_symbols > 0 || figure_.traces[k].style == TraceStyle::interval)
        legend += fmt::format("<path style=\"stroke:{0};fill:{0}\" d=\"{1}\"/>",
                              colour(look.colour), symbol_at(look.symbol, x + 12, y - 4));
      legend += text_at(x + 29, y, "start", name);
      x += width;
    }
    top_ = y + 10;
    return legend;
  }

  const Figure& figure_;
  std::vector<std::string> labels_;
  double top_ = 0;
  Scale x_, y_;
  std::string svg_;
};

}  // namespace

std::string svg_figure(const Figure& figure) { return Drawing(figure).whole(); }

}  // namespace cablefit

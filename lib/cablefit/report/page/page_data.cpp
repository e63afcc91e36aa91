#include "cablefit/report/page/page_data.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "cablefit/base/base64.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/report/page/html_text.hpp"
#include "cablefit/report/page/trace_look.hpp"
#include "cablefit/report/sections/batch_figures.hpp"

namespace cablefit {
namespace {

using Json = nlohmann::ordered_json;

/// In the order of TraceStyle.
constexpr const char* kStyles[] = {"line",  "broad",    "dashed", "points",
                                   "steps", "interval", "area"};

/// As it is shown: symbols as in print.
std::string shown(const std::string& text) { return isolated(pretty_symbols(printable(text))); }

Json texts(const std::vector<std::string>& all) {
  Json list = Json::array();
  for (const std::string& text : all) list.push_back(isolated(printable(text)));
  return list;
}

Json numbers(const std::vector<double>& values) {
  double base = 0;
  for (const double value : values)
    if (std::isfinite(value)) {
      base = value;
      break;
    }
  return {{"base", base}, {"floats", packed(values, base)}};
}

Json axis_json(const FigureAxis& axis) {
  return {{"title", shown(axis.title)},
          {"unit", pretty_unit(printable(axis.unit))},
          {"dates", axis.title == kDateAxis},
          {"log", axis.logarithmic}};
}

Json look_json(const TraceLook& look) {
  return {{"colour", look.colour},
          {"width", look.width},
          {"dash", look.dash},
          {"symbol", look.symbol},
          {"symbols", look.n_symbols}};
}

Json trace_json(const Figure& figure, std::size_t k) {
  const Trace& trace = figure.traces[k];
  Json json = {{"name", shown(trace.name)},
               {"style", kStyles[static_cast<std::size_t>(trace.style)]},
               {"look", look_json(look_of(figure, k))}};
  if (trace.labels.empty()) {
    json["x"] = numbers(trace.x);
  } else {
    json["labels"] = texts(trace.labels);
  }
  json["y"] = numbers(trace.y);
  if (trace.low.empty()) return json;
  json["low"] = numbers(trace.low);
  json["high"] = numbers(trace.high);
  return json;
}

Json figure_json(const Figure& figure) {
  Json json = {{"section", printable(figure.section)},
               {"group", printable(figure.group)},
               {"title", shown(figure.title)},
               {"x", axis_json(figure.x)},
               {"y", axis_json(figure.y)},
               {"wide", figure.wide},
               {"traces", Json::array()},
               {"marks", Json::array()},
               {"notes", Json::array()}};
  for (std::size_t k = 0; k < figure.traces.size(); ++k)
    json["traces"].push_back(trace_json(figure, k));
  for (const Mark& mark : figure.marks)
    json["marks"].push_back({{"x", mark.x}, {"text", isolated(printable(mark.text))}});
  for (const Note& note : figure.notes)
    json["notes"].push_back(
        {{"x", note.x}, {"y", note.y}, {"text", isolated(printable(note.text))}});
  return json;
}

std::string for_script(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const std::string_view rest(json.data() + i, json.size() - i);
    if (rest.front() == '<') {
      safe += "\\u003c";
    } else if (rest.front() == '>') {
      safe += "\\u003e";
    } else if (rest.front() == '&') {
      safe += "\\u0026";
    } else if (rest.starts_with("\xE2\x80\xA8") || rest.starts_with("\xE2\x80\xA9")) {
      safe += rest[2] == '\xA8' ? "\\u2028" : "\\u2029";
      i += 2;
    } else {
      safe += rest.front();
    }
  }
  return safe;
}

}  // namespace

std::string packed(const std::vector<double>& values, double base) {
  std::string bytes;
  bytes.reserve(4 * values.size());
  for (const double value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value - base));
    for (unsigned shift = 0; shift < 32; shift += 8)
      bytes += static_cast<char>(static_cast<unsigned char>(bits >> shift & 255u));
  }
  return base64(bytes);
}

std::string page_data(const Document& document) {
  Json json = {{"figures", Json::array()}};
  for (const Figure& figure : document.figures) json["figures"].push_back(figure_json(figure));
  return for_script(json.dump());
}

}  // namespace cablefit

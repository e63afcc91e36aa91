// cablefit list: the tables of the library, as they are.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cablefit/dynamic/dynamic_fit.hpp"
#include "cablefit/dynamic/estimators/estimators.hpp"
#include "cablefit/log/log_reader.hpp"
#include "cablefit/model/arm.hpp"
#include "cablefit/model/cables.hpp"
#include "cablefit/model/effects.hpp"
#include "cablefit/model/effects/effect_parameter.hpp"
#include "cablefit/model/load.hpp"
#include "cablefit/report/writers/list_json.hpp"
#include "cablefit/report/writers/writers.hpp"
#include "commands/command.hpp"
#include "options/command_line.hpp"
#include "output/delivery.hpp"

namespace cablefit::apps {
namespace {

constexpr const char* kListExample =
    "Example:\n"
    "  cablefit list effects\n";

/// A table whose columns hold text only.
Table text_table_of(const std::string& title, const std::vector<std::string>& columns) {
  Table table;
  table.title = title;
  for (const std::string& name : columns) table.columns.push_back({"", name, "", true});
  return table;
}

std::string parameters_of(std::span<const ParameterInfo> parameters) {
  std::string text;
  for (const ParameterInfo& info : parameters) {
    if (!text.empty()) text += ", ";
    text += info.name;
    if (!info.unit.empty()) text += fmt::format(" [{}]", info.unit);
  }
  return text;
}

/// The other names of its class.
std::string aliases_of(const Effect& row) {
  std::string text;
  for (const Effect& other : candidate_effects())
    if (!row.alias_class.empty() && other.alias_class == row.alias_class && &other != &row)
      text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", other.name, to_string(other.site));
  return text;
}

Table effect_table(const std::string& title, std::span<const Effect> effects) {
  Table table = text_table_of(title, {"name", "side", "equation", "parameters", "source"});
  for (const Effect& row : effects)
    table.rows.push_back({std::string(row.name), std::string(to_string(row.site)),
                          std::string(row.equation), parameters_of(row.parameters),
                          std::string(row.source)});
  return table;
}

Table difference_table() {
  Table table = text_table_of("What separates similar effects",
                              {"name", "side", "never from", "signature", "experiment"});
  table.detail = true;
  for (const Effect& row : candidate_effects())
    table.rows.push_back({std::string(row.name), std::string(to_string(row.site)), aliases_of(row),
                          std::string(row.signature), std::string(row.experiment)});
  return table;
}

/// As --effects takes it: with its side where the effect acts on several.
std::string option_name(const Effect& row) {
  const std::span<const Effect> all = effects();
  const auto n_sides = std::count_if(all.begin(), all.end(),
                                     [&](const Effect& other) { return other.name == row.name; });
  return n_sides == 1 ? std::string(row.name)
                      : fmt::format("{}[{}]", row.name, to_string(row.site));
}

/// "0 .. 1, default 0"; short, so that the names of effects stay whole on the screen.
std::string values_of(const Effect& row, std::size_t parameter) {
  const ParameterInfo& info = row.parameters[parameter];
  std::string text;
  if (std::isfinite(info.lower))
    text = std::isfinite(info.upper) ? fmt::format("{:g} .. {:g}", info.lower, info.upper)
                                     : fmt::format(">= {:g}", info.lower);
  if (may_be_left_out(row, parameter)) text += text.empty() ? "default 0" : ", default 0";
  return text;
}

Table parameter_table() {
  Table table = text_table_of("Parameters of the effects",
                              {"effect", "parameter", "unit", "values", "meaning"});
  table.detail = true;
  for (const Effect& row : effects()) {
    const std::string effect = option_name(row);
    for (std::size_t k = 0; k < row.parameters.size(); ++k) {
      const ParameterInfo& info = row.parameters[k];
      table.rows.push_back({effect, std::string(info.name), std::string(info.unit),
                            values_of(row, k), std::string(info.meaning)});
    }
    if (!row.is_event) continue;
    table.rows.push_back({effect, "event.time", "s", "", "when, since its log began"});
    table.rows.push_back({effect, "event.log", "", ">= 1, default 1", "number of its log"});
  }
  return table;
}

std::vector<Table> effect_tables() {
  return {
      effect_table("Base model", base_effects()),
      effect_table("Effects beyond the base model, which refine may identify", candidate_effects()),
      difference_table(), parameter_table(),
      effect_table("Errors of the rig file, which refine may identify from several joints together",
                   rig_errors())};
}

std::string orders_of(const CableLaw& law) {
  return law.max_order == 1 ? "1" : fmt::format("1 to {}", law.max_order);
}

std::vector<Table> model_tables() {
  Table models = text_table_of("Models of stage 2", {"name", "equation", "source"});
  for (const DynamicModel& model : dynamic_models()) {
    models.rows.push_back(
        {std::string(model.name), std::string(model.equation), std::string(model.source)});
  }
  Table cables = text_table_of("Cable laws (rig file: cables, law)",
                               {"name", "order", "equation", "coefficients", "source"});
  for (const CableLaw& law : cable_laws()) {
    cables.rows.push_back({std::string(law.name), orders_of(law), std::string(law.equation),
                           std::string(law.coefficients), std::string(law.source)});
  }
  Table maps = text_table_of("Displacement maps (rig file: cables, motor_radius and link_radius)",
                             {"name", "displacement at angle x", "source"});
  for (const MapKind& kind : map_kinds()) {
    maps.rows.push_back(
        {std::string(kind.name), std::string(kind.equation), std::string(kind.source)});
  }
  Table pairs = text_table_of("Maps of two joints (rig file: cables, motor_map and link_map)",
                              {"name", "displacement at angles x1, x2", "source"});
  for (const PairMapKind& kind : pair_map_kinds()) {
    pairs.rows.push_back(
        {std::string(kind.name), std::string(kind.equation), std::string(kind.source)});
  }
  Table loads = text_table_of("Load laws (rig file: load, type)", {"name", "equation"});
  for (const LoadLaw& law : load_laws()) {
    loads.rows.push_back({std::string(law.name), std::string(law.equation)});
  }
  Table arms = text_table_of("Arms (rig file: arm, type)", {"name", "link side", "source"});
  for (const ArmKind& kind : arm_kinds()) {
    arms.rows.push_back(
        {std::string(kind.name), std::string(kind.equation), std::string(kind.source)});
  }
  return {models, cables, maps, pairs, loads, arms};
}

std::vector<Table> estimator_tables() {
  Table table = text_table_of("Estimators", {"name", "description", "source"});
  for (const Estimator& row : estimators()) {
    table.rows.push_back(
        {std::string(row.name), std::string(row.description), std::string(row.source)});
  }
  return {table};
}

std::vector<Table> format_tables() {
  Table logs = text_table_of("Log formats, also as .gz and .zst", {"name", "description"});
  for (const LogFormat& format : log_formats()) {
    logs.rows.push_back({std::string(format.name), std::string(format.description)});
  }
  Table reports = text_table_of("Report formats", {"name", "extension", "description"});
  for (const ReportWriter& writer : report_writers()) {
    reports.rows.push_back(
        {std::string(writer.name), std::string(writer.extension), std::string(writer.description)});
  }
  return {logs, reports};
}

struct Section {
  const char* name;
  std::vector<Table> (*tables)();
};

constexpr Section kSections[] = {{"effects", effect_tables},
                                 {"models", model_tables},
                                 {"estimators", estimator_tables},
                                 {"formats", format_tables}};

std::vector<std::string> section_names() {
  std::vector<std::string> names;
  for (const Section& section : kSections) names.emplace_back(section.name);
  return names;
}

}  // namespace

int run_list(const Arguments& arguments) {
  CLI::App app("List the effects, models, estimators and formats of cablefit.", "list");
  CommonOptions options;
  std::string wanted;
  app.add_option("WHAT", wanted, "effects, models, estimators or formats [all]")->type_name("");
  app.add_option("--json", options.json, "as JSON; - for standard output")->type_name("FILE");
  app.add_flag("--verbose", options.verbose,
               "also print parameters, and what separates similar effects");
  app.footer(kListExample);
  if (!parse(app, arguments)) return 0;
  if (!wanted.empty()) require_known("list", wanted, section_names());

  Document document;
  std::vector<ListSection> sections;
  for (const Section& section : kSections) {
    if (!wanted.empty() && wanted != section.name) continue;
    const std::vector<Table> tables = section.tables();
    sections.push_back({section.name, tables});
    document.tables.insert(document.tables.end(), tables.begin(), tables.end());
  }
  deliver(options, document, {{"", list_json(sections)}});
  return 0;
}

}  // namespace cablefit::apps

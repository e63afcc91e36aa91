#include "cablefit/campaign/plan/templates.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cablefit/base/quote.hpp"

namespace cablefit {
namespace {

/// A text in JSON.
std::string json(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : printable(text)) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

std::string list(const std::vector<std::string>& paths, const std::string& margin) {
  std::string text;
  for (const std::string& path : paths) text += (text.empty() ? "" : ",\n" + margin) + json(path);
  return "[" + text + "]";
}

std::string cell_text(const FoundCell& cell) {
  std::string text = "    {\"preload\": " + json(cell.preload);
  if (!cell.date.empty()) text += ", \"date\": " + json(cell.date);
  if (!cell.rig.empty()) text += ", \"rig\": " + json(cell.rig);
  text += ",\n     \"blocked\": " + list(cell.blocked, "                 ");
  if (!cell.moving.empty()) text += ",\n     \"moving\": " + list(cell.moving, "                ");
  return text + "}";
}

std::string left_out_text(const FoundCell& cell) {
  return fmt::format("    // left out: preload {} has no log with the link blocked, only {}\n",
                     json(cell.preload), json(cell.moving.front()));
}

std::string columns_text(const std::vector<std::string>& columns) {
  std::string text;
  for (const std::string& column : columns) text += (text.empty() ? "" : ", ") + printable(column);
  return text.empty() ? "none that could be read" : text;
}

}  // namespace

bool is_complete(const FoundCell& cell) { return !cell.blocked.empty(); }

std::string campaign_template(const std::string& name, const FoundLogs& found) {
  std::string cells, left_out;
  for (const FoundCell& cell : found.cells) {
    if (is_complete(cell))
      cells += (cells.empty() ? "" : ",\n") + cell_text(cell);
    else
      left_out += left_out_text(cell);
  }
  return fmt::format(R"({{
  // What 'cablefit batch' fits and what must hold. Comments are allowed. Paths are relative to
  // this file.
  "schema": "cablefit/campaign/1",
  "name": {},
  // A cell is one preload of one robot at one date. Logs may be patterns: ["low/moving*.csv"].
  // More keys:
  //   "date": "2026-03-14", "robot": "arm 7"   where there are several: parameters against them
  //   "name": "low, new cable"                 of the cell; else preload, robot and date
  //   "validation": ["low/check*.csv"]         logs that are not fitted: they judge the fit
  //   "refine": true                           search for a missing effect
  "cells": [
{}{}
  ],
  "models": ["linear", "poly"],
  "estimator": "auto",               // see 'cablefit list estimators'
  // Gates for CI: exit code 1 when one fails.
  "limits": {{
    "rsd_percent": 25                // largest relative sd of a parameter, %
    // , "torque_error": 1.5         // largest residual, N m rms
    // , "drift": {{"baseline": "baseline.json", "percent": 15}}   // batch.json of an earlier run
    // , "new_effect": false         // cells with "refine": no effect may be missing
  }}
}}
)",
                     json(name), left_out, cells);
}

std::string rig_template(const FolderWithoutRig& folder) {
  const std::string preload = folder.preload.empty()
                                  ? "  // \"preload\": \"low\","
                                  : "  \"preload\": " + json(folder.preload) + ",";
  return fmt::format(R"({{
  // What the logs in this folder mean and what the bench is made of. All keys:
  // data/schema/rig.schema.json
  "schema": "cablefit/rig/1",
  "name": "",
{}
  // Columns here: {}.
  // Wanted: t, q (link), theta (motor after the reduction), tau (its torque), tau_load; SI, or a
  // unit in the header. Others are mapped, with scale and unit where the header has none:
  // "columns": {{"t": "time", "theta": {{"column": "motor", "unit": "deg"}},
  //             "tau": {{"column": "i_q", "scale": 0.083, "unit": "N m"}}}},
  "torque_hold": "auto"              // "zoh": a command that is held; "none": a mean around t
  // The load is the column tau_load, where a log has one; else a law: "constant", "pendulum",
  // "table", "none", or
  // , "load": {{"type": "hanging_mass", "mass": 40, "radius": 0.1, "direction": -1}}
  // Simulations run closed loop with a controller; type "open_loop": tau is a command by itself.
  // , "controller": {{"type": "pd", "kp": 800, "kd": 6, "limit": 250, "reference": "theta_ref"}}
  // , "cad": {{"J_link": 0.3}}        // printed beside, never fitted to
}}
)",
                     preload, columns_text(folder.columns));
}

}  // namespace cablefit

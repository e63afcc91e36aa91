// Options with clear messages, over CLI11: values are checked as they are read, and an unknown
// option gets a near match.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "options/arguments.hpp"

namespace cablefit::apps {

/// Allowed values of a number; both ends are allowed.
struct Range {
  double low = 0, high = std::numeric_limits<double>::infinity();
};

/// A number or whole number within a range, "--cutoff HZ".
void add_number(CLI::App& app, const std::string& name, const std::string& unit, Range range,
                const std::function<void(double)>& use, const std::string& help);
void add_whole(CLI::App& app, const std::string& name, const std::string& unit, Range range,
               const std::function<void(long)>& use, const std::string& help);

/// One of some words; anything else gets a near match. `what` names them: "model".
void add_choice(CLI::App& app, const std::string& name, const std::string& what,
                const std::vector<std::string>& known,
                const std::function<void(const std::string&)>& use, const std::string& help);

/// What the converters above do with a value.
double parse_number(const std::string& option, const std::string& text, Range range);
long parse_whole(const std::string& option, const std::string& text, Range range);
/// "a,b" at ',': all parts, empty ones too.
std::vector<std::string> parts_of(const std::string& text, char at);
void require_known(const std::string& what, const std::string& text,
                   const std::vector<std::string>& known);

/// Options added from here on stand under this heading of --help.
void begin_group(CLI::App& app, const std::string& heading);

/// False when help was asked for (and printed). Throws Error(usage).
bool parse(CLI::App& app, const Arguments& arguments);

}  // namespace cablefit::apps

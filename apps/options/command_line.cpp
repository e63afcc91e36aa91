#include "options/command_line.hpp"

#include <fmt/format.h>

#include <CLI/Config.hpp>
#include <CLI/Error.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>
#include <system_error>

#include "cablefit/base/catalog.hpp"
#include "cablefit/base/error.hpp"
#include "cablefit/base/files/output_file.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/report/writers/wrap.hpp"

namespace cablefit::apps {
namespace {

constexpr std::size_t kMostDigits = 15;  // exact in a double

/// "a whole number from 1 to 9".
std::string wanted_text(const char* kind, Range range) {
  if (std::isinf(range.high)) return fmt::format("{} from {:g} up", kind, range.low);
  return fmt::format("{} from {:g} to {:g}", kind, range.low, range.high);
}

Error bad_value(const std::string& option, const std::string& text, const std::string& wanted) {
  return usage_error(fmt::format("{} cannot be {}", option, in_quotes(text)), "give " + wanted);
}

/// Every option of the command, for a near match.
std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

Error unknown_option(const CLI::App& app, const std::string& argument) {
  std::error_code ignored;
  if (std::filesystem::exists(argument, ignored)) {
    return usage_error("unknown option " + in_quotes(argument),
                       "for a file of that name write ./" + argument);
  }
  const std::string name = argument.substr(0, argument.find('='));
  const std::vector<std::string> names = option_names(app);
  const std::vector<std::string_view> known(names.begin(), names.end());
  const auto nearest = nearest_name(name, known);
  return usage_error("unknown option " + in_quotes(name),
                     nearest ? fmt::format("did you mean '{}'?", *nearest)
                             : fmt::format("see '{} --help'", app.get_name()));
}

}  // namespace

void begin_group(CLI::App& app, const std::string& heading) {
  app.option_defaults()->group(heading);
}

double parse_number(const std::string& option, const std::string& text, Range range) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool is_number = !text.empty() && *end == '\0' && std::isfinite(value);
  if (is_number && value >= range.low && value <= range.high) return value;
  throw bad_value(option, text, wanted_text("a number", range));
}

long parse_whole(const std::string& option, const std::string& text, Range range) {
  const bool is_whole = !text.empty() && text.size() <= kMostDigits &&
                        text.find_first_not_of("0123456789") == std::string::npos;
  const long value = is_whole ? std::stol(text) : -1;
  const auto number = static_cast<double>(value);
  if (is_whole && number >= range.low && number <= range.high) return value;
  throw bad_value(option, text, wanted_text("a whole number", range));
}

std::vector<std::string> parts_of(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  if (text.empty() || text.back() == at) parts.emplace_back();
  return parts;
}

void require_known(const std::string& what, const std::string& text,
                   const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), text) != known.end()) return;
  throw usage_error(fmt::format("unknown {} {}", what, in_quotes(text)),
                    suggestion(text, std::vector<std::string_view>(known.begin(), known.end())));
}

void add_number(CLI::App& app, const std::string& name, const std::string& unit, Range range,
                const std::function<void(double)>& use, const std::string& help) {
  app.add_option_function<std::string>(
         name, [=](const std::string& text) { use(parse_number(name, text, range)); }, help)
      ->type_name(unit);
}

void add_whole(CLI::App& app, const std::string& name, const std::string& unit, Range range,
               const std::function<void(long)>& use, const std::string& help) {
  app.add_option_function<std::string>(
         name, [=](const std::string& text) { use(parse_whole(name, text, range)); }, help)
      ->type_name(unit);
}

void add_choice(CLI::App& app, const std::string& name, const std::string& what,
                const std::vector<std::string>& known,
                const std::function<void(const std::string&)>& use, const std::string& help) {
  const auto take = [=](const std::string& text) {
    require_known(what, text, known);
    use(text);
  };
  app.add_option_function<std::string>(name, take, help)
      ->type_name(fmt::format("{}", fmt::join(known, "|")));
}

namespace {

/// Options in two columns, at most kTextWidth wide.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    constexpr std::size_t kNames = 30;
    const std::string name =
        "  " + make_option_name(option, is_positional) + make_option_opts(option);
    const std::string help = wrapped(std::string(kNames, ' '), make_option_desc(option), kNames);
    if (name.size() + 2 > kNames) return name + "\n" + help;
    return name + help.substr(name.size());
  }
  std::string make_description(const CLI::App* app) const override {
    return wrapped("", app->get_description(), 0) + "\n";
  }
};

}  // namespace

namespace {

std::string without_double_blank_lines(std::string text) {
  for (std::size_t at = text.find("\n\n\n"); at != std::string::npos; at = text.find("\n\n\n"))
    text.erase(at, 1);
  return text;
}

}  // namespace

bool parse(CLI::App& app, const Arguments& arguments) {
  app.name("cablefit " + app.get_name());
  app.formatter(std::make_shared<HelpFormatter>());
  app.allow_extras();
  try {
    app.parse(Arguments(arguments.rbegin(), arguments.rend()));  // CLI11 takes them last first
  } catch (const CLI::CallForHelp&) {
    write_whole("-", without_double_blank_lines(app.help()));
    return false;
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string message = error.what();  // "--cutoff: 1 required HZ missing"
    const bool again = message.find("At Most") != std::string::npos;
    throw usage_error(message.substr(0, message.find(':')) +
                          (again ? " is given more than once" : " needs a value"),
                      fmt::format("see '{} --help'", app.get_name()));
  } catch (const CLI::ParseError& error) {
    throw usage_error(error.what(), fmt::format("see '{} --help'", app.get_name()));
  }
  std::vector<std::string> extras = app.remaining();
  std::erase(extras, "--");  // ends the options, and is none itself
  for (const std::string& extra : extras) {
    if (extra.starts_with('-')) throw unknown_option(app, extra);
  }
  if (!extras.empty()) {
    throw usage_error("unexpected argument " + in_quotes(extras.front()),
                      fmt::format("see '{} --help'", app.get_name()));
  }
  return true;
}

}  // namespace cablefit::apps

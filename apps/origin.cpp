#include "origin.hpp"

#include <cstdlib>
#include <ctime>

namespace cablefit::apps {
namespace {

std::string& command() {
  static std::string text;
  return text;
}

/// In single quotes where a shell would read it otherwise.
std::string for_shell(const std::string& argument) {
  constexpr const char* kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./:=,+@%-";
  if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) return argument;
  std::string text = "'";
  for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::time_t now() {
  const char* given = std::getenv("SOURCE_DATE_EPOCH");
  if (given == nullptr || *given == '\0') return std::time(nullptr);
  char* end = nullptr;
  const long long seconds = std::strtoll(given, &end, 10);
  return *end == '\0' ? static_cast<std::time_t>(seconds) : std::time(nullptr);
}

}  // namespace

void remember_command(const std::vector<std::string>& arguments) {
  command() = "cablefit";
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    if (arguments[k] == "--threads")
      ++k;
    else if (!arguments[k].starts_with("--threads="))
      command() += " " + for_shell(arguments[k]);
  }
}

Origin origin() {
  const std::time_t seconds = now();
  std::tm day{};
  char text[16] = "";
  if (::gmtime_r(&seconds, &day) != nullptr) (void)std::strftime(text, sizeof text, "%F", &day);
  return {text, command()};
}

}  // namespace cablefit::apps

#include "output/colour.hpp"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace cablefit::apps {
namespace {

constexpr std::string_view kYellow = "\x1b[33m", kRed = "\x1b[31m", kPlain = "\x1b[0m";

void mark(std::string& text, std::string_view word, std::string_view colour) {
  for (std::size_t at = text.find(word); at != std::string::npos;
       at = text.find(word, at + colour.size() + word.size() + kPlain.size())) {
    text.insert(at + word.size(), kPlain);
    text.insert(at, colour);
  }
}

}  // namespace

bool shows_colour() {
  const char* off = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return ::isatty(STDOUT_FILENO) == 1 && (off == nullptr || *off == '\0') && terminal != nullptr &&
         std::string_view(terminal) != "dumb";
}

std::string coloured(const std::string& text) {
  std::string marked = text;
  mark(marked, "warning:", kYellow);
  mark(marked, "FAILED", kRed);
  return marked;
}

}  // namespace cablefit::apps

#include "cablefit/samples/survey/part_tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "cablefit/base/catalog.hpp"

namespace cablefit {
namespace {

void check_phase(const std::string& phase, const LogPlan& plan, std::uint64_t line) {
  if (phase.empty() || phase == "blocked" || phase == "moving") return;
  constexpr std::array<std::string_view, 2> known = {"blocked", "moving"};
  throw input_error({plan.path, line, 0}, fmt::format("unknown phase '{:.40}'", phase),
                    suggestion(phase, known));
}

}  // namespace

PartTracker::PartTracker(const LogPlan& plan, std::string default_preload)
    : plan_(plan),
      default_preload_(default_preload.empty() ? "default" : std::move(default_preload)),
      texts_(plan.text_columns()) {}

std::size_t PartTracker::end_of_part(const LogChunk& chunk, std::size_t begin) {
  std::size_t end = chunk.n_rows;
  for (const std::vector<std::uint32_t>& text : chunk.texts) {
    const auto first = text.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = text.begin() + static_cast<std::ptrdiff_t>(end);
    const auto differs = std::find_if(first, last, [&](std::uint32_t k) { return k != *first; });
    end = static_cast<std::size_t>(differs - text.begin());
  }
  return end;
}

PartTracker::Key PartTracker::key(const LogReader& reader, const LogChunk& chunk,
                                  std::size_t row) const {
  std::size_t next = 0;
  const auto word = [&](const std::optional<std::size_t>& column, const std::string& otherwise) {
    if (!column) return otherwise;
    const std::size_t k = next++;
    const std::string& text = reader.words(k)[chunk.texts[k][row]];
    return text.empty() ? otherwise : text;
  };
  Key key;
  key.preload = word(plan_.preload_column, default_preload_);
  key.phase = word(plan_.phase_column, "");
  key.run = word(plan_.run_column, "");
  check_phase(key.phase, plan_, chunk.lines[row]);
  return key;
}

}  // namespace cablefit

#include "cablefit/refine/null/logs_seed.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <random>
#include <vector>

namespace cablefit {
namespace {

using Marks = std::vector<std::uint64_t>;

/// The largest and the smallest value of every channel: exact, however the rows are summed.
Marks marks_of(const LogSurvey& log) {
  Marks marks = {log.n_rows};
  for (const PartSurvey& part : log.parts)
    for (const ChannelSurvey& channel : part.channels)
      for (const double extreme : {channel.min, channel.max})
        marks.push_back(std::bit_cast<std::uint64_t>(extreme));
  return marks;
}

/// In an order of their own: that of the logs says nothing.
Marks marks_of(std::span<const LogSurvey> logs) {
  std::vector<Marks> each;
  for (const LogSurvey& log : logs) each.push_back(marks_of(log));
  std::sort(each.begin(), each.end());
  Marks all;
  for (const Marks& marks : each) all.insert(all.end(), marks.begin(), marks.end());
  return all;
}

}  // namespace

std::uint64_t seed_for(std::span<const LogSurvey> logs, std::uint64_t seed) {
  constexpr unsigned kHalf = 32;
  std::vector<std::uint32_t> words;
  Marks marks = marks_of(logs);
  marks.push_back(seed);
  for (const std::uint64_t mark : marks) {
    words.push_back(static_cast<std::uint32_t>(mark));
    words.push_back(static_cast<std::uint32_t>(mark >> kHalf));
  }
  std::seed_seq mixed(words.begin(), words.end());
  std::array<std::uint32_t, 2> out{};
  mixed.generate(out.begin(), out.end());
  return std::uint64_t{out[1]} << kHalf | out[0];
}

}  // namespace cablefit

#include "output/progress_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "cablefit/base/quote.hpp"

namespace cablefit::apps {
namespace {

constexpr std::size_t kBarWidth = 20;
constexpr double kLeastShare = 0.005;  // read; less says nothing of the time left
constexpr double kQuietSeconds = 1;    // without new bytes: something else is being done

std::string bar(double share) {
  const auto n_full = static_cast<std::size_t>(share * kBarWidth);
  return fmt::format("[{}{}]", std::string(n_full, '#'), std::string(kBarWidth - n_full, '.'));
}

/// Never cuts a character in two.
std::string at_most(std::size_t width, const std::string& text) {
  std::size_t end = 0;
  for (std::size_t n = 0; end < text.size() && n < width; ++n) {
    do {
      ++end;
    } while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0u) == 0x80u);
  }
  return text.substr(0, end);
}

}  // namespace

std::string ProgressLine::duration(double seconds) {
  const long whole = std::lround(std::ceil(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string ProgressLine::at(double seconds, const ReadProgress& now, std::size_t width) {
  if (now.n_passes != latest_.n_passes || now.n_bytes != latest_.n_bytes) latest_read_ = seconds;
  latest_ = now;
  const double elapsed = seconds - now.began;
  const double share = now.n_expected == 0
                           ? 1.0
                           : static_cast<double>(now.n_bytes) / static_cast<double>(now.n_expected);
  const bool is_reading = share < 1 && seconds - latest_read_ < kQuietSeconds;
  if (!is_reading || !(elapsed > 0) || share < kLeastShare) {
    return at_most(width, fmt::format("{} ... {}", what_, duration(seconds - start_)));
  }
  const double rate = static_cast<double>(now.n_bytes) / elapsed;  // bytes/s
  const double left = static_cast<double>(now.n_expected) * (1 - share) / rate;
  const std::string file = shortened(std::filesystem::path(now.path).filename().string());
  return at_most(width,
                 fmt::format("{}: {} {} {:3.0f} %, {:.3g} MB/s, {} left", what_, file, bar(share),
                             std::floor(100 * share), rate / 1e6, duration(left)));
}

}  // namespace cablefit::apps

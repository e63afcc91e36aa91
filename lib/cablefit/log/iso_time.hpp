// Dates and times of ISO 8601, as loggers write them: 2026-11-09T10:00:00.125Z.
#pragma once

#include <optional>
#include <string_view>

namespace cablefit {

/// Days since 1970-01-01 and seconds since the midnight before, in UTC where a zone is given.
struct IsoTime {
  long day = 0;
  double seconds = 0;
};

/// "2026-11-09T10:00:00", a blank for the T, a fraction behind a point or a comma, and Z or +01:00
/// at the end; empty for anything else.
std::optional<IsoTime> read_iso_time(std::string_view text);

/// Seconds from the midnight that begins `day`: small numbers keep more digits of a fraction.
inline double seconds_from(const IsoTime& time, long day) {
  return 86400.0 * static_cast<double>(time.day - day) + time.seconds;
}

}  // namespace cablefit

// Numbers as people like to read them: as many digits as their uncertainty leaves meaningful.
#pragma once

#include <string>

namespace cablefit {

/// "-": there is no number.
inline constexpr const char* kNoNumber = "-";

/// Significant digits of errors, gaps and shares; of what is planned or measured; of times.
inline constexpr int kDigits = 3, kFineDigits = 4, kTimeDigits = 5;

/// `n_digits` significant digits, without an exponent between 1e-5 and 1e7. NaN gives "-".
std::string significant(double value, int n_digits);
inline std::string short_number(double value) { return significant(value, kDigits); }

/// The value up to the second digit of its sd: 1367.71 with sd 1.234 is "1367.7". Four significant
/// digits when there is no sd.
std::string value_text(double value, double sd);

/// The sd with two digits, as many decimals as value_text() gives the value.
std::string sd_text(double value, double sd);

/// "1367.7 +- 1.2"; the value alone when there is no sd.
std::string value_with_sd(double value, double sd);

/// "-13.8 .. 13.8": both in thousandths; "-" where there is no range.
std::string milli_range(double low, double high);

/// Shortest text that reads back as the same bits; empty for NaN and infinities.
std::string exact(double value);

}  // namespace cablefit

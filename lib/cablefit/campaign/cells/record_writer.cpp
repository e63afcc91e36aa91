#include "cablefit/campaign/cells/record_writer.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "cablefit/base/base64.hpp"
#include "cablefit/base/quote.hpp"
#include "cablefit/campaign/cells/portable_text.hpp"

namespace cablefit {
namespace {

constexpr std::size_t kNumbersPerText = 1u << 15;  // far below the longest token of a JSON file

std::string bytes_of(const double* values, std::size_t n) {
  std::string bytes;
  bytes.reserve(8 * n);
  for (std::size_t k = 0; k < n; ++k) {
    const auto bits = std::bit_cast<std::uint64_t>(values[k]);
    for (unsigned shift = 0; shift < 64; shift += 8)
      bytes += static_cast<char>(static_cast<unsigned char>(bits >> shift & 255u));
  }
  return bytes;
}

}  // namespace

void RecordWriter::open(char bracket) {
  text_ += bracket;
  is_first_ = true;
}

void RecordWriter::close(char bracket) {
  text_ += bracket;
  is_first_ = false;
}

void RecordWriter::separate() {
  if (!is_first_) text_ += ",\n";
  is_first_ = false;
}

void RecordWriter::quote(std::string_view text) {
  text_ += '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') text_ += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      text_ += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      text_ += c;
  }
  text_ += '"';
}

void RecordWriter::write(const std::string& value) { quote(portable_text(value, paths_)); }

void RecordWriter::write(double value) {
  if (std::isfinite(value))
    // JSON readers take "-0" for a whole number, whose sign is lost.
    text_ += value == 0 ? (std::signbit(value) ? "-0.0" : "0") : fmt::format("{}", value);
  else
    quote(std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf");
}

void RecordWriter::write(const Eigen::VectorXd& values) {
  write(std::vector<double>(values.begin(), values.end()));
}

void RecordWriter::write(const Eigen::MatrixXd& rows) {
  open('[');
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    separate();
    write(Eigen::VectorXd(rows.row(i)));
  }
  close(']');
}

void RecordWriter::packed(std::string_view name, const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (std::size_t k = 0; k < values.size(); k += kNumbersPerText)
    texts.push_back(
        base64(bytes_of(values.data() + k, std::min(kNumbersPerText, values.size() - k))));
  separate();
  quote(name);
  text_ += ':';
  open('[');
  for (const std::string& text : texts) {
    separate();
    quote(text);
  }
  close(']');
}

}  // namespace cablefit

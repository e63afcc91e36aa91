// Logs written by hand: named columns as CSV text, and a seeded normal that is the same everywhere.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace cablefit::test {

/// Columns in the order given, all of one length; "%.17g", so that nothing is lost.
struct Columns {
  std::vector<std::pair<std::string, std::vector<double>>> columns;

  std::vector<double>& add(const std::string& name) {
    return columns.emplace_back(name, std::vector<double>()).second;
  }
  std::string csv() const {
    std::string text;
    for (std::size_t c = 0; c < columns.size(); ++c) text += (c ? "," : "") + columns[c].first;
    text += '\n';
    for (std::size_t i = 0; i < columns.at(0).second.size(); ++i) {
      for (std::size_t c = 0; c < columns.size(); ++c)
        text += fmt::format("{}{:.17g}", c ? "," : "", columns[c].second.at(i));
      text += '\n';
    }
    return text;
  }
};

/// The distributions of <random> differ between libraries, its engines do not: polar method.
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : engine_(seed) {}
  double operator()() {
    for (;;) {
      const double u = uniform(), v = uniform();
      const double s = u * u + v * v;
      if (s < 1 && s > 0) return u * std::sqrt(-2 * std::log(s) / s);
    }
  }
  /// In [-1, 1).
  double uniform() { return 2 * (static_cast<double>(engine_() >> 11U) * 0x1p-53) - 1; }

 private:
  std::mt19937_64 engine_;
};

/// A sum of sines with its derivatives in closed form.
struct MultiSine {
  struct Line {
    double hz, amplitude, phase;
  };
  std::vector<Line> lines;

  /// d^order/dt^order at t.
  double at(double t, int order = 0) const {
    double sum = 0;
    for (const Line& line : lines) {
      const double omega = 2 * std::numbers::pi * line.hz;
      sum += line.amplitude * std::pow(omega, order) *
             std::sin(omega * t + line.phase + order * std::numbers::pi / 2);
    }
    return sum;
  }
};

inline double sign(double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; }

}  // namespace cablefit::test

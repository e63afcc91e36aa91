// Tables over seeds: bias, scatter against the sd reported, coverage.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "cablefit/base/parameter.hpp"

namespace cablefit::test {

/// CABLEFIT_MONTE_CARLO=full selects the long forms.
inline bool full_monte_carlo() {
  const char* value = std::getenv("CABLEFIT_MONTE_CARLO");
  return value != nullptr && std::string(value) == "full";
}

/// One parameter over many runs.
struct RunTable {
  std::string name;
  double truth = 0;
  std::vector<double> values, sds;
  std::size_t inside_two_sd = 0, inside_interval = 0;

  void add(const Estimate& e) {
    values.push_back(e.value);
    sds.push_back(e.sd);
    inside_two_sd += std::abs(e.value - truth) < 2 * e.sd;
    inside_interval += e.ci_low <= truth && truth <= e.ci_high;
  }
  double n() const { return static_cast<double>(values.size()); }
  double mean() const { return mean_of(values); }
  double mean_sd() const { return mean_of(sds); }
  double bias() const { return mean() - truth; }
  /// sd over the runs.
  double scatter() const {
    double sum = 0;
    for (const double v : values) sum += (v - mean()) * (v - mean());
    return std::sqrt(sum / (n() - 1));
  }
  /// sd of mean(): what a bias has to stand out of.
  double standard_error() const { return scatter() / std::sqrt(n()); }
  double share_two_sd() const { return static_cast<double>(inside_two_sd) / n(); }

  static void print_header(const char* title) {
    std::printf("%s\n    %-8s %12s %12s %8s %8s %9s %10s %7s %7s\n", title, "", "true", "mean",
                "bias %", "se %", "scatter", "sd/scatter", "in 2sd", "in ci95");
  }
  void print() const {
    std::printf("    %-8s %12.6g %12.6g %+8.3f %8.3f %9.3g %10.2f %6.0f%% %6.0f%%\n", name.c_str(),
                truth, mean(), 100 * bias() / truth, 100 * standard_error() / truth, scatter(),
                mean_sd() / scatter(), 100 * share_two_sd(),
                100 * static_cast<double>(inside_interval) / n());
  }

 private:
  static double mean_of(const std::vector<double>& x) {
    double sum = 0;
    for (const double v : x) sum += v;
    return sum / static_cast<double>(x.size());
  }
};

}  // namespace cablefit::test

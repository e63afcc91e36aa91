#include "cablefit/report/writers/excite_csv.hpp"

#include <fmt/format.h>

#include <iterator>

namespace cablefit {

std::string excite_csv(const NextRun& run) {
  std::string text = run.blocked ? "# with the link blocked\n" : "";
  text += "t,theta_ref,tau_load\n";
  for (Eigen::Index i = 0; i < run.theta_ref.size(); ++i)
    fmt::format_to(std::back_inserter(text), "{:.9g},{:.9g},{:.6g}\n",
                   static_cast<double>(i) * run.period, run.theta_ref(i), run.load);
  return text;
}

}  // namespace cablefit

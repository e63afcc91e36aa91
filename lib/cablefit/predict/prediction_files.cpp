#include "cablefit/predict/prediction_files.hpp"

#include <fmt/format.h>

#include <iterator>

namespace cablefit {
namespace {

/// A name as a CSV cell or part of one.
std::string as_cell(std::string name) {
  for (char& c : name)
    if (c == ',' || c == '"' || c == '\n' || c == '\r') c = '_';
  return name;
}

}  // namespace

ElasticFile::ElasticFile(const std::string& path, const ElasticPrediction& prediction)
    : file_(path) {
  text_ = "log,t";
  for (const ElasticSignal& signal : prediction.signals()) text_ += "," + as_cell(signal.name);
  if (prediction.has_band())
    for (const ElasticSignal& signal : prediction.signals())
      text_ += "," + as_cell(signal.name) + "_band";
  file_.append(text_ + "\n");
}

void ElasticFile::add(std::size_t log, double t0, double period,
                      const ElasticPrediction::Rows& rows) {
  text_.clear();
  const auto out = std::back_inserter(text_);
  for (Eigen::Index i = 0; i < rows.values.rows(); ++i) {
    fmt::format_to(out, "{},{:.15g}", log, t0 + static_cast<double>(i) * period);
    for (const double value : rows.values.row(i)) fmt::format_to(out, ",{:.9g}", value);
    if (rows.half_widths.size() > 0)
      for (const double width : rows.half_widths.row(i)) fmt::format_to(out, ",{:.4g}", width);
    text_ += '\n';
  }
  file_.append(text_);
}

SensedFile::SensedFile(const std::string& path) : file_(path) {
  file_.append("log,t,equation,torque,model\n");
}

void SensedFile::add(std::size_t log, const std::string& equation, const ResidualRows& rows) {
  text_.clear();
  for (std::size_t i = 0; i < rows.t.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    fmt::format_to(std::back_inserter(text_), "{},{:.15g},{},{:.9g},{:.9g}\n", log, rows.t[i],
                   equation, rows.torque(at), rows.torque(at) - rows.residual(at));
  }
  file_.append(text_);
}

}  // namespace cablefit

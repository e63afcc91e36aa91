#include "real_log.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace hidden {
namespace {

using Eigen::Index;

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> out;
  std::stringstream cells(line);
  for (std::string cell; std::getline(cells, cell, ',');) out.push_back(cell);
  return out;
}

}  // namespace

bool RealLog::has(std::string_view name) const {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Eigen::VectorXd RealLog::column(std::string_view name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::runtime_error("no column " + std::string(name));
  return values.col(found - names.begin());
}

std::string RealLog::with_tau(const Eigen::VectorXd& tau) const {
  const auto at = std::find(names.begin(), names.end(), "tau") - names.begin();
  std::string text = header + '\n';
  for (Index k = 0; k < values.rows(); ++k) {
    for (Index c = 0; c < values.cols(); ++c)
      text += fmt::format("{}{:.12g}", c == 0 ? "" : ",", c == at ? tau[k] : values(k, c));
    text += '\n';
  }
  return text;
}

RealLog read_log(const std::filesystem::path& file) {
  std::ifstream in(file);
  RealLog log;
  do {
    if (!std::getline(in, log.header)) throw std::runtime_error("cannot read " + file.string());
    if (log.header.starts_with('#')) log.comment = log.header;
  } while (log.header.starts_with('#'));
  if (log.header.ends_with('\r')) log.header.pop_back();
  log.names = split(log.header);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) rows.push_back(split(line));
  log.values.resize(static_cast<Index>(rows.size()), static_cast<Index>(log.names.size()));
  for (Index k = 0; k < log.values.rows(); ++k)
    for (Index c = 0; c < log.values.cols(); ++c)
      log.values(k, c) =
          std::stod(rows[static_cast<std::size_t>(k)].at(static_cast<std::size_t>(c)));
  return log;
}

Track track(const Eigen::VectorXd& t, const Eigen::VectorXd& x, Index half) {
  Track out{x, Eigen::VectorXd::Zero(x.size()), Eigen::VectorXd::Zero(x.size())};
  for (Index k = 0; k < x.size(); ++k) {
    const Index first = std::max<Index>(0, k - half), n = std::min(x.size(), k + half + 1) - first;
    const Eigen::ArrayXd s = t.segment(first, n).array() - t[k];
    const double unit = s.abs().maxCoeff();
    Eigen::MatrixX3d W(n, 3);
    W << Eigen::ArrayXd::Ones(n), s / unit, (s / unit).square();
    // Three columns of a bounded, evenly filled range: normal equations lose nothing here.
    const Eigen::Vector3d c = (W.transpose() * W).ldlt().solve(W.transpose() * x.segment(first, n));
    out.x[k] = c[0];
    out.v[k] = c[1] / unit;
    out.a[k] = 2 * c[2] / (unit * unit);
  }
  return out;
}

}  // namespace hidden

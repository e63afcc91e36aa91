#include "cablefit/dynamic/estimators/online_system.hpp"

#include <algorithm>
#include <cmath>

namespace cablefit::estimation {
namespace {

std::vector<std::string> names_of(const DynamicColumns& columns) {
  std::vector<std::string> names;
  for (const DynamicParameter& parameter : columns.parameters) names.push_back(parameter.name);
  return names;
}

/// What the direct fit holds at 0: bounds, and given values, which its response contains.
bool is_held(const LinearSolution& s, const DynamicColumns& columns, Eigen::Index k) {
  const auto place = static_cast<std::size_t>(k);
  return s.at_bound[place] || columns.parameters[place].given;
}

Eigen::MatrixXd equalities_of(const LinearSolution& s, const DynamicColumns& columns) {
  const Eigen::Index p = s.x.size();
  Eigen::MatrixXd rows(0, p);
  for (Eigen::Index k = 0; k < p; ++k) {
    if (!is_held(s, columns, k)) continue;
    rows.conservativeResize(rows.rows() + 1, p);
    rows.row(rows.rows() - 1) = Eigen::RowVectorXd::Unit(p, k);
  }
  return rows;
}

JointBlock block_of(const EstimationTask& task, const EquationRows& e, const LinearSolution& s) {
  const Eigen::Index p = s.x.size();
  JointBlock block;
  block.regressors = Eigen::MatrixXd::Identity(e.columns.count, p);
  block.response = s.residual_combination;
  block.response.head(p) += s.x;
  const LinearSolution own = solve_equation(e, task.job.elastic, task.model);
  if (own.rss > 0) block.weight = static_cast<double>(e.rows->n_rows()) / own.rss;
  return block;
}

/// The columns of the parameters over all rows of the system: a factor of their second moments,
/// per row; zero where a parameter is held.
Eigen::MatrixXd free_columns(const EstimationTask& task, const std::vector<std::size_t>& equations,
                             const Estimation& direct) {
  const EquationRows& first = task.equations[equations.front()];
  const LinearSolution& s = direct.solutions[equations.front()];
  Eigen::MatrixXd all(0, s.x.size());
  double n_rows = 0;
  for (const std::size_t k : equations) {
    const Eigen::MatrixXd r = task.equations[k].rows->r().leftCols(s.x.size());
    all.conservativeResize(all.rows() + r.rows(), Eigen::NoChange);
    all.bottomRows(r.rows()) = r;
    n_rows += static_cast<double>(task.equations[k].rows->n_rows());
  }
  for (Eigen::Index k = 0; k < all.cols(); ++k)
    if (is_held(s, first.columns, k) || !s.not_identifiable[static_cast<std::size_t>(k)].empty())
      all.col(k).setZero();
  return all / std::sqrt(std::max(1.0, n_rows));
}

}  // namespace

OnlineSystem::OnlineSystem(const EstimationTask& task, const std::vector<std::size_t>& equations,
                           const Estimation& direct, const OnlineRule& rule, double samples)
    : equations_(equations),
      rule_(rule),
      information_(names_of(task.equations[equations.front()].columns),
                   equalities_of(direct.solutions[equations.front()],
                                 task.equations[equations.front()].columns)) {
  double variance = 0;
  for (const std::size_t k : equations_) {
    blocks_.push_back(block_of(task, task.equations[k], direct.solutions[k]));
    variance += 1 / blocks_.back().weight / static_cast<double>(equations_.size());
  }
  noise_sd_ = std::sqrt(variance);
  if (rule.method != "gradient") return;
  const Eigen::MatrixXd columns = free_columns(task, equations_, direct);
  slowest_ = slowest_direction(columns);
  const Eigen::VectorXd rms = columns.colwise().norm().transpose();
  const auto rows = samples * static_cast<double>(equations_.size());
  step_ = gradient_step(std::max<Eigen::Index>(1, (rms.array() > 0).count()), rows);
  gradient_.emplace(rms, step_);
}

OnlineSystem::Part OnlineSystem::part_of(const EquationBatch& batch, const GridSpan& span) const {
  const auto begin = batch.numbers.begin();
  const auto from = std::lower_bound(begin, batch.numbers.end(), span.first);
  return {from - begin, std::lower_bound(from, batch.numbers.end(), span.last) - from};
}

Eigen::Index OnlineSystem::take(const RowBatch& batch, const GridSpan& span) {
  std::vector<Part> parts;
  Eigen::Index n = 0;
  for (const std::size_t k : equations_) {
    parts.push_back(part_of(batch.equations[k], span));
    n += parts.back().n;
  }
  if (gradient_)
    take_by_gradient(batch, parts);
  else
    take_recursively(batch, parts, span);
  n_rows_ += static_cast<std::size_t>(n);
  return n;
}

void OnlineSystem::take_recursively(const RowBatch& batch, const std::vector<Part>& parts,
                                    const GridSpan& span) {
  if (rule_.forgetting < 1)
    information_.forget(std::pow(rule_.forgetting, static_cast<double>(span.last - seen_until_)));
  seen_until_ = span.last;
  for (std::size_t e = 0; e < equations_.size(); ++e) {
    const EquationBatch& own = batch.equations[equations_[e]];
    if (parts[e].n == 0) continue;
    Eigen::VectorXd weights(parts[e].n);
    for (Eigen::Index i = 0; i < parts[e].n; ++i) {
      const Eigen::Index number = own.numbers[static_cast<std::size_t>(parts[e].first + i)];
      weights(i) = std::pow(rule_.forgetting, static_cast<double>(span.last - 1 - number));
    }
    information_.add(blocks_[e], own.rows.middleRows(parts[e].first, parts[e].n), weights);
  }
}

/// Row after row of all equations, by their time.
void OnlineSystem::take_by_gradient(const RowBatch& batch, const std::vector<Part>& parts) {
  struct Place {
    Eigen::Index number, row;
    std::size_t equation;
  };
  std::vector<Place> order;
  for (std::size_t e = 0; e < equations_.size(); ++e)
    for (Eigen::Index i = parts[e].first; i < parts[e].first + parts[e].n; ++i)
      order.push_back({batch.equations[equations_[e]].numbers[static_cast<std::size_t>(i)], i, e});
  std::stable_sort(order.begin(), order.end(),
                   [](const Place& a, const Place& b) { return a.number < b.number; });
  for (const Place& at : order) {
    const auto row = batch.equations[equations_[at.equation]].rows.row(at.row);
    const JointBlock& block = blocks_[at.equation];
    gradient_->add(row * block.regressors, row.dot(block.response));
  }
}

TracePoint OnlineSystem::point(const std::string& record) const {
  if (!gradient_) return information_.point(record);
  const Eigen::VectorXd sd = gradient_->steady_sd(noise_sd_);
  const Eigen::VectorXd& x = gradient_->x();
  return {n_rows_, record, {x.begin(), x.end()}, {sd.begin(), sd.end()}};
}

}  // namespace cablefit::estimation

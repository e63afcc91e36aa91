#include "cablefit/dynamic/checks/noise_floor.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "cablefit/samples/rows/agreement.hpp"
#include "cablefit/samples/rows/preliminary.hpp"
#include "cablefit/samples/survey/noise.hpp"

namespace cablefit {
namespace {

constexpr int kFloorWindows = 2;             // of every log
constexpr double kFewPairs = 20;             // fewer pairs say nothing
constexpr std::uint64_t kFloorSeed = 1;      // of the noise that is added
constexpr double kSameReference = 1e-6;      // of its range: what formatting loses
constexpr Eigen::Index kReferenceStep = 16;  // rows: enough to distinguish two references
constexpr double kShortest = 0.5;            // of the longer log: less is no repeat

/// Marsaglia's polar method: the same numbers everywhere, unlike std::normal_distribution.
class Normal {
 public:
  double operator()() {
    for (;;) {
      const double u = uniform(), v = uniform(), s = u * u + v * v;
      if (s < 1 && s > 0) return u * std::sqrt(-2 * std::log(s) / s);
    }
  }

 private:
  double uniform() { return 2 * (static_cast<double>(engine_() >> 11U) * 0x1p-53) - 1; }
  std::mt19937_64 engine_{kFloorSeed};
};

double channel_noise(const LogSurvey& log, const PartSurvey& part, const Slot& slot) {
  if (slot.channel == Channel::theta_ref) return 0;
  return position_noise(log, part, slot.channel, slot.joint);  // of any channel with a quantum
}

void add_noise(Window& window, const LogSurvey& log, Normal& normal) {
  for (std::size_t k = 0; k < log.plan.slots.size(); ++k) {
    const double sd = channel_noise(log, log.parts[window.part], log.plan.slots[k]);
    if (sd > 0)
      for (double& value : window.data.col(static_cast<Eigen::Index>(k))) value += sd * normal();
  }
}

/// Squares of the change of a residual on the rows that both have.
struct Change {
  double squares = 0, n = 0;
  void add(const EquationBatch& clean, const EquationBatch& noisy,
           const Eigen::VectorXd& residual) {
    std::map<Eigen::Index, double> before;
    const Eigen::VectorXd a = clean.rows * residual, b = noisy.rows * residual;
    for (std::size_t i = 0; i < clean.numbers.size(); ++i)
      before[clean.numbers[i]] = a(static_cast<Eigen::Index>(i));
    for (std::size_t i = 0; i < noisy.numbers.size(); ++i) {
      const auto found = before.find(noisy.numbers[i]);
      if (found == before.end()) continue;
      squares += std::pow(b(static_cast<Eigen::Index>(i)) - found->second, 2);
      n += 1;
    }
  }
};

/// The reference of the only wanted part, every step-th row; empty: there is none.
std::vector<double> reference_of(const DynamicJob& job, const LogSurvey& log) {
  const int slot = log.plan.find(Channel::theta_ref);
  const auto n_parts = std::count_if(log.parts.begin(), log.parts.end(), job.wanted);
  std::vector<double> values;
  if (slot < 0 || n_parts != 1 || log.samples == nullptr) return values;
  Eigen::MatrixXd rows;
  Eigen::Index row = 0;
  for (const SamplePiece& piece : log.samples->pieces()) {
    if (!job.wanted(log.parts[piece.part])) continue;
    log.samples->read(piece, rows);
    for (Eigen::Index i = 0; i < rows.rows(); ++i, ++row)
      if (row % kReferenceStep == 0) values.push_back(rows(i, slot + 1));  // behind t
  }
  return values;
}

bool is_same(const std::vector<double>& a, const std::vector<double>& b) {
  const std::size_t n = std::min(a.size(), b.size());
  if (n == 0 ||
      static_cast<double>(n) < kShortest * static_cast<double>(std::max(a.size(), b.size())))
    return false;
  const auto [low, high] = std::minmax_element(a.begin(), a.end());
  const double slack = kSameReference * (*high - *low);
  if (!(slack > 0)) return false;  // stands still
  for (std::size_t i = 0; i < n; ++i)
    if (std::abs(a[i] - b[i]) > slack) return false;
  return true;
}

}  // namespace

std::vector<double> sensor_floor(const DynamicJob& job, const std::vector<EquationRows>& equations,
                                 std::span<const LogSurvey> logs,
                                 const std::vector<Eigen::VectorXd>& residuals) {
  std::vector<Equation> plain;
  for (const EquationRows& e : equations) plain.push_back(e.equation);
  std::vector<Change> changes(equations.size());
  Normal normal;
  const RowSettings& settings = job.settings.rows;
  const double rate = sample_rates(logs, job.wanted).highest;
  for (const PreliminaryWindow& p : preliminary_windows(logs, job.wanted, settings.signal,
                                                        row_halo(settings, rate), kFloorWindows)) {
    Window noisy = p.window;
    add_noise(noisy, logs[p.log], normal);
    const RowBatch before = make_rows(p.window, logs[p.log], 0, settings, plain);
    const RowBatch after = make_rows(noisy, logs[p.log], 0, settings, plain);
    for (std::size_t k = 0; k < equations.size(); ++k)
      changes[k].add(before.equations[k], after.equations[k], residuals[k]);
  }
  std::vector<double> floor;
  for (const Change& change : changes)
    floor.push_back(change.n > 0 ? std::sqrt(change.squares / change.n) : 0);
  return floor;
}

std::vector<Repeat> find_repeats(const DynamicJob& job, std::span<const LogSurvey> logs) {
  std::vector<Repeat> repeats;
  std::vector<std::pair<std::size_t, std::vector<double>>> known;
  for (std::size_t k = 0; k < logs.size(); ++k) {
    std::vector<double> reference = reference_of(job, logs[k]);
    if (reference.empty()) continue;
    const auto same = std::find_if(known.begin(), known.end(), [&](const auto& other) {
      return is_same(other.second, reference);
    });
    if (same != known.end()) {
      repeats.push_back({same->first, k});
    } else {
      known.emplace_back(k, std::move(reference));
    }
  }
  return repeats;
}

std::optional<double> repeat_floor(const JudgedRows& rows, const std::vector<Repeat>& repeats,
                                   const Eigen::VectorXd& residual) {
  double squares = 0, n = 0;
  for (const Repeat& repeat : repeats) {
    std::map<Eigen::Index, double> first;
    rows.rows->for_each([&](const Eigen::MatrixXd& batch, std::span<const Eigen::Index> numbers) {
      const auto log = static_cast<std::size_t>(batch(0, rows.log));
      if (log != repeat.first && log != repeat.second) return;
      const Eigen::VectorXd r = batch.leftCols(rows.n_own) * residual;
      for (std::size_t i = 0; i < numbers.size(); ++i) {
        const Eigen::Index place = numbers[i] - rows.first_number[log];
        const double value = r(static_cast<Eigen::Index>(i));
        if (log == repeat.first) {
          first[place] = value;
        } else if (const auto same = first.find(place); same != first.end()) {
          squares += std::pow(value - same->second, 2) / 2;
          n += 1;
        }
      }
    });
  }
  if (n < kFewPairs) return std::nullopt;
  return std::sqrt(squares / n);
}

}  // namespace cablefit

#include "cablefit/refine/verdict/unexplained.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "cablefit/refine/gap_levels.hpp"
#include "cablefit/refine/null/kept_effects.hpp"
#include "cablefit/refine/rows/residual_spectrum.hpp"

namespace cablefit {
namespace {

constexpr double kMostOf = 0.4;  // of the gap: what a hum or a mode removes at least

// A mass m on a spring and a damper, carried by an axis: with r its way relative to the axis,
// r'' + 2 zeta w r' + w^2 r = -a, and the axis has to give m (a + r'') = -m (2 zeta w r' + w^2 r).
// Shape: frequency (Hz), damping ratio zeta.

/// r and r' of a free oscillator and under a = 1, after h (Meirovitch 2001, 2.2 and 3.11).
void shake(double acceleration, const double* shape, double h, double* z) {
  const double w = 2 * std::numbers::pi * shape[0], zeta = shape[1];
  const double wd = w * std::sqrt(1 - zeta * zeta), decay = std::exp(-zeta * w * h);
  const double rest = -acceleration / (w * w);  // where it would come to rest
  const double r = z[0] - rest, v = z[1];
  const double c = std::cos(wd * h), s = std::sin(wd * h) / wd;
  z[0] = rest + decay * (r * c + (v + zeta * w * r) * s);
  z[1] = decay * (v * c - (zeta * w * v + w * w * r) * s);
}

double reaction(const double* shape, const double* z) {
  const double w = 2 * std::numbers::pi * shape[0];
  return -(2 * shape[1] * w * z[1] + w * w * z[0]);
}

constexpr ParameterInfo kMass[] = {{"inertia", "J_a", "kg m^2", "of what swings", 0},
                                   {"frequency", "f", "Hz", "by itself", 0},
                                   {"damping", "zeta", "", "ratio", 0, 1}};
constexpr ShapeGrid kMode[] = {{.low = 1.5, .high = 60, .n_values = 28},
                               {.low = 0.005, .high = 0.3, .n_values = 5}};

void shake_link(const JointState& state, const double* shape, double h, double* z) {
  shake(state.qdd, shape, h, z);
}
void shake_motor(const JointState& state, const double* shape, double h, double* z) {
  shake(state.thetadd, shape, h, z);
}
void react_link(const JointState& /*state*/, const double* shape, const double* z, double* link,
                double* /*motor*/) {
  link[0] = reaction(shape, z);
}
void react_motor(const JointState& /*state*/, const double* shape, const double* z,
                 double* /*link*/, double* motor) {
  motor[0] = reaction(shape, z);
}

/// No row of the catalogue: it is described, not named.
const Effect& attached_mass(bool link) {
  const auto row = [](Site site, auto advance, auto torque) {
    Effect mass;
    mass.name = "attached mass";
    mass.site = site;
    mass.parameters = kMass;
    mass.shape = kMode;
    mass.n_states = 2;
    mass.advance = advance;
    mass.torque = torque;
    return mass;
  };
  static const Effect kLink = row(Site::link, shake_link, react_link);
  static const Effect kMotor = row(Site::motor, shake_motor, react_motor);
  return link ? kLink : kMotor;
}

/// The rows of a search hold what is slow; a hum or a mode may be twice as fast.
Design with_dense_rows(const Design& design, const Eigen::VectorXd& x) {
  Smoothing dense = design.smoothing;
  dense.every = std::max<Eigen::Index>(1, dense.every / 2);
  dense.stride = stride_for(dense.columns / 2, dense.period, dense.every);
  return with_variants(make_design(design.models, *design.recorded, dense), design.added, x);
}

/// What there is of one equation beyond its floor, (N m)^2 summed over its rows.
struct EquationGap {
  RowKind kind = RowKind::motor;
  double squares = 0, n_rows = 0, floor = 0;
  double row_period = 0;  ///< s, where they are furthest apart
  double above() const { return squares - n_rows * floor * floor; }
};

EquationGap largest_gap(const Design& design, const Eigen::VectorXd& x, const KindLevels& floor) {
  EquationGap largest;
  double most = 0;
  for (const RowKind kind : {RowKind::link, RowKind::motor, RowKind::blocked}) {
    EquationGap gap{kind, 0, 0, floor[static_cast<std::size_t>(kind)], 0};
    for (std::size_t s = 0; s < design.rows.size(); ++s)
      for (const KindRows& rows : design.rows[s].kinds) {
        if (rows.kind != kind) continue;
        gap.row_period = std::max(gap.row_period, design.smoothing_of(s).row_period());
        gap.squares += (rows.response - rows.base * x).squaredNorm();
        gap.n_rows += static_cast<double>(rows.response.size());
      }
    const double in_floors = gap.above() / (gap.floor * gap.floor);
    if (gap.squares > kVisibleGap * gap.n_rows * gap.floor * gap.floor && in_floors > most) {
      most = in_floors;
      largest = gap;
    }
  }
  return largest;
}

/// A piece of one equation's residual, no longer than a hum stays in step.
struct Piece {
  Eigen::ArrayXd t, residual;
};

std::vector<Piece> pieces_of(const Design& design, const Eigen::VectorXd& x, RowKind kind) {
  constexpr double kLongest = 20;  // s
  constexpr Eigen::Index kFewest = 32;
  std::vector<Piece> pieces;
  for (std::size_t s = 0; s < design.rows.size(); ++s)
    for (const KindRows& rows : design.rows[s].kinds) {
      if (rows.kind != kind) continue;
      const double period = design.stretches[s].recording.period;
      const Eigen::ArrayXd residual = (rows.response - rows.base * x).array();
      for (std::size_t from = 0; from < rows.at.size();) {
        const auto end = rows.at[from] + static_cast<Eigen::Index>(kLongest / period);
        std::size_t to = from;
        while (to < rows.at.size() && rows.at[to] < end) ++to;
        Piece piece;
        const auto n = static_cast<Eigen::Index>(to - from);
        piece.residual = residual.segment(static_cast<Eigen::Index>(from), n);
        piece.t.resize(n);
        for (Eigen::Index i = 0; i < n; ++i)
          piece.t(i) = period * static_cast<double>(rows.at[from + static_cast<std::size_t>(i)]);
        if (n >= kFewest) pieces.push_back(std::move(piece));
        from = to;
      }
    }
  return pieces;
}

/// Sine and cosine of a frequency at the times of a piece, as columns.
Eigen::MatrixXd waves(const Piece& piece, double frequency) {
  const Eigen::ArrayXd phase = 2 * std::numbers::pi * frequency * piece.t;
  Eigen::MatrixXd a(phase.size(), 2);
  a.col(0) = phase.sin().matrix();
  a.col(1) = phase.cos().matrix();
  return a;
}

/// Waves of a frequency to those of that plus another: cheaper than sines.
void turn_on(Eigen::MatrixXd& waves, const Eigen::MatrixXd& by) {
  const Eigen::ArrayXd sine = waves.col(0), cosine = waves.col(1);
  waves.col(0) = sine * by.col(1).array() + cosine * by.col(0).array();
  waves.col(1) = cosine * by.col(1).array() - sine * by.col(0).array();
}

/// What a sine of any size and phase removes from the squares of a piece.
double removed(const Piece& piece, const Eigen::MatrixXd& waves) {
  const Eigen::Matrix2d gram = waves.transpose() * waves;
  const Eigen::Vector2d right = waves.transpose() * piece.residual.matrix();
  const double determinant = gram.determinant();
  if (!(determinant > 1e-6 * gram.squaredNorm())) return 0;
  return right.dot(gram.inverse() * right);
}

struct Line {
  double frequency = 0, removed = 0;
};

void keep_stronger(Line& best, const Line& other) {
  if (other.removed > best.removed) best = other;
}

/// Of evenly spaced frequencies.
Line strongest_of(const std::vector<Piece>& pieces, double lowest, double highest, double step) {
  std::vector<Eigen::MatrixXd> now, by;
  for (const Piece& piece : pieces) {
    now.push_back(waves(piece, lowest));
    by.push_back(waves(piece, step));
  }
  Line best;
  for (double f = lowest; f < highest; f += step) {
    Line here{f, 0};
    for (std::size_t k = 0; k < pieces.size(); ++k) {
      here.removed += removed(pieces[k], now[k]);
      turn_on(now[k], by[k]);
    }
    keep_stronger(best, here);
  }
  return best;
}

/// The frequency at which sines, one a piece, remove most. Noise alone gives each piece two
/// degrees of freedom, which the search makes larger: of a gap that is a small price.
Line strongest_line(const std::vector<Piece>& pieces, double lowest, double highest) {
  double longest = 1;
  for (const Piece& piece : pieces)
    longest = std::max(longest, piece.t(piece.t.size() - 1) - piece.t(0));
  const double step = 0.4 / longest;
  const auto line_at = [&](double frequency) {
    Line line{frequency, 0};
    for (const Piece& piece : pieces) line.removed += removed(piece, waves(piece, frequency));
    return line;
  };
  const double around = strongest_of(pieces, std::max(lowest, step), highest, step).frequency;
  Line best = line_at(around);
  for (int k = -8; k <= 8; ++k) keep_stronger(best, line_at(around + step * k / 8));
  return best;
}

struct AttachedMode {
  double frequency = 0, damping = 0, inertia = 0, removed = 0;
};

/// The attached mass that removes most, everything else fitted anew.
AttachedMode strongest_mode(const Design& design, const Eigen::VectorXd& x, const EquationGap& gap,
                            const KindLevels& floor, double block_seconds) {
  AttachedMode best;
  if (gap.kind == RowKind::blocked) return best;
  const Effect& row = attached_mass(gap.kind == RowKind::link);
  const BlockGrams grams = block_grams(design, block_seconds);
  const auto without = fit_blocks(grams, floor, false);  // x may be of other weights
  if (!without) return best;
  const double squares = without->squares[static_cast<std::size_t>(gap.kind)];
  const auto try_at = [&](double frequency, double damping) {
    const Variant variant{&row, {frequency, damping}, 0, 0, false};
    const auto fit = fit_blocks(extended(grams, design.rows, design.stretches,
                                         variant_columns(design, variant, x), block_seconds),
                                floor, false);
    if (!fit || !(fit->x(fit->x.size() - 1) > 0)) return;
    const double left = fit->squares[static_cast<std::size_t>(gap.kind)];
    if (squares - left > best.removed)
      best = {frequency, damping, fit->x(fit->x.size() - 1), squares - left};
  };
  const LogScale scale = design.scale;
  for (int i = 0; i < kMode[0].n_values; ++i) try_at(kMode[0].value(i, scale), 0.05);
  if (!(best.removed > 0)) return best;
  // By turns, in ever smaller steps.
  for (double step = 0.06; step > 0.002; step /= 2) {
    const AttachedMode here = best;
    for (const double f : {1 - step, 1 + step}) try_at(here.frequency * f, here.damping);
    const AttachedMode there = best;
    for (const double d : {1 - 8 * step, 1 + 8 * step, 0.5})
      try_at(there.frequency, std::clamp(there.damping * d, 0.002, 0.7));
  }
  return best;
}

/// How long the residual remembers: where the autocovariance above the floor's falls to 1/e.
double correlation_time(const Design& design, const Eigen::VectorXd& x, const EquationGap& gap) {
  constexpr std::size_t kMostLags = 512;
  const ResidualMemory memory = residual_memory(design, x, gap.kind, kMostLags);
  if (!(memory.period > 0)) return 0;
  const double wanted = std::exp(-1.0) * gap.above() / gap.n_rows;
  for (Eigen::Index lag = 1; lag < memory.covariance.size(); ++lag)
    if (memory.covariance(lag) < wanted) return static_cast<double>(lag) * memory.period;
  return static_cast<double>(kMostLags) * memory.period;
}

}  // namespace

std::optional<Unexplained> describe_remainder(const Design& searched, const Eigen::VectorXd& x,
                                              const KindLevels& floor, double block_seconds) {
  const Design design = with_dense_rows(searched, x);
  const EquationGap gap = largest_gap(design, x, floor);
  if (!(gap.n_rows > 0)) return {};
  constexpr double kLowest = 0.5;  // Hz: slower ones are low-frequency disturbances
  const Line line = strongest_line(pieces_of(design, x, gap.kind), kLowest, 0.4 / gap.row_period);
  const AttachedMode mode = strongest_mode(design, x, gap, floor, block_seconds);
  Unexplained found;
  found.equation = to_string(gap.kind);
  found.rms = std::sqrt(gap.above() / gap.n_rows);
  const bool hums = line.removed > mode.removed;
  found.share_of_squared_gap = std::max(line.removed, mode.removed) / gap.above();
  if (found.share_of_squared_gap < kMostOf) {
    found.kind = "wandering";
    found.correlation_time = correlation_time(design, x, gap);
    found.share_of_squared_gap = 1;
    return found;
  }
  found.kind = hums ? "hum" : "mode";
  found.frequency = hums ? line.frequency : mode.frequency;
  found.share_of_squared_gap = std::min(1.0, found.share_of_squared_gap);
  if (hums) return found;
  found.damping = mode.damping;
  found.inertia = mode.inertia;
  return found;
}

}  // namespace cablefit

// Reference numbers: SciPy 1.10.1. The snippets that made them:
//   b, a = scipy.signal.butter(n, 100, fs=1000)
//   x = [sin(0.3 i) + 0.01 i^2 - (3 if i % 7 == 0 else 0) for i in range(30)]
//   sosfiltfilt(butter(4, 100, fs=1000, output='sos'), x, padtype='odd', padlen=29)
#include "cablefit/samples/rows/butterworth.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <numbers>

namespace {

using cablefit::Biquad;
using cablefit::Butterworth;

struct Reference {
  int order;
  std::vector<double> b, a;
};

const std::vector<Reference> kScipy = {
    {1, {0.2452372752527856, 0.2452372752527856}, {1, -0.5095254494944288}},
    {2,
     {0.06745527388907192, 0.1349105477781438, 0.06745527388907192},
     {1, -1.142980502539901, 0.4128015980961888}},
    {3,
     {0.01809893300751443, 0.05429679902254331, 0.05429679902254331, 0.01809893300751443},
     {1, -1.760041880343169, 1.182893262037831, -0.2780599176345463}},
    {4,
     {0.004824343357716231, 0.01929737343086492, 0.02894606014629739, 0.01929737343086492,
      0.004824343357716231},
     {1, -2.369513007182038, 2.31398841441588, -1.054665405878568, 0.1873794923681849}},
    {5,
     {0.001282581078960686, 0.006412905394803428, 0.01282581078960686, 0.01282581078960686,
      0.006412905394803428, 0.001282581078960686},
     {1, -2.975422109745683, 3.806018119320411, -2.545252868330466, 0.8811300754378364,
      -0.1254306221553556}},
    {6,
     {0.000340537652720128, 0.002043225916320768, 0.005108064790801919, 0.00681075305440256,
      0.005108064790801919, 0.002043225916320768, 0.000340537652720128},
     {1, -3.579434798331191, 5.658667165933624, -4.965415228778569, 2.529494905841446,
      -0.7052741145099002, 0.08375647961867888}}};

std::vector<double> times(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> product(x.size() + y.size() - 1, 0.0);
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < y.size(); ++j) product[i + j] += x[i] * y[j];
  return product;
}

TEST_CASE("Butterworth sections multiply to SciPy's polynomials", "[samples]") {
  for (const Reference& reference : kScipy) {
    INFO("order " << reference.order);
    std::vector<double> b = {1}, a = {1};
    const Butterworth filter(reference.order, 100, 1000);
    for (const Biquad& c : filter.sections()) {
      b = times(b, {c.b0, c.b1, c.b2});
      a = times(a, {1, c.a1, c.a2});
    }
    REQUIRE(b.size() >= reference.b.size());
    // Sixteen digits are printed; products of three sections lose one or two of them.
    for (std::size_t k = 0; k < b.size(); ++k) {
      const bool beyond = k >= reference.b.size();  // b2 = a2 = 0 of a first-order section
      CHECK_THAT(b[k], Catch::WithinAbs(beyond ? 0 : reference.b[k], 1e-14));
      CHECK_THAT(a[k], Catch::WithinAbs(beyond ? 0 : reference.a[k], 1e-13));
    }
  }
}

TEST_CASE("filtering both ways with odd padding is SciPy's sosfiltfilt", "[samples]") {
  Eigen::MatrixXd x(30, 1);
  for (int i = 0; i < 30; ++i) x(i, 0) = std::sin(0.3 * i) + 0.01 * i * i - (i % 7 == 0 ? 3 : 0);
  const std::vector<double> expected = {
      -3.00015159137925,  -1.520358699021028, -0.2572455967862861, 0.6399455655129241,
      1.128028006240396,  1.266517772459769,  1.178770690832249,   0.9977579359431248,
      0.8205928024308387, 0.6898407288252359, 0.6050096268254893,  0.5515692343822881,
      0.5275001814206894, 0.5525245156954526, 0.6579982389133099,  0.8679278035320431,
      1.186252412246792,  1.599008554659437,  2.087513886623917,   2.640769604939887,
      3.257280304741974,  3.935448006004895,  4.66102656280531,    5.403142002728289,
      6.123825788229676,  6.794801915253115,  7.409323387968399,   7.980838293980643,
      8.530386067924551,  9.073409940844908};
  const Butterworth filter(4, 100, 1000);
  REQUIRE(filter.settling_rows() >= 29);  // so the padding is n - 1 = 29 rows, as in the snippet
  filter.apply(x, true, true);
  for (int i = 0; i < 30; ++i) {
    INFO("row " << i);
    CHECK_THAT(x(i, 0), Catch::WithinAbs(expected[static_cast<std::size_t>(i)], 1e-12));
  }
}

TEST_CASE("columns are filtered independently, whatever their number", "[samples]") {
  for (const int n_columns : {1, 3, 4, 5, 9}) {
    Eigen::MatrixXd together(200, n_columns);
    for (int c = 0; c < n_columns; ++c)
      for (int i = 0; i < 200; ++i) together(i, c) = std::sin(0.05 * (c + 1) * i) + c;
    Eigen::MatrixXd alone = together;
    const Butterworth filter(4, 60, 1000);
    filter.apply(together, true, false);
    for (int c = 0; c < n_columns; ++c) {
      Eigen::MatrixXd one = alone.col(c);
      filter.apply(one, true, false);
      CHECK((one - together.col(c)).cwiseAbs().maxCoeff() == 0);
    }
  }
}

TEST_CASE("zero phase: a sine keeps its phase and loses |H|^2", "[samples]") {
  for (const double hz : {20.0, 60.0, 120.0}) {
    Eigen::MatrixXd x(4000, 1);
    const double omega = 2 * std::numbers::pi * hz / 1000;
    for (int i = 0; i < 4000; ++i) x(i, 0) = std::sin(omega * i);
    const Butterworth filter(4, 60, 1000);
    filter.apply(x, true, true);
    // Bilinear Butterworth: |H|^2 = 1 / (1 + (tan(pi f/fs) / tan(pi fc/fs))^8), once each way.
    const double gain =
        1 / (1 + std::pow(std::tan(omega / 2) / std::tan(std::numbers::pi * 0.06), 8));
    double worst = 0;
    for (int i = 1000; i < 3000; ++i)
      worst = std::max(worst, std::abs(x(i, 0) - gain * std::sin(omega * i)));
    INFO(hz << " Hz, gain " << gain);
    // 1000 rows from the ends the transient is below 1e-10.
    CHECK(worst < 1e-9);
  }
}

TEST_CASE("a start-up transient is gone after settling_rows", "[samples]") {
  for (const int order : {1, 2, 4, 6})
    for (const double cutoff : {5.0, 60.0, 200.0}) {
      const Butterworth filter(order, cutoff, 1000);
      const Eigen::Index settling = filter.settling_rows();
      INFO("order " << order << ", " << cutoff << " Hz, " << settling << " rows");
      // A step at the start: the backward pass carries it to the left, nothing comes later.
      const Eigen::Index n = 2 * settling + 50;
      Eigen::MatrixXd with = Eigen::MatrixXd::Zero(n, 1), without = with;
      with(0, 0) = 1;  // starts from the steady state of 1
      filter.apply(with, false, false);
      // 1e-10 of the slowest pole; the others multiply it by a handful.
      CHECK(with.col(0).tail(n - settling).cwiseAbs().maxCoeff() < 1e-8);
      CHECK(with.col(0).tail(50).cwiseAbs().maxCoeff() < 1e-9);
      CHECK(with(0, 0) > 1e-3);
    }
}

}  // namespace

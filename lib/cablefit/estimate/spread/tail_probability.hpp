// Tail probabilities of the distributions that tests refer to.
#pragma once

namespace cablefit {

/// P(X > x) for chi-squared with `dof` > 0 degrees of freedom: the regularized incomplete gamma
/// function Q(dof/2, x/2) by its series or continued fraction (Abramowitz & Stegun 6.5.29,
/// 6.5.31). Relative error below 1e-10 down to 1e-300.
double chi_squared_tail(double x, double dof);

/// P(X > x) for F with dof_1, dof_2 > 0 degrees of freedom (real numbers): the regularized
/// incomplete beta function by its continued fraction (Abramowitz & Stegun 26.5.8). 1 for x <= 0.
double f_tail(double x, double dof_1, double dof_2);

/// P(|X| > x) for Student's t with `dof` > 0 degrees of freedom (a real number).
double t_tail(double x, double dof);
/// The x at which t_tail() is `probability`, in (0, 1). Relative error below 1e-12.
double t_quantile(double probability, double dof);

}  // namespace cablefit

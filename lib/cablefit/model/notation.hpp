// Notation, for reading only: symbols, units and signs used throughout cablefit.
// clang-format off
//
//   J_link  qdd     + f_v  qd     + f_s  sgn(qd)              = tau_elas_l(q, theta) + tau_load    link
//   J_motor thetadd + f_vm thetad + f_sm sgn(thetad) + offset + tau_elas_m(q, theta) = tau         motor
//
//   q         rad   link position
//   theta     rad   motor position, after the reduction
//   tau       N m   motor torque, after the reduction
//   tau_load  N m   load torque on the link; positive when it accelerates q
//   phi       rad   deflection theta - q
//   l         m     elongation of a cable (rad in joint space), l = g - h + l_o
//   l_o       m     initial elongation, Fichera & Grossard 2017 (4c)
//   P, S      m     coupling matrices, tau_elas_l = P f, tau_elas_m = S f, (8a)-(8b)
//
// clang-format on
// J_link is the paper's J_M and J_motor its J_m; reports print both. The ORDER of a cable law is
// the order of its force: order 1 is the linear cable, order 2 is K_0 l + K_1 l^2, the paper's
// second order. On a linear axis read m for rad, N for N m, kg for kg m^2.
#pragma once

"""Semi-structured B-spline for blending two B-spline surfaces (2014, doi 10.1016/j.camwa.2014.07.013).

Letters are the paper's. Besides, in formulas and residuals: h_r is the distance from a contact to the r-th knot of U
after it (u_r at u = 0, 1 - u_{m-k+2-r} at u = 1), H_r the same of the base across the contact. Y is the value of a
surface or of a rule, C that of a curve, L and F_0 are a last and a first index, n(i) = n_i. F(i, j, ...) is a blossom
P_ij^s[...]; in counts F(j, s) is the number of control points of Q_j^s. K couples two control points in the energy; A_d
and G_d are integrals of products of two d-th derivatives, in u and in v. J is the area element |P_u x P_v|. within(x,
y, z) is 1 where x <= y <= z and same(x, y) where x = y, each 0 elsewhere; a, b number any control point. E_6 and E_7
are least energies of a strip with 6 and 7 rows, f_0, f'_0, f''_0 and f_1, f'_1, f''_1 its value and derivatives at u =
0 and 1; E_small and E_large are those over a space and a larger one, where one more coefficient x gives the energy c +
2 g x + h x^2. N_u and N_c are inner knots of both contact curves together and of the converted blend, q pairs of the
rule; D the control points that own knots save, s inner knots that both curves have, r and t those of one alone, d those
of the middle curves, c of them. E_x is the energy beyond that of a cubic which lacks delta_0, delta_1 of the second
derivatives, E_l the least energy from value d_0 and slope d_1 to zero over a length ell; a_best is the alpha^2 of least
energy between plates a gap d apart, their exits at angles theta, phi to the chord, c_between the cosine of theta - phi.
J_0, J_1 and J are jumps at a seam. In Fig. 3 x is the argument of the Bernstein polynomials. The made pair is
`examples/made-pair.json`: two bicubic bases of our own, extent 8, with 3 and 4 inner knots along their contacts. What
is below 1e-9 (degrees, fractions of the curvature) is rounding. `sentences.py`, beside this file, names the records
that decide each sentence of the paper.
"""

/* gauss.h - Gauss-Legendre quadrature */
#pragma once

/* Gives n nodes in (0, 1), ascending, and weights that sum to 1: exact for polynomials up to degree 2n - 1. */
void gauss_legendre(int n, double *x, double *w);

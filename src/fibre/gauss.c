#include "fibre/gauss.h"

#include "base/pi.h"

#include <math.h>

/* Finds the roots of P_n(z) by Newton's method. (k + 1) P_{k+1} = (2 k + 1) z P_k - k P_{k-1}, the start is
 * z = cos(pi (j + 3/4) / (n + 1/2)),  P_n' = n (z P_n - P_{n-1}) / (z^2 - 1),  w = 2 / ((1 - z^2) P_n'^2).
 * Milton Abramowitz, Irene Stegun, "Handbook of Mathematical Functions", 1964, 22.7.10, 22.8.5, 25.4.29. */
void gauss_legendre(int n, double *x, double *w) {
    for (int j = 0; j < n; j++) {
        double z = cos(PI_DOUBLE * (j + 0.75) / (n + 0.5)), slope = 1.0;
        for (int round = 0; round < 8; round++) {
            double p = 1.0, before = 0.0;
            for (int k = 0; k < n; k++) {
                double next = ((2 * k + 1) * z * p - k * before) / (k + 1);
                before = p;
                p = next;
            }
            slope = n * (z * p - before) / (z * z - 1.0);
            z -= p / slope;
        }
        x[j] = 0.5 * (1.0 - z);
        w[j] = 1.0 / ((1.0 - z * z) * slope * slope);
    }
}

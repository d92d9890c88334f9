#include "fibre/doubling.h"

#include <math.h>
#include <stdlib.h>

#include "base/matrix.h"
#include "base/memory.h"

/* Kernels here have sqrt(c) of the nodes multiplied into their rows and columns, 1 for passengers. The product over the
 * quadrature, A diag(c) B, is then an ordinary one over the first `nodes` columns of A and rows of B. All matrices are
 * symmetric or stored by columns. */
typedef struct SlabLayers {
    int nodes, total;
    double *r, *t;      /* diffuse parts of one layer */
    double *direct;     /* e^(-lambda h): transmitted without scattering */
    double *rr, *d, *u; /* see join */
} SlabLayers;

/* Computes C = A B + keep C over the quadrature. */
static bool product(const SlabLayers *m, const double *a, const double *b, double keep, double *c) {
    return matrix_product(m->total, m->total, m->nodes, 1.0, (Matrix){a, 1, m->total}, (Matrix){b, 1, m->total}, keep,
                          c, m->total);
}

/* Makes a layer of depth h by exact single scattering:
 *   r = K (1 - e^{-(li + lj) h}) / (li + lj),   t = K (e^{-li h} - e^{-lj h}) / (lj - li). */
static void thin_layer(const SlabLayers *m, const Doubling *slab, const double *root, double h) {
    int n = m->total;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            double sum = slab->lambda[i] + slab->lambda[j], gap = fabs(slab->lambda[j] - slab->lambda[i]);
            double low = fmin(slab->lambda[i], slab->lambda[j]), w = root[i] * root[j];
            double through = gap * h > 1e-300 ? -expm1(-gap * h) / gap : h;
            m->r[j * n + i] *= w * -expm1(-sum * h) / sum;
            m->t[j * n + i] *= w * exp(-low * h) * through;
        }
    for (int i = 0; i < n; i++) m->direct[i] = exp(-slab->lambda[i] * h);
}

/* Doubles the layer by putting it on an equal one:
 *   d = (1 - r r)^-1 (t + r r e)   light that goes down between them, u = r e + r d what comes up,
 *   r <- r + e u + t u,   t <- e d + t e + t d,   e <- e^2. */
static bool join(SlabLayers *m) {
    int n = m->total;
    if (!product(m, m->r, m->r, 0.0, m->rr)) return false;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) m->d[j * n + i] = m->t[j * n + i] + m->rr[j * n + i] * m->direct[j];
    for (int j = 0; j < m->nodes; j++) { /* passengers' rows of rr are kept for the last product below */
        for (int i = 0; i < m->nodes; i++) m->rr[j * n + i] = (i == j) - m->rr[j * n + i];
    }
    int passengers = n - m->nodes;
    if (!matrix_factor(m->nodes, m->rr, n) || !matrix_solve(m->nodes, m->rr, n, n, m->d, n) ||
        !matrix_product(passengers, n, m->nodes, 1.0, (Matrix){m->rr + m->nodes, 1, n}, (Matrix){m->d, 1, n}, 1.0,
                        m->d + m->nodes, n))
        return false;

    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) m->u[j * n + i] = m->r[j * n + i] * m->direct[j];
    if (!product(m, m->r, m->d, 1.0, m->u) || !product(m, m->t, m->u, 1.0, m->r) || !product(m, m->t, m->d, 0.0, m->rr))
        return false;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            m->r[j * n + i] += m->direct[i] * m->u[j * n + i];
            m->t[j * n + i] = m->rr[j * n + i] + m->direct[i] * m->d[j * n + i] + m->t[j * n + i] * m->direct[j];
        }
    for (int i = 0; i < n; i++) m->direct[i] *= m->direct[i];
    for (int j = 0; j < n; j++)
        for (int i = 0; i < j; i++) {
            m->r[j * n + i] = m->r[i * n + j] = 0.5 * (m->r[j * n + i] + m->r[i * n + j]);
            m->t[j * n + i] = m->t[i * n + j] = 0.5 * (m->t[j * n + i] + m->t[i * n + j]);
        }
    return true;
}

/* Stores the results for passengers at one of the kept depths. */
static void store(const SlabLayers *m, const double *root, int level, const Layered *out) {
    size_t n = (size_t)m->total, nodes = (size_t)m->nodes, passengers = n - nodes;
    for (size_t i = 0; i < passengers; i++) {
        const double *r = m->r + (nodes + i) * n, *t = m->t + (nodes + i) * n;
        double up = 0.0, down = m->direct[nodes + i];
        for (size_t j = 0; j < nodes; j++) {
            up += r[j] * root[j];
            down += t[j] * root[j];
        }
        size_t at = (size_t)level * passengers + i;
        if (out->up) out->up[at] = up;
        if (out->down) out->down[at] = down;
        for (size_t j = 0; j < passengers; j++) {
            if (out->r) out->r[at * passengers + j] = r[nodes + j];
            if (out->t) out->t[at * passengers + j] = t[nodes + j];
        }
    }
}

bool doubling_run(const Doubling *slab, double *r, double *t, const Layered *out) {
    size_t n = (size_t)slab->total;
    double *block = alloc_array(3 * n * n + 2 * n, sizeof(double));
    if (!block) return false;
    double *root = block + 3 * n * n;
    SlabLayers m = {slab->nodes, slab->total, r, t, root + n, block, block + n * n, block + 2 * n * n};
    for (size_t i = 0; i < n; i++) root[i] = i < (size_t)slab->nodes ? sqrt(slab->c[i]) : 1.0;
    thin_layer(&m, slab, root, ldexp(slab->depth, -slab->halvings));
    bool done = true;
    for (int left = slab->halvings; done; left--) {
        if (left < slab->kept) store(&m, root, slab->kept - 1 - left, out);
        if (left == 0) break;
        done = join(&m);
    }
    free(block);
    return done;
}

/* transform.h - affine maps of 3-space, in double precision because node trees multiply many of them */
#pragma once

/* An affine map: component r of the result is m[r][0] x + m[r][1] y + m[r][2] z + m[r][3]. */
typedef struct Transform {
    double m[3][4];
} Transform;

static const Transform transform_identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

/* Returns the map that applies b, then a. */
static inline Transform transform_product(const Transform *a, const Transform *b) {
    Transform p;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) {
            p.m[r][c] = c == 3 ? a->m[r][3] : 0.0;
            for (int k = 0; k < 3; k++) p.m[r][c] += a->m[r][k] * b->m[k][c];
        }
    return p;
}

/* Returns the cofactors of the linear part: determinant times inverse transpose, which exist for singular
 * maps too. They map normals to normals, reversed if the determinant is negative. */
static inline Transform transform_cofactors(const Transform *t) {
    Transform c = {{{0}}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            c.m[i][j] = t->m[i1][j1] * t->m[i2][j2] - t->m[i1][j2] * t->m[i2][j1];
        }
    return c;
}

static inline double transform_determinant(const Transform *t) {
    Transform c = transform_cofactors(t);
    return t->m[0][0] * c.m[0][0] + t->m[0][1] * c.m[0][1] + t->m[0][2] * c.m[0][2];
}

/* Applies the linear part to v in place, and with w = 1 the translation too. */
static inline void transform_apply(const Transform *t, double v[3], double w) {
    double x = v[0], y = v[1], z = v[2];
    for (int r = 0; r < 3; r++) v[r] = t->m[r][0] * x + t->m[r][1] * y + t->m[r][2] * z + t->m[r][3] * w;
}

/* widen.h - highlights of a stack over slopes that a pixel does not resolve
 *
 *   alpha'^2 = alpha^2 + 2 sigma^2   along either axis, sigma^2 the variance of the slopes
 *
 *   Slopes of Beckmann's facets are normally distributed with the variance alpha^2 / 2, and variances add: Marc Olano,
 * Dan Baker, "LEAN Mapping", I3D 2010. GGX, which has no variance, is widened by the same rule: Yusuke Tokuyoshi,
 * Anton S. Kaplanyan, "Improved Geometric Specular Antialiasing", I3D 2019.
 *   Wider are ggx and cook-torrance with D ggx, ggx-aniso or beckmann, and a coat of ggx. Other lobes are as broad as
 * most bumps, or no distribution of normals. */
#pragma once

#include "shading/lobes/cook_torrance.h"
#include "shading/lobes/ggx.h"
#include "shading/stack/stack.h"

FN float widened(float alpha, float more) { return min(sqrt(alpha * alpha + max(more, 0.0f)), 1.0f); }

/* Widens a lobe ggx; others stay. It cannot be longer along y than along x, where it becomes round. */
FN Lobe widen_ggx(Lobe lobe, float xx, float yy) {
    Lobe m = lobe, ggx = lobe_default(LOBE_GGX);
    if (m.id != ggx.id) return m;
    float stretch = m.params[GGX_ANISOTROPY], alpha = m.params[GGX_ALPHA];
    float ax = widened(mix(alpha, 1.0f, stretch * stretch), xx), ay = widened(alpha, yy);
    if (ax < ay) {
        ax = sqrt(ax * ay);
        ay = ax;
    }
    m.params[GGX_ALPHA] = ay;
    m.params[GGX_ANISOTROPY] = sqrt((ax - ay) / max(1.0f - ay, 1e-6f));
    return m;
}

FN Lobe widen_facets(Lobe lobe, float xx, float yy) {
    Lobe m = lobe;
    int d = to_int(m.params[COOK_TORRANCE_D]);
    float alpha = m.params[COOK_TORRANCE_ALPHA], even = widened(alpha, 0.5f * (xx + yy));
    float ax = widened(alpha * m.params[COOK_TORRANCE_STRETCH], xx), ay = widened(alpha, yy);
    if (d == D_GGX_ANISO) m.params[COOK_TORRANCE_STRETCH] = ax / max(ay, 1e-6f);
    if (d == D_GGX_ANISO) m.params[COOK_TORRANCE_ALPHA] = ay;
    if (d == D_GGX || d == D_BECKMANN) m.params[COOK_TORRANCE_ALPHA] = even;
    return m;
}

/* Widens the highlight by xx = 2 sigma^2 along x and yy along y of the shading frame, the coat by coat_more in all
 * directions, and prepares both again. */
FN void stack_widen(Stack *m, float xx, float yy, float coat_more) {
    if (HAS_SPECULAR(m)) {
        m->specular.lobe = widen_ggx(m->specular.lobe, xx, yy);
        if (lobe_is_composed(m->specular.lobe.id)) m->specular.lobe = widen_facets(m->specular.lobe, xx, yy);
        IN_SLOT(specular, prepare)(&m->specular.lobe, &m->specular_prepared);
    }
    if (HAS_COAT(m)) {
        m->coat.lobe = widen_ggx(m->coat.lobe, coat_more, coat_more);
        IN_SLOT(coat, prepare)(&m->coat.lobe, &m->coat_prepared);
    }
}

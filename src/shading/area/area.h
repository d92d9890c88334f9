/* area.h - a surface under a polygon light: what it reflects of a radiance of 1
 *
 *   integral of f cos_i over the polygon  =  I_D (sum of f cos_i a) / (sum of D a),   I_D = integral of D
 *
 *   D is a linearly transformed cosine: its integral I_D over the polygon has a closed form. The points of
 * both sums are those of polygon.h in the space where D is a cosine, a their solid angles: so they lie where
 * D is bright, however narrow it is, and where the light is a part of it, in that part. It is exact where
 * f cos_i is D, so for a matt base, and corrects everything else: the shape of the lobe, Fresnel, the layer rule's
 * factor on the base for each wi.
 *
 *   The cosine itself serves lobes that are broad; a fit to ggx, stretched, those of facets; a fit to fibre
 * those of fibres.
 *
 *   Eric Heitz, Jonathan Dupuy, Stephen Hill, David Neubelt, "Real-Time Polygonal-Light Shading with Linearly
 * Transformed Cosines", ACM Transactions on Graphics 35(4), 2016, has I_D with an amplitude in place of the
 * sums. Eric Heitz, Stephen Hill, Morgan McGuire, "Combining Analytic Direct Illumination and Stochastic
 * Shadows", I3D 2018, uses such a ratio for shadows. */
#pragma once

#include "shading/lobe/lobe_tables.h"
#include "shading/ltc/ltc_table.h"
#include "shading/ltc/polygon.h"
#include "shading/material/stack_value.h"

/* D: a cosine of v = (x v'_x, y v'_y, v'_z),  v' = M^-1 w. */
STRUCT(AreaDensity) {
    Ltc m;
    float x, y;
    bool narrow; /* true unless the density is the cosine of w itself */
};

FN AreaDensity area_of(Ltc m, float x, float y, bool narrow) {
    AreaDensity d;
    d.m = m;
    d.x = x;
    d.y = y;
    d.narrow = narrow;
    return d;
}

FN AreaDensity area_cosine(Dir o) { return area_of(ltc_of(1.0f, 1.0f, 0.0f, 0.0f, o.z), 1.0f, 1.0f, false); }

/* Returns D of microfacets. In the limit of a mirror v_xy / v_z is the slope of the half vector over alpha, so x and y
 * stretch D along each axis, and narrow it beyond the least alpha of the table. For a rougher lobe this is less exact,
 * so it is stretched less; study_area chose the power. */
FN AreaDensity area_facets(float ax, float ay, Dir o) {
    TableRef e = lobe_table_ltc_ggx();
    float alpha = sqrt(ax * ay), fitted = clamp(alpha, e.low * e.low, e.high * e.high);
    float narrow = max(fitted / alpha, 1.0f), stretch = pow(ay / ax, 0.5f / (1.0f + alpha));
    return area_of(ltc_table_level(e, o.z, fitted).m, narrow * stretch, narrow / stretch, true);
}

FN AreaDensity area_fibres(float alpha, Dir o) {
    return area_of(ltc_table_level(lobe_table_ltc_fibre(), o.z, alpha).m, 1.0f, 1.0f, true);
}

/* Returns D for a lobe. */
FN AreaDensity area_density(const Lobe *m, Dir o) {
    Proxy p = lobe_proxy(m);
    if (p.fit == PROXY_FACETS) return area_facets(p.ax, p.ay, o);
    if (p.fit == PROXY_FIBRES) return area_fibres(p.ax, o);
    return area_cosine(o);
}

/* Returns the light that the slots reflect together, integrated at the points of one D, without retroreflection. o and the polygon, which is
 * above the horizon, are in the frame of the slots. */
FN Rgb area_slots_of(const Stack *m, const StackView *view, Slots only, AreaDensity d, Dir o, Polygon p) {
    Polygon q = p;
    for (int k = 0; k < p.count; k++) {
        Dir v = ltc_inverse(d.m, o, p.corners[k]);
        q.corners[k] = polygon_unit(dir(v.x * d.x, v.y * d.y, v.z));
    }
    Dir flux = polygon_flux(q), c = polygon_middle(q, flux), a = polygon_last(q);
    Rgb sum = rgb_grey(0.0f);
    float seen = 0.0f, scale = d.m.det * d.m.det / (d.x * d.y);
    int rays = polygon_rays(p.count), steps = polygon_steps(p.count);
    for (int k = 0; k < p.count; k++) {
        Dir b = q.corners[k];
        for (int j = 0; j < rays; j++) {
            PolygonRay ray = polygon_ray(c, a, b, j, rays);
            for (int n = 0; n < steps; n++) {
                PolygonPoint v = polygon_point(c, ray, n, steps);
                Dir w = ltc_forward(d.m, o, dir(v.w.x / d.x, v.w.y / d.y, v.w.z));
                float r = 1.0f / sqrt(max(dir_dot(w, w), 1e-24f));
                w = dir(w.x * r, w.y * r, w.z * r);
                seen = seen + v.area * max(v.w.z, 0.0f);
                if (w.z > 0.0f) {
                    Angles angles = angles_between(o, w);
                    StackValue value = stack_value_of(m, view, only, &angles, &angles);
                    sum = rgb_add(sum, rgb_scale(value.f_cos, v.area * scale * r * r * r));
                }
            }
        }
        a = b;
    }
    return rgb_scale(sum, (max(flux.z, 0.0f) + POLYGON_SMALL) / (seen + POLYGON_SMALL));
}

/* Works as area_slots_of, with the light that the base turns back: that of the polygon after half a turn about the normal. */
FN Rgb area_slots(const Stack *m, const StackView *view, Slots only, AreaDensity d, Dir o, Polygon p) {
    if (!HAS_RETRO(m) || !(only.diffuse || only.specular)) return area_slots_of(m, view, only, d, o, p);
    Stack plain = *m;
    Polygon opposite = p;
    plain.retro = 0.0f;
    for (int k = 0; k < p.count; k++) opposite.corners[k] = dir_opposite(p.corners[k]);
    Slots base = slots_of(only.diffuse, only.specular, false, false, false);
    Slots rest = slots_of(false, false, only.sheen, false, only.dust);
    Rgb f = rgb_mix(area_slots_of(&plain, view, base, d, o, p), area_slots_of(&plain, view, base, d, o, opposite),
                    m->retro);
    return rgb_add(f, area_slots_of(&plain, view, rest, d, o, p));
}

FN Polygon area_to_coat(const Stack *m, Polygon p) {
    Polygon q = p;
    for (int k = 0; k < p.count; k++) q.corners[k] = stack_to_coat(m, p.corners[k]);
    return polygon_clip(q);
}

/* Returns the radiance of a stack towards wo (shading frame) under a polygon that emits radiance 1 from each of its
 * points. For layer rule stochastic, this is the first pass. */
FN Rgb stack_polygon(const Stack *m, const StackView *view, Polygon p) {
    Rgb sum = rgb_grey(0.0f);
    Polygon q = polygon_clip(p);
    Dir o = view->o;
    if (q.count < 3 || o.z <= 0.0f) return sum;
    AreaDensity specular = area_density(&m->specular.lobe, o), sheen = area_density(&m->sheen.lobe, o);
    AreaDensity dust = area_density(&m->dust.lobe, o);
    for (int pass = 0; pass < 5; pass++) {
        Slots only = slots_of(SHOWS_DIFFUSE && HAS_DIFFUSE(m) && pass == 0,
                              SHOWS_SPECULAR && HAS_SPECULAR(m) && pass == (specular.narrow ? 1 : 0),
                              SHOWS_SHEEN && HAS_SHEEN(m) && pass == (sheen.narrow ? 2 : 0),
                              SHOWS_COAT && HAS_COAT(m) && pass == 4,
                              SHOWS_DUST && HAS_DUST(m) && pass == (dust.narrow ? 3 : 0));
        AreaDensity d = area_cosine(o);
        Dir from = o;
        if (pass == 1) d = specular;
        if (pass == 2) d = sheen;
        if (pass == 3) d = dust;
        if (only.coat) {
            from = view->coat_o;
            q = area_to_coat(m, q);
            d = area_density(&m->coat.lobe, from);
        }
        if (only.diffuse || only.specular || only.sheen || only.coat || only.dust)
            if (from.z > 0.0f) sum = rgb_add(sum, area_slots(m, view, only, d, from, q));
    }
    return sum;
}

/* Returns the light of a polygon of radiance 1 below the surface that thin glass lets through: that of its mirror image in
 * the specular lobe, whose colours are those of the glass. */
FN Rgb stack_polygon_glass(const Stack *m, const StackView *view, Polygon mirrored) {
    Stack glass = *m;
    SlotColors c = stack_glass_colors(m, view);
    glass.specular.f0 = c.f0;
    glass.specular.f90 = c.f90;
    glass.extra_f0 = rgb_grey(0.0f);
    glass.extra_f90 = rgb_grey(0.0f);
    glass.extra_f_quadratic = rgb_grey(0.0f);
    AreaDensity d = area_density(&m->specular.lobe, view->o);
    Slots only = slots_of(false, true, false, false, false);
    return area_slots_of(&glass, view, only, d, view->o, mirrored);
}

/* Returns the light of a polygon of radiance 1 below the surface that comes through: that of its mirror image at the points
 * of the cosine, each as the layers dim it, and through glass. */
FN Rgb stack_polygon_behind(const Stack *m, const StackView *view, Polygon p) {
    Polygon q = p;
    for (int k = 0; k < p.count; k++) q.corners[k] = dir(p.corners[k].x, p.corners[k].y, -p.corners[k].z);
    q = polygon_clip(q);
    Rgb sum = rgb_grey(0.0f), clear = sum;
    if (q.count < 3 || view->o.z <= 0.0f) return sum;
    if (HAS_GLASS(m)) clear = stack_polygon_glass(m, view, q);
    q = polygon_on_sphere(q);
    Dir flux = polygon_flux(q), c = polygon_middle(q, flux), a = polygon_last(q);
    float seen = 0.0f;
    int rays = polygon_rays(q.count), steps = polygon_steps(q.count);
    for (int k = 0; k < q.count; k++) {
        Dir b = q.corners[k];
        for (int j = 0; j < rays; j++) {
            PolygonRay ray = polygon_ray(c, a, b, j, rays);
            for (int n = 0; n < steps; n++) {
                PolygonPoint v = polygon_point(c, ray, n, steps);
                if (v.w.z > 0.0f) {
                    Angles angles = angles_between(view->o, v.w);
                    StackValue value = stack_transmitted_evenly(m, view, &angles);
                    seen = seen + v.area * v.w.z;
                    sum = rgb_add(sum, rgb_scale(value.f_cos, v.area));
                }
            }
        }
        a = b;
    }
    return rgb_add(clear, rgb_scale(sum, (max(flux.z, 0.0f) + POLYGON_SMALL) / (seen + POLYGON_SMALL)));
}

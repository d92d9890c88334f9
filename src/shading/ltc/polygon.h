/* polygon.h - a flat convex polygon as a point sees it, integrated over its directions
 *
 *   G_k = gamma_k (a_k x a_k+1) / |a_k x a_k+1|,   L = 1/2 sum G_k                               [sr]
 *
 * a_k are the corners on the unit sphere, gamma_k the arcs between them, and L is the integral of w over the
 * polygon: L_z / pi is the share of a cosine that it covers, its form factor. Johann Heinrich Lambert,
 * "Photometria", 1760; James Arvo, "The Irradiance Jacobian for Partially Occluded Polyhedral Sources",
 * SIGGRAPH 1994, equation (2).
 *
 *   What is no cosine is integrated along rays from the middle c of the polygon to points e of its edges. A
 * triangle c a b has the solid angle  integral of c . G / (1 + c . e) dt,  t in [0, 1] along the arc, since
 * an azimuth about c holds 1 - c . e; and along the ray from c to e that part grows as the square of
 * s = |w - c| / |e - c|. Both are smooth up to the hemisphere, so Gauss' rules for t and for s serve.
 *
 *   Corners are given relative to the point, in a frame whose horizon is z = 0; in which order, does not
 * matter to any integral here. */
#pragma once

#include "shading/ltc/ltc.h"

#define POLYGON_SIDES   8  /* of a light */
#define POLYGON_CORNERS 10 /* two horizons cut off may add one each */

STRUCT(Polygon) {
    Dir corners[POLYGON_CORNERS];
    int count;
};

FN Dir polygon_cross(Dir a, Dir b) { return dir(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); }

/* Returns w / |w|. A corner at the point itself has no direction and becomes 0. */
FN Dir polygon_unit(Dir w) {
    float most = max(max(abs(w.x), abs(w.y)), max(abs(w.z), 1e-18f)), s = 1.0f / most;
    Dir v = dir(w.x * s, w.y * s, w.z * s);
    float r = 1.0f / sqrt(max(dir_dot(v, v), 1e-12f));
    return dir(v.x * r, v.y * r, v.z * r);
}

/* Returns the last corner, which precedes the first; any corner if the polygon is empty. */
FN Dir polygon_last(Polygon p) { return p.corners[p.count > 0 ? p.count - 1 : 0]; }

/* Returns the part above the horizon; its count is 0 if there is none. Ivan E. Sutherland, Gary W. Hodgman, "Reentrant
 * Polygon Clipping", Communications of the ACM 17(1), 1974, for one plane. */
FN Polygon polygon_clip(Polygon p) {
    Polygon q = p;
    q.count = 0;
    Dir a = polygon_last(p);
    for (int k = 0; k < p.count; k++) {
        Dir b = p.corners[k];
        if ((a.z < 0.0f) != (b.z < 0.0f) && q.count < POLYGON_CORNERS) {
            float t = a.z / (a.z - b.z);
            q.corners[q.count] = dir(mix(a.x, b.x, t), mix(a.y, b.y, t), 0.0f);
            q.count = q.count + 1;
        }
        if (b.z >= 0.0f && q.count < POLYGON_CORNERS) {
            q.corners[q.count] = b;
            q.count = q.count + 1;
        }
        a = b;
    }
    if (q.count < 3) q.count = 0;
    return q;
}

/* Returns the polygon with its corners projected to the unit sphere. */
FN Polygon polygon_on_sphere(Polygon p) {
    Polygon q = p;
    for (int k = 0; k < p.count; k++) q.corners[k] = polygon_unit(p.corners[k]);
    return q;
}

/* Evaluates gamma / sin gamma for x = 1 - cos gamma in [0, 1] by a polynomial interpolated at Chebyshev nodes, within
 * 2.3e-7 and exact at 0. */
FN float polygon_arc(float x) {
    float p = 0.0127232925f;
    p = p * x - 0.0242560185f;
    p = p * x + 0.0321926243f;
    p = p * x - 0.00237361049f;
    p = p * x + 0.0291656957f;
    p = p * x + 0.0566537583f;
    p = p * x + 0.133357078f;
    p = p * x + 0.333333147f;
    return 1.0f + x * p;
}

/* Returns G of the arc from a to b. It is computed from the difference of the corners, since near ones have most digits
 * in common; beyond a right angle gamma is pi less the arc to -b. */
FN Dir polygon_edge(Dir a, Dir b) {
    Dir d = dir(b.x - a.x, b.y - a.y, b.z - a.z), n = polygon_cross(a, d);
    float x = 0.5f * dir_dot(d, d), k = polygon_arc(min(x, 1.0f));
    if (x > 1.0f) k = PI / sqrt(max(dir_dot(n, n), 1e-14f)) - polygon_arc(max(2.0f - x, 0.0f));
    return dir(n.x * k, n.y * k, n.z * k);
}

/* Returns the sum of the corners, a direction inside the polygon. */
FN Dir polygon_sum(Polygon p) {
    Dir sum = dir(0.0f, 0.0f, 0.0f);
    for (int k = 0; k < p.count; k++) sum = dir(sum.x + p.corners[k].x, sum.y + p.corners[k].y, sum.z + p.corners[k].z);
    return sum;
}

/* Returns L of a polygon on the sphere. */
FN Dir polygon_flux(Polygon p) {
    Dir sum = dir(0.0f, 0.0f, 0.0f), a = polygon_last(p);
    for (int k = 0; k < p.count; k++) {
        Dir b = p.corners[k], g = polygon_edge(a, b);
        sum = dir(sum.x + g.x, sum.y + g.y, sum.z + g.z);
        a = b;
    }
    float s = dir_dot(sum, polygon_sum(p)) < 0.0f ? -0.5f : 0.5f;
    return dir(s * sum.x, s * sum.y, s * sum.z);
}

/* Below this L, sr, rounding reaches a thousandth of it, and another formula without that loss takes over. */
#define POLYGON_SMALL 1e-4f

/* Returns c of a polygon on the sphere: the direction of L. */
FN Dir polygon_middle(Polygon p, Dir flux) {
    Dir sum = polygon_sum(p);
    return polygon_unit(
        dir(flux.x + POLYGON_SMALL * sum.x, flux.y + POLYGON_SMALL * sum.y, flux.z + POLYGON_SMALL * sum.z));
}

/* Returns the integral of max(z, 0) / pi over the part of the polygon above the horizon, 0 to 1. */
FN float polygon_cosine(Polygon p) {
    return clamp(polygon_flux(polygon_on_sphere(polygon_clip(p))).z / PI, 0.0f, 1.0f);
}

/* Returns the integral of a linearly transformed cosine over the part of the polygon above the horizon. */
FN float polygon_ltc(Ltc m, Dir o, Polygon p) {
    Polygon q = polygon_clip(p);
    for (int k = 0; k < q.count; k++) q.corners[k] = ltc_inverse(m, o, q.corners[k]);
    return polygon_cosine(q);
}

/* A ray from c to the point e of an edge, and the solid angle that it stands for. */
STRUCT(PolygonRay) {
    Dir e;
    float cosine, area; /* c . e; sr */
};

STRUCT(PolygonPoint) {
    Dir w;
    float area; /* sr */
};

/* Returns the number of rays for an edge of a polygon with `count` corners, 1 to 3; polygon_steps the points on a ray,
 * 2 or 3. They are at most 32 in all. */
FN int polygon_rays(int count) { return count < 4 ? 3 : count < 9 ? 2 : 1; }
FN int polygon_steps(int count) { return count < 6 || count > 8 ? 3 : 2; }

/* Returns ray j of `rays` to the arc from a to b: Gauss' points for a constant weight, counted from the middle. */
FN PolygonRay polygon_ray(Dir c, Dir a, Dir b, int j, int rays) {
    float t = 0.0f, weight = 1.0f;
    if (rays == 2) {
        t = j == 0 ? -0.577350269f : 0.577350269f;
        weight = 0.5f;
    }
    if (rays == 3) {
        t = 0.774596669f * to_float(j - 1);
        weight = j == 1 ? 0.444444444f : 0.277777778f;
    }
    Dir g = polygon_edge(a, b), d = dir(b.x - a.x, b.y - a.y, b.z - a.z);
    Dir m = polygon_unit(dir(a.x + b.x, a.y + b.y, a.z + b.z));
    float arc = 0.5f * t * sqrt(dir_dot(g, g)), up = cos(arc);
    float along = sin(arc) / sqrt(max(dir_dot(d, d), 1e-18f));
    PolygonRay r;
    r.e = dir(m.x * up + d.x * along, m.y * up + d.y * along, m.z * up + d.z * along);
    r.cosine = clamp(dir_dot(c, r.e), -1.0f, 1.0f);
    r.area = weight * abs(dir_dot(c, g)) / max(1.0f + r.cosine, 1e-3f);
    return r;
}

/* Returns point j of a ray: Gauss' points for the weight 2 s. With 1 - w . c = s^2 (1 - e . c) = x, w is on the arc
 * where it is e k + c (1 - x - k e . c),  k = s sqrt((2 - x) / (1 + e . c)). */
FN PolygonPoint polygon_point(Dir c, PolygonRay r, int j, int steps) {
    float s = j == 0 ? 0.355051026f : 0.844948974f, weight = j == 0 ? 0.363917237f : 0.636082763f;
    if (steps == 3) {
        s = j == 0 ? 0.212340538f : j == 1 ? 0.590533136f : 0.911412040f;
        weight = j == 0 ? 0.139653960f : j == 1 ? 0.458482213f : 0.401863827f;
    }
    float x = (1.0f - r.cosine) * s * s, k = s * sqrt((2.0f - x) / max(1.0f + r.cosine, 1e-3f));
    float back = 1.0f - x - k * r.cosine;
    PolygonPoint p;
    p.w = dir(r.e.x * k + c.x * back, r.e.y * k + c.y * back, r.e.z * k + c.z * back);
    p.area = r.area * weight;
    return p;
}

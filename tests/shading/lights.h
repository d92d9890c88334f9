/* lights.h - polygon lights over a floor and a sphere, and what they send by brute force, in double
 *
 * For the tests and for study/area.c. A point on the floor or on the sphere is seen from one eye; a light is
 * four corners relative to it, in its shading frame. */
#ifndef WEFT_TEST_SHADING_LIGHTS_H
#define WEFT_TEST_SHADING_LIGHTS_H

#include "base/pi.h"
#include "base/random.h"
#include "shading/area/area.h"
#include "shading/material/material_stack.h"

typedef struct Point {
    double x, y, z;
} Point;

static inline Point point(double x, double y, double z) { return (Point){x, y, z}; }
static inline Point point_add(Point a, Point b, double s) { return point(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z); }
static inline double point_dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Point point_cross(Point a, Point b) {
    return point(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double point_length(Point a) { return (sqrt)(point_dot(a, a)); }
static inline Point point_unit(Point a) { return point_add(point(0.0, 0.0, 0.0), a, 1.0 / point_length(a)); }
static inline Dir point_dir(Point a) { return dir((float)a.x, (float)a.y, (float)a.z); }

/* In [0, 1), the same in every run. */
static inline double light_random(uint64_t *state) {
    return (double)(hash64(*state += 0x9e3779b97f4a7c15u) >> 11) * 0x1p-53;
}

/* Three such. In statements of their own: compilers differ in the order of arguments. */
static inline Point light_random_point(uint64_t *state) {
    double z = light_random(state), y = light_random(state), x = light_random(state);
    return point(x, y, z);
}
static inline Point light_random_flat(uint64_t *state, double z) {
    double y = light_random(state), x = light_random(state);
    return point(x, y, z);
}

/* A function of directions, f cos_i say; 1/sr. */
typedef double (*Integrand)(const void *what, Dir o, Dir i);

typedef struct Integral {
    Integrand f;
    const void *what;
    Dir o;
    Point normal;     /* of the light */
    double tolerance; /* absolute, of one triangle */
    int least;        /* how often a triangle is cut in four before it is trusted */
} Integral;

/* f dwi of one triangle, seen from the origin, by Radon's rule of degree five. */
static inline double light_triangle(const Integral *integral, const Point p[3]) {
    static const double at[3] = {1.0 / 3.0, 0.059715871789769820, 0.797426985353087320};
    static const double weights[3] = {0.225, 0.132394152788506181, 0.125939180544827153};
    Point m = point_cross(point_add(p[1], p[0], -1.0), point_add(p[2], p[0], -1.0));
    double sum = 0.0;
    for (int k = 0; k < 7; k++) {
        int kind = (k + 2) / 3, special = (k + 2) % 3;
        double most = at[kind], rest = 0.5 * (1.0 - most);
        Point w = point(0.0, 0.0, 0.0);
        for (int c = 0; c < 3; c++) w = point_add(w, p[c], c == special ? most : rest);
        double r = point_length(w), z = w.z / r;
        if (!(z > 0.0 && r > 0.0)) continue;
        sum += weights[kind] * integral->f(integral->what, integral->o, point_dir(point_unit(w))) *
               fabs(point_dot(integral->normal, w)) / (r * r * r);
    }
    return 0.5 * point_length(m) * sum;
}

static inline double light_refine(const Integral *integral, const Point p[3], double whole, int depth) {
    Point middle[3];
    for (int k = 0; k < 3; k++)
        middle[k] = point_add(p[(k + 1) % 3], point_add(p[(k + 2) % 3], p[(k + 1) % 3], -1.0), 0.5);
    const Point parts[4][3] = {{p[0], middle[2], middle[1]},
                               {middle[2], p[1], middle[0]},
                               {middle[1], middle[0], p[2]},
                               {middle[0], middle[1], middle[2]}};
    double value[4], sum = 0.0;
    for (int k = 0; k < 4; k++) sum += value[k] = light_triangle(integral, parts[k]);
    if (depth >= 9 || (depth >= integral->least && fabs(sum - whole) < integral->tolerance)) return sum;
    sum = 0.0;
    for (int k = 0; k < 4; k++) sum += light_refine(integral, parts[k], value[k], depth + 1);
    return sum;
}

/* The integral over the part of a convex polygon above the horizon; `least` is 2 for what is smooth. */
static inline double light_integral(Integrand f, const void *what, Dir o, const Point *corners, int count, int least) {
    Point above[16];
    int n = 0;
    for (int k = 0; k < count; k++) {
        Point a = corners[k], b = corners[(k + 1) % count];
        if (a.z >= 0.0) above[n++] = a;
        if ((a.z < 0.0) != (b.z < 0.0)) above[n++] = point_add(a, point_add(b, a, -1.0), a.z / (a.z - b.z));
    }
    if (n < 3) return 0.0;
    Integral integral = {f, what, o, point(0.0, 0.0, 0.0), HUGE_VAL, least};
    integral.normal =
        point_unit(point_cross(point_add(corners[1], corners[0], -1.0), point_add(corners[2], corners[0], -1.0)));
    double sum = 0.0;
    for (int pass = 0; pass < 2; pass++) { /* a first sum, that the tolerance is a part of */
        double total = 0.0;
        for (int k = 1; k + 1 < n; k++)
            total += light_refine(&integral, (const Point[]){above[0], above[k], above[k + 1]}, HUGE_VAL, pass ? 0 : 2);
        sum = total;
        integral.tolerance = 1e-4 * total + 1e-8; /* Dir has floats: there is a floor to what they tell */
    }
    return sum;
}

/* What a whole stack, seen from o, reflects in green. */
static inline double light_stack(const void *what, Dir o, Dir i) { return (double)seen_eval(what, i, 0).f_cos.g; }

/* A pose: a rectangle somewhere around, in any attitude; one in about ten crosses the floor. */
typedef struct LightPose {
    Point corners[4];
} LightPose;

static inline LightPose light_pose(uint64_t *state) {
    const Point half = {0.5, 0.5, 0.5};
    Point c = light_random_point(state);
    c = point(3.0 * c.x - 1.5, 3.0 * c.y - 1.5, 2.3 * c.z - 0.3);
    Point n = point_unit(point_add(light_random_point(state), half, -1.0));
    Point u = point_unit(point_cross(n, point_add(light_random_flat(state, 0.75), half, -1.0)));
    Point v = point_cross(n, u);
    double su = 0.1 + 0.8 * light_random(state), sv = 0.1 + 0.8 * light_random(state);
    LightPose pose;
    for (int k = 0; k < 4; k++)
        pose.corners[k] = point_add(point_add(c, u, k == 1 || k == 2 ? su : -su), v, k < 2 ? -sv : sv);
    return pose;
}

typedef struct Light {
    Point corners[4];
    Dir o;
} Light;

/* The pose as a point sees it: one of the floor, 2 wide, or of what the eye sees of a sphere that lies on it.
 */
static inline Light light_seen(const LightPose *pose, bool sphere, uint64_t *state) {
    const Point eye = {0.3, -3.0, 1.6}, centre = {0.0, 0.0, 0.45};
    const Point half = {0.5, 0.5, 0.5};
    Point at = light_random_flat(state, 0.0), n = point(0.0, 0.0, 1.0), o;
    at = point(2.0 * at.x - 1.0, 2.0 * at.y - 1.0, 0.0);
    do {
        if (sphere) {
            double z = 2.0 * light_random(state) - 1.0, r = (sqrt)(1.0 - z * z),
                   phi = 6.28318530717958648 * light_random(state);
            n = point(r * (cos)(phi), r * (sin)(phi), z);
            at = point_add(centre, n, 0.45);
        }
        o = point_unit(point_add(eye, at, -1.0));
    } while (point_dot(n, o) < 0.02);
    Point t = point_unit(point_cross(n, point_add(light_random_flat(state, 0.87), half, -1.0)));
    Point b = point_cross(n, t);
    Light light = {.o = point_dir(point(point_dot(o, t), point_dot(o, b), point_dot(o, n)))};
    for (int k = 0; k < 4; k++) {
        Point w = point_add(pose->corners[k], at, -1.0);
        light.corners[k] = point(point_dot(w, t), point_dot(w, b), point_dot(w, n));
    }
    return light;
}

static inline Polygon light_polygon(const Point *corners, int count) {
    Polygon p = {.count = count};
    for (int k = 0; k < count; k++) p.corners[k] = point_dir(corners[k]);
    return p;
}

/* A convex polygon of 3 to 8 corners in any attitude, `far` away; returns how many. */
static inline int any_polygon(uint64_t *state, double far, Point corners[8]) {
    int count = 3 + (int)(6.0 * light_random(state));
    Point n = point_unit(point(light_random(state) - 0.5, light_random(state) - 0.5, light_random(state) - 0.5));
    Point u = point_unit(point_cross(n, point(light_random(state) - 0.5, light_random(state) - 0.5, 0.25)));
    Point v = point_cross(n, u);
    Point c = point(far * (2.0 * light_random(state) - 1.0), far * (2.0 * light_random(state) - 1.0),
                    far * (2.0 * light_random(state) - 0.8));
    for (int k = 0; k < count; k++) {
        double phi = 2.0 * PI_DOUBLE * (k + 0.8 * light_random(state)) / count;
        corners[k] = point_add(point_add(c, u, (cos)(phi)), v, (sin)(phi)); /* of a circle: convex */
    }
    return count;
}

/* A stack of one lobe, white: as the base's diffuse or specular lobe, or as a sheen. */
static inline SeenStack light_lone(Lobe lobe, Dir o) {
    SeenStack m;
    stack_clear(&m.stack);
    Slot slot;
    slot_even(&slot, lobe, rgb_grey(1.0f), rgb_grey(1.0f), 1.0f);
    unsigned traits = weft_lobe_info(lobe.id)->traits;
    if (traits & TRAIT_DIFFUSE)
        m.stack.diffuse = slot;
    else if (area_density(&lobe, dir(0.0f, 0.0f, 1.0f)).narrow)
        m.stack.specular = slot;
    else
        m.stack.sheen = slot;
    seen_prepare(&m, o);
    return m;
}

/* One copy: stack_polygon is long once all in it is inlined. */
static __attribute__((noinline, unused)) Rgb light_on(const SeenStack *m, Polygon p) {
    return stack_polygon(&m->stack, &m->view, p);
}

#endif

/* cases.h - what the shading tests loop over: every lobe at a spread of parameters, directions, random
 * surfaces; and a hemisphere cut into cells
 *
 * Include it after the standard headers and cmocka: the dialect's names shadow <math.h>, so a double function
 * is called as (exp)(x). */
#ifndef WEFT_TEST_SHADING_CASES_H
#define WEFT_TEST_SHADING_CASES_H

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <setjmp.h>

#include <cmocka.h>

#include "base/pi.h"
#include "base/random.h"
#include "shading/material/material_stack.h"

/* WEFT_TEST_LONG=1 asks for finer grids and more samples, WEFT_TEST_SHORT=1 (sanitizers) for fewer. */
static inline bool test_asked(const char *variable) {
    const char *value = getenv(variable);
    return value && value[0] == '1';
}
static inline bool test_long(void) { return test_asked("WEFT_TEST_LONG"); }
static inline bool test_short(void) { return test_asked("WEFT_TEST_SHORT"); }

/* Whether this case has its turn: each in long runs, one of `usual` in plain ones, one of `few` under
 * sanitizers. Numbers without a factor in common with the loops around it reach every value of each loop. */
static inline bool test_turn(int *at, int usual, int few) {
    return (*at)++ % (test_long() ? 1 : test_short() ? few : usual) == 0;
}

/* Random numbers that are the same in every run: splitmix64 (Guy L. Steele, Doug Lea, Christine H. Flood,
 * "Fast Splittable Pseudorandom Number Generators", 2014). */
typedef struct Random {
    uint64_t state;
} Random;

static inline uint32_t random_bits(Random *random) {
    uint64_t x = random->state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return (uint32_t)((x ^ (x >> 31)) >> 32);
}

static inline float random_unit(Random *random) { return unit_float(random_bits(random)); }

static inline Dir direction(double theta, double phi) {
    double s = (sin)(theta);
    return dir((float)(s * (cos)(phi)), (float)(s * (sin)(phi)), (float)(cos)(theta));
}

static inline Dir direction_cos(double cos_theta, double phi) { return direction(acos(cos_theta), phi); }

/* Any direction of the upper hemisphere. */
static inline Dir random_direction(Random *random) {
    double z = 1.0 - (double)random_unit(random);
    return direction_cos(z, 2.0 * PI_DOUBLE * (double)random_unit(random));
}

/* Parameter spread: the default; each parameter alone at both ends of its plausible and of its hard range and
 * in between; and, for lobes of several parameters, some random combinations. */
enum { CASE_VALUES = 5, CASE_COMBINATIONS = 4 };

/* A choice is tried at each of its ids. */
static inline int case_values(const WeftParamInfo *p) { return p->choices ? 1 + (int)p->hard_high : CASE_VALUES; }

static inline int case_count(int id) {
    const WeftLobeInfo *info = weft_lobe_info((int)id);
    int n = 1 + (info->param_count > 1 ? CASE_COMBINATIONS : 0);
    for (int p = 0; p < info->param_count; p++) n += case_values(&info->params[p]);
    return n;
}

static inline float case_value(const WeftParamInfo *p, int k) {
    if (p->choices) return (float)k;
    switch (k) {
    case 0: return p->low;
    case 1: return p->high;
    case 2: return p->hard_low;
    case 3: return p->hard_high;
    default: return p->low > 0.0f ? sqrtf(p->low * p->high) : 0.5f * (p->low + p->high);
    }
}

static inline Lobe case_lobe(int id, int k) {
    const WeftLobeInfo *info = weft_lobe_info((int)id);
    Lobe lobe = lobe_default(id);
    if (k == 0) return lobe;
    int at = k - 1;
    for (int p = 0; p < info->param_count; at -= case_values(&info->params[p++]))
        if (at < case_values(&info->params[p])) {
            lobe_set(&lobe, p, case_value(&info->params[p], at));
            return lobe;
        }
    Random random = {(uint64_t)k};
    for (int p = 0; p < info->param_count; p++) {
        float t = random_unit(&random);
        float value = weft_mix(info->params[p].low, info->params[p].high, info->params[p].choices ? t : t * t);
        lobe_set(&lobe, p, info->params[p].choices ? floorf(value + 0.5f) : value);
    }
    return lobe;
}

/* Whether f of a lobe is an estimate: who asks for exact numbers passes it over, and
 * tests/fibre/test_walk_lobe.c asks for its means. */
static inline bool case_walks(int id) { return (weft_lobe_info(id)->traits & TRAIT_REFERENCE) != 0; }

typedef struct CaseName {
    char text[160];
} CaseName;

static inline CaseName case_name(const Lobe *lobe, Dir o) {
    const WeftLobeInfo *info = weft_lobe_info((int)lobe->id);
    CaseName name;
    int used = snprintf(name.text, sizeof name.text, "%s", info->id);
    for (int k = 0; k < info->param_count; k++)
        used += snprintf(name.text + used, sizeof name.text - (size_t)used, " %s=%g", info->params[k].name,
                         (double)lobe->params[k]);
    snprintf(name.text + used, sizeof name.text - (size_t)used, " cos_o=%g", (double)o.z);
    return name;
}

/* The hemisphere of wi as a square [-1, 1]^2 stretched about the direction that mirrors wo: both theta and
 * phi move slowly there, and again at the far ends (normal, horizon, backscatter), since that is where lobes
 * change fast. Cells are unit steps of that square; integrals are midpoint sums over them. */
typedef struct Grid {
    double theta, phi; /* of the mirror direction */
} Grid;

static inline Grid grid_about(Dir o) {
    return (Grid){atan2(hypot((double)o.x, (double)o.y), (double)o.z), atan2(-(double)o.y, -(double)o.x)};
}

/* x in (0, 1) to (0, 1), flat at both ends; and its derivative. */
static inline double stretch(double x) {
    double a = x * x * x * x, y = 1.0 - x, b = y * y * y * y;
    return a / (a + b);
}
static inline double stretch_slope(double x) {
    double y = 1.0 - x, xy = x * y, n = x * x * x * x + y * y * y * y;
    return 4.0 * xy * xy * xy / (n * n);
}
static inline double unstretch(double m) {
    if (m >= 1.0) return 1.0;
    double r = (sqrt)((sqrt)(m / (1.0 - m)));
    return r / (1.0 + r);
}

/* The direction at (s, t) of the square, and the solid angle per unit of its area. */
static inline Dir grid_direction(Grid grid, double s, double t, double *solid_angle) {
    double range = s < 0.0 ? grid.theta : PI_DOUBLE / 2.0 - grid.theta;
    double theta = grid.theta + (s < 0.0 ? -1.0 : 1.0) * range * stretch(fabs(s));
    double phi = grid.phi + (t < 0.0 ? -1.0 : 1.0) * PI_DOUBLE * stretch(fabs(t));
    *solid_angle = range * stretch_slope(fabs(s)) * PI_DOUBLE * stretch_slope(fabs(t)) * (sin)(theta);
    return direction(theta, phi);
}

/* The inverse: (s, t) of a direction. */
static inline void grid_place(Grid grid, Dir i, double *s, double *t) {
    double theta = atan2(hypot((double)i.x, (double)i.y), (double)i.z) - grid.theta;
    double range = theta < 0.0 ? grid.theta : PI_DOUBLE / 2.0 - grid.theta;
    double phi = atan2((double)i.y, (double)i.x) - grid.phi;
    phi -= 2.0 * PI_DOUBLE * (floor)(phi / (2.0 * PI_DOUBLE) + 0.5);
    *s = range > 0.0 ? (theta < 0.0 ? -1.0 : 1.0) * unstretch(fabs(theta) / range) : 0.0;
    *t = (phi < 0.0 ? -1.0 : 1.0) * unstretch(fabs(phi) / PI_DOUBLE);
}

/* A plausible surface with everything switched on now and then. With tilt, the coat has a normal of its own.
 */
static inline Surface random_surface(Random *random, bool tilt) {
    Surface s = {.opacity = 1.0f, .occlusion = 1.0f, .sheen = 1.0f, .ior = 1.0f + 1.2f * random_unit(random)};
    s.sheen_second = (Rgb){1.0f, 1.0f, 1.0f};
    s.base_color = (Rgb){random_unit(random), random_unit(random), random_unit(random)};
    s.metallic = max(2.0f * random_unit(random) - 1.0f, 0.0f);
    s.roughness = random_unit(random);
    s.specular = min(2.0f * random_unit(random), 1.0f);
    s.specular_color = (Rgb){1.0f, random_unit(random), random_unit(random)};
    s.anisotropy = max(2.0f * random_unit(random) - 1.0f, 0.0f);
    if (s.anisotropy > 0.0f) s.roughness = weft_mix(0.3f, 1.0f, s.roughness); /* a Grid resolves no finer ridge */
    s.normal = s.clearcoat_normal = dir(0.0f, 0.0f, 1.0f);
    s.anisotropy_direction = dir(1.0f, 0.0f, 0.0f);
    s.clearcoat = max(2.0f * random_unit(random) - 1.0f, 0.0f);
    s.clearcoat_roughness = weft_mix(tilt ? 0.4f : 0.0f, 1.0f, random_unit(random));
    if (tilt) { /* compilers differ in the order of arguments */
        double phi = 6.0 * (double)random_unit(random), theta = 0.5 * (double)random_unit(random);
        s.clearcoat_normal = direction(theta, phi);
    }
    if (random_unit(random) < 0.5f)
        s.sheen_color = (Rgb){random_unit(random), random_unit(random), random_unit(random)};
    s.sheen_roughness = random_unit(random);
    s.sheen_density = 1.0f;
    s.sheen_tail = 0.6f;
    s.sheen_rise = 3.0f;
    s.diffuse_retro = s.diffuse_lift = 0.3f;
    s.coat_ior = 1.5f;
    s.coat_color = s.fuzz_color = (Rgb){1.0f, 1.0f, 1.0f};
    s.coat_anisotropy_direction = dir(1.0f, 0.0f, 0.0f);
    s.fuzz_roughness = 0.5f;
    return s;
}

/* The same under white dust. */
static inline Surface dusted(Surface s, float dust) {
    s.dust = min(dust, 1.0f);
    s.dust_color = (Rgb){1.0f, 1.0f, 1.0f};
    s.dust_roughness = 1.0f;
    s.dust_falloff = 1.0f;
    s.dust_direction = dir(1.0f, 0.0f, 0.0f);
    s.dust_scale = 0.05f;
    return s;
}

/* Nothing chosen but a sheen and a layer rule. */
static inline Choices test_choices(int sheen_lobe, int layer) {
    Choices c = choices_unmade();
    c.sheen_lobe = sheen_lobe;
    c.layer = layer;
    return c;
}

/* The stack of a surface with that sheen. */
static inline SeenStack test_stack(const Surface *surface, int layer, const AlbedoTable *table, Dir o) {
    Choices choices = test_choices(table->lobe.id, layer);
    SeenStack stack;
    seen_make(&stack, surface, &choices, albedo_table_ref(table), o);
    return stack;
}

/* A white Lambert base without an interface, under a white sheen. */
static inline Surface white_cloth(float roughness) {
    return (Surface){.base_color = {1.0f, 1.0f, 1.0f},
                     .sheen_color = {1.0f, 1.0f, 1.0f},
                     .sheen_second = {1.0f, 1.0f, 1.0f},
                     .sheen = 1.0f,
                     .ior = 1.0f,
                     .sheen_roughness = roughness,
                     .sheen_density = 1.0f,
                     .sheen_tail = 0.6f,
                     .sheen_rise = 3.0f,
                     .diffuse_retro = 0.3f,
                     .diffuse_lift = 0.3f,
                     .normal = {0.0f, 0.0f, 1.0f}};
}

/* The lobe that a material's sheen is where that one is chosen. */
static inline Lobe sheen_lobe(int id, float roughness) {
    Surface cloth = white_cloth(roughness);
    Choices choices = test_choices(id, CHOICE_AUTO);
    Stack stack;
    stack_make(&stack, &cloth, &choices, (TableRef){.kind = TABLE_NONE});
    return stack.sheen.lobe;
}

/* E of a lobe over what a roughness from 0 to 1 makes of its first parameter, as a stack expects it. */
static inline void fill_albedo(AlbedoTable *table, int id) {
    Lobe lobe = sheen_lobe(id, 0.5f);
    float a = sheen_lobe(id, 0.0f).params[0], b = sheen_lobe(id, 1.0f).params[0];
    bool one = weft_lobe_info((int)id)->param_count == 0;
    albedo_table_fill(table, &lobe, one ? 0.0f : min(a, b), one ? 0.0f : max(a, b), 0);
}

#endif

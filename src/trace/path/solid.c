#include "trace/path/solid.h"

#include "shading/stack/frame.h"

static const float LEAST_BENT = 1.001f; /* an ior of 1 leaves no half vector */

SolidGlass solid_take(Stack *stack, const Surface *surface, const SolidTable *table) {
    const Proxy facets = lobe_proxy(&stack->specular.lobe);
    const SolidGlass glass = {.share = stack->glass,
                              .tint = stack->glass_tint,
                              .ior = max(compose_ior(surface), LEAST_BENT),
                              .ax = max(facets.ax, 0.001f),
                              .ay = max(facets.ay, 0.001f),
                              .f0 = stack->specular.f0,
                              .f90 = stack->specular.f90,
                              .interface_f0 = stack->interface_f0,
                              .interface_f90 = stack->interface_f90,
                              .table = table};
    solid_drop(stack);
    return glass;
}

void solid_drop(Stack *stack) {
    Slot *diffuse = &stack->diffuse;
    const float through = rgb_mean(stack->transmitted), clear = stack_glass_facing(stack);
    const bool dark = !(rgb_max3(diffuse->f0) + rgb_max3(diffuse->f90) + through > 0.0f);
    diffuse->normal = dark ? 0.0f : max(diffuse->normal - clear, 1e-30f);
    stack->transmitted_p = min(stack->transmitted_p * (diffuse->normal + clear) / max(diffuse->normal, 1e-30f), 1.0f);
    stack_without_glass(stack);
}

void solid_hide_highlight(Stack *stack) { stack->specular.normal = 0.0f; }

/* Returns the cosine of light to a facet on the side of air, where it is c on the side of wo; 0 where all is reflected. */
static float cosine_outside(const SolidView *view, float c) {
    const float ior = view->glass->ior;
    return view->inside ? sqrt(max(1.0f - ior * ior * (1.0f - c * c), 0.0f)) : c;
}

/* Returns F of the interface where light meets a facet at the cosine c on the side of wo. */
static Rgb interface_at(const SolidView *view, float c) {
    const SolidGlass *glass = view->glass;
    const float outside = cosine_outside(view, c);
    if (view->inside && !(outside > 0.0f)) return rgb_grey(1.0f);
    return rgb_mix(glass->interface_f0, rgb_grey(glass->interface_f90), schlick_s(outside));
}

/* Returns the colour of what a facet reflects at the cosine c on the side of wo: from inside all that it reflects from
 * outside, but that of glass by its own F there. */
static Rgb reflects_at(const SolidView *view, float c) {
    const SolidGlass *glass = view->glass;
    const float s = schlick_s(c);
    const Rgb opaque = rgb_mix(glass->f0, glass->f90, s),
              outside = rgb_mix(glass->interface_f0, rgb_grey(glass->interface_f90), s),
              inside = rgb_scale(interface_at(view, c), view->scale),
              f = rgb_add(opaque, rgb_scale(rgb_add(inside, rgb_scale(outside, -1.0f)), glass->share));
    return rgb(max(f.r, 0.0f), max(f.g, 0.0f), max(f.b, 0.0f));
}

/* Returns the probability that a facet reflects a sample: 0 outside, where the stack has the reflection. */
static float reflects_p(const SolidView *view, float c) {
    if (!view->inside) return 0.0f;
    const float f = min(rgb_mean(interface_at(view, c)), 1.0f), through = (1.0f - f) * rgb_mean(view->glass->tint),
                reflected = rgb_mean(reflects_at(view, c));
    return reflected / max(reflected + through, 1e-12f);
}

/* Returns the part of samples for the glass: about the part of all light that it sends on. */
static float sampled_p(const SolidView *view) {
    const Stack *stack = view->stack;
    const bool others =
        HAS_DIFFUSE(stack) || HAS_SPECULAR(stack) || HAS_SHEEN(stack) || HAS_COAT(stack) || HAS_DUST(stack);
    const float facing = view->inside ? 0.0f : schlick_s(view->view->o.z);
    const Rgb f = rgb_mix(view->glass->interface_f0, rgb_grey(view->glass->interface_f90), facing);
    const float part = view->inside ? 1.0f : rgb_mean(rgb_mul(view->glass->tint, stack_one_minus(f)));
    return others ? clamp(part * view->view->scale.diffuse * rgb_mean(view->view->base_scale), 0.1f, 0.9f) : 1.0f;
}

/* Returns a number of the table, mixed linearly. */
static float table_scale(const SolidTable *table, bool inside, float alpha, float cosine) {
    const float y = sqrt(clamp(alpha, 0.0f, 1.0f)) * (float)(SOLID_ROWS - 1);
    const float x = sqrt(clamp(cosine, 0.0f, 1.0f)) * (float)(SOLID_COLUMNS - 1);
    const int row = y < (float)(SOLID_ROWS - 1) ? (int)y : SOLID_ROWS - 2;
    const int column = x < (float)(SOLID_COLUMNS - 1) ? (int)x : SOLID_COLUMNS - 2;
    const float *a = table->scale[inside][row] + column, *b = table->scale[inside][row + 1] + column;
    const float right = x - (float)column;
    return mix(mix(a[0], a[1], right), mix(b[0], b[1], right), y - (float)row);
}

SolidView solid_see(const SolidGlass *glass, const Stack *stack, const StackView *view, bool inside) {
    SolidView seen = {.glass = glass,
                      .stack = stack,
                      .view = view,
                      .inside = inside,
                      .n = inside ? 1.0f / glass->ior : glass->ior,
                      .facets = ggx_stretched(glass->ax, glass->ay),
                      .scale = table_scale(glass->table, inside, min(glass->ax, glass->ay), view->o.z)};
    ggx_view(&seen.facets, view->o, &seen.facets_view);
    seen.p = sampled_p(&seen);
    return seen;
}

/* Returns f cos and pdf of light that the surface reflects inside. */
static StackValue reflected(const SolidView *view, const Angles *a) {
    const LobeValue lobe = ggx_value(&view->facets, &view->facets_view, *a);
    const Rgb f = rgb_mul(reflects_at(view, a->d), stack_over_glass(view->stack, view->view, a));
    return (StackValue){rgb_scale(f, lobe.f * a->i.z), view->p * reflects_p(view, a->d) * lobe.pdf};
}

/* Returns f cos and pdf of light from i beyond the surface. a: of the mirror image of i. */
static StackValue refracted(const SolidView *view, Dir i, const Angles *a) {
    const float n = view->n, ax = view->glass->ax, ay = view->glass->ay;
    const Dir o = view->view->o;
    Dir h = dir_normal_or(dir(-o.x - n * i.x, -o.y - n * i.y, -o.z - n * i.z), dir(0.0f, 0.0f, 1.0f));
    if (h.z < 0.0f) h = dir_scale(h, -1.0f);
    const float c = dir_dot(o, h), beyond = dir_dot(i, h), sum = c + n * beyond;
    if (!(c > 0.0f && beyond < 0.0f && sum * sum > 0.0f)) return (StackValue){0};
    const float below = -i.z;
    const float g_o = 2.0f * o.z / (o.z + ggx_length(ax, ay, o));
    const float g_i = 2.0f * below / (below + ggx_length(ax, ay, dir(i.x, i.y, below)));
    const float pdf = g_o * ggx_d(ax, ay, h) * c / o.z * (n * n * -beyond / (sum * sum));
    const Rgb colour = rgb_mul(view->glass->tint, stack_one_minus(interface_at(view, c)));
    const Rgb f = rgb_mul(colour, stack_over_glass(view->stack, view->view, a));
    return (StackValue){rgb_scale(f, pdf * g_i * view->scale), view->p * (1.0f - reflects_p(view, c)) * pdf};
}

/* Returns the direction that a facet bends wo to; z is not below 0 if there is none. */
static Dir bent(const SolidView *view, Dir o, Dir h) {
    const float c = dir_dot(o, h), n = view->n, k = 1.0f - (1.0f - c * c) / (n * n);
    if (!(k > 0.0f)) return dir(1.0f, 0.0f, 0.0f);
    const float along = c / n - sqrt(k);
    return dir_normal_or(dir(along * h.x - o.x / n, along * h.y - o.y / n, along * h.z - o.z / n),
                         dir(1.0f, 0.0f, 0.0f));
}

/* Returns R and T of white glass from wo, by directions of facets that fill the square evenly: Martin Roberts, "The
 * Unreasonable Effectiveness of Quasirandom Sequences", 2018. */
static void parts_of(const SolidView *view, Dir o, double parts[2]) {
    enum { POINTS = 2048 };
    const float ax = view->glass->ax;
    parts[0] = parts[1] = 0.0;
    for (int k = 0; k < POINTS; k++) {
        const double u = fmod((k + 0.5) * 0.7548776662466927, 1.0), v = fmod((k + 0.5) * 0.5698402909980532, 1.0);
        const Dir h = ggx_sample_h(ax, ax, o, (float)u, (float)v), mirror = dir_mirror(o, h),
                  through = bent(view, o, h);
        const float f = min(rgb_mean(interface_at(view, dir_dot(o, h))), 1.0f), below = -through.z;
        if (mirror.z > 0.0f) {
            const LobeValue lobe = ggx_value(&view->facets, &view->facets_view, angles_between(o, mirror));
            if (lobe.pdf > 0.0f) parts[0] += (double)(f * lobe.f * mirror.z / lobe.pdf) / POINTS;
        }
        if (below > 0.0f)
            parts[1] += (double)((1.0f - f) * 2.0f * below / (below + ggx_length(ax, ax, through))) / POINTS;
    }
}

/* Returns the factor of one place of the table. */
static float scale_of(const SolidGlass *glass, bool inside, float roughness, float cosine) {
    const Dir o = dir(sqrt(1.0f - cosine * cosine), 0.0f, cosine);
    SolidGlass even = *glass;
    double parts[2];
    even.ax = even.ay = max(roughness * roughness, 0.001f);
    SolidView view = {.glass = &even,
                      .inside = inside,
                      .n = inside ? 1.0f / glass->ior : glass->ior,
                      .facets = ggx_stretched(even.ax, even.ay)};
    ggx_view(&view.facets, o, &view.facets_view);
    parts_of(&view, o, parts);
    const double scale = inside ? 1.0 / (parts[0] + parts[1]) : (1.0 - parts[0]) / parts[1];
    return (float)fmin(fmax(scale, 1.0), 8.0);
}

void solid_table_fill(const SolidGlass *glass, bool textured, SolidTable *table) {
    const float place = sqrt(clamp(min(glass->ax, glass->ay), 0.0f, 1.0f)) * (float)(SOLID_ROWS - 1);
    for (int side = 0; side < 2; side++)
        for (int row = 0; row < SOLID_ROWS; row++) {
            if (!textured && !(abs((float)row - place) < 1.5f)) continue;
            for (int column = 0; column < SOLID_COLUMNS; column++) {
                const float root = max((float)column / (float)(SOLID_COLUMNS - 1), 0.02f);
                table->scale[side][row][column] =
                    scale_of(glass, side == 1, (float)row / (float)(SOLID_ROWS - 1), root * root);
            }
        }
}

StackValue solid_glass(const SolidView *view, Dir i) {
    if (!(view->view->o.z > 0.0f) || !(abs(i.z) > 0.0f)) return (StackValue){0};
    const Angles a = angles_between(view->view->o, dir(i.x, i.y, abs(i.z)));
    if (i.z < 0.0f) return refracted(view, i, &a);
    return view->inside ? reflected(view, &a) : (StackValue){0};
}

void solid_sample(const SolidView *view, float u, float v, float third, Dir *i) {
    const Dir o = view->view->o;
    if (!stack_takes(view->p, &u)) {
        stack_sample(view->stack, view->view, u, v, i);
        if (!HAS_TRANSMITTED(view->stack)) i->z = max(i->z, 0.0f); /* what is below is no sample */
        return;
    }
    const Dir h = ggx_sample_h(view->glass->ax, view->glass->ay, o, u, v);
    const bool reflects = third < reflects_p(view, dir_dot(o, h));
    const Dir to = reflects ? dir_mirror(o, h) : bent(view, o, h);
    *i = reflects == (to.z > 0.0f) ? to : dir(1.0f, 0.0f, 0.0f);
}

Rgb solid_absorption(const Surface *surface) {
    if (!(surface->attenuation_distance > 0.0f)) return rgb_grey(0.0f);
    const Rgb c = surface->attenuation_color;
    const float per = -1.0f / max(surface->attenuation_distance, 1e-6f);
    return rgb(logf(max(c.r, 1e-6f)) * per, logf(max(c.g, 1e-6f)) * per, logf(max(c.b, 1e-6f)) * per);
}

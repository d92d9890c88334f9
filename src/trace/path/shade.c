/* shade.c - light samples and materials at the vertices of a chunk, and the rays that go on */
#include "trace/path/slot_light.h"

#include "base/random.h"
#include "shading/dialect/loop.h"
#include "shading/stack/frame.h"
#include "trace/geometry/sampler.h"

/* Draws the points of one pair of dimensions (sampler.h). */
LOOP(draw_numbers, (const Chunk *chunk, uint32_t pair, int n, float *restrict u, float *restrict v),
     (chunk, pair, n, u, v)) {
    const uint32_t *pixel = chunk->pixel, *sample = chunk->sample;
    EACH(k, (size_t)n) {
        Point p = sampler_point(pixel[k], sample[k], pair);
        u[k] = p.u;
        v[k] = p.v;
    }
}

/* Rotates n directions w from world space into the shading frame. */
LOOP(to_frame_n, (const Chunk *chunk, Row w[3], int n, Row *restrict local), (chunk, w, n, local)) {
    for (int axis = 0; axis < 3; axis++) {
        const Row *along = chunk->frame[axis];
        float *to = local[axis];
        EACH(k, (size_t)n) { to[k] = w[0][k] * along[0][k] + w[1][k] * along[1][k] + w[2][k] * along[2][k]; }
    }
}

/* Gives the normals below which no light counts; 0 if it counts from both sides. */
static void put_horizon_normals(const Chunk *chunk, const PathMaterial *material, const float *horizon[3]) {
    static const Row none;
    for (int a = 0; a < 3; a++) horizon[a] = material->transmits ? none : chunk->horizon_normal[a];
}

/* Samples each group of lights, and draws the numbers that sample the material. */
static void sample_lights(Chunk *chunk, const ChunkSource *source, int n) {
    const Lights *lights = source->context->lights;
    KindVertices *vertices = &chunk->vertices;
    uint32_t pair = SAMPLER_VERTEX + SAMPLER_PER_VERTEX * (uint32_t)source->depth;
    const float *const point[3] = {chunk->lifted[0], chunk->lifted[1], chunk->lifted[2]};
    const float *normal[3];
    put_horizon_normals(chunk, &source->context->materials[source->material], normal);
    for (int g = 0; g < LIGHT_GROUPS; g++) {
        if (!lights_has_group(lights, (LightGroup)g)) continue;
        draw_numbers(chunk, pair + (uint32_t)g, n, vertices->u, vertices->v);
        stage_end(chunk->clock, STAGE_NUMBERS);
        lights_sample_rows(lights, (LightGroup)g, n, point, normal, vertices->u, vertices->v, &chunk->light_samples[g]);
        to_frame_n(chunk, chunk->light_samples[g].wi, n, vertices->i[g]);
        stage_end(chunk->clock, (TraceStage)(STAGE_SKY + g)); /* in the order of LightGroup */
    }
    draw_numbers(chunk, pair + LIGHT_GROUPS, n, vertices->u, vertices->v);
    stage_end(chunk->clock, STAGE_NUMBERS);
}

static void put_value(Chunk *chunk, int direction, int k, const Rgb *f_cos, float pdf) {
    KindVertices *vertices = &chunk->vertices;
    vertices->f[direction][0][k] = f_cos->r;
    vertices->f[direction][1][k] = f_cos->g;
    vertices->f[direction][2][k] = f_cos->b;
    vertices->pdf[direction][k] = pdf;
}

/* Returns f cos for light of the environment, from the f_cos that stack_eval returned with that seed: `ambient` times
 * what the diffuse lobe and dust reflect first, plus `reflection` times what the other lobes and thin glass do. */
static Rgb f_cos_of_sky(const PathContext *context, const Stack *stack, const StackView *view, Dir wi, uint32_t seed,
                        Rgb f_cos) {
    const Environment *sky = &context->scene->environment;
    Slots others = slots_of(false, true, true, true, false);
    Rgb rest = rgb_add(stack_eval_of(stack, view, others, wi).f_cos, layer_walk_bounces(stack, view, others, wi, seed));
    rest = rgb_add(rest, stack_clear_f_cos(stack, view, wi));
    Rgb f = rgb_add(rgb_scale(f_cos, sky->ambient), rgb_scale(rest, sky->reflection - sky->ambient));
    return rgb(max(f.r, 0.0f), max(f.g, 0.0f), max(f.b, 0.0f));
}

/* Returns the stack at a vertex: the material's, or one of its own in chunk->stack. Of solid glass, chunk->glass becomes
 * what was taken from it. */
static const Stack *stack_at(Chunk *chunk, const PathMaterial *material, int k) {
    Surface surface = surface_of_row(&chunk->vertices.surface, (size_t)k);
    if (!material->textured && !dust_settles(surface)) {
        if (material->solid) chunk->glass = material->glass;
        return &material->stack;
    }
    Dir normal = dir(chunk->frame[2][0][k], chunk->frame[2][1][k], chunk->frame[2][2][k]);
    Dir position = dir(chunk->position[0][k], chunk->position[1][k], chunk->position[2][k]);
    surface = dust_accumulate(frame_surface(surface), normal, position);
    stack_make(&chunk->stack, &surface, &material->choices, material->sheen_e);
    if (material->solid) chunk->glass = solid_take(&chunk->stack, &surface, &material->table);
    if (material->cloth) {
        const YarnRows *yarn = &chunk->vertices.yarn;
        const Lobe lobe = yarn_of_row(yarn, (size_t)k);
        stack_put_base(&chunk->stack, &lobe, ROW_RGB(yarn->single, k), ROW_RGB(yarn->multiple, k));
    }
    return &chunk->stack;
}

/* The stack or the solid at a vertex, which reflects and transmits. */
typedef struct Shaded {
    const Stack *stack;
    const StackView *view;
    const Measured *measured; /* in place of the stack; NULL: the stack */
    const SolidView *solid;   /* glass beside the stack; NULL: none */
} Shaded;

/* Evaluates f cos and pdf of the stack and the glass, or of a measurement in their place. Half of its samples are the
 * stack's. */
static void vertex_eval(const Shaded *at, const Dir *wi, uint32_t seed, StackValue *value) {
    float f[3];
    stack_eval(at->stack, at->view, wi, seed, value);
    if (at->solid) {
        const StackValue glass = solid_glass(at->solid, *wi);
        value->f_cos = rgb_add(value->f_cos, glass.f_cos);
        value->pdf = value->pdf * (1.0f - at->solid->p) + glass.pdf;
    }
    if (!at->measured) return;
    measured_at(at->measured, at->view->o, *wi, f);
    value->f_cos = rgb_scale(rgb(f[0], f[1], f[2]), max(wi->z, 0.0f));
    value->pdf = wi->z > 0.0f ? 0.5f * (value->pdf + measured_pdf(at->measured, at->view->o, *wi)) : 0.0f;
}

/* Samples wi by the stack and the glass, or for a measurement by it or the stack with equal probability. */
static void vertex_sample(const Shaded *at, float u, float v, uint32_t seed, Dir *wi) {
    const Measured *measured = at->measured;
    if (measured && u < 0.5f)
        *wi = measured_sample(measured, at->view->o, 2.0f * u, v);
    else if (at->solid)
        solid_sample(at->solid, u, v, unit_float(hash32(seed + 0x9e3779b9u)), wi);
    else
        stack_sample(at->stack, at->view, measured ? 2.0f * u - 1.0f : u, v, wi);
}

/* Returns f cos for light of the environment. A measurement as a whole and solid glass count as reflection. */
static Rgb vertex_sky(const PathContext *context, const Shaded *at, Dir wi, uint32_t seed, Rgb f_cos) {
    const float reflection = context->scene->environment.reflection;
    const Rgb glass = at->solid ? solid_glass(at->solid, wi).f_cos : rgb_grey(0.0f);
    if (at->measured) return rgb_scale(f_cos, reflection);
    const Rgb rest = f_cos_of_sky(context, at->stack, at->view, wi, seed, rgb_add(f_cos, rgb_scale(glass, -1.0f)));
    return rgb_add(rest, rgb_scale(glass, reflection));
}

/* Shades one vertex, whatever its stack is: fills f cos and pdf of all directions, and samples wi. */
static void shade_vertex(Chunk *chunk, const ChunkSource *source, const PathMaterial *material, int k) {
    const PathContext *context = source->context;
    KindVertices *vertices = &chunk->vertices;
    const bool inside = material->solid && chunk->side[k] < 0.0f;
    const bool stays = material->pane && context->panes && source->depth > 0; /* what passes does so before (panes.c) */
    const Stack *stack = stack_at(chunk, material, k);
    uint32_t seed = hash32(chunk->key[k]);
    Dir o = dir(vertices->o[0][k], vertices->o[1][k], vertices->o[2][k]), wi;
    StackValue value;
    SolidView solid = {0};
    if (inside || stays) {
        if (stack != &chunk->stack) chunk->stack = *stack;
        if (inside) solid_hide_highlight(&chunk->stack);
        if (stays) solid_drop(&chunk->stack);
        stack = &chunk->stack;
    }
    stack_see(stack, &o, &chunk->view);
    if (material->solid) solid = solid_see(&chunk->glass, stack, &chunk->view, inside);
    const Shaded at = {stack, &chunk->view, material->measured, material->solid ? &solid : NULL};
    for (int g = 0; g < LIGHT_GROUPS; g++) {
        if (!lights_has_group(context->lights, (LightGroup)g)) continue;
        wi = dir(vertices->i[g][0][k], vertices->i[g][1][k], vertices->i[g][2][k]);
        vertex_eval(&at, &wi, seed, &value);
        if (g == LIGHTS_SKY && context->sky_in_parts) value.f_cos = vertex_sky(context, &at, wi, seed, value.f_cos);
        put_value(chunk, g, k, &value.f_cos, value.pdf);
    }
    seed = hash32(chunk->key[k] ^ 0x68e31da4u);
    vertex_sample(&at, vertices->u[k], vertices->v[k], seed, &wi);
    vertex_eval(&at, &wi, seed, &value);
    vertices->i[KIND_DRAWN][0][k] = wi.x, vertices->i[KIND_DRAWN][1][k] = wi.y, vertices->i[KIND_DRAWN][2][k] = wi.z;
    put_value(chunk, KIND_DRAWN, k, &value.f_cos, value.pdf);
    if (!context->sky_in_parts) return;
    Rgb f = vertex_sky(context, &at, wi, seed, value.f_cos);
    chunk->f_cos_sky[0][k] = f.r, chunk->f_cos_sky[1][k] = f.g, chunk->f_cos_sky[2][k] = f.b;
}

/* Divides one among the slots of a stack, as they reflect light from a direction. What comes through is diffuse. */
static void put_shares(const Stack *stack, const StackView *view, Dir wi, float share[LIT_SLOTS][3][ROW_CAPACITY],
                       size_t k) {
    Rgb f[LIT_SLOTS], sum = rgb_grey(0.0f);
    for (int slot = 0; slot < LIT_SLOTS; slot++) {
        const Slots only =
            slots_of(slot == LIT_DIFFUSE, slot == LIT_SPECULAR, slot == LIT_SHEEN, slot == LIT_COAT, slot == LIT_DUST);
        f[slot] =
            wi.z > 0.0f ? stack_eval_of(stack, view, only, wi).f_cos : rgb_grey(slot == LIT_DIFFUSE ? 1.0f : 0.0f);
        f[slot] = rgb(max(f[slot].r, 0.0f), max(f[slot].g, 0.0f), max(f[slot].b, 0.0f));
        sum = rgb_add(sum, f[slot]);
    }
    for (int slot = 0; slot < LIT_SLOTS; slot++) {
        share[slot][0][k] = sum.r > 0.0f ? f[slot].r / sum.r : 0.0f;
        share[slot][1][k] = sum.g > 0.0f ? f[slot].g / sum.g : 0.0f;
        share[slot][2][k] = sum.b > 0.0f ? f[slot].b / sum.b : 0.0f;
    }
}

/* Divides the light of all directions of vertex k among the slots. A measurement is specular. */
static void share_vertex(Chunk *chunk, const ChunkSource *source, const PathMaterial *material, size_t k) {
    LightBySlot *light = chunk->slots;
    const Stack *stack = stack_at(chunk, material, (int)k);
    const Dir o = ROW_DIR(chunk->vertices.o, k);
    stack_see(stack, &o, &chunk->view);
    for (int d = 0; d < KIND_DIRECTIONS; d++) {
        if (d < LIGHT_GROUPS && !lights_has_group(source->context->lights, (LightGroup)d)) continue;
        put_shares(stack, &chunk->view, ROW_DIR(chunk->vertices.i[d], k), light->share[d], k);
        for (int slot = 0; material->measured && slot < LIT_SLOTS; slot++)
            for (int c = 0; c < 3; c++) light->share[d][slot][c][k] = slot == LIT_SPECULAR ? 1.0f : 0.0f;
    }
    for (int slot = 0; slot < LIT_SLOTS; slot++)
        for (int c = 0; c < 3; c++) light->onward[slot][c][chunk->id[k]] = light->share[KIND_DRAWN][slot][c][k];
}

void chunk_shade(Chunk *chunk, const ChunkSource *source) {
    const PathContext *context = source->context;
    const PathMaterial *material = &context->materials[source->material];
    int n = row_whole(source->n);
    sample_lights(chunk, source, n);
    if (material->kind && !context->sky_in_parts) {
        bool sampled[LIGHT_GROUPS];
        for (int g = 0; g < LIGHT_GROUPS; g++) sampled[g] = lights_has_group(context->lights, (LightGroup)g);
        kind_shade(material->kind, &chunk->vertices, material->sheen_e, sampled, n);
        stage_end(chunk->clock, STAGE_SHADE);
    } else {
        for (int k = 0; k < source->n; k++) shade_vertex(chunk, source, material, k);
        stage_end(chunk->clock, STAGE_SHADE_EACH);
    }
    for (int k = 0; chunk->slots && source->depth == 0 && k < source->n; k++)
        share_vertex(chunk, source, material, (size_t)k);
}

/* Weighs each path along the direction that was drawn, and decides if it continues. place: of the random number for
 * Russian roulette. */
LOOP(weigh_paths_n, (Chunk *restrict chunk, bool roulette, uint32_t place, int n), (chunk, roulette, place, n)) {
    KindVertices *vertices = &chunk->vertices;
    float(*wi)[ROW_CAPACITY] = vertices->i[KIND_DRAWN], (*f_cos)[ROW_CAPACITY] = vertices->f[KIND_DRAWN],
    *pdf = vertices->pdf[KIND_DRAWN];
    Row *horizon = chunk->horizon_normal;
    float survival_min = roulette ? 0.0f : 1.0f;
    EACH(k, (size_t)n) {
        float x = wi[0][k], y = wi[1][k], z = wi[2][k], p = pdf[k];
        float wx = x * chunk->frame[0][0][k] + y * chunk->frame[1][0][k] + z * chunk->frame[2][0][k];
        float wy = x * chunk->frame[0][1][k] + y * chunk->frame[1][1][k] + z * chunk->frame[2][1][k];
        float wz = x * chunk->frame[0][2][k] + y * chunk->frame[1][2][k] + z * chunk->frame[2][2][k];
        float up = wx * horizon[0][k] + wy * horizon[1][k] + wz * horizon[2][k];
        float weight = 1.0f / (p > 0.0f ? p : 1.0f);
        float r = chunk->throughput[0][k] * f_cos[0][k] * weight, g = chunk->throughput[1][k] * f_cos[1][k] * weight,
              b = chunk->throughput[2][k] * f_cos[2][k] * weight, strongest = max(r, max(g, b));
        /* the square root ends paths later than in proportion to their light, as the eye sees it */
        float survival = max(min(sqrt(max(strongest, 0.0f)), 1.0f), survival_min);
        float chance = sampler_random(chunk->pixel[k], chunk->sample[k], place);
        bool live = (z * up > 0.0f) & (p > 0.0f) & (strongest > 0.0f) & (chance < survival);
        float compensation = 1.0f / max(survival, 1e-20f);
        chunk->continues[k] = live ? 1.0f : 0.0f;
        chunk->next_throughput[0][k] = r * compensation;
        chunk->next_throughput[1][k] = g * compensation;
        chunk->next_throughput[2][k] = b * compensation;
        chunk->sample_weight[k] = weight * compensation;
        chunk->next_direction[0][k] = wx;
        chunk->next_direction[1][k] = wy;
        chunk->next_direction[2][k] = wz;
    }
}

/* Selects the vertices of which the path continues; returns how many they are. */
static int select_continuing(Chunk *chunk, int n) {
    int count = 0;
    for (int k = 0; k < n; k++) {
        chunk->selected[count] = k;
        count += chunk->continues[k] > 0.0f;
    }
    return count;
}

/* Writes n selected rays to the paths from index `at` on. */
FN void append_each(const Chunk *chunk, bool transmits, int at, int n, Paths *restrict to) {
    const int *selected = chunk->selected;
    const float *z = chunk->vertices.i[KIND_DRAWN][2];
    for (int a = 0; a < 3; a++) {
        float *o = to->origin[a] + at, *d = to->direction[a] + at, *throughput = to->throughput[a] + at;
        const float *origin = chunk->origin[a], *behind = chunk->origin_behind[a];
        const float *direction = chunk->next_direction[a], *next_throughput = chunk->next_throughput[a];
        EACH(k, (size_t)n) {
            float start = origin[selected[k]];
            if (transmits) {
                float far = behind[selected[k]];
                start = z[selected[k]] < 0.0f ? far : start;
            }
            o[k] = start;
            d[k] = direction[selected[k]];
            throughput[k] = next_throughput[selected[k]];
        }
    }
    uint32_t *id = to->id + at, *key = to->key + at;
    float *pdf = to->pdf + at;
    EACH(k, (size_t)n) {
        int j = selected[k];
        id[k] = chunk->id[j];
        key[k] = hash32(chunk->key[j] + 0x9e3779b9u);
        pdf[k] = chunk->vertices.pdf[KIND_DRAWN][j];
    }
}

LOOP(append, (const Chunk *chunk, bool transmits, int at, int n, Paths *restrict to), (chunk, transmits, at, n, to)) {
    if (transmits)
        append_each(chunk, true, at, n, to);
    else
        append_each(chunk, false, at, n, to);
}

/* Writes the horizon normals, from which light_pdf of lit.c finds the density of a light that is hit. */
static void append_normals(const Chunk *chunk, const PathMaterial *material, int at, int n, Paths *to) {
    const float *horizon[3];
    put_horizon_normals(chunk, material, horizon);
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < n; k++) to->horizon_normal[a][at + k] = horizon[a][chunk->selected[k]];
}

/* Writes in which solids the rays are. */
static void append_inside(const Chunk *chunk, const ChunkSource *source, int at, int n, Paths *to) {
    for (int k = 0; k < n; k++) {
        const int j = chunk->selected[k];
        to->inside[at + k] = chunk_inside(chunk, source, j, chunk->vertices.i[KIND_DRAWN][2][j] < 0.0f);
    }
}

/* Writes the throughputs for light of the environment. */
static void append_sky(const Chunk *chunk, int at, int n, Paths *to) {
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < n; k++) {
            int j = chunk->selected[k];
            to->sky_throughput[a][at + k] = chunk->throughput[a][j] * chunk->f_cos_sky[a][j] * chunk->sample_weight[j];
        }
}

int chunk_continue(Chunk *chunk, const ChunkSource *source, Paths *paths, int count) {
    const PathContext *context = source->context;
    const PathMaterial *material = &context->materials[source->material];
    weigh_paths_n(chunk, context->roulette && source->depth >= 1, (uint32_t)source->depth, row_whole(source->n));
    int added = select_continuing(chunk, source->n);
    append(chunk, material->transmits, count, added, paths);
    if (context->sky_in_parts) append_sky(chunk, count, added, paths);
    if (context->solids) append_inside(chunk, source, count, added, paths);
    if (lights_has_group(context->lights, LIGHTS_EMITTERS)) append_normals(chunk, material, count, added, paths);
    return count + added;
}

#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "raster/light/ray_albedos.h"

#include "base/memory.h"
#include "raster/light/triangle_points.h"
#include "scene/record/material_at.h"
#include "shading/dialect/points.h"
#include "shading/dialect/warp.h"
#include "shading/material/dust.h"
#include "shading/stack/frame.h"
#include "weave/cloth_base.h"

enum {
    SAMPLES = 512,  /* of a material */
    STEPS_MOST = 6, /* a triangle's mean takes steps^2 points, */
    PER_STEP = 4    /* so many texels apart if they suffice */
};
enum { PAIR_PLACE, PAIR_NORMAL, PAIR_SYSTEM, PAIR_EYE, PAIR_LIGHT };
static const float white[4] = {1.0f, 1.0f, 1.0f, 1.0f};

static Dir direction_of(Point at) {
    const float z = 1.0f - 2.0f * at.u, r = sqrt(max(1.0f - z * z, 0.0f));
    return dir(r * cos(2.0f * PI * at.v), r * sin(2.0f * PI * at.v), z);
}

/* Puts one system of a cloth in the place of the base, as bright as both: half of the samples have each. */
static void put_cloth(const WeftCloth *cloth, bool weft, Stack *stack) {
    const WeaveBase base = cloth_base_far(cloth, weft);
    stack_put_base(stack, &base.lobe, rgb_scale(base.single, 2.0f), rgb_scale(base.multiple, 2.0f));
}

/* Returns the part that one sample of light comes back with, from a random direction to a random one. */
static Rgb sample(const WeftScene *scene, const Material *material, TableRef e, float base_color, uint index) {
    const Point place = sampler_point(0, index, PAIR_PLACE), eye = sampler_point(0, index, PAIR_EYE),
                light = sampler_point(0, index, PAIR_LIGHT);
    const Choices choices = material_choices(material);
    const WeftCloth *cloth = scene_cloth_of(scene, material);
    float uv[2][2] = {{place.u, place.v}, {place.u, place.v}};
    Surface s = material_plain(material);
    Stack stack;
    StackView view;
    StackValue value;
    Dir o = warp_cosine(eye.u, eye.v), i;
    material_textures(scene, material, uv, white, &s);
    s.base_color = rgb_grey(base_color);
    s = dust_accumulate(frame_surface(s), direction_of(sampler_point(0, index, PAIR_NORMAL)), dir(0.0f, 0.0f, 0.0f));
    stack_make(&stack, &s, &choices, e);
    if (cloth) put_cloth(cloth, sampler_point(0, index, PAIR_SYSTEM).u < 0.5f, &stack);
    stack_see(&stack, &o, &view);
    stack_sample(&stack, &view, light.u, light.v, &i);
    if (!(i.z > 0.0f)) return rgb_grey(0.0f);
    stack_eval(&stack, &view, &i, index, &value);
    return value.pdf > 0.0f ? rgb_scale(value.f_cos, 1.0f / value.pdf) : rgb_grey(0.0f);
}

static Rgb reflected(const WeftScene *scene, const Material *material, TableRef e, float base_color) {
    Rgb sum = rgb_grey(0.0f);
    for (uint k = 0; k < SAMPLES; k++) sum = rgb_add(sum, sample(scene, material, e, base_color, sampler_index(k)));
    sum = rgb_scale(sum, 1.0f / SAMPLES);
    return rgb(clamp(sum.r, 0.0f, 1.0f), clamp(sum.g, 0.0f, 1.0f), clamp(sum.b, 0.0f, 1.0f));
}

static RayAlbedo albedo_of(const WeftScene *scene, const Material *material, TableRef e) {
    if (material->unlit) return (RayAlbedo){{0.0f}, {0.0f}};
    const Rgb black = reflected(scene, material, e, 0.0f), all = reflected(scene, material, e, 1.0f);
    return (RayAlbedo){{black.r, black.g, black.b}, {all.r - black.r, all.g - black.g, all.b - black.b}};
}

RayAlbedo *ray_albedos_make(const WeftScene *scene, const SheenTables *sheens) {
    const size_t count = (size_t)scene_shaded_materials(scene);
    RayAlbedo *albedos = alloc_array(count, sizeof(RayAlbedo));
    bool *shown = alloc_array(count, sizeof(bool));
    for (int m = 0; shown && m < scene->mesh_count; m++) {
        const int front = scene->meshes[m].material, back = scene_back(scene, front);
        shown[front] = true;
        if (back >= 0) shown[back] = true;
    }
    for (size_t k = 0; albedos && shown && k < count; k++)
        if (shown[k]) albedos[k] = albedo_of(scene, &scene->materials[k], sheen_tables_of(sheens, (int)k));
    const bool made = shown != NULL;
    free(shown);
    if (made) return albedos;
    free(albedos);
    return NULL;
}

/* Places of a triangle's corners in a map. */
typedef struct TriangleCorners {
    float u[3], v[3];
} TriangleCorners;

static TriangleCorners corners_of(const Mesh *mesh, const uint32_t *index, const Input *input) {
    const float *uv = mesh->texcoord[input->texcoord], *m = input->transform;
    TriangleCorners corners;
    for (int k = 0; k < 3; k++) {
        const float u = uv ? uv[2 * (size_t)index[k]] : 0.0f, v = uv ? uv[2 * (size_t)index[k] + 1] : 0.0f;
        corners.u[k] = m[0] * u + m[1] * v + m[2];
        corners.v[k] = m[3] * u + m[4] * v + m[5];
    }
    return corners;
}

/* Returns by how many steps a triangle is divided, for the texels that it spans. */
static int steps_of(const TriangleCorners *at, const WeftImage *image) {
    const float wide = fmaxf(at->u[0], fmaxf(at->u[1], at->u[2])) - fminf(at->u[0], fminf(at->u[1], at->u[2])),
                high = fmaxf(at->v[0], fmaxf(at->v[1], at->v[2])) - fminf(at->v[0], fminf(at->v[1], at->v[2]));
    const float texels = fmaxf(wide * (float)image->width, high * (float)image->height);
    return texels < (float)(STEPS_MOST * PER_STEP) ? 1 + (int)(texels / (float)PER_STEP) : STEPS_MOST;
}

/* Sets the mean of a map over a triangle. */
static void map_mean(const WeftScene *scene, const Mesh *mesh, const uint32_t *index, const Input *input,
                     float mean[3]) {
    const Texture *texture = &scene->textures[input->texture - 1];
    const TriangleCorners at = corners_of(mesh, index, input);
    const int steps = steps_of(&at, &scene->images[texture->image]), count = steps * steps;
    mean[0] = mean[1] = mean[2] = 0.0f;
    for (int k = 0; k < count; k++) {
        float w[3];
        triangle_point(k, steps, w);
        const Texel t =
            texture_fetch(texture, scene->images, &scene->srgb, w[0] * at.u[0] + w[1] * at.u[1] + w[2] * at.u[2],
                          w[0] * at.v[0] + w[1] * at.v[1] + w[2] * at.v[2]);
        for (int c = 0; c < 3; c++) mean[c] += t.c[c] / (float)count;
    }
}

/* Adds what one side of a triangle sends back, times `unit`, to packed. */
static void pack(const RayAlbedo *albedo, const WeftScene *scene, const Mesh *mesh, const uint32_t *index,
                 const Material *material, float unit, float packed[3]) {
    const Input *input = &material->inputs[INPUT_base_color];
    float map[3] = {1.0f, 1.0f, 1.0f};
    if (input->texture) map_mean(scene, mesh, index, input, map);
    for (int c = 0; c < 3; c++) {
        float base = input->value[c] * map[c], color = 0.0f;
        for (int k = 0; mesh->color && k < 3; k++) color += mesh->color[4 * (size_t)index[k] + (size_t)c] / 3.0f;
        if (mesh->color) base *= color;
        const float albedo_here = albedo->black[c] + albedo->more[c] * base;
        packed[c] += unit * floorf(fminf(fmaxf(albedo_here, 0.0f), 1.0f) * 4095.0f + 0.5f);
    }
}

void ray_albedos_triangle(const RayAlbedo *albedos, const WeftScene *scene, const Mesh *mesh, uint32_t triangle,
                          float packed[3]) {
    const uint32_t *index = mesh->index + 3 * (size_t)triangle;
    const int front = mesh->material, other = scene_back(scene, front), back = other >= 0 ? other : front;
    packed[0] = packed[1] = packed[2] = 0.0f;
    pack(&albedos[front], scene, mesh, index, &scene->materials[front], 1.0f, packed);
    pack(&albedos[back], scene, mesh, index, &scene->materials[back], 4096.0f, packed);
}

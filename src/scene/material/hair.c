#include "scene/material/hair.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/equal.h"
#include "base/fail.h"
#include "base/pi.h"
#include "base/random.h"
#include "scene/record/material_at.h"
#include "weave/cloth_base.h"

/* Hair that is growing on a mesh. */
typedef struct Growth {
    const WeftScene *scene;
    const Mesh *on;
    const Material *material;
    Mesh *mesh;       /* has room for all fibres */
    uint32_t *roots;  /* as in Hair, with as much room */
    uint64_t numbers; /* the stream of random numbers */
} Growth;

/* A point of the cloth from which a fibre grows. */
typedef struct Root {
    Vec3 point, normal;
    float uv[2][2], color[4];
} Root;

static float draw(Growth *growth) { return (float)unit_double(stream_next(&growth->numbers)); }

/* Returns a random direction. */
static Vec3 draw_direction(Growth *growth) {
    const float z = 2.0f * draw(growth) - 1.0f, azimuth = 2.0f * PI_FLOAT * draw(growth), r = sqrtf(1.0f - z * z);
    return vec3(r * cosf(azimuth), r * sinf(azimuth), z);
}

static Vec3 corner_of(const Mesh *mesh, const uint32_t *index, int corner) {
    return vec3_load(mesh->position + 3 * (size_t)index[corner]);
}

/* Returns the cross product of two edges of a triangle: its normal times twice its area. */
static Vec3 spanned(const Mesh *mesh, const uint32_t *index) {
    const Vec3 a = corner_of(mesh, index, 0);
    return vec3_cross(vec3_sub(corner_of(mesh, index, 1), a), vec3_sub(corner_of(mesh, index, 2), a));
}

/* Returns how many fibres are to stand on a triangle, on the mean. */
static double expected(const Mesh *mesh, const Material *material, uint32_t triangle) {
    const Vec3 n = spanned(mesh, mesh->index + 3 * (size_t)triangle);
    const double area = 0.5 * (sqrt)((double)n.x * (double)n.x + (double)n.y * (double)n.y + (double)n.z * (double)n.z);
    return isfinite(area) ? area * (double)material->hair[WEFT_HAIR_DENSITY] : (double)INFINITY;
}

/* Returns how many fibres are to stand on a mesh, on the mean; 0 where its material has no hair. */
static double expected_on(const WeftScene *scene, int m) {
    const Mesh *mesh = &scene->meshes[m];
    const Material *material = &scene->materials[mesh->material];
    double sum = 0.0;
    if (!(material->hair[WEFT_HAIR_LENGTH] > 0.0f && material->hair[WEFT_HAIR_THICKNESS] > 0.0f)) return 0.0;
    for (uint32_t k = 0; k < mesh->triangle_count; k++) sum += expected(mesh, material, k);
    return sum;
}

/* Returns a random point of a triangle. */
static Root draw_root(Growth *growth, const uint32_t *index) {
    const Mesh *on = growth->on;
    const float along = sqrtf(draw(growth)), b = along * draw(growth), weight[3] = {1.0f - along, along - b, b};
    Root root = {.color = {0.0f}};
    Vec3 normal = {0.0f, 0.0f, 0.0f};
    for (int k = 0; k < 3; k++) {
        const size_t vertex = index[k];
        root.point = vec3_madd(root.point, corner_of(on, index, k), weight[k]);
        if (on->normal) normal = vec3_madd(normal, vec3_load(on->normal + 3 * vertex), weight[k]);
        for (size_t set = 0; set < 2; set++)
            for (size_t c = 0; on->texcoord[set] && c < 2; c++)
                root.uv[set][c] += weight[k] * on->texcoord[set][2 * vertex + c];
        for (size_t c = 0; c < 4; c++) root.color[c] += weight[k] * (on->color ? on->color[4 * vertex + c] : 1.0f);
    }
    root.normal = vec3_normal_or(normal, vec3_normal_or(spanned(on, index), vec3(0.0f, 1.0f, 0.0f)));
    return root;
}

/* Writes a vertex of a fibre, and returns its number. */
static uint32_t put_vertex(const Growth *growth, Vec3 point, Vec3 normal, const Root *root) {
    Mesh *mesh = growth->mesh;
    const size_t k = mesh->vertex_count;
    memcpy(mesh->position + 3 * k, &point, sizeof point);
    memcpy(mesh->normal + 3 * k, &normal, sizeof normal);
    for (size_t set = 0; set < 2; set++)
        if (mesh->texcoord[set]) memcpy(mesh->texcoord[set] + 2 * k, root->uv[set], sizeof root->uv[set]);
    if (mesh->color) memcpy(mesh->color + 4 * k, root->color, sizeof root->color);
    return mesh->vertex_count++;
}

static void put_triangle(const Growth *growth, uint32_t a, uint32_t b, uint32_t c) {
    uint32_t *index = growth->mesh->index + 3 * (size_t)growth->mesh->triangle_count++;
    index[0] = a, index[1] = b, index[2] = c;
}

/* Returns `a` without its part along a unit vector, as a unit vector. */
static Vec3 across_of(Vec3 a, Vec3 along) {
    return vec3_normal_or(vec3_madd(a, along, -vec3_dot(a, along)), vec3(0.0f, 0.0f, 0.0f));
}

float hair_lets_through(const Material *material) {
    const float *numbers = material->hair;
    return expf(-0.9f * 0.5625f * numbers[WEFT_HAIR_DENSITY] * numbers[WEFT_HAIR_LENGTH] *
                numbers[WEFT_HAIR_THICKNESS]);
}

Vec3 hair_across(const Mesh *hair, uint32_t vertex) {
    const uint32_t of_fibre = vertex % HAIR_VERTICES, beside = vertex - of_fibre + (of_fibre ^ 1u);
    if (of_fibre == HAIR_VERTICES - 1) return vec3(0.0f, 0.0f, 0.0f);
    const Vec3 here = vec3_load(hair->position + 3 * (size_t)vertex);
    return vec3_scale(vec3_sub(here, vec3_load(hair->position + 3 * (size_t)beside)), 0.5f);
}

/* Grows a fibre at a root. */
static void grow_fibre(Growth *growth, const Root *root) {
    const float *numbers = growth->material->hair, rise = 0.2f + 0.8f * draw(growth);
    const float piece = 0.25f * numbers[WEFT_HAIR_LENGTH] * (1.0f + draw(growth));
    const Vec3 lean = across_of(draw_direction(growth), root->normal);
    const Vec3 up = vec3_madd(vec3_scale(root->normal, rise), lean, sqrtf(1.0f - rise * rise));
    const Vec3 on = vec3_normal_or(vec3_madd(up, draw_direction(growth), 0.7f), up);
    const Vec3 across = across_of(draw_direction(growth), up),
               half = vec3_scale(across, 0.5f * numbers[WEFT_HAIR_THICKNESS]);
    const Vec3 joint = vec3_madd(root->point, up, piece), tip = vec3_madd(joint, on, piece);
    const Vec3 low = vec3_cross(across, up), high = across_of(vec3_cross(across, on), on);
    const Vec3 middle = vec3_normal_or(vec3_add(low, high), low);
    const uint32_t a = put_vertex(growth, vec3_sub(root->point, half), low, root),
                   b = put_vertex(growth, vec3_add(root->point, half), low, root),
                   c = put_vertex(growth, vec3_sub(joint, half), middle, root),
                   d = put_vertex(growth, vec3_add(joint, half), middle, root),
                   e = put_vertex(growth, tip, vec3_normal_or(high, low), root);
    put_triangle(growth, a, b, d);
    put_triangle(growth, a, d, c);
    put_triangle(growth, c, d, e);
}

/* Gives a root the colour that its fibre has beside that of the material. */
static void color_root(const Growth *growth, Root *root) {
    const int cloth = growth->material->cloth;
    const Rgb fibre = cloth ? cloth_fibre_albedo(growth->scene->cloths[cloth - 1], root->uv[0]) : rgb_grey(1.0f);
    root->color[0] *= fibre.r, root->color[1] *= fibre.g, root->color[2] *= fibre.b, root->color[3] = 1.0f;
}

/* Grows the fibres of a triangle: their number on the mean, rounded at random to a whole one. */
static void grow_triangle(Growth *growth, uint32_t triangle) {
    const uint32_t count = (uint32_t)(expected(growth->on, growth->material, triangle) + (double)draw(growth));
    for (uint32_t k = 0; k < count; k++) {
        Root root = draw_root(growth, growth->on->index + 3 * (size_t)triangle);
        if (draw(growth) >= material_opacity(growth->scene, growth->material, root.uv, root.color[3])) continue;
        growth->roots[growth->mesh->vertex_count / HAIR_VERTICES] = triangle;
        color_root(growth, &root);
        grow_fibre(growth, &root);
    }
}

static void mesh_free(Mesh *mesh) {
    free(mesh->position);
    free(mesh->normal);
    for (int k = 0; k < 2; k++) free(mesh->texcoord[k]);
    free(mesh->color);
    free(mesh->index);
}

/* Allocates the arrays of a mesh of so many fibres. Returns false if memory is short. */
static bool mesh_reserve(Mesh *mesh, const Mesh *on, bool colored, size_t most) {
    const size_t vertices = HAIR_VERTICES * most;
    bool made = (mesh->position = alloc_array(vertices, 3 * sizeof(float))) != NULL;
    made = made && (mesh->normal = alloc_array(vertices, 3 * sizeof(float))) != NULL;
    made = made && (mesh->index = alloc_array(HAIR_TRIANGLES * most, 3 * sizeof(uint32_t))) != NULL;
    for (int k = 0; k < 2; k++)
        if (on->texcoord[k]) made = made && (mesh->texcoord[k] = alloc_array(vertices, 2 * sizeof(float))) != NULL;
    if (colored) made = made && (mesh->color = alloc_array(vertices, 4 * sizeof(float))) != NULL;
    return made;
}

/* Grows hair into *out, and sets its roots. Returns false if memory is short. */
static bool grow(const WeftScene *scene, Hair *hair, Mesh *out) {
    const Mesh *on = &scene->meshes[hair->mesh];
    const Material *material = &scene->materials[on->material];
    size_t most = 0;
    for (uint32_t k = 0; k < on->triangle_count; k++) most += (size_t)expected(on, material, k) + 1;
    *out = (Mesh){.name = on->name};
    hair->roots = alloc_array(most, sizeof *hair->roots);
    if (!hair->roots || !mesh_reserve(out, on, on->color || material->cloth, most)) return false;
    Growth growth = {.scene = scene, .on = on, .material = material, .mesh = out, .roots = hair->roots};
    for (uint32_t k = 0; k < on->triangle_count; k++) {
        growth.numbers = stream_start((uint64_t)hair->mesh, k);
        grow_triangle(&growth, k);
    }
    return true;
}

/* Returns the material of the hair of a cloth. */
static Material hair_material(const Material *cloth) {
    static const InputId of_cloth[] = {INPUT_opacity,
                                       INPUT_normal,
                                       INPUT_occlusion,
                                       INPUT_emission,
                                       INPUT_nap,
                                       INPUT_anisotropy,
                                       INPUT_anisotropy_direction,
                                       INPUT_nap_direction,
                                       INPUT_dust,
                                       INPUT_clearcoat,
                                       INPUT_clearcoat_normal};
    const Material plain = material_default();
    Material hair = *cloth;
    for (size_t k = 0; k < sizeof of_cloth / sizeof *of_cloth; k++)
        hair.inputs[of_cloth[k]] = plain.inputs[of_cloth[k]];
    memcpy(hair.hair, plain.hair, sizeof plain.hair);
    hair.alpha_mode = WEFT_ALPHA_OPAQUE;
    hair.double_sided = true;
    hair.measured = hair.cloth = 0;
    if (!cloth->cloth) return hair;
    hair.inputs[INPUT_base_color] = plain.inputs[INPUT_base_color];
    hair.inputs[INPUT_roughness].value[0] = 1.0f;
    hair.inputs[INPUT_specular].value[0] = 0.0f;
    return hair;
}

static Hair hair_of(const WeftScene *scene, int m) {
    const Material *material = &scene->materials[scene->meshes[m].material];
    Hair hair = {.mesh = m,
                 .cloth = material->cloth,
                 .alpha_mode = material->alpha_mode,
                 .alpha_cutoff = material->alpha_cutoff,
                 .opacity = material->inputs[INPUT_opacity]};
    memcpy(hair.numbers, material->hair, sizeof hair.numbers);
    return hair;
}

/* Returns true if both hairs have the same fibres. */
static bool is_same(const Hair *a, const Hair *b) {
    bool same = a->mesh == b->mesh && a->cloth == b->cloth && a->alpha_mode == b->alpha_mode &&
                is_equal(a->alpha_cutoff, b->alpha_cutoff) && input_same_texels(&a->opacity, &b->opacity) &&
                a->opacity.channel == b->opacity.channel && is_equal(a->opacity.value[0], b->opacity.value[0]);
    for (int k = 0; k < WEFT_HAIR_NUMBERS; k++) same &= is_equal(a->numbers[k], b->numbers[k]);
    return same;
}

/* Lists in `hairs` the hair that the scene is to have, and returns its count. total: fibres of all of them; worst: the mesh
 * with most. */
static int list(const WeftScene *scene, Hair *hairs, double *total, int *worst) {
    double most = 0.0;
    int count = 0;
    *total = 0.0, *worst = 0;
    for (int m = 0; m < scene_own_meshes(scene); m++) {
        const double fibres = expected_on(scene, m);
        if (!(fibres > 0.0)) continue;
        hairs[count++] = hair_of(scene, m);
        *total += fibres;
        if (fibres > most) *worst = m, most = fibres;
    }
    return count;
}

static bool is_grown(const WeftScene *scene, const Hair *hairs, int count) {
    bool same = count == scene->hair_count;
    for (int k = 0; k < count && same; k++) same = is_same(&hairs[k], &scene->hairs[k]);
    return same;
}

/* Makes room for `count` meshes of hair and their materials in the scene's lists. Those of lights, and the free ones behind
 * them, move. Returns false if memory is short. */
static bool make_room(WeftScene *scene, int count) {
    const size_t meshes = (size_t)scene_own_meshes(scene), materials = (size_t)scene_own_materials(scene),
                 lights = (size_t)scene->polygon_light_capacity, room = (size_t)count,
                 backs = (size_t)scene->back_count;
    if (count == scene->hair_count) return true;
    Mesh *all_meshes = arena_array(&scene->arena, meshes + room + lights, sizeof *all_meshes);
    Material *all_materials = arena_array(&scene->arena, materials + room + lights + backs, sizeof *all_materials);
    if (!all_meshes || !all_materials) return false;
    memcpy(all_meshes, scene->meshes, meshes * sizeof *all_meshes);
    memcpy(all_materials, scene->materials, materials * sizeof *all_materials);
    if (lights) {
        memcpy(all_meshes + meshes + room, scene->meshes + scene_light_meshes(scene), lights * sizeof *all_meshes);
        memcpy(all_materials + materials + room, scene->materials + scene_light_materials(scene),
               (size_t)scene->polygon_light_count * sizeof *all_materials);
    }
    memcpy(all_materials + materials + room + (size_t)scene->polygon_light_count,
           scene->materials + scene->material_count, backs * sizeof *all_materials);
    for (int k = 0; k < scene->polygon_light_count; k++)
        all_meshes[meshes + room + (size_t)k].material = (int)(materials + room) + k;
    scene->mesh_count += count - scene->hair_count;
    scene->material_count += count - scene->hair_count;
    scene->hair_count = count;
    scene->meshes = all_meshes;
    scene->materials = all_materials;
    return true;
}

void hairs_free(WeftScene *scene) {
    for (int k = 0; k < scene->hair_count; k++) {
        mesh_free(&scene->meshes[scene_own_meshes(scene) + k]);
        free(scene->hairs[k].roots);
    }
    free(scene->hairs);
    scene->hairs = NULL;
}

/* Puts grown hair in the place of the scene's. Returns false if memory is short; the scene is then as it was. */
static bool replace(WeftScene *scene, Hair *hairs, const Mesh *grown, int count) {
    const WeftScene before = *scene;
    if (!make_room(scene, count)) return false;
    WeftScene gone = before;
    hairs_free(&gone);
    for (int k = 0; k < count; k++) {
        Mesh *mesh = &scene->meshes[scene_own_meshes(scene) + k];
        *mesh = grown[k];
        mesh->material = mesh->own_material = scene_own_materials(scene) + k;
    }
    scene->hairs = hairs;
    scene->hair_version++;
    scene->shape_version++;
    return true;
}

/* Grows all hair of a list and gives it to the scene. Returns false if memory is short. */
static bool grow_all(WeftScene *scene, Hair *hairs, int count) {
    Mesh *grown = alloc_array((size_t)count, sizeof *grown);
    bool made = grown != NULL;
    for (int k = 0; k < count && made; k++) made = grow(scene, &hairs[k], &grown[k]);
    made = made && replace(scene, hairs, grown, count);
    for (int k = 0; k < count && grown && !made; k++) {
        mesh_free(&grown[k]);
        free(hairs[k].roots);
    }
    free(grown);
    return made;
}

static WeftResult refuse(const WeftScene *scene, double total, int worst, WeftError *error) {
    const Material *material = &scene->materials[scene->meshes[worst].material];
    const double density = (double)material->hair[WEFT_HAIR_DENSITY];
    char value[32];
    snprintf(value, sizeof value, "%g", density);
    return fail(error, WEFT_MESSAGE_PARAM_VALUE, value,
                "hair_density makes %.3g fibres on %.3g m2, more than %d, most of them on %.60s: set %.2g or less",
                total, total / density, HAIRS_MOST, scene->meshes[worst].name,
                0.99 * density * (double)HAIRS_MOST / total);
}

WeftResult hairs_fit(WeftScene *scene, WeftError *error) {
    double total;
    int worst;
    Hair *hairs = alloc_array((size_t)scene_own_meshes(scene), sizeof *hairs);
    if (!hairs) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    const int count = list(scene, hairs, &total, &worst);
    WeftResult result = WEFT_OK;
    bool taken = false;
    if (!(total <= (double)HAIRS_MOST))
        result = refuse(scene, total, worst, error);
    else if (!is_grown(scene, hairs, count))
        taken = grow_all(scene, hairs, count);
    if (result == WEFT_OK && !taken && !is_grown(scene, hairs, count))
        result = fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    if (!taken) free(hairs);
    for (int k = 0; k < scene->hair_count; k++)
        scene->materials[scene_own_materials(scene) + k] =
            hair_material(&scene->materials[scene->meshes[scene->hairs[k].mesh].material]);
    return result;
}

bool hairs_left_out(const WeftScene *scene, Arena *arena, WeftScene *out) {
    const size_t meshes = (size_t)scene_own_meshes(scene), materials = (size_t)scene_own_materials(scene),
                 lights = (size_t)scene->polygon_light_count, backs = (size_t)scene->back_count;
    *out = *scene;
    if (!scene->hair_count) return true;
    out->meshes = arena_array(arena, meshes + lights, sizeof *out->meshes);
    out->materials = arena_array(arena, materials + lights + backs, sizeof *out->materials);
    if (!out->meshes || !out->materials) return false;
    memcpy(out->meshes, scene->meshes, meshes * sizeof *out->meshes);
    memcpy(out->materials, scene->materials, materials * sizeof *out->materials);
    memcpy(out->materials + materials + lights, scene->materials + scene->material_count,
           backs * sizeof *out->materials);
    for (size_t k = 0; k < lights; k++) {
        out->meshes[meshes + k] = scene->meshes[(size_t)scene_light_meshes(scene) + k];
        out->materials[materials + k] = scene->materials[(size_t)scene_light_materials(scene) + k];
        out->meshes[meshes + k].material = (int)(materials + k);
    }
    out->mesh_count -= scene->hair_count;
    out->material_count -= scene->hair_count;
    out->hair_count = 0;
    return true;
}

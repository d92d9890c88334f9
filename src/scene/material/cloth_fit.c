#include "scene/material/cloth_fit.h"

#include <math.h> /* the dialect has sqrt() and log() of floats; in parentheses they are those of doubles */

#include "base/fail.h"
#include "scene/material/backs.h"
#include "scene/material/hair.h"
#include "scene/material/relief.h"
#include "weave/weft_cloth.h"

static double twice_area(const Mesh *mesh, const uint32_t index[3]) {
    double e[2][3];
    for (int edge = 0; edge < 2; edge++)
        for (int c = 0; c < 3; c++)
            e[edge][c] = (double)mesh->position[3 * (size_t)index[edge + 1] + (size_t)c] -
                         (double)mesh->position[3 * (size_t)index[0] + (size_t)c];
    const double x = e[0][1] * e[1][2] - e[0][2] * e[1][1], y = e[0][2] * e[1][0] - e[0][0] * e[1][2],
                 z = e[0][0] * e[1][1] - e[0][1] * e[1][0];
    return (sqrt)(x * x + y * y + z * z);
}

static double twice_uv_area(const float *uv, const uint32_t index[3]) {
    const float *a = uv + 2 * (size_t)index[0], *b = uv + 2 * (size_t)index[1], *c = uv + 2 * (size_t)index[2];
    return fabs(((double)b[0] - (double)a[0]) * ((double)c[1] - (double)a[1]) -
                ((double)b[1] - (double)a[1]) * ((double)c[0] - (double)a[0]));
}

double cloth_uv_metres(const WeftScene *scene, int material, int set, double *uneven) {
    double area = 0.0, uv_area = 0.0, sum = 0.0, squares = 0.0;
    for (int m = 0; m < scene->mesh_count; m++) {
        const Mesh *mesh = &scene->meshes[m];
        if (mesh->material != material || !mesh->texcoord[set]) continue;
        for (uint32_t k = 0; k < mesh->triangle_count; k++) {
            const double a = twice_area(mesh, mesh->index + 3 * (size_t)k),
                         uv = twice_uv_area(mesh->texcoord[set], mesh->index + 3 * (size_t)k);
            if (!(a > 0.0) || !(uv > 0.0)) continue;
            const double log_metres = 0.5 * (log)(a / uv);
            area += a;
            uv_area += uv;
            sum += a * log_metres;
            squares += a * log_metres * log_metres;
        }
    }
    const bool any = area > 0.0 && uv_area > 0.0 && isfinite(area) && isfinite(uv_area);
    if (uneven) *uneven = any ? (sqrt)(fmax(squares / area - (sum / area) * (sum / area), 0.0)) : 0.0;
    return any ? (sqrt)(area / uv_area) : 0.0;
}

void cloth_fit(const WeftScene *scene, int material, WeftCloth *cloth) {
    const double metres = cloth->automatic ? cloth_uv_metres(scene, material, 0, NULL) : 0.0;
    if (metres > 0.0) cloth_spread(cloth, metres);
}

void cloth_check(const WeftScene *scene, int material, const WeftLog *log) {
    const char *name = scene->material_names[material];
    double uneven;
    int meshes = 0;
    for (int m = 0; m < scene_own_meshes(scene); m++) meshes += scene->meshes[m].material == material;
    const double metres = cloth_uv_metres(scene, material, 0, &uneven);
    if (scene->materials[material].inputs[INPUT_transmission].value[0] > 0.0f)
        warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, name,
             "its transmission: threads are no glass; light comes through them by diffuse_transmission, and through "
             "gaps "
             "between them where alpha_mode is not opaque");
    if (meshes && !(metres > 0.0))
        warn(
            log, WEFT_MESSAGE_PLAUSIBLE, name,
            "its mesh has no texture coordinates, which say where threads lie: all of it shows one place of the weave");
    else if (uneven > CLOTH_UNEVEN)
        warn(
            log, WEFT_MESSAGE_PLAUSIBLE, name,
            "its texture coordinates are uneven: a unit spans %.2g to %.2g m on most of it, and threads differ as much "
            "in size",
            metres * (exp)(-uneven), metres * (exp)(uneven));
}

WeftResult cloth_put(WeftScene *scene, int material, WeftCloth *cloth, WeftError *error) {
    cloth_fit(scene, material, cloth);
    const int number = scene_adopt_cloth(scene, cloth);
    if (number) {
        scene->materials[material].cloth = number;
        return WEFT_OK;
    }
    weft_cloth_free(cloth);
    return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
}

/* Returns true if a material before this one has the same cloth. */
static bool has_earlier(const WeftScene *scene, int material) {
    int k = 0;
    while (scene->materials[k].cloth != scene->materials[material].cloth) k++;
    return k < material;
}

WeftResult cloths_fit(WeftScene *scene, bool fresh, WeftError *error) {
    for (int k = 0; k < scene_own_materials(scene); k++) {
        const int number = scene->materials[k].cloth;
        const WeftCloth *cloth = number ? scene->cloths[number - 1] : NULL;
        if (!cloth || !cloth->automatic) continue;
        const double metres = cloth_uv_metres(scene, k, 0, NULL);
        if (!(metres > 0.0) || fabs(metres / cloth->metres - 1.0) < 1e-6) continue;
        if (fresh && !has_earlier(scene, k)) {
            cloth_spread(scene->cloths[number - 1], metres);
            continue;
        }
        WeftCloth *fitted = cloth_copy(cloth);
        if (!fitted) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
        WeftResult result = cloth_put(scene, k, fitted, error);
        if (result != WEFT_OK) return result;
    }
    WeftResult result = reliefs_fit(scene, error);
    if (result == WEFT_OK) result = backs_fit(scene, error);
    return result == WEFT_OK ? hairs_fit(scene, error) : result;
}

/* fuzz_gltf - the glTF reader: GLB and JSON from memory, all that can lie in one file
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. What was read must keep the
 * promises of scene/scene.h. Use the dictionary gltf.dict. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/gltf.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void demand(int condition) {
    if (!condition) abort();
}

static void check_mesh(const WeftScene *scene, const Mesh *mesh) {
    demand(mesh->name && mesh->triangle_count && mesh->material >= 0 &&
           mesh->material < scene->material_count);
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++) demand(mesh->index[i] < mesh->vertex_count);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const float *p = mesh->position + 3 * i, *n = mesh->normal ? mesh->normal + 3 * i : NULL,
                    *t = mesh->tangent ? mesh->tangent + 4 * i : NULL;
        demand(isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]));
        if (n) demand(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0f) < 1e-3f);
        if (t) demand(fabsf(t[0] * t[0] + t[1] * t[1] + t[2] * t[2] - 1.0f) < 1e-3f && fabsf(t[3]) == 1.0f);
    }
    for (int v = 0; v < scene->variant_count && mesh->variant_material; v++)
        demand(mesh->variant_material[v] < scene->material_count);
}

static void check_scene(const WeftScene *scene) {
    for (int m = 0; m < scene->mesh_count; m++) check_mesh(scene, &scene->meshes[m]);
    for (int m = 0; m < scene->material_count; m++)
        for (int i = 0; i < INPUT_COUNT; i++) {
            const Input *input = &scene->materials[m].inputs[i];
            demand(isfinite(input->value[0]) && input->texcoord <= 1 && input->texture >= 0 &&
                   input->texture <= scene->texture_count);
        }
    for (int t = 0; t < scene->texture_count; t++)
        demand(scene->textures[t].image >= 0 && scene->textures[t].image < scene->image_count &&
               scene->images[scene->textures[t].image].pixels);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    /* Not scene_create: its studio would cost more than the reading. */
    WeftScene *scene = alloc_array(1, sizeof *scene);
    demand(scene != NULL);
    WeftError error;
    WeftResult result = gltf_read("fuzz", data, size, scene, NULL, &error);
    if (result == WEFT_OK)
        check_scene(scene);
    else
        demand(error.result == result && strchr(error.text, '\n') == NULL && error.text[0]);
    weft_scene_free(scene);
    return 0;
}

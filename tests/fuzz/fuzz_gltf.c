/* fuzz_gltf - the glTF reader: GLB and JSON from memory, all that can lie in one file
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. What was read must keep the
 * promises of scene/record/scene.h. Use the dictionary gltf.dict. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "gltf/read/gltf.h"
#include "gltf/save/patch.h"
#include "measure/doctor/doctor.h"
#include "weft/doctor.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* In place of the program's own: how much light a cloth sends back is arithmetic on numbers that check_ranges and
 * the reader have bounded, and takes a minute under the sanitizers. */
void check_energy(WeftDoctor *doctor, const Cloth *cloth) {
    (void)doctor;
    (void)cloth;
}

static void demand(int condition) {
    if (!condition) abort();
}

static void check_arrays(const WeftScene *scene, const Mesh *mesh) {
    demand(mesh->name && mesh->triangle_count && mesh->material >= 0 && mesh->material < scene->material_count);
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
    for (int m = 0; m < scene->mesh_count; m++) check_arrays(scene, &scene->meshes[m]);
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

/* Text that was not edited comes back as it was; text of which a part is gone means what is left. */
static void check_patch(const Asset *asset) {
    size_t size = 0;
    char *same = patch_text((const char *)asset->text.data, asset->text.size, asset->root, asset->root, &size);
    demand(same && size == asset->text.size && memcmp(same, asset->text.data, size) == 0);
    free(same);
    json_t *less = json_deep_copy(asset->root);
    json_object_del(less, "materials");
    char *text = patch_text((const char *)asset->text.data, asset->text.size, asset->root, less, &size);
    json_t *back = text ? json_loadb(text, size, 0, NULL) : NULL;
    demand(back && json_equal(back, less));
    json_decref(back);
    json_decref(less);
    free(text);
}

/* What opens is examined, whatever it looks like. */
static void check_doctor(const uint8_t *data, size_t size) {
    WeftDoctor *doctor;
    WeftError error;
    Asset asset = {0};
    gltf_open(&asset, "fuzz", data, size);
    if (asset.result == WEFT_OK) check_patch(&asset);
    gltf_close(&asset);
    if (weft_doctor_open_memory(data, size, "fuzz", &doctor, NULL, &error) != WEFT_OK) {
        demand(error.text[0] && strchr(error.text, '\n') == NULL);
        return;
    }
    for (int k = 0; k < weft_doctor_count(doctor); k++) {
        const WeftFinding *finding = weft_doctor_finding(doctor, k);
        demand(finding->words[0] && finding->subject[0] && strchr(finding->words, '\n') == NULL);
    }
    weft_doctor_close(doctor);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    check_doctor(data, size);
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

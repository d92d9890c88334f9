/* fuzz_gltf - the glTF reader: GLB and JSON from memory, all that can lie in one file
 *
 * Any input must be read or refused with one line; sanitizers watch the rest. What was read must keep the
 * promises of scene/record/scene.h. One with animations is read at a moment of the first. Use the dictionary gltf.dict. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/patch.h"
#include "gltf/asset/material_fields.h"
#include "gltf/read/gltf.h"
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

/* Returns true if the member is absent, or one of the texts, which end with NULL. */
static bool is_one_of(const json_t *object, const char *key, const char *const *texts) {
    const json_t *value = json_object_get(object, key);
    for (; value && *texts; texts++)
        if (json_is_string(value) && strcmp(json_string_value(value), *texts) == 0) return true;
    return !value;
}

static bool is_wrap(const json_t *value) {
    double number = json_number_value(value);
    return !value || number == 10497.0 || number == 33071.0 || number == 33648.0;
}

/* Demands of a number or an array of them what a row allows. */
static void check_range(const json_t *value, const MaterialField *row) {
    const size_t count = json_is_array(value) ? json_array_size(value) : 1;
    for (size_t k = 0; value && k < count && row->low >= 0.0f; k++) {
        const double number = json_number_value(json_is_array(value) ? json_array_get(value, k) : value);
        demand(number >= (double)row->low && number <= (double)row->high);
    }
}

/* Demands that a file which was read without a word is understood: its words, constants, numbers and extensions are
 * those that there are. */
static void check_understood(json_t *root) {
    static const char *const modes[] = {"OPAQUE", "MASK", "BLEND", NULL};
    size_t k;
    json_t *value;
    json_array_foreach(json_object_get(root, "materials"), k, value) {
        const char *name;
        json_t *extension;
        demand(is_one_of(value, "alphaMode", modes));
        json_object_foreach(json_object_get(value, "extensions"), name, extension) { demand(gltf_supports(name)); }
        for (const MaterialField *row = material_fields; row->factor; row++) {
            json_t *extensions = json_object_get(value, "extensions");
            json_t *object = material_field_extends(row) ? json_object_get(extensions, row->object)
                             : row->object               ? json_object_get(value, row->object)
                                                         : value;
            if (row->input != NO_INPUT && !material_field_inside(row))
                check_range(json_object_get(object, row->factor), row);
        }
    }
    json_array_foreach(json_object_get(root, "samplers"), k, value) {
        demand(is_wrap(json_object_get(value, "wrapS")) && is_wrap(json_object_get(value, "wrapT")));
    }
}

static void count_warning(void *user, WeftMessage message, const char *text) {
    (void)message;
    demand(text[0] && strchr(text, '\n') == NULL);
    ++*(int *)user;
}

static void check_silence(const uint8_t *data, size_t size, int warnings) {
    Asset asset = {0};
    if (warnings) return;
    gltf_open(&asset, "fuzz", data, size);
    if (asset.result == WEFT_OK) check_understood(asset.root);
    gltf_close(&asset);
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

/* Returns true if the word is anywhere in the input. */
static bool has_word(const uint8_t *data, size_t size, const char *word) {
    const size_t length = strlen(word);
    for (size_t k = 0; k + length <= size; k++)
        if (memcmp(data + k, word, length) == 0) return true;
    return false;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    check_doctor(data, size);
    /* Not scene_create: its studio would cost more than the reading. */
    WeftScene *scene = alloc_array(1, sizeof *scene);
    demand(scene != NULL);
    WeftError error;
    int warnings = 0;
    const WeftLog log = {count_warning, &warnings};
    const WeftMoment moment = {.time = 0.75};
    const bool moves = has_word(data, size, "animations");
    WeftResult result = gltf_read_watched("fuzz", data, size, moves ? &moment : NULL, scene, NULL, NULL, &log, &error);
    if (result == WEFT_OK) {
        check_scene(scene);
        check_silence(data, size, warnings);
    } else {
        demand(error.result == result && strchr(error.text, '\n') == NULL && error.text[0]);
    }
    weft_scene_free(scene);
    return 0;
}

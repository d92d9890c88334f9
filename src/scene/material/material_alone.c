/* material_alone.c - a material without a scene: the default, that of a file or a preset, set by name */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/path.h"
#include "scene/material/material_file.h"
#include "scene/material/material_numbers.h"
#include "scene/material/presets.h"
#include "scene/material/set.h"
#include "scene/material/u3m.h"
#include "scene/mtlx/mtlx_read.h"

const char *weft_preset_name(int index) { return preset_at(index) ? preset_at(index)->name : NULL; }
const char *weft_preset_group(int index) { return preset_at(index) ? preset_at(index)->group : NULL; }
const char *weft_preset_help(int index) { return preset_at(index) ? preset_at(index)->help : NULL; }
const char *weft_preset_text(int index) { return preset_at(index) ? preset_at(index)->text : NULL; }

static const struct {
    const char *name, *help;
} groups[] = {
#define ROW(name, help) {name, help},
    PRESET_GROUPS(ROW)
#undef ROW
};
enum { GROUPS = sizeof groups / sizeof *groups };

const char *weft_preset_group_name(int index) { return index >= 0 && index < GROUPS ? groups[index].name : NULL; }
const char *weft_preset_group_help(int index) { return index >= 0 && index < GROUPS ? groups[index].help : NULL; }

static WeftResult load_preset(const char *name, MaterialFile *out, WeftError *error) {
    for (int k = 0; preset_at(k); k++) {
        const Preset *preset = preset_at(k);
        if (strcmp(preset->name, name) == 0) /* without warnings on embedded presets */
            return material_file_read(preset->text, strlen(preset->text), name, NULL, out, NULL, error);
    }
    return fail(error, WEFT_MESSAGE_PRESET_NAME, name, "`weft models` lists them");
}

/* Reads a MaterialX document as the material file that it amounts to. */
static WeftResult read_mtlx(const FileBytes *bytes, const char *path, const char *folder, MaterialFile *out,
                            const WeftLog *log, WeftError *error) {
    json_t *json;
    WeftResult result = mtlx_read(bytes->data, bytes->size, path, &json, log, error);
    if (result != WEFT_OK) return result;
    char *text = json_dumps(json, JSON_REAL_PRECISION(9));
    json_decref(json);
    if (!text) return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    result = material_file_read(text, strlen(text), path, folder, out, log, error);
    free(text);
    return result;
}

WeftResult material_file_load(const char *path, MaterialFile *out, const WeftLog *log, WeftError *error) {
    static const char prefix[] = "preset:";
    const size_t limit = (size_t)1 << 20;
    memset(out, 0, sizeof *out);
    if (path_is_u3m(path)) return u3m_load(path, out, log, error);
    if (strncmp(path, prefix, strlen(prefix)) == 0) return load_preset(path + strlen(prefix), out, error);
    FileBytes bytes;
    WeftResult result = file_read(path, limit, &bytes, error);
    if (result != WEFT_OK) return result;
    char *folder = strdup(path), *slash = folder ? strrchr(folder, '/') : NULL;
    if (folder) *(slash ? slash + 1 : folder) = '\0';
    if (!folder)
        result = fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    else if (path_ends(path, ".mtlx"))
        result = read_mtlx(&bytes, path, folder, out, log, error);
    else
        result = material_file_read(bytes.data, bytes.size, path, folder, out, log, error);
    free(folder);
    free(bytes.data);
    return result;
}

void weft_material_default(WeftMaterial *out) { *out = material_default(); }

/* Takes the texture from an input, which then has the value that the file gives for this case, or the factor. */
static void leave_texture(const MaterialFile *file, InputId id, Input *input) {
    if (input->texture && file->has_constants) memcpy(input->value, file->constant[id], sizeof input->value);
    input->texture = 0;
}

/* Reads the material of a file or preset. cloth: NULL leaves out a weave. */
static WeftResult read_alone(const char *path, WeftMaterial *out, WeftCloth **cloth, const WeftLog *log,
                             WeftError *error) {
    MaterialFile file;
    weft_material_default(out);
    WeftResult result = material_file_load(path, &file, log, error);
    if (result == WEFT_OK) {
        if (file.texture_count)
            warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, path, "its textures; only its numbers count here");
        if (file.cloth && cloth) {
            *cloth = file.cloth;
            file.cloth = NULL;
        } else if (file.cloth)
            warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, path, "its weave; only its numbers count here");
        if (file.measured)
            warn(log, WEFT_MESSAGE_GLTF_WARN_IGNORED, path, "its measurement; only its numbers count here");
        *out = file.material;
        for (int k = 0; k < INPUT_COUNT; k++) leave_texture(&file, (InputId)k, &out->inputs[k]);
    }
    material_file_free(&file);
    return result;
}

WeftResult weft_material_read(const char *path, WeftMaterial *out, const WeftLog *log, WeftError *error) {
    return read_alone(path, out, NULL, log, error);
}

WeftResult weft_material_read_woven(const char *path, WeftMaterial *out, WeftCloth **cloth, const WeftLog *log,
                                    WeftError *error) {
    *cloth = NULL;
    return read_alone(path, out, cloth, log, error);
}

WeftResult weft_material_set_number(WeftMaterial *material, int input, const float *values, WeftError *error) {
    char number[16];
    snprintf(number, sizeof number, "%d", input);
    if (input < 0 || input >= INPUT_COUNT) return fail(error, WEFT_MESSAGE_PARAM_NAME, number, NULL);
    Setting setting = {.input = input};
    for (int c = 0; c < input_value_count((InputId)input); c++) {
        if (!isfinite(values[c]))
            return fail(error, WEFT_MESSAGE_PARAM_VALUE, input_infos[input].name, "its value is not finite");
        setting.v[c] = input_clamped((InputId)input, values[c]);
    }
    material_set(material, &setting);
    return WEFT_OK;
}

WeftResult weft_material_set(WeftMaterial *material, const char *name, const char *value, const WeftLog *log,
                             WeftError *error) {
    Setting setting;
    WeftResult result = setting_read(name, value, name, &setting, log, error);
    if (result == WEFT_OK) material_set(material, &setting);
    return result;
}

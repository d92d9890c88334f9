/* doctor.c - reads an asset, runs the checks over it, and keeps, reports and repairs the findings */
#include "measure/doctor/doctor.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/path.h"
#include "base/printable.h"
#include "gltf/asset/uri.h"
#include "gltf/read/gltf.h"
#include "gltf/save/rewrite.h"

static const struct {
    const char *name, *help;
    WeftSeverity severity;
    int fixable;
} catalogue[] = {
#define CATALOGUE_ROW(id, name, severity, fixable, help) {name, help, WEFT_SEVERITY_##severity, fixable},
    WEFT_FINDINGS(CATALOGUE_ROW)
#undef CATALOGUE_ROW
};

static bool is_kind(int kind) { return kind >= 0 && kind < WEFT_FINDING_COUNT; }

const char *weft_finding_name(int kind) { return is_kind(kind) ? catalogue[kind].name : NULL; }
const char *weft_finding_help(int kind) { return is_kind(kind) ? catalogue[kind].help : NULL; }
WeftSeverity weft_finding_severity(int kind) { return is_kind(kind) ? catalogue[kind].severity : WEFT_SEVERITY_NOTE; }
int weft_finding_fixable(int kind) { return is_kind(kind) ? catalogue[kind].fixable : 0; }

const char *weft_severity_name(WeftSeverity severity) {
    static const char *const names[] = {"note", "warning", "error"};
    return (unsigned)severity < sizeof names / sizeof *names ? names[severity] : NULL;
}

/* Returns the name of the array in the glTF file that lists what a finding is about; "" for the asset as a whole. */
static const char *list_name(WeftFindingOf of) {
    static const char *const names[] = {"", "materials", "meshes", "images"};
    return names[of];
}

static void name_subject(const WeftDoctor *doctor, WeftFinding *finding) {
    json_t *item = doctor_item(doctor, list_name(finding->of), finding->index);
    const char *name = json_string_value(json_object_get(item, "name"));
    const char *uri = json_string_value(json_object_get(item, "uri"));
    if (!name && uri && !uri_is_data(uri)) name = uri;
    if (finding->of == WEFT_OF_ASSET)
        snprintf(finding->subject, sizeof finding->subject, "asset");
    else if (name && name[0])
        snprintf(finding->subject, sizeof finding->subject, "%s", name);
    else
        snprintf(finding->subject, sizeof finding->subject, "%s[%d]", list_name(finding->of), finding->index);
    make_printable(finding->subject);
}

static void name_place(WeftFinding *finding, const char *path) {
    char *to = finding->place;
    size_t capacity = sizeof finding->place;
    const char *slash = path && path[0] ? "/" : "";
    if (!path) path = "";
    if (finding->of == WEFT_OF_ASSET)
        snprintf(to, capacity, "%s%s", slash, path);
    else
        snprintf(to, capacity, "/%s/%d%s%s", list_name(finding->of), finding->index, slash, path);
    make_printable(to);
}

/* Allocates space for one more finding. Returns false if there are too many or memory is short. */
static bool reserve(WeftDoctor *doctor) {
    enum { FINDINGS_MAX = 10000 };
    if (doctor->count < doctor->capacity) return true;
    if (doctor->count >= FINDINGS_MAX) return false; /* more than anyone would read */
    size_t capacity = doctor->capacity ? 2 * (size_t)doctor->capacity : 32;
    WeftFinding *items = realloc_array(doctor->items, capacity, sizeof *items);
    if (items) doctor->items = items;
    Repair *repairs = realloc_array(doctor->repairs, capacity, sizeof *repairs);
    if (repairs) doctor->repairs = repairs;
    if (items && repairs) doctor->capacity = (int)capacity;
    doctor->failed |= !items || !repairs;
    return items && repairs;
}

void doctor_found(WeftDoctor *doctor, WeftFindingKind kind, Place place, unsigned engines, double figure,
                  const Repair *repair, const char *words, ...) {
    if (!reserve(doctor)) return;
    WeftFinding *finding = &doctor->items[doctor->count];
    *finding = (WeftFinding){.kind = kind,
                             .severity = catalogue[kind].severity,
                             .of = place.of,
                             .index = place.index,
                             .engines = engines,
                             .fixable = repair && repair->act != REPAIR_NONE,
                             .figure = figure};
    doctor->repairs[doctor->count++] = repair ? *repair : (Repair){.act = REPAIR_NONE};
    va_list arguments;
    va_start(arguments, words);
    vsnprintf(finding->words, sizeof finding->words, words, arguments);
    va_end(arguments);
    make_printable(finding->words);
    name_subject(doctor, finding);
    name_place(finding, place.path);
}

void doctor_advise(WeftDoctor *doctor, const char *fix, ...) {
    if (!doctor->count) return;
    WeftFinding *finding = &doctor->items[doctor->count - 1];
    va_list arguments;
    va_start(arguments, fix);
    vsnprintf(finding->fix, sizeof finding->fix, fix, arguments);
    va_end(arguments);
    make_printable(finding->fix);
}

void doctor_soften(WeftDoctor *doctor) {
    if (!doctor->count) return;
    doctor->items[doctor->count - 1].severity = WEFT_SEVERITY_NOTE;
    doctor->items[doctor->count - 1].fixable = 0;
    doctor->repairs[doctor->count - 1].act = REPAIR_NONE;
}

/* Reports progress. Reading takes little time beside the checks and counts as 0. */
static int report_progress(void *user, double fraction) {
    const WeftDoctor *doctor = user;
    return doctor->progress ? doctor->progress(doctor->user, doctor->examining ? fraction : 0.0) : 0;
}

/* Reports progress; returns false if the caller wants to stop. */
static bool goes_on(WeftDoctor *doctor, size_t done) {
    Asset *asset = &doctor->asset;
    return asset_progress(asset, 0.0, 1.0, done, asset->material_count + asset->mesh_count);
}

static void examine(WeftDoctor *doctor) {
    static void (*const of_asset[])(WeftDoctor *) = {check_extensions, check_empty, check_glass, check_spaces};
    static void (*const of_material[])(WeftDoctor *, const Cloth *) = {
        check_archived, check_ranges, check_defaults,   check_factors,   check_transforms, check_black,
        check_channels, check_energy, check_neighbours, check_plausible, check_scale};
    for (size_t k = 0; k < sizeof of_asset / sizeof *of_asset; k++) of_asset[k](doctor);
    doctor->examining = true;
    int materials = (int)doctor->asset.material_count;
    for (int m = 0; m < materials && goes_on(doctor, (size_t)m); m++) {
        Cloth cloth = doctor_cloth(doctor, m);
        for (size_t k = 0; k < sizeof of_material / sizeof *of_material; k++) of_material[k](doctor, &cloth);
    }
    for (int m = 0; m < (int)doctor->asset.mesh_count && goes_on(doctor, (size_t)materials + (size_t)m); m++)
        check_mesh(doctor, m);
}

/* A finding with its repair and its index, for sorting. */
typedef struct Found {
    WeftFinding item;
    Repair repair;
    int at;
} Found;

/* Orders findings by asset, materials, meshes, images; then by index in the file; then the gravest first. */
static int compare_findings(const void *left, const void *right) {
    const Found *x = left, *y = right;
    const WeftFinding *a = &x->item, *b = &y->item;
    if (a->of != b->of) return (int)a->of - (int)b->of;
    if (a->index != b->index) return a->index - b->index;
    if (a->severity != b->severity) return (int)b->severity - (int)a->severity;
    if (a->kind != b->kind) return (int)a->kind - (int)b->kind;
    return x->at - y->at; /* as they were found */
}

static void sort(WeftDoctor *doctor) {
    Found *found = alloc_array((size_t)doctor->count, sizeof *found);
    doctor->failed |= !found;
    if (!found) return;
    for (int k = 0; k < doctor->count; k++) found[k] = (Found){doctor->items[k], doctor->repairs[k], k};
    qsort(found, (size_t)doctor->count, sizeof *found, compare_findings);
    for (int k = 0; k < doctor->count; k++) {
        doctor->items[k] = found[k].item;
        doctor->repairs[k] = found[k].repair;
    }
    free(found);
}

/* Examines the U3M at path. */
static WeftResult open_u3m(const char *path, WeftDoctor **out, const WeftLog *log, WeftError *error) {
    WeftDoctor *doctor = alloc_array(1, sizeof *doctor);
    *out = NULL;
    if (!doctor) return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    if (log) doctor->log = *log;
    doctor->u3m = true;
    WeftResult result = doctor_u3m(doctor, path, error);
    if (result == WEFT_OK && !doctor->failed) sort(doctor);
    if (result == WEFT_OK && doctor->failed) result = fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    if (result == WEFT_OK)
        *out = doctor;
    else
        weft_doctor_close(doctor);
    return result;
}

static WeftResult open_any(const char *path, const void *data, size_t size, WeftProgress progress, void *user,
                           WeftDoctor **out, const WeftLog *log, WeftError *error) {
    WeftDoctor *doctor = alloc_array(1, sizeof *doctor);
    *out = NULL;
    if (!doctor) return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    doctor->scene = alloc_array(1, sizeof *doctor->scene);
    if (!doctor->scene) {
        free(doctor);
        return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    }
    if (log) doctor->log = *log;
    doctor->progress = progress;
    doctor->user = user;
    doctor->scene->srgb = srgb_table();
    doctor->own = (WeftLog){doctor_hear, doctor};
    doctor->asset = (Asset){.error = &doctor->error,
                            .scene = doctor->scene,
                            .examined = true,
                            .log = &doctor->own,
                            .progress = report_progress,
                            .user = doctor};
    gltf_open(&doctor->asset, path, data, size);
    gltf_read_parts(&doctor->asset);
    if (doctor->asset.result == WEFT_OK)
        doctor->pixels = alloc_array((size_t)doctor->scene->image_count, sizeof *doctor->pixels);
    if (doctor->asset.result == WEFT_OK && !doctor->pixels) doctor->failed = true;
    if (doctor->asset.result == WEFT_OK && !doctor->failed) examine(doctor);
    if (doctor->asset.result == WEFT_OK && !doctor->failed) doctor_unite(doctor);
    if (doctor->asset.result == WEFT_OK && !doctor->failed) sort(doctor);
    if (doctor->failed) asset_fail(&doctor->asset, WEFT_MESSAGE_MEMORY, NULL);
    if (doctor->asset.result == WEFT_OK) {
        *out = doctor;
        return WEFT_OK;
    }
    WeftResult result = doctor->asset.result;
    if (error) *error = doctor->error;
    weft_doctor_close(doctor);
    return result;
}

WeftResult weft_doctor_open(const char *path, WeftDoctor **out, const WeftLog *log, WeftError *error) {
    return weft_doctor_open_watched(path, NULL, NULL, out, log, error);
}

WeftResult weft_doctor_open_watched(const char *path, WeftProgress progress, void *user, WeftDoctor **out,
                                    const WeftLog *log, WeftError *error) {
    if (path_is_u3m(path)) return open_u3m(path, out, log, error);
    return open_any(path, NULL, 0, progress, user, out, log, error);
}

WeftResult weft_doctor_open_memory(const void *data, size_t size, const char *name, WeftDoctor **out,
                                   const WeftLog *log, WeftError *error) {
    return open_any(name, data ? data : "", data ? size : 0, NULL, NULL, out, log, error);
}

void weft_doctor_close(WeftDoctor *doctor) {
    if (!doctor) return;
    gltf_close(&doctor->asset);
    weft_scene_free(doctor->scene);
    free(doctor->items);
    free(doctor->repairs);
    free(doctor->pixels);
    free(doctor->energies);
    free(doctor->energy_tables);
    free(doctor);
}

int weft_doctor_count(const WeftDoctor *doctor) { return doctor->count; }

const WeftFinding *weft_doctor_finding(const WeftDoctor *doctor, int index) {
    return index >= 0 && index < doctor->count ? &doctor->items[index] : NULL;
}

WeftDoctorInfo weft_doctor_info(const WeftDoctor *doctor) {
    WeftDoctorInfo info = {.material_count = (int)doctor->asset.material_count,
                           .mesh_count = (int)doctor->asset.mesh_count,
                           .image_count = (int)doctor->asset.image_count};
    for (int m = 0; m < info.material_count; m++)
        info.sheen_count += doctor_part(doctor_item(doctor, "materials", m), "extensions/KHR_materials_sheen") != NULL;
    return info;
}

static WeftResult fix_once(const WeftDoctor *doctor, const char *path, WeftError *error) {
    Rewrite rewrite;
    Asset asset = doctor->asset; /* a copy, so that a failure here leaves the doctor as it is */
    WeftResult result = rewrite_begin(&rewrite, &asset, error);
    for (int k = 0; k < doctor->count && result == WEFT_OK; k++) result = doctor_repair(doctor, &rewrite, k, error);
    if (result == WEFT_OK) result = rewrite_save(&rewrite, path, error);
    rewrite_end(&rewrite);
    return result;
}

static bool can_fix(const WeftDoctor *doctor) {
    bool any = false;
    for (int k = 0; k < doctor->count; k++) any |= doctor->items[k].fixable;
    return any;
}

/* Repairs in up to ROUNDS rounds, and examines the written file after each: a repair may switch a sheen on,
 * which then has findings of its own. */
WeftResult weft_doctor_fix(const WeftDoctor *doctor, const char *path, WeftError *error) {
    enum { ROUNDS = 4 };
    if (doctor->u3m) return fail(error, WEFT_MESSAGE_SCENE_KIND, path, "a U3M is not repaired");
    WeftResult result = fix_once(doctor, path, error);
    bool more = can_fix(doctor);
    for (int round = 1; round < ROUNDS && more && result == WEFT_OK; round++) {
        WeftDoctor *again;
        result = weft_doctor_open_watched(path, doctor->progress, doctor->user, &again, NULL, error);
        if (result != WEFT_OK) break;
        more = can_fix(again);
        if (more) result = fix_once(again, path, error);
        weft_doctor_close(again);
    }
    return result;
}

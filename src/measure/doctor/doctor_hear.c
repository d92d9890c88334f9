/* doctor_hear.c - the warnings of the reader as findings: whatever it says, the doctor says too */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/fail.h"
#include "gltf/asset/field.h"
#include "gltf/asset/material_fields.h"
#include "measure/doctor/doctor.h"

/* The finding that a warning becomes. */
typedef struct Response {
    WeftMessage message;
    WeftFindingKind kind;
    const char *after; /* what follows the words of the reader */
    const char *fix;
} Response;

static const Response responses[] = {
    {WEFT_MESSAGE_FILE_OPEN, WEFT_FINDING_IMAGE_UNREAD, "",
     "put the file where the asset names it; its contents were not examined"},
    {WEFT_MESSAGE_GLTF_URI, WEFT_FINDING_IMAGE_UNREAD, "",
     "name the file by its path in the asset's folder, and move it there, or open the folder as the line says; its "
     "contents were not examined"},
    {WEFT_MESSAGE_IMAGE_REPAIRED, WEFT_FINDING_IMAGE_REPAIRED, "",
     "write the image again: other readers may refuse it"},
    {WEFT_MESSAGE_GLTF_WARN_EXTENSION, WEFT_FINDING_EXTENSION_IGNORED,
     " is used, which weft does not read: all is examined and shown without it",
     "look whether the engines that the asset is for read it"},
    {WEFT_MESSAGE_GLTF_WARN_REST_POSE, WEFT_FINDING_REST_POSE, " are seen in the rest pose",
     "for another pose, export the mesh as it is in that pose"},
    {WEFT_MESSAGE_GLTF_WARN_REPAIRED, WEFT_FINDING_PART_REPAIRED, "",
     "write what was meant: other readers may refuse it, or read it in another way"},
    {WEFT_MESSAGE_GLTF_WARN_IGNORED, WEFT_FINDING_PART_IGNORED, "", "drop it, or write it as glTF has it"},
};
static const Response unread = {WEFT_MESSAGE_NONE, WEFT_FINDING_IMAGE_UNREAD, "",
                                "write it as PNG or JPEG; its contents were not examined"},
                      other = {WEFT_MESSAGE_NONE, WEFT_FINDING_PART_IGNORED, "", "see docs/gltf.md"};

static const Response *response_of(WeftMessage message) {
    for (size_t k = 0; k < sizeof responses / sizeof *responses; k++)
        if (responses[k].message == message) return &responses[k];
    return message_result(message) == WEFT_INPUT ? &unread : &other;
}

enum { PATH = 160 };

/* Writes the path below `top` as a JSON pointer without its first slash, and returns its length. */
static size_t pointer_write(const Field *field, const Field *top, char path[PATH]) {
    if (field == top) {
        path[0] = '\0';
        return 0;
    }
    size_t used = pointer_write(field->parent, top, path);
    const char *slash = used ? "/" : "";
    int wrote = field->key ? snprintf(path + used, PATH - used, "%s%s%s", slash, field->extension ? "extensions/" : "",
                                      field->key)
                           : snprintf(path + used, PATH - used, "%s%zu", slash, field->index);
    used += wrote > 0 ? (size_t)wrote : 0;
    return used < PATH ? used : PATH - 1;
}

/* Returns the place of a field: in a material, a mesh or an image if it is in one. */
static Place place_of(const Field *field, char path[PATH]) {
    static const char *const lists[] = {"materials", "meshes", "images"}; /* as WeftFindingOf from WEFT_OF_MATERIAL */
    const Field *top = field, *item = NULL, *list = NULL;
    for (; top && top->parent; top = top->parent) {
        item = list;
        list = top;
    }
    for (int k = 0; item && list->key && k < 3; k++)
        if (strcmp(list->key, lists[k]) == 0) {
            pointer_write(field, item, path);
            return (Place){(WeftFindingOf)(WEFT_OF_MATERIAL + k), (int)item->index, path};
        }
    if (field) pointer_write(field, top, path);
    return (Place){WEFT_OF_ASSET, 0, path};
}

/* Returns the place of a warning without a field, which may begin with "meshes[3]". */
static Place place_told(const char *words) {
    int mesh = -1;
    if (sscanf(words, "meshes[%d]", &mesh) == 1 && mesh >= 0) return (Place){WEFT_OF_MESH, mesh, NULL};
    return (Place){WEFT_OF_ASSET, 0, NULL};
}

/* Returns the words of a warning: of one about an image all of them, of others those behind the message. */
static const char *words_of(const Response *response, WeftMessage message, const char *text) {
    const char *told = weft_message_text(message), *words = *told ? strstr(text, told) : NULL;
    if (response->kind == WEFT_FINDING_IMAGE_UNREAD || response->kind == WEFT_FINDING_IMAGE_REPAIRED || !words)
        return text;
    words += strlen(told);
    return strncmp(words, ": ", 2) == 0 && words[2] ? words + 2 : words - strlen(told);
}

/* Returns the row of a textureInfo of a material; NULL if the field is none. */
static const MaterialField *row_of(const Field *field) {
    const MaterialField *row = material_fields;
    if (!field || !field->key) return NULL;
    while (row->factor && !(row->texture && strcmp(row->texture, field->key) == 0)) row++;
    return row->factor ? row : NULL;
}

/* Reports a texture of which nothing is shown: for want of a picture, or of the coordinates. */
static void texture_found(WeftDoctor *doctor, const MaterialField *row, Place place, const char *words) {
    const bool coordinates = strstr(words, "TEXCOORD_") != NULL;
    char name[64] = "a number";
    if (row->input != NO_INPUT) snprintf(name, sizeof name, "%s", input_infos[row->input].name);
    for (char *c = name; *c; c++)
        if (*c == '_') *c = ' ';
    doctor_found(doctor, WEFT_FINDING_TEXTURE_UNSHOWN, place, 0, (double)NAN, NULL,
                 coordinates ? "%s is shown without its picture: %s" : "%s has no picture: %s", name, words);
    doctor_advise(doctor, "%s",
                  coordinates ? "read the textures of a material by two sets at most"
                              : "give the texture a plain source too, a PNG or JPEG");
}

static bool is_required(const WeftDoctor *doctor, const char *extension) {
    size_t k;
    json_t *value;
    json_array_foreach(doctor_list(doctor, "extensionsRequired"), k, value) {
        if (json_is_string(value) && strcmp(json_string_value(value), extension) == 0) return true;
    }
    return false;
}

/* Returns true if the words of an ignored extension go on after its name with what weft leaves out of it. The name is the
 * file's, and may hold anything. */
static bool says_loss(const char *words) {
    char name[64];
    const char *end = strstr(words, ": ");
    if (!end || end - words >= (long)sizeof name) return false;
    snprintf(name, sizeof name, "%.*s", (int)(end - words), words);
    const char *lost = material_extension_lost(name);
    return lost && strcmp(end + 2, lost) == 0;
}

/* Returns true if the last finding, before which there were `count`, repeats another. */
static bool is_repeated(const WeftDoctor *doctor, int count) {
    const WeftFinding *last = &doctor->items[count];
    for (int k = 0; k < count; k++)
        if (doctor->items[k].kind == last->kind && doctor->items[k].index == last->index &&
            strcmp(doctor->items[k].place, last->place) == 0 && strcmp(doctor->items[k].words, last->words) == 0)
            return true;
    return false;
}

void doctor_hear(void *user, WeftMessage message, const char *text) {
    WeftDoctor *doctor = user;
    const Response *response = response_of(message);
    const Field *field = doctor->asset.place;
    const char *words = words_of(response, message, text);
    char path[PATH] = "";
    const Place place = field ? place_of(field, path) : place_told(words);
    const MaterialField *row = place.of == WEFT_OF_MATERIAL ? row_of(field) : NULL;
    const int count = doctor->count;
    if (doctor->log.fn && message_result(message) != WEFT_INPUT) doctor->log.fn(doctor->log.user, message, text);
    const bool extension = response->kind == WEFT_FINDING_EXTENSION_IGNORED;
    const bool loss = extension && says_loss(words);
    if (extension && is_required(doctor, words)) return; /* an error says so */
    if (response->kind == WEFT_FINDING_PART_IGNORED && row) {
        texture_found(doctor, row, place, words);
    } else {
        doctor_found(doctor, response->kind, place, 0, (double)NAN, NULL, "%s%s", words, loss ? "" : response->after);
        if (doctor->count == count) return; /* the list is full */
        doctor_advise(doctor, "%s", response->fix);
    }
    if (doctor->count == count) return; /* the list is full */
    /* Animations, and pictures with a plain one beside them, are left out without harm. */
    if (place.of == WEFT_OF_ASSET && (strncmp(path, "animations", 10) == 0 || strncmp(path, "textures/", 9) == 0))
        doctor_soften(doctor);
    if (is_repeated(doctor, count)) doctor->count--;
}

/* Returns true if a check found a number out of range where, or in which, the reader repaired one. */
static bool is_said(const WeftDoctor *doctor, const WeftFinding *heard) {
    for (int k = 0; k < doctor->count; k++) {
        const WeftFinding *finding = &doctor->items[k];
        size_t length = strlen(finding->place);
        if (finding->kind == WEFT_FINDING_VALUE_RANGE && strncmp(heard->place, finding->place, length) == 0 &&
            (!heard->place[length] || heard->place[length] == '/'))
            return true;
    }
    return false;
}

void doctor_unite(WeftDoctor *doctor) {
    int count = 0;
    for (int k = 0; k < doctor->count; k++) {
        if (doctor->items[k].kind == WEFT_FINDING_PART_REPAIRED && is_said(doctor, &doctor->items[k])) continue;
        doctor->items[count] = doctor->items[k];
        doctor->repairs[count++] = doctor->repairs[k];
    }
    doctor->count = count;
}

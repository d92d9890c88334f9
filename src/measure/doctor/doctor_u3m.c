/* doctor_u3m.c - findings in a U3M: what its readers do not agree on
 *
 * Vizoo and Browzwear, "Unified 3D Material", schema 1.1, 2020, and "Additional information": what a file has to have, and
 * what its numbers mean. The reader's own warnings are findings too. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/json.h"
#include "base/path.h"
#include "image/pixel.h"
#include "image/srgb.h"
#include "measure/doctor/doctor.h"
#include "scene/material/green.h"
#include "scene/material/u3m.h"
#include "scene/material/u3m_texture.h"
#include "scene/u3m/u3m_fields.h"

/* A U3M under examination. */
typedef struct U3mExam {
    WeftDoctor *doctor;
    U3mArchive *archive; /* NULL: the pictures lie beside path */
    const char *path;
    char *folder; /* of the .u3m, with a slash at its end, or "" */
} U3mExam;

/* A member of a visual part with a texture, and its picture. */
typedef struct U3mTextured {
    const U3mField *field;
    const json_t *member, *texture, *image;
    const char *place; /* a pointer to the member, without its first slash */
    const char *file;
    WeftImage pixels; /* none where the picture cannot be read */
    double mean[3];   /* of its channels */
} U3mTextured;

static Place at(const char *place) { return (Place){WEFT_OF_ASSET, 0, place}; }

static double number_at(const json_t *object, const char *key) {
    return json_number_value(json_object_get(object, key));
}

static double constant_of(const json_t *visual, const char *member) {
    return number_at(json_object_get(visual, member), "constant");
}

static bool has_texture(const json_t *visual, const char *member) {
    return json_is_object(json_object_get(json_object_get(visual, member), "texture"));
}

/* Receives the reader's warnings, which name a member as "front.roughness". */
static void hear(void *user, WeftMessage message, const char *text) {
    WeftDoctor *doctor = user;
    static const char unread[] = "its constant stands for the texture: ";
    const char *told = weft_message_text(message), *words = told[0] ? strstr(text, told) : NULL,
               *without = strstr(text, unread);
    if (doctor->log.fn) doctor->log.fn(doctor->log.user, message, text);
    if (message == WEFT_MESSAGE_DRAFT_COMPLETED) return; /* how weft shows it, and no fault of the file */
    words = words && strncmp(words + strlen(told), ": ", 2) == 0 ? words + strlen(told) + 2 : text;
    if (without) {
        doctor_found(doctor, WEFT_FINDING_IMAGE_UNREAD, at("material"), 0, (double)NAN, NULL, "%s", words);
        doctor_advise(doctor, "put the picture where the file names it, as PNG, JPEG or TIFF");
    } else if (message == WEFT_MESSAGE_PARAM_RANGE) {
        doctor_found(doctor, WEFT_FINDING_VALUE_RANGE, at("material"), 0, (double)NAN, NULL, "%s", text);
        doctor_soften(doctor);
        doctor_advise(doctor, "write a number that every reader takes: some clamp it and some do not");
    } else if (message != WEFT_MESSAGE_GLTF_WARN_REPAIRED) { /* a check says what is lacking */
        doctor_found(doctor, WEFT_FINDING_PART_IGNORED, at("material"), 0, (double)NAN, NULL, "%s", words);
        doctor_advise(doctor, "see docs/u3m.md for what is shown");
    }
}

/* Reads the picture of a texture, and the means of its channels. */
static void picture_read(const U3mExam *exam, U3mTextured *t) {
    char path[4096];
    FileBytes bytes = {0};
    if (!t->file || !u3m_path_inside(t->file)) return;
    snprintf(path, sizeof path, "%s%s", exam->folder, t->file);
    if (!exam->archive)
        weft_image_read(path, &t->pixels, NULL, NULL);
    else if (u3m_archive_read(exam->archive, path, &bytes, NULL) == WEFT_OK)
        weft_image_read_memory(bytes.data, bytes.size, path, &t->pixels, NULL, NULL);
    free(bytes.data);
    const size_t texels = (size_t)t->pixels.width * (size_t)t->pixels.height, channels = (size_t)t->pixels.channels;
    for (size_t k = 0; k < texels; k++)
        for (size_t c = 0; c < 3; c++) {
            const double x = pixel_value(&t->pixels, k * channels + (channels < 3 ? 0 : c));
            t->mean[c] += (t->field->kind == U3M_COLOR ? (double)srgb_decode((float)x) : x) / (double)texels;
        }
}

/* Finds pictures without a size, or with two that differ. */
static void check_size(WeftDoctor *doctor, const U3mTextured *t) {
    static const char *const sides[] = {"width", "height"}, *const axes[] = {"x", "y"};
    const json_t *dpi = json_object_get(t->image, "dpi");
    const int pixels[2] = {t->pixels.width, t->pixels.height};
    double worst = 1.0;
    for (int k = 0; k < 2; k++) {
        const double mm = number_at(t->image, sides[k]), dots = number_at(dpi, axes[k]);
        if (!(mm > 0.0)) {
            doctor_found(doctor, WEFT_FINDING_U3M_SIZE, at(t->place), 0, mm, NULL,
                         "the picture has no %s in millimetres: some readers take the dpi, others any size", sides[k]);
            doctor_advise(doctor, "write the millimetres of cloth that the picture shows");
            return;
        }
        const double ratio = pixels[k] && dots > 0.0 ? pixels[k] / dots * 25.4 / mm : 1.0;
        if (fabs(log(ratio)) > fabs(log(worst))) worst = ratio;
    }
    if (fabs(worst - 1.0) < 0.01) return;
    doctor_found(doctor, WEFT_FINDING_U3M_DPI, at(t->place), 0, worst, NULL,
                 "the dpi make the picture %.3g times as large as its millimetres: readers take the one or the other",
                 worst);
    doctor_advise(doctor, "write dpi as pixels / millimetres x 25.4");
}

/* Finds a repeat that simple readers do not have. */
static void check_repeat(WeftDoctor *doctor, const U3mTextured *t) {
    const json_t *repeat = json_object_get(t->image, "repeat");
    const char *mode = json_string_value(json_object_get(repeat, "mode"));
    const double rotation = number_at(repeat, "rotation");
    if ((!mode || strcmp(mode, "normal") == 0) && fabs(rotation) < 1e-6) return;
    doctor_found(doctor, WEFT_FINDING_U3M_REPEAT, at(t->place), 0, rotation, NULL,
                 "its repeat is %s, turned by %g degrees: readers that only wrap show seams", mode ? mode : "normal",
                 rotation);
    doctor_advise(doctor, "a picture that tiles by itself is alike everywhere");
}

/* Finds a constant that is another value than the texture, which some readers show in its place. */
static void check_constant(WeftDoctor *doctor, const U3mTextured *t) {
    static const char *const names[] = {"r", "g", "b"};
    const double limit = 0.1;
    const json_t *constant = json_object_get(t->member, "constant"), *factor = json_object_get(t->texture, "factor");
    double most = 0.0;
    if (!t->pixels.pixels || t->field->kind == U3M_NORMAL) return;
    if (t->field->kind == U3M_NUMBER) {
        const double mean = (t->mean[0] + t->mean[1] + t->mean[2]) / 3.0;
        most = fabs(json_number_value(constant) - json_number_value(factor) * mean - number_at(t->texture, "offset"));
    } else {
        const char *mode = json_string_value(json_object_get(t->texture, "mode"));
        if (!mode || strcmp(mode, "multiply") != 0) return;
        for (int c = 0; c < 3; c++) {
            const double by = (double)srgb_decode((float)number_at(factor, names[c])),
                         is = (double)srgb_decode((float)number_at(constant, names[c]));
            most = fmax(most, fabs(is - by * t->mean[c]));
        }
    }
    if (!(most > limit)) return;
    doctor_found(doctor, WEFT_FINDING_U3M_CONSTANT, at(t->place), 0, most, NULL,
                 "the constant differs by %.2g from the mean of the texture, which readers without textures show",
                 most);
    doctor_advise(doctor, "write the mean of the texture, its factor applied, as the constant");
}

/* Finds numbers in pictures whose channels differ: by the specification their mean counts. */
static void check_colored(WeftDoctor *doctor, const U3mTextured *t) {
    if (!t->pixels.pixels || t->field->kind != U3M_NUMBER) return;
    const double spread =
        fmax(t->mean[0], fmax(t->mean[1], t->mean[2])) - fmin(t->mean[0], fmin(t->mean[1], t->mean[2]));
    if (spread < 0.02 || u3m_texture_grey(&t->pixels)) return;
    doctor_found(doctor, WEFT_FINDING_U3M_CHANNELS, at(t->place), 0, spread, NULL,
                 "the channels of its picture have the means %.2g, %.2g and %.2g: the mean of all counts, and some "
                 "readers take red",
                 t->mean[0], t->mean[1], t->mean[2]);
    doctor_advise(doctor, "write a grey picture; one that packs several numbers does not fit");
}

static void check_mode(WeftDoctor *doctor, const U3mTextured *t) {
    const char *mode = json_string_value(json_object_get(t->texture, "mode"));
    if (t->field->kind != U3M_COLOR || !mode || strcmp(mode, "multiply") == 0) return;
    doctor_found(doctor, WEFT_FINDING_U3M_MODE, at(t->place), 0, (double)NAN, NULL,
                 "the picture and its factor are mixed by %s, which readers that only multiply do not do", mode);
    doctor_advise(doctor, "mix it into the picture, and write multiply with the factor 1");
}

static void check_gloss(WeftDoctor *doctor, const U3mTextured *t) {
    const char *name = t->field->name, *file = t->file;
    const double factor = number_at(t->texture, "factor");
    if (!file || !strstr(name, "roughness") || !(factor > 0.0)) return;
    for (; *file; file++)
        if (strncasecmp(file, "gloss", 5) == 0 || strncasecmp(file, "smoothness", 10) == 0) break;
    if (!*file) return;
    doctor_found(doctor, WEFT_FINDING_U3M_GLOSS, at(t->place), 0, (double)NAN, NULL,
                 "its picture is called %.80s: gloss is 1 - roughness", t->file);
    doctor_advise(doctor, "write the factor -1 and the offset 1, or a picture of the roughness");
}

/* Finds normals with green down, or that went through the curve of colours: flat ones are then 0.73, not 0.5. */
static void check_normals(WeftDoctor *doctor, const U3mTextured *t) {
    if (!t->pixels.pixels || t->field->kind != U3M_NORMAL || t->pixels.channels < 3) return;
    if (fabs(t->mean[0] - 0.735) < 0.06 && fabs(t->mean[1] - 0.735) < 0.06) {
        doctor_found(doctor, WEFT_FINDING_U3M_NORMAL_SPACE, at(t->place), 0, t->mean[0], NULL,
                     "red and green have the mean %.2g: the normals were encoded in sRGB as colours are",
                     0.5 * (t->mean[0] + t->mean[1]));
        doctor_advise(doctor, "write them without a curve: 0.5, 0.5, 1 is flat");
    } else if (normals_green_down(&t->pixels)) {
        doctor_found(
            doctor, WEFT_FINDING_U3M_GREEN, at(t->place), 0, (double)NAN, NULL,
            "by its slopes green points down, as in DirectX: U3M's normals are OpenGL's, and relief looks dented");
        doctor_advise(doctor, "write 1 - green");
    }
}

static void check_texture(const U3mExam *exam, const U3mField *field, const json_t *member, const char *place) {
    static void (*const checks[])(WeftDoctor *, const U3mTextured *) = {
        check_size, check_repeat, check_constant, check_colored, check_mode, check_gloss, check_normals};
    U3mTextured t = {.field = field, .member = member, .texture = json_object_get(member, "texture"), .place = place};
    t.image = json_object_get(t.texture, "image");
    t.file = json_string_value(json_object_get(t.image, "path"));
    picture_read(exam, &t);
    for (size_t k = 0; k < sizeof checks / sizeof *checks; k++) checks[k](exam->doctor, &t);
    weft_image_free(&t.pixels);
}

/* Finds a specular_value beyond what it means, or that is in the range of reflectances of cloth themselves. */
static void check_specular(WeftDoctor *doctor, const json_t *visual, const char *part) {
    char place[96];
    const double value = constant_of(visual, "specular_value");
    snprintf(place, sizeof place, "material/%s/specular_value", part);
    if (has_texture(visual, "specular_value") || !json_object_get(visual, "specular_value")) return;
    if (value < 0.0 || value > 1.0)
        doctor_found(doctor, WEFT_FINDING_U3M_SPECULAR, at(place), 0, value, NULL,
                     "it is %g, a reflectance of %.3g %%: 0 to 1 is 0 to 8 %%, and readers clamp others or do not",
                     value, 8.0 * value);
    else if (value >= 0.02 && value <= 0.08)
        doctor_found(doctor, WEFT_FINDING_U3M_SPECULAR, at(place), 0, value, NULL,
                     "it is %g, a reflectance of %.2g %%: some programs write the reflectance itself here, of which %g "
                     "is usual",
                     value, 8.0 * value, value);
    else
        return;
    doctor_advise(doctor, "write the reflectance over 8 %%: 0.5 is 4 %%");
}

/* Finds a sheen of the tint 0: Burley's default is 0.5, and programs disagree on which counts. */
static void check_tint(WeftDoctor *doctor, const json_t *visual, const char *part) {
    char place[96];
    const bool sheen = constant_of(visual, "sheen_value") > 0.0 || has_texture(visual, "sheen_value");
    if (!sheen || constant_of(visual, "sheen_tint") > 0.0 || has_texture(visual, "sheen_tint")) return;
    snprintf(place, sizeof place, "material/%s/sheen_tint", part);
    doctor_found(
        doctor, WEFT_FINDING_U3M_TINT, at(place), 0, 0.0, NULL,
        "the sheen is white: 0 is the schema's default, 0.5 that of the shader, and programs that drop defaults "
        "show another hue");
    doctor_advise(doctor, "a tint that is no default, such as 0.01, is read alike");
}

/* Finds a coat without normals of its own over a base with some, which programs take for the coat too, or not. */
static void check_coat(WeftDoctor *doctor, const json_t *visual, const char *part) {
    char place[96];
    const bool coat = constant_of(visual, "clearcoat_value") > 0.0 || has_texture(visual, "clearcoat_value");
    if (!coat || !has_texture(visual, "normal") || has_texture(visual, "clearcoat_normal")) return;
    snprintf(place, sizeof place, "material/%s/clearcoat_normal", part);
    doctor_found(doctor, WEFT_FINDING_U3M_COAT_NORMAL, at(place), 0, (double)NAN, NULL,
                 "the coat is flat here, and some programs give it the base's normals");
    doctor_advise(doctor, "write the normals that the coat has");
}

static void check_visual(const U3mExam *exam, const char *part, const json_t *visual) {
    WeftDoctor *doctor = exam->doctor;
    for (int k = 0; u3m_field(k); k++) {
        const U3mField *field = u3m_field(k);
        const json_t *member = json_object_get(visual, field->name);
        char place[96];
        if (k && strcmp(field->name, u3m_field(k - 1)->name) == 0) continue;
        snprintf(place, sizeof place, "material/%s/%s", part, field->name);
        if (!member) {
            doctor_found(doctor, WEFT_FINDING_U3M_MEMBER, at(place), 0, (double)NAN, NULL,
                         "it is lacking: readers take their own default, or refuse the file");
            doctor_advise(doctor, "write it, with its default where nothing else is meant");
        } else if (has_texture(visual, field->name)) {
            check_texture(exam, field, member, place);
            doctor->asset.image_count++;
        }
    }
    check_specular(doctor, visual, part);
    check_tint(doctor, visual, part);
    check_coat(doctor, visual, part);
}

/* Finds members at the top and of the material that the schema demands. */
static void check_members(WeftDoctor *doctor, const json_t *object, const char *of, const char *const *names) {
    for (; *names; names++) {
        char place[96];
        if (json_object_get(object, *names)) continue;
        snprintf(place, sizeof place, "%s%s%s", of, of[0] ? "/" : "", *names);
        doctor_found(doctor, WEFT_FINDING_U3M_MEMBER, at(place), 0, (double)NAN, NULL,
                     "it is lacking, and strict readers refuse the file");
        doctor_advise(doctor, "write it; null where there is nothing to say of a part, physics, metadata or custom");
    }
}

/* Puts the member before the words of findings about one, "front.roughness: ", as the reader has it. */
static void members_say(WeftDoctor *doctor) {
    for (int k = 0; k < doctor->count; k++) {
        WeftFinding *finding = &doctor->items[k];
        char part[16], member[40], words[sizeof finding->words];
        if (sscanf(finding->place, "/material/%15[^/]/%39s", part, member) != 2) continue;
        memcpy(words, finding->words, sizeof words);
        snprintf(finding->words, sizeof finding->words, "%s.%s: %.320s", part, member, words);
    }
}

static void examine(U3mExam *exam, const json_t *root) {
    static const char *const parts[] = {"front", "back", "side"}, *const top[] = {"schema", "material", "custom", NULL},
                             *const needed[] = {"id",   "name", "description", "created",  "modified", "front",
                                                "back", "side", "physics",     "metadata", NULL};
    const json_t *material = json_object_get(root, "material");
    check_members(exam->doctor, root, "", top);
    check_members(exam->doctor, material, "material", needed);
    for (int k = 0; k < 3; k++) {
        const json_t *visual = json_object_get(material, parts[k]);
        if (json_is_object(visual)) check_visual(exam, parts[k], visual);
    }
    members_say(exam->doctor);
}

/* Opens the archive of an exam, where the file is one, and sets the folder of its .u3m. */
static WeftResult pictures_open(U3mExam *exam, FileBytes *bytes, WeftError *error) {
    const char *where = exam->path;
    if (path_ends(exam->path, ".u3ma")) {
        WeftResult result = file_read(exam->path, (size_t)1 << 30, bytes, error);
        if (result == WEFT_OK) result = u3m_archive_open(bytes->data, bytes->size, exam->path, &exam->archive, error);
        if (result != WEFT_OK) return result;
        where = u3m_archive_material(exam->archive);
    }
    const char *slash = strrchr(where, '/');
    exam->folder = strndup(where, slash ? (size_t)(slash + 1 - where) : 0);
    exam->doctor->failed |= !exam->folder;
    return WEFT_OK;
}

WeftResult doctor_u3m(WeftDoctor *doctor, const char *path, WeftError *error) {
    const WeftLog log = {hear, doctor};
    U3mExam exam = {.doctor = doctor, .path = path};
    FileBytes bytes = {0};
    MaterialFile file;
    WeftResult result = u3m_load(path, &file, &log, error);
    if (result == WEFT_OK) result = pictures_open(&exam, &bytes, error);
    if (result == WEFT_OK && !doctor->failed) {
        json_error_t where;
        bool starved;
        json_t *root = json_parse(file.u3m->text, file.u3m->size, 0, &where, &starved);
        doctor->failed |= !root;
        doctor->asset.material_count = 1;
        if (root) examine(&exam, root);
        json_decref(root);
    }
    material_file_free(&file);
    u3m_archive_close(exam.archive);
    free(exam.folder);
    free(bytes.data);
    return result;
}

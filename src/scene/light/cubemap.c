#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "scene/light/cubemap.h"

#include "base/fail.h"
#include "base/file.h"
#include "base/little_endian.h"
#include "base/memory.h"
#include "image/ktx2/ktx2.h"
#include "scene/light/env_split.h"

enum { FACES = 6, NAME_SIZE = 1024 };

static const char *const long_names[FACES] = {"posx", "negx", "posy", "negy", "posz", "negz"};
static const char *const short_names[FACES] = {"px", "nx", "py", "ny", "pz", "nz"};

/* The formats of image/, without .npy, which no camera makes. */
static const char *const suffixes[] = {"exr", "hdr", "png", "jpg", "jpeg", "tga", "ktx2"};

typedef struct Faces {
    char paths[FACES][NAME_SIZE];
    bool shorter; /* true for the shorter kind of names */
} Faces;

/* Returns the face that a file name without its folder stands for, or -1. */
static int face_named(const char *name, bool shorter) {
    const char *dot = strrchr(name, '.');
    size_t stem = dot ? (size_t)(dot - name) : 0, matches = 0;
    for (size_t k = 0; dot && k < sizeof suffixes / sizeof suffixes[0]; k++)
        matches += strcasecmp(dot + 1, suffixes[k]) == 0;
    for (int k = 0; matches && k < FACES; k++) {
        const char *face = shorter ? short_names[k] : long_names[k];
        if (strlen(face) == stem && strncasecmp(name, face, stem) == 0) return k;
    }
    return -1;
}

static bool is_folder(const char *path) {
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

static const char *file_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Returns true if the path is a KTX 2 file of six faces. */
static bool is_ktx2_cube(const char *path) {
    FileBytes start = {0};
    if (file_read_start(path, 40, &start, NULL) != WEFT_OK) return false;
    const bool cube =
        start.size == 40 && ktx2_starts(start.data, start.size) && little_endian(start.data + 36, 4) == FACES;
    free(start.data);
    return cube;
}

bool cubemap_named(const char *path) {
    const char *name = file_name(path);
    return is_folder(path) || is_ktx2_cube(path) || face_named(name, false) >= 0 || face_named(name, true) >= 0;
}

/* Finds the faces in a folder by one kind of names. Returns their number, or -1 after a failure. */
static int look_through(const char *folder, bool shorter, Faces *faces, WeftError *error) {
    DIR *list = opendir(folder);
    int found = 0;
    *faces = (Faces){.shorter = shorter};
    if (!list) {
        fail(error, WEFT_MESSAGE_FILE_OPEN, folder, NULL);
        return -1;
    }
    for (struct dirent *entry; found >= 0 && (entry = readdir(list));) {
        int k = face_named(entry->d_name, shorter);
        if (k < 0) continue;
        char *path = faces->paths[k];
        if (path[0]) {
            fail(error, WEFT_MESSAGE_CUBEMAP, folder, "%s is there twice", shorter ? short_names[k] : long_names[k]);
            found = -1;
        } else if ((size_t)snprintf(path, NAME_SIZE, "%s/%s", folder, entry->d_name) >= NAME_SIZE) {
            fail(error, WEFT_MESSAGE_FILE_OPEN, folder, "its name is too long");
            found = -1;
        } else {
            found++;
        }
    }
    closedir(list);
    return found;
}

/* Finds the faces. In a folder with both kinds of names it takes the kind that more faces have; for a face
 * its own kind. */
static WeftResult find_faces(const char *path, Faces *faces, WeftError *error) {
    char folder[NAME_SIZE];
    WeftError local = {0};
    bool whole = is_folder(path);
    int length = whole ? (int)strlen(path) : (int)(file_name(path) - path);
    if ((size_t)snprintf(folder, sizeof folder, "%.*s", length > 0 ? length : 1, length > 0 ? path : ".") >=
        sizeof folder)
        return fail(error, WEFT_MESSAGE_FILE_OPEN, path, "its name is too long");
    bool shorter = !whole && face_named(file_name(path), true) >= 0;
    int found = look_through(folder, shorter, faces, &local);
    if (whole && found >= 0 && found < FACES) {
        Faces other;
        int more = look_through(folder, true, &other, &local);
        if (more > found) *faces = other;
        if (more < 0 || more > found) found = more;
    }
    for (int k = 0; k < FACES && found >= 0; k++)
        if (!faces->paths[k][0])
            return fail(error, WEFT_MESSAGE_CUBEMAP, path, "%s is missing",
                        faces->shorter ? short_names[k] : long_names[k]);
    if (found < 0 && error) *error = local;
    return found < 0 ? local.result : WEFT_OK;
}

static WeftResult read_face(const char *path, int side, WeftImage *out, const WeftLog *log, WeftError *error) {
    WeftImage raw;
    WeftResult result = weft_image_read(path, &raw, log, error);
    if (result != WEFT_OK) return result;
    if (raw.width != raw.height)
        result = fail(error, WEFT_MESSAGE_CUBEMAP, path, "it is %d by %d and not square", raw.width, raw.height);
    else if (side && raw.width != side)
        result = fail(error, WEFT_MESSAGE_CUBEMAP, path, "it is %d wide and the first face %d", raw.width, side);
    else
        result = weft_image_convert_f32(&raw, 1, out, error);
    weft_image_free(&raw);
    return result;
}

/* Reads the faces of six files, whose names are found. */
static WeftResult read_files(const char *path, Faces *names, WeftImage faces[FACES], const WeftLog *log,
                             WeftError *error) {
    WeftResult result = find_faces(path, names, error);
    for (int k = 0; k < FACES && result == WEFT_OK; k++)
        result = read_face(names->paths[k], k ? faces[0].width : 0, &faces[k], log, error);
    return result;
}

/* Reads the faces of one KTX 2 file, of its first level. */
static WeftResult read_ktx2(const char *path, WeftImage faces[FACES], const WeftLog *log, WeftError *error) {
    FileBytes bytes;
    Ktx2 file;
    WeftResult result = file_read(path, (size_t)1 << 30, &bytes, error);
    if (result != WEFT_OK) return result;
    const ImageSource source = {.data = bytes.data, .size = bytes.size, .name = path, .log = log};
    result = ktx2_open(&source, &file, error);
    for (int k = 0; k < FACES && result == WEFT_OK; k++) {
        WeftImage raw;
        result = ktx2_picture(&file, 0, k, &raw, error);
        if (result == WEFT_OK) result = weft_image_convert_f32(&raw, !file.linear, &faces[k], error);
        weft_image_free(&raw);
    }
    free(bytes.data);
    return result;
}

/* Returns the face that direction d meets, and sets the place on it, from -1 to 1 towards the right and down. */
static int face_at(Vec3 d, float *right, float *down) {
    float x = fabsf(d.x), y = fabsf(d.y), z = fabsf(d.z);
    if (x >= y && x >= z) {
        *right = d.x > 0.0f ? -d.z / x : d.z / x;
        *down = -d.y / x;
        return d.x > 0.0f ? 0 : 1;
    }
    if (y >= z) {
        *right = d.x / y;
        *down = d.y > 0.0f ? d.z / y : -d.z / y;
        return d.y > 0.0f ? 2 : 3;
    }
    *right = d.z > 0.0f ? d.x / z : -d.x / z;
    *down = -d.y / z;
    return d.z > 0.0f ? 4 : 5;
}

/* Adds the radiance from direction d, bilinear within a face, times scale. */
static void add_radiance(const WeftImage faces[FACES], Vec3 d, float scale, float *to) {
    float right, down;
    const WeftImage *face = &faces[face_at(d, &right, &down)];
    float most = (float)(face->width - 1), half = 0.5f * (float)face->width;
    float x = fminf(fmaxf((right + 1.0f) * half - 0.5f, 0.0f), most);
    float y = fminf(fmaxf((down + 1.0f) * half - 0.5f, 0.0f), most);
    int x0 = (int)x, y0 = (int)y, x1 = x0 < face->width - 1 ? x0 + 1 : x0, y1 = y0 < face->width - 1 ? y0 + 1 : y0;
    float fx = x - (float)x0, fy = y - (float)y0;
    const float weights[4] = {(1.0f - fx) * (1.0f - fy), fx * (1.0f - fy), (1.0f - fx) * fy, fx * fy};
    const int columns[4] = {x0, x1, x0, x1}, rows[4] = {y0, y0, y1, y1};
    for (int k = 0; k < 4; k++) {
        const float *p = (const float *)face->pixels +
                         ((size_t)rows[k] * (size_t)face->width + (size_t)columns[k]) * (size_t)face->channels;
        for (int c = 0; c < 3; c++) to[c] += scale * weights[k] * p[face->channels >= 3 ? c : 0];
    }
}

/* Fills the image from four look-ups a texel, since texels at a face's corners are smaller than those of the image. */
static void resample(const WeftImage faces[FACES], WeftImage *out) {
    float *p = out->pixels;
    for (int y = 0; y < out->height; y++)
        for (int x = 0; x < out->width; x++, p += 3)
            for (int k = 0; k < 4; k++) {
                double u = (x + 0.25 + 0.5 * (k & 1)) / out->width, v = (y + 0.25 + 0.5 * (k >> 1)) / out->height;
                add_radiance(faces, latlong_direction(u, v), 0.25f, p);
            }
}

WeftResult cubemap_read(const char *path, WeftImage *out, const WeftLog *log, WeftError *error) {
    Faces *names = alloc_array(1, sizeof *names);
    WeftImage faces[FACES] = {{0}};
    *out = (WeftImage){0};
    if (!names) return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    WeftResult result =
        is_ktx2_cube(path) ? read_ktx2(path, faces, log, error) : read_files(path, names, faces, log, error);
    if (result == WEFT_OK) {
        int width = faces[0].width < CUBEMAP_WIDTH / 4 ? 4 * faces[0].width : CUBEMAP_WIDTH;
        result = weft_image_create(width, width / 2, 3, WEFT_PIXEL_F32, out, error);
    }
    if (result == WEFT_OK) resample(faces, out);
    for (int k = 0; k < FACES; k++) weft_image_free(&faces[k]);
    free(names);
    return result;
}

/* judge_objects.c - finds the objects that a picture shows, their interiors and the cells of these */
#include <math.h>
#include <stdlib.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/thread.h"
#include "measure/judge/judge.h"
#include "scene/record/camera.h"
#include "trace/geometry/geometry.h"

/* A picture of the numbers of meshes. */
typedef struct MeshMap {
    const Geometry *geometry;
    View view;
    int width, height, *meshes; /* meshes: of each pixel, -1 where there is none */
} MeshMap;

static void map_row(void *user, int y, int thread) {
    const MeshMap *map = user;
    (void)thread;
    for (int x = 0; x < map->width; x++) {
        const float u = 2.0f * ((float)x + 0.5f) / (float)map->width - 1.0f;
        const float v = 1.0f - 2.0f * ((float)y + 0.5f) / (float)map->height;
        const CameraRay through = view_ray(&map->view, u, v);
        const Ray ray = {.origin = through.origin, .direction = through.direction, .far = INFINITY};
        Hit hit;
        const bool any = geometry_hit(map->geometry, ray, &hit);
        map->meshes[(size_t)y * (size_t)map->width + (size_t)x] = any ? (int)hit.mesh : -1;
    }
}

/* Fills the numbers of the meshes behind the middles of the pixels; hair and the shapes of lights are left out. */
static WeftResult map_meshes(const WeftJudge *judge, int *meshes, WeftError *error) {
    const WeftRenderDesc *desc = &judge->desc.render;
    const float aspect = (float)desc->width / (float)desc->height;
    Geometry *geometry = NULL;
    Camera camera;
    WeftResult result = camera_find(judge->scene, desc->camera, aspect, &camera, error);
    if (result == WEFT_OK)
        result = geometry_create(judge->scene, scene_own_meshes(judge->scene), desc->threads, &geometry, error);
    if (result != WEFT_OK) return result;
    MeshMap map = {geometry, view_of(&camera, aspect), desc->width, desc->height, meshes};
    parallel_for(desc->threads, desc->height, map_row, &map);
    geometry_free(geometry);
    return WEFT_OK;
}

/* Returns true if all pixels about (x, y) show the mesh of that pixel. */
static bool is_interior(const WeftJudge *judge, const int *meshes, int x, int y) {
    const int width = judge->desc.render.width, height = judge->desc.render.height;
    const int mesh = meshes[(size_t)y * (size_t)width + (size_t)x];
    if (mesh < 0) return false;
    if (x < WEFT_JUDGE_MARGIN || y < WEFT_JUDGE_MARGIN || x >= width - WEFT_JUDGE_MARGIN ||
        y >= height - WEFT_JUDGE_MARGIN)
        return false;
    for (int j = y - WEFT_JUDGE_MARGIN; j <= y + WEFT_JUDGE_MARGIN; j++)
        for (int i = x - WEFT_JUDGE_MARGIN; i <= x + WEFT_JUDGE_MARGIN; i++)
            if (meshes[(size_t)j * (size_t)width + (size_t)i] != mesh) return false;
    return true;
}

/* Counts the pixels of each mesh, and sums the places of its interior's. */
typedef struct MeshCount {
    int seen, pixels, object; /* object: -1: none */
    double x, y;
} MeshCount;

static void count_meshes(const WeftJudge *judge, const int *meshes, MeshCount *counts) {
    const int width = judge->desc.render.width, height = judge->desc.render.height;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const int mesh = meshes[(size_t)y * (size_t)width + (size_t)x];
            if (mesh < 0) continue;
            counts[mesh].seen++;
            if (!is_interior(judge, meshes, x, y)) continue;
            counts[mesh].pixels++;
            counts[mesh].x += (double)x + 0.5;
            counts[mesh].y += (double)y + 0.5;
        }
}

/* Makes an object of each mesh whose interior is large enough. */
static WeftResult make_objects(WeftJudge *judge, MeshCount *counts, WeftError *error) {
    const WeftScene *scene = judge->scene;
    const int own = scene_own_meshes(scene);
    judge->objects = alloc_array((size_t)own, sizeof(WeftJudgeObject));
    if (!judge->objects) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    for (int k = 0; k < own; k++) {
        MeshCount *count = &counts[k];
        const Mesh *mesh = &scene->meshes[k];
        count->object = -1;
        if (count->pixels < WEFT_JUDGE_PIXELS_LEAST) {
            judge->left_out += count->seen > 0;
            continue;
        }
        count->object = judge->object_count;
        judge->objects[judge->object_count++] = (WeftJudgeObject){.name = mesh->name,
                                                                  .material = scene->material_names[mesh->material],
                                                                  .mesh = k,
                                                                  .material_index = mesh->material,
                                                                  .pixels = count->pixels,
                                                                  .x = (float)(count->x / count->pixels),
                                                                  .y = (float)(count->y / count->pixels)};
    }
    if (judge->object_count) return WEFT_OK;
    return fail(error, WEFT_MESSAGE_DESC, scene->name,
                "no object covers %d pixels without its outline; make the picture larger or move the camera closer",
                WEFT_JUDGE_PIXELS_LEAST);
}

/* Returns the cell of an object among those from `first` on, which it adds if there is none. */
static int cell_at(WeftJudge *judge, int first, int object) {
    for (int k = first; k < judge->cell_count; k++)
        if (judge->cells[k].object == object) return k;
    judge->cells[judge->cell_count] = (JudgeCell){.object = object};
    return judge->cell_count++;
}

/* Puts the pixels of a square into cells. */
static void make_cells_of(WeftJudge *judge, const int *meshes, const MeshCount *counts, int left, int top) {
    const int width = judge->desc.render.width, height = judge->desc.render.height, first = judge->cell_count;
    for (int y = top; y < top + WEFT_JUDGE_CELL && y < height; y++)
        for (int x = left; x < left + WEFT_JUDGE_CELL && x < width; x++) {
            const size_t at = (size_t)y * (size_t)width + (size_t)x;
            const int object = is_interior(judge, meshes, x, y) ? counts[meshes[at]].object : -1;
            judge->cell_of[at] = -1;
            if (object < 0) continue;
            judge->cell_of[at] = cell_at(judge, first, object);
            judge->cells[judge->cell_of[at]].pixels++;
        }
}

static WeftResult make_cells(WeftJudge *judge, const int *meshes, const MeshCount *counts, WeftError *error) {
    const int width = judge->desc.render.width, height = judge->desc.render.height;
    const size_t pixels = (size_t)width * (size_t)height;
    judge->cell_of = alloc_array(pixels, sizeof(int));
    judge->cells = alloc_array(pixels, sizeof(JudgeCell));
    if (!judge->cell_of || !judge->cells) return fail(error, WEFT_MESSAGE_MEMORY, judge->scene->name, NULL);
    for (int y = 0; y < height; y += WEFT_JUDGE_CELL)
        for (int x = 0; x < width; x += WEFT_JUDGE_CELL) make_cells_of(judge, meshes, counts, x, y);
    return WEFT_OK;
}

WeftResult judge_find_objects(WeftJudge *judge, WeftError *error) {
    const size_t pixels = (size_t)judge->desc.render.width * (size_t)judge->desc.render.height;
    int *meshes = alloc_array(pixels, sizeof(int));
    MeshCount *counts = alloc_array((size_t)scene_own_meshes(judge->scene), sizeof(MeshCount));
    WeftResult result = meshes && counts ? map_meshes(judge, meshes, error)
                                         : fail(error, WEFT_MESSAGE_MEMORY, judge->scene->name, NULL);
    if (result == WEFT_OK && meshes && counts) {
        count_meshes(judge, meshes, counts);
        result = make_objects(judge, counts, error);
    }
    if (result == WEFT_OK && meshes && counts) result = make_cells(judge, meshes, counts, error);
    free(meshes);
    free(counts);
    return result;
}

void judge_cells(const WeftJudge *judge, const WeftImage *image, CellMean *means) {
    const size_t pixels = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    const float *values = image->pixels;
    for (int k = 0; k < judge->cell_count; k++)
        for (int c = 0; c < JUDGE_CHANNELS; c++) means[k].c[c] = 0.0;
    for (size_t at = 0; at < pixels; at++) {
        const int cell = judge->cell_of[at];
        if (cell < 0) continue;
        for (size_t c = 0; c < JUDGE_CHANNELS; c++)
            means[cell].c[c] += (double)values[at * channels + (channels < 3 ? 0 : c)] / judge->cells[cell].pixels;
    }
}

void judge_object_mean(const WeftJudge *judge, int object, const CellMean *means, double mean[JUDGE_CHANNELS]) {
    const double pixels = judge->objects[object].pixels;
    for (int c = 0; c < JUDGE_CHANNELS; c++) mean[c] = 0.0;
    for (int k = 0; k < judge->cell_count; k++) {
        if (judge->cells[k].object != object) continue;
        for (int c = 0; c < JUDGE_CHANNELS; c++) mean[c] += means[k].c[c] * judge->cells[k].pixels / pixels;
    }
}

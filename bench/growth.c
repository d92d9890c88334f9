/* growth - builds and renders a rippled ball of about N triangles and prints one row of figures:
 *
 *   bench_growth TRIANGLES THREADS
 *   triangles  load s  build s  M samples/s  M rays/s  peak MiB
 *
 * The ball is a GLB made in memory, so that the row is what loading a file of that size costs. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "base/steady_clock.h"
#include "weft/weft.h"

static void put(unsigned char **at, const void *bytes, size_t size) {
    memcpy(*at, bytes, size);
    *at += size;
}

/* A GLB of a sphere with ripples, positions and normals, rings x 2 rings quads. */
static unsigned char *make_glb(uint32_t rings, size_t *size) {
    uint32_t sectors = 2 * rings, across = sectors + 1, vertices = (rings + 1) * across, indices = 6 * rings * sectors;
    size_t positions = 12 * (size_t)vertices, bin = 2 * positions + 4 * (size_t)indices;
    char json[2048];
    int length =
        snprintf(json, sizeof json,
                 "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
                 "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.1,0.1,1],\"metallicFactor\":0,"
                 "\"roughnessFactor\":0.8},\"extensions\":{\"KHR_materials_sheen\":{\"sheenColorFactor\":[0.8,0.7,0.6]"
                 ","
                 "\"sheenRoughnessFactor\":0.5}}}],\"extensionsUsed\":[\"KHR_materials_sheen\"],"
                 "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1},\"indices\":2,"
                 "\"material\":0}]}],"
                 "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":%u,\"type\":\"VEC3\"},"
                 "{\"bufferView\":1,\"componentType\":5126,\"count\":%u,\"type\":\"VEC3\"},"
                 "{\"bufferView\":2,\"componentType\":5125,\"count\":%u,\"type\":\"SCALAR\"}],"
                 "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":%zu},"
                 "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu},{\"buffer\":0,\"byteOffset\":%zu,"
                 "\"byteLength\":%zu}],"
                 "\"buffers\":[{\"byteLength\":%zu}]}",
                 vertices, vertices, indices, positions, positions, positions, 2 * positions, 4 * (size_t)indices, bin);
    while (length % 4) json[length++] = ' ';
    *size = 12 + 8 + (size_t)length + 8 + bin;
    unsigned char *glb = malloc(*size), *at = glb;
    if (!glb) return NULL;
    put(&at, (uint32_t[]){0x46546c67u, 2, (uint32_t)*size, (uint32_t)length, 0x4e4f534au}, 20);
    put(&at, json, (size_t)length);
    put(&at, (uint32_t[]){(uint32_t)bin, 0x004e4942u}, 8);
    for (int attribute = 0; attribute < 2; attribute++)
        for (uint32_t k = 0; k < vertices; k++) {
            float theta = 3.14159265f * (float)(k / across) / (float)rings;
            float phi = 6.28318531f * (float)(k % across) / (float)sectors;
            float r = attribute ? 1.0f : 1.0f + 0.03f * sinf(14.0f * theta) * cosf(11.0f * phi);
            put(&at, (float[]){r * sinf(theta) * sinf(phi), r * cosf(theta), r * sinf(theta) * cosf(phi)}, 12);
        }
    for (uint32_t k = 0; k < rings * sectors; k++) {
        uint32_t a = k / sectors * across + k % sectors, b = a + across;
        put(&at, (uint32_t[]){a, b, a + 1, a + 1, b, b + 1}, 24);
    }
    return glb;
}

int main(int argc, char **argv) {
    if (argc != 3) {
        fputs("bench_growth TRIANGLES THREADS\n", stderr);
        return WEFT_USAGE;
    }
    enum { WIDTH = 640, HEIGHT = 480, SPP = 16 };
    uint32_t rings = (uint32_t)sqrt(atof(argv[1]) / 4.0);
    size_t size;
    unsigned char *glb = make_glb(rings < 4 ? 4 : rings, &size);
    WeftError error;
    WeftScene *scene = NULL;
    WeftRender *render = NULL;
    double start = clock_now();
    WeftResult result = glb ? weft_scene_load_memory(glb, size, "ball", &scene, NULL, &error) : WEFT_RESOURCES;
    double loaded = clock_now();
    free(glb);
    if (result == WEFT_OK)
        result = weft_render_create(
            scene, &(WeftRenderDesc){.width = WIDTH, .height = HEIGHT, .threads = atoi(argv[2])}, &render, &error);
    if (result != WEFT_OK) {
        fprintf(stderr, "bench_growth: %s\n", glb ? error.text : "out of memory");
        return (int)result;
    }
    weft_render_run(render, SPP, 0.0, NULL, NULL);
    WeftRenderInfo info = weft_render_info(render);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    printf("%9lld  %7.3f  %7.3f  %11.2f  %8.2f  %8.0f\n", weft_scene_info(scene).triangle_count, loaded - start,
           info.build_seconds, info.samples_per_pixel * WIDTH * HEIGHT / info.render_seconds * 1e-6,
           (double)info.rays / info.render_seconds * 1e-6, (double)usage.ru_maxrss / 1024.0);
    weft_render_free(render);
    weft_scene_free(scene);
    return 0;
}

#include "raster/light/ray_panes.h"

#include "raster/light/triangle_points.h"
#include "scene/light/pane.h"

/* Returns by how many steps a triangle is divided for its mean. */
static int steps_of(const WeftScene *scene, const Mesh *mesh) {
    const Material *material = &scene->materials[mesh->material];
    bool varies = mesh->color != NULL;
    for (int k = 0; k < INPUT_COUNT; k++) varies |= material->inputs[k].texture != 0;
    return varies ? 6 : 1;
}

/* Interpolates texture coordinates and colours. */
static void interpolate(const Mesh *mesh, uint32_t triangle, const float weight[3], float uv[2][2], float color[4]) {
    for (size_t corner = 0; corner < 3; corner++) {
        const size_t vertex = mesh->index[3 * (size_t)triangle + corner];
        for (size_t k = 0; k < 4; k++) {
            const float *texcoord = mesh->texcoord[k / 2];
            if (texcoord) uv[k / 2][k % 2] += weight[corner] * texcoord[2 * vertex + k % 2];
            color[k] += weight[corner] * (mesh->color ? mesh->color[4 * vertex + k] : 1.0f);
        }
    }
}

static void add(float sum[3], Rgb c, float share) {
    sum[0] += share * c.r, sum[1] += share * c.g, sum[2] += share * c.b;
}

void ray_pane_triangle(const WeftScene *scene, const Mesh *mesh, uint32_t triangle, float facing[3], float grazing[3]) {
    const int steps = steps_of(scene, mesh), count = steps * steps;
    facing[0] = facing[1] = facing[2] = grazing[0] = grazing[1] = grazing[2] = 0.0f;
    for (int k = 0; k < count; k++) {
        float weight[3], uv[2][2] = {{0.0f}}, color[4] = {0.0f};
        triangle_point(k, steps, weight);
        interpolate(mesh, triangle, weight, uv, color);
        add(facing, pane_transmittance(scene, mesh->material, uv, color, 1.0f), 1.0f / (float)count);
        add(grazing, pane_transmittance(scene, mesh->material, uv, color, 0.0f), 1.0f / (float)count);
    }
}

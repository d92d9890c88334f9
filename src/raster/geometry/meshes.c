#include "raster/geometry/meshes.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include <epoxy/gl.h>

#include "base/fail.h"
#include "base/memory.h"
#include "base/random.h"
#include "image/half.h"
#include "raster/geometry/occlusion.h"
#include "raster/gl/gl_check.h"
#include "scene/material/hair.h"

static const int components[AT_COUNT] = {3, 3, 4, 2, 2, 4};

static const float *stream_of(const Mesh *mesh, int attribute) {
    switch (attribute) {
    case AT_POSITION: return mesh->position;
    case AT_NORMAL: return mesh->normal;
    case AT_TANGENT: return mesh->tangent;
    case AT_COLOR: return mesh->color;
    default: return mesh->texcoord[attribute - AT_TEXCOORD];
    }
}

static int tangents_of(const WeftScene *scene) {
    int count = 0;
    for (int m = 0; m < scene->mesh_count; m++) count += scene->meshes[m].tangent != NULL;
    return count;
}

static uint32_t own_vertices(const Refinement *refinement, const WeftScene *scene) {
    uint32_t count = 0;
    for (int m = 0; m < scene_own_meshes(scene); m++) count += refinement_mesh(refinement, scene, m).vertex_count;
    return count;
}

/* Uploads an attribute of all meshes, one after the other; a mesh without it has 0, or white. An attribute that no mesh
 * has takes no memory: the shader reads the constant that meshes_bind sets. */
static WeftResult upload(const GlMeshes *self, const WeftScene *scene, int attribute, WeftError *error) {
    size_t count = self->vertex_count;
    size_t width = (size_t)components[attribute];
    const float constant = attribute == AT_COLOR ? 1.0f : 0.0f;
    bool any = false;
    for (int m = 0; m < scene->mesh_count; m++) any |= stream_of(&scene->meshes[m], attribute) != NULL;
    if (!any) return WEFT_OK;
    float *all = alloc_array(count, width * sizeof(float)), *to = all;
    if (!all) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    for (int m = 0; m < scene->mesh_count; m++) {
        const Mesh *mesh = &scene->meshes[m];
        const RefinedMesh refined = refinement_mesh(self->refinement, scene, m);
        const float *from = stream_of(mesh, attribute);
        size_t floats = refined.vertex_count * width;
        if (from) refined_fill(&refined, mesh, from, width, to);
        for (size_t k = 0; k < floats && !from; k++) to[k] = constant;
        to += floats;
    }
    glBindBuffer(GL_ARRAY_BUFFER, self->attributes[attribute]);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(count * width * sizeof(float)), all, GL_STATIC_DRAW);
    glVertexAttribPointer((GLuint)attribute, components[attribute], GL_FLOAT, GL_FALSE, 0, NULL);
    glEnableVertexAttribArray((GLuint)attribute);
    free(all);
    return gl_check(error, "vertices");
}

/* A vertex of hair: a unit vector from the middle of its fibre and a random number of the fibre, of SHRT_MAX; and the normal
 * of the cloth, of CHAR_MAX. */
typedef struct Across {
    int16_t to[3], chance;
    int8_t root[4];
} Across;

/* Returns the sum of a triangle's normals at its corners, or its own, as a unit vector. */
static Vec3 normal_of(const Mesh *mesh, uint32_t triangle) {
    const uint32_t *index = mesh->index + 3 * (size_t)triangle;
    Vec3 corner[3], sum = {0.0f, 0.0f, 0.0f};
    for (int k = 0; k < 3; k++) {
        corner[k] = vec3_load(mesh->position + 3 * (size_t)index[k]);
        if (mesh->normal) sum = vec3_add(sum, vec3_load(mesh->normal + 3 * (size_t)index[k]));
    }
    const Vec3 own = vec3_cross(vec3_sub(corner[1], corner[0]), vec3_sub(corner[2], corner[0]));
    return vec3_normal_or(sum, vec3_normal_or(own, vec3(0.0f, 1.0f, 0.0f)));
}

static Across across_of(const Mesh *hair, uint32_t vertex, Vec3 root) {
    const Vec3 to = vec3_scale(vec3_normal_or(hair_across(hair, vertex), vec3(0.0f, 0.0f, 0.0f)), 32767.0f);
    const int16_t chance = (int16_t)(hash32(vertex / HAIR_VERTICES) & 0x7fff);
    return (Across){
        .to = {(int16_t)lrintf(to.x), (int16_t)lrintf(to.y), (int16_t)lrintf(to.z)},
        .chance = chance,
        .root = {(int8_t)lrintf(127.0f * root.x), (int8_t)lrintf(127.0f * root.y), (int8_t)lrintf(127.0f * root.z), 0}};
}

/* Fills the vertices of a mesh of hair. */
static void fill_across(const WeftScene *scene, int m, Across *to) {
    const Hair *hair = &scene->hairs[m - scene_own_meshes(scene)];
    const Mesh *mesh = &scene->meshes[m];
    for (uint32_t fibre = 0; fibre < mesh->vertex_count / HAIR_VERTICES; fibre++) {
        const Vec3 root = normal_of(&scene->meshes[hair->mesh], hair->roots[fibre]);
        for (uint32_t k = fibre * HAIR_VERTICES; k < (fibre + 1) * HAIR_VERTICES; k++) to[k] = across_of(mesh, k, root);
    }
}

/* Uploads the widths of the fibres of hair; other vertices have none. */
static WeftResult upload_across(GlMeshes *self, const WeftScene *scene, WeftError *error) {
    if (!scene->hair_count) return WEFT_OK;
    Across *all = alloc_array(self->vertex_count, sizeof *all);
    if (!all) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    size_t at = self->own_count;
    for (int m = scene_own_meshes(scene); m < scene_light_meshes(scene); m++) {
        fill_across(scene, m, all + at);
        at += scene->meshes[m].vertex_count;
    }
    glGenBuffers(1, &self->across);
    glBindBuffer(GL_ARRAY_BUFFER, self->across);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(self->vertex_count * sizeof *all), all, GL_STATIC_DRAW);
    glVertexAttribPointer(AT_ACROSS, 4, GL_SHORT, GL_TRUE, sizeof *all, NULL);
    glVertexAttribPointer(AT_ROOT, 3, GL_BYTE, GL_TRUE, sizeof *all, (const void *)offsetof(Across, root));
    glEnableVertexAttribArray(AT_ACROSS);
    glEnableVertexAttribArray(AT_ROOT);
    free(all);
    return gl_check(error, "hair");
}

static WeftResult upload_indices(GlMeshes *self, const WeftScene *scene, WeftError *error) {
    uint32_t count = self->first[scene->mesh_count], vertex = 0;
    uint32_t *all = alloc_array(count, sizeof(uint32_t)), *to = all;
    if (!all) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    for (int m = 0; m < scene->mesh_count; m++) {
        const RefinedMesh mesh = refinement_mesh(self->refinement, scene, m);
        for (size_t k = 0; k < 3 * (size_t)mesh.triangle_count; k++) *to++ = mesh.index[k] + vertex;
        vertex += mesh.vertex_count;
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, self->index);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(count * sizeof(uint32_t)), all, GL_STATIC_DRAW);
    free(all);
    return gl_check(error, "triangles");
}

WeftResult meshes_create(const WeftScene *scene, const Refinement *refinement, GlMeshes *out, WeftError *error) {
    *out = (GlMeshes){.refinement = refinement};
    out->first = alloc_array((size_t)scene->mesh_count + 1, sizeof(uint32_t));
    if (!out->first) return fail(error, WEFT_MESSAGE_MEMORY, scene->name, NULL);
    size_t vertices = 0, indices = 0;
    for (int m = 0; m < scene->mesh_count; m++) {
        const RefinedMesh mesh = refinement_mesh(refinement, scene, m);
        out->first[m] = (uint32_t)indices;
        vertices += mesh.vertex_count;
        indices += 3 * (size_t)mesh.triangle_count;
        if (vertices > INT32_MAX || indices > INT32_MAX) {
            meshes_destroy(out);
            return fail(error, WEFT_MESSAGE_GL_MEMORY, scene->name, "more than 2^31 vertices or corners");
        }
    }
    out->first[scene->mesh_count] = (uint32_t)indices;
    glGenVertexArrays(1, &out->vertices);
    glGenBuffers(AT_COUNT, out->attributes);
    glGenBuffers(1, &out->index);
    glBindVertexArray(out->vertices);
    out->vertex_count = (uint32_t)vertices;
    out->own_count = own_vertices(refinement, scene);
    WeftResult result = upload_indices(out, scene, error);
    for (int a = 0; a < AT_COUNT && result == WEFT_OK; a++) result = upload(out, scene, a, error);
    if (result == WEFT_OK) result = upload_across(out, scene, error);
    glBindVertexArray(0);
    out->mesh_count = scene->mesh_count;
    out->own_meshes = scene_own_meshes(scene);
    out->hair_version = scene->hair_version;
    out->tangents = tangents_of(scene);
    if (result != WEFT_OK) meshes_destroy(out);
    return result;
}

WeftResult meshes_refine(GlMeshes *self, const WeftScene *scene, const Refinement *refinement, WeftError *error) {
    GlMeshes fresh;
    WeftResult result = meshes_create(scene, refinement, &fresh, error);
    if (result != WEFT_OK) return result;
    meshes_destroy(self);
    *self = fresh;
    return WEFT_OK;
}

WeftResult meshes_update(GlMeshes *self, const WeftScene *scene, WeftError *error) {
    int tangents = tangents_of(scene);
    if (tangents == self->tangents) return WEFT_OK;
    glBindVertexArray(self->vertices);
    WeftResult result = upload(self, scene, AT_TANGENT, error);
    glBindVertexArray(0);
    if (result == WEFT_OK) self->tangents = tangents;
    return result;
}

static const GLsizeiptr seen_size = OCCLUSION_VALUES * sizeof(uint16_t); /* halves */

/* Has what vertices see looked up in the buffer, or not. */
static void look_up(const GlMeshes *self, bool in_buffer) {
    for (GLuint k = 0; k < (self->env_lights ? 5 : 3); k++)
        if (in_buffer)
            glEnableVertexAttribArray(AT_OCCLUSION + k);
        else
            glDisableVertexAttribArray(AT_OCCLUSION + k);
}

/* Sets what vertices see that have no values of their own: the whole sky, and of lights nothing is known. */
static void see_all(void) {
    glVertexAttrib4f(AT_OCCLUSION, 1.0f, 1.0f, 1.0f, 1.0f);
    for (GLuint k = 0; k < 2; k++) glVertexAttrib4f(AT_OPEN + k, 1.0f, 0.0f, 0.0f, 0.0f);
    for (GLuint k = 0; k < 2; k++) glVertexAttrib4f(AT_LIGHTS + k, -1.0f, -1.0f, -1.0f, -1.0f);
}

/* Makes the buffer of what vertices of own meshes see, without its values, and has it looked up. */
static void begin_occlusion(GlMeshes *self, bool env_lights) {
    if (!self->occlusion) glGenBuffers(1, &self->occlusion);
    glBindVertexArray(self->vertices);
    glBindBuffer(GL_ARRAY_BUFFER, self->occlusion);
    glBufferData(GL_ARRAY_BUFFER, seen_size * (GLsizeiptr)self->own_count, NULL, GL_STATIC_DRAW);
    for (size_t k = 0, at = 0; k < (env_lights ? 5 : 3); at += k++ ? 4 : 2) {
        GLuint attribute = (GLuint)(AT_OCCLUSION + k);
        glVertexAttribPointer(attribute, k ? 4 : 2, GL_HALF_FLOAT, GL_FALSE, (GLsizei)seen_size,
                              (const void *)(at * sizeof(uint16_t)));
    }
    self->env_lights = env_lights;
    look_up(self, true);
}

WeftResult meshes_occlusion(GlMeshes *self, const float *values, WeftError *error) {
    const size_t count = (size_t)self->own_count * OCCLUSION_VALUES;
    uint16_t *halves = alloc_array(count, sizeof *halves);
    if (!halves) return fail(error, WEFT_MESSAGE_MEMORY, "occlusion", NULL);
    for (size_t k = 0; k < count; k++) halves[k] = half_bits(values[k]);
    begin_occlusion(self, true);
    glBufferSubData(GL_ARRAY_BUFFER, 0, seen_size * (GLsizeiptr)self->own_count, halves);
    free(halves);
    return gl_check(error, "occlusion");
}

void meshes_forget_lights(GlMeshes *self) {
    glBindVertexArray(self->vertices);
    for (GLuint k = 0; k < 2; k++) glDisableVertexAttribArray(AT_LIGHTS + k);
    self->env_lights = false;
}

static bool same_counts(const GlMeshes *self, const WeftScene *scene) {
    uint32_t vertices = self->own_count;
    bool same = self->mesh_count == scene->mesh_count && self->hair_version == scene->hair_version;
    for (int m = scene_own_meshes(scene); m < scene->mesh_count && same; m++) {
        same = self->first[m + 1] - self->first[m] == 3 * scene->meshes[m].triangle_count;
        vertices += scene->meshes[m].vertex_count;
    }
    return same && vertices == self->vertex_count;
}

static void move_lights(const GlMeshes *self, const WeftScene *scene) {
    GLsizeiptr at = (GLsizeiptr)self->own_count * 3 * (GLsizeiptr)sizeof(float);
    for (int m = scene_own_meshes(scene); m < scene_light_meshes(scene); m++)
        at += (GLsizeiptr)scene->meshes[m].vertex_count * 3 * (GLsizeiptr)sizeof(float);
    glBindBuffer(GL_ARRAY_BUFFER, self->attributes[AT_POSITION]);
    for (int m = scene_light_meshes(scene); m < scene->mesh_count; m++) {
        GLsizeiptr size = (GLsizeiptr)scene->meshes[m].vertex_count * 3 * (GLsizeiptr)sizeof(float);
        glBufferSubData(GL_ARRAY_BUFFER, at, size, scene->meshes[m].position);
        at += size;
    }
}

WeftResult meshes_reshape(GlMeshes *self, const WeftScene *scene, WeftError *error) {
    GlMeshes fresh;
    if (same_counts(self, scene)) {
        move_lights(self, scene);
        return gl_check(error, "lights");
    }
    WeftResult result = meshes_create(scene, self->refinement, &fresh, error);
    if (result == WEFT_OK && self->occlusion) {
        begin_occlusion(&fresh, self->env_lights);
        glBindBuffer(GL_COPY_READ_BUFFER, self->occlusion);
        glBindBuffer(GL_COPY_WRITE_BUFFER, fresh.occlusion);
        glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, seen_size * (GLsizeiptr)self->own_count);
        glBindBuffer(GL_COPY_READ_BUFFER, 0);
        glBindBuffer(GL_COPY_WRITE_BUFFER, 0);
        result = gl_check(error, "occlusion");
    }
    meshes_destroy(result == WEFT_OK ? self : &fresh);
    if (result == WEFT_OK) *self = fresh;
    return result;
}

void meshes_destroy(GlMeshes *self) {
    if (self->vertices) {
        glDeleteVertexArrays(1, &self->vertices);
        glDeleteBuffers(AT_COUNT, self->attributes);
        glDeleteBuffers(1, &self->index);
        glDeleteBuffers(1, &self->occlusion);
        glDeleteBuffers(1, &self->across);
    }
    free(self->first);
    *self = (GlMeshes){0};
}

void meshes_bind(const GlMeshes *self) {
    glBindVertexArray(self->vertices);
    for (GLuint a = 0; a < AT_COUNT; a++) {
        const float constant = a == AT_COLOR ? 1.0f : 0.0f;
        glVertexAttrib4f(a, constant, constant, constant, constant);
    }
    see_all();
}

void meshes_draw(const GlMeshes *self, int mesh) {
    uint32_t first = self->first[mesh], count = self->first[mesh + 1] - first;
    const bool sees_all = self->occlusion && mesh >= self->own_meshes;
    if (!count) return;
    if (sees_all) {
        look_up(self, false);
        see_all();
    }
    glDrawElements(GL_TRIANGLES, (GLsizei)count, GL_UNSIGNED_INT, (const void *)(first * sizeof(uint32_t)));
    if (sees_all) look_up(self, true);
}

/* scene.h - the contents of a loaded file: world-space triangles, materials, lights, cameras, environment
 *
 * World space is glTF's: right-handed, +y up, metres. gltf/ or builtin/ make a scene, the renderers read it. All memory
 * except pixels is in one arena. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "base/memory.h"
#include "base/vec3.h"
#include "scene/record/material.h"
#include "scene/record/texture.h"
#include "weft/scene.h"
#include "weft/weave.h"

typedef struct Measured Measured; /* brdf/measured.h */

/* Limits of coordinates, m. Squares of a scene's coordinates must stay finite. A ray may start further out, up to
 * RAY_REACH, since a camera backs off to see a scene and rays of a parallel one start beside its eye; from 1.844e18 on
 * Embree treats a number as NaN. */
#define SCENE_REACH 1e15f
#define RAY_REACH   1e18f

/* Returns false if a coordinate is beyond reach or NaN. */
static inline bool within_reach(Vec3 p, float reach) {
    return fabsf(p.x) <= reach && fabsf(p.y) <= reach && fabsf(p.z) <= reach;
}

/* One set of triangles with one material, already in world space; front faces wind counter-clockwise. */
typedef struct Mesh {
    const char *name; /* never NULL */
    uint32_t vertex_count, triangle_count;
    float *position;       /* 3 a vertex */
    float *normal;         /* 3 a vertex, unit; NULL: use the flat face normal */
    float *tangent;        /* 4 a vertex: unit xyz, w = +1 or -1 with bitangent = w cross(n, t); NULL: none needed */
    float *texcoord[2];    /* 2 a vertex; NULL reads as (0, 0) */
    float *color;          /* 4 a vertex, linear RGBA, multiplies base_color and opacity; NULL: white */
    uint32_t *index;       /* 3 a triangle, each < vertex_count */
    int material;          /* index into materials; always valid */
    int own_material;      /* without a variant, where there are any */
    int *variant_material; /* variant_count entries, -1: its own; NULL: all -1 */
} Mesh;

/* Hair on one of the scene's own meshes, as it was grown (scene/material/hair.h). */
typedef struct Hair {
    int mesh, cloth;                  /* cloth: of the material then, counted from 1; 0: none */
    float numbers[WEFT_HAIR_NUMBERS]; /* of the material then */
    WeftAlphaMode alpha_mode;         /* of the material then, as is its opacity */
    float alpha_cutoff;
    Input opacity;
    uint32_t *roots; /* the triangle that each fibre stands on; owned */
} Hair;

typedef enum LightKind { LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_SPOT } LightKind;

/* Radiometric: color * intensity is W/(m^2) across the beam (directional) or W/sr (point, spot). */
typedef struct Light {
    const char *name;
    LightKind kind;
    Vec3 position;  /* point, spot */
    Vec3 direction; /* unit, the way the light travels; directional, spot */
    float color[3], intensity;
    float range;                /* m; 0: no limit. Window of KHR_lights_punctual */
    float cos_inner, cos_outer; /* spot: full inside the inner cone, none outside the outer */
} Light;

/* A light that is a flat mesh. The scene's last meshes are those of its polygon lights, and behind its own materials
 * come theirs, in their order, which light_list.c maintains. */
typedef struct PolygonLight {
    WeftLight light; /* as it was given, its defaults filled in */
    int place;       /* among all lights as callers count them; punctual ones fill the places between */
} PolygonLight;

typedef struct Camera {
    const char *name;
    Vec3 eye, right, up, forward; /* right, up, forward orthonormal; the camera looks along forward */
    bool orthographic;
    float yfov; /* vertical field of view, radians; perspective */
    float ymag; /* half of the visible height, m; orthographic */
} Camera;

typedef enum EnvironmentKind { ENVIRONMENT_STUDIO = 0, ENVIRONMENT_CONSTANT, ENVIRONMENT_IMAGE } EnvironmentKind;

/* Distant light. An image is lat-long: row 0 is +y, the middle column is -z, columns run towards +x. */
typedef struct Environment {
    EnvironmentKind kind;
    float color[3];   /* CONSTANT: radiance */
    WeftImage image;  /* IMAGE and STUDIO: F32, 1 to 4 channels, owned; all zero otherwise */
    float rotation;   /* radians about +y, counter-clockwise seen from above */
    float strength;   /* factor on the radiance */
    float ambient;    /* factor on the light that diffuse lobes and dust reflect of it */
    float reflection; /* factor on the light that all other lobes reflect of it */
    unsigned version; /* counts changes of image or colour */
} Environment;

/* The look of a material from behind: the same, unless it is woven or has a back of its own
 * (scene/material/backs.h). */
typedef enum MaterialBack { BACK_SAME = 0, BACK_WOVEN, BACK_GIVEN } MaterialBack;

struct U3mSource; /* scene/u3m/u3m_source.h */

struct WeftScene {
    Arena arena; /* everything below but the pixels of images */
    SrgbTable srgb;
    const char *name;
    WeftImage *images;
    Texture *textures;
    Material *materials; /* the scene's own, its polygon lights', and then the backs of its own */
    WeftCloth **cloths;  /* owned; NULL without any */
    int cloth_count;
    Measured **measured; /* owned; NULL without any */
    int measured_count;
    const char **material_names; /* of its own materials: never NULL, may be empty */
    Mesh *meshes;
    Light *lights;
    Camera *cameras;
    const char **variants;
    int variant; /* number of the active variant, counted from 1; 0: none */
    int image_count, texture_count, material_count, mesh_count, light_count, camera_count, variant_count;
    int back_count;               /* 0, or one for each own material, which material_count leaves out */
    MaterialBack *backs;          /* of own materials; NULL without places */
    const struct U3mSource **u3m; /* of own materials: the U3M that one was read from, or NULL; NULL without any */
    int light_capacity, polygon_light_count, polygon_light_capacity; /* capacity: entries that a list has memory for */
    PolygonLight *polygon_lights;
    Hair *hairs;    /* owned, as are the vertices of its meshes; NULL without any */
    int hair_count; /* meshes of hair, each with a material: after the scene's own ones and before those of lights */
    unsigned hair_version;  /* counts how often hair was grown */
    unsigned shape_version; /* counts changes of shapes; only those of lights and hair may change */
    Environment environment;
    Vec3 low, high; /* bounding box of its own vertices; low > high when there are none */
};

/* Return the numbers of the first mesh and of the first material of its lights. */
static inline int scene_light_meshes(const WeftScene *scene) { return scene->mesh_count - scene->polygon_light_count; }
static inline int scene_light_materials(const WeftScene *scene) {
    return scene->material_count - scene->polygon_light_count;
}

/* Return the counts of the scene's own meshes and materials, without those of its hair and lights. */
static inline int scene_own_meshes(const WeftScene *scene) { return scene_light_meshes(scene) - scene->hair_count; }
static inline int scene_own_materials(const WeftScene *scene) {
    return scene_light_materials(scene) - scene->hair_count;
}

/* Returns the material that a material of hair was made of, or the material itself if it is no hair's. */
static inline int scene_grown_from(const WeftScene *scene, int material) {
    const int hair = material - scene_own_materials(scene);
    return hair < 0 || hair >= scene->hair_count ? material : scene->meshes[scene->hairs[hair].mesh].material;
}

/* Returns how far hair may reach from the scene's own meshes, m. */
static inline float scene_hair_reach(const WeftScene *scene) {
    float reach = 0.0f;
    for (int k = 0; k < scene->hair_count; k++) reach = fmaxf(reach, scene->hairs[k].numbers[WEFT_HAIR_LENGTH]);
    return reach;
}
/* Returns the count of materials with backs, which is what renderers prepare. */
static inline int scene_shaded_materials(const WeftScene *scene) { return scene->material_count + scene->back_count; }

/* Returns the index of the material that is seen of a material from behind, or -1: the same, or nothing. */
static inline int scene_back(const WeftScene *scene, int material) {
    const bool other =
        material < scene->back_count && scene->backs[material] != BACK_SAME && scene->materials[material].double_sided;
    return other ? scene->material_count + material : -1;
}

/* Returns true if a material was given a back of its own. */
static inline bool scene_has_back(const WeftScene *scene, int material) {
    return material < scene->back_count && scene->backs[material] == BACK_GIVEN;
}

/* Returns the cloth of a material, or NULL. The back of a woven one has the number of the cloth below 0: its other
 * face. */
const WeftCloth *scene_cloth_of(const WeftScene *scene, const Material *material);

/* Returns an empty scene with the studio environment, or NULL if memory is short. */
WeftScene *scene_create(const char *name);

/* Writes "available: a, b, c" for messages: the first few names that `name` returns, or the index of an unnamed one.
 * Returns text. */
enum { NAMES_SIZE = 256 };
const char *scene_names(const WeftScene *scene, const char *(*name)(const WeftScene *scene, int index),
                        char text[NAMES_SIZE]);

/* Takes over a cloth and returns its number, counted from 1. If the scene has the same cloth this is its number, and
 * the new one is freed. Returns 0 if memory is short; the cloth is then still the caller's. A cloth stays as long as
 * the scene, since materials may refer to it. */
int scene_adopt_cloth(WeftScene *scene, WeftCloth *cloth);

/* Takes over a measurement in the same way; one of the same file stays in its place. */
int scene_adopt_measured(WeftScene *scene, Measured *measured);

/* Reads a measurement into memory of its own. Fails as measured_read, and with WEFT_MESSAGE_MEASURED where the name is
 * of no format. Release with scene_measured_free. */
WeftResult scene_measured_read(const char *path, Measured **out, WeftError *error);
void scene_measured_free(Measured *measured); /* may be NULL */

/* Sets low and high from the meshes. Call once all meshes stand. */
void scene_bounds(WeftScene *scene);

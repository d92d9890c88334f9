#include "trace/path/path_materials.h"

#include "base/equal.h"
#include "scene/light/pane.h"
#include "scene/light/polygons.h"
#include "scene/record/material_at.h"
#include "shading/stack/frame.h"

/* Returns true if no input of glass, a coat, a matt base or a base that turns light back is in use that kinds leave out. */
static bool is_without_coming(const PathMaterial *prepared) {
    static const InputId coming[] = {INPUT_diffuse_roughness, INPUT_retroreflection, INPUT_coat_ior,
                                     INPUT_coat_color,        INPUT_coat_darkening,  INPUT_coat_anisotropy,
                                     INPUT_transmission};
    const Material plain = material_default();
    bool without = true;
    for (size_t k = 0; k < sizeof coming / sizeof *coming; k++) {
        const Input *input = &prepared->material.inputs[coming[k]], *as = &plain.inputs[coming[k]];
        without &= !input->texture;
        for (int c = 0; c < 3; c++) without &= is_equal(input->value[c], as->value[c]);
    }
    return without;
}

/* Takes solid glass out of the stack. The thickness of a solid is that of its mesh, and light is absorbed along paths. */
static void prepare_solid(PathMaterial *prepared, const Surface *surface) {
    prepared->solid = material_is_solid(&prepared->material);
    if (!prepared->solid) return;
    prepared->absorption = solid_absorption(surface);
    prepared->untextured.attenuation_distance = 0.0f;
    Surface clear = *surface;
    clear.attenuation_distance = 0.0f;
    stack_make(&prepared->stack, &clear, &prepared->choices, prepared->sheen_e);
    prepared->glass = solid_take(&prepared->stack, &clear, &prepared->table);
    const bool textured = prepared->material.inputs[INPUT_roughness].texture != 0;
    solid_table_fill(&prepared->glass, textured, &prepared->table);
}

static void prepare(const WeftScene *scene, int k, TableRef sheen_e, PathMaterial *prepared) {
    const Material *material = &scene->materials[k];
    prepared->material = *material;
    prepared->material.inputs[INPUT_occlusion].texture = 0; /* paths trace it */
    prepared->material.inputs[INPUT_opacity].texture = 0;   /* a ray that hits has decided it */
    prepared->material.inputs[INPUT_thickness].texture = 0; /* the mesh bounds the glass */
    prepared->material.inputs[INPUT_attenuation_distance].texture = 0;
    prepared->material.inputs[INPUT_attenuation_color].texture = 0;
    if (material->cloth) prepared->material.inputs[INPUT_transmission].texture = 0; /* threads are no glass */
    prepared->untextured = material_plain(material);
    prepared->choices = material_choices(material);
    for (int input = 0; input < INPUT_COUNT; input++) {
        const Input *of = &prepared->material.inputs[input];
        prepared->textured |= of->texture != 0;
        prepared->texcoords[of->texcoord] |= of->texture != 0;
        prepared->leveled[of->texcoord] |= of->texture && texture_levels(&scene->textures[of->texture - 1]);
    }
    prepared->cloth = scene_cloth_of(scene, material);
    prepared->textured |= prepared->cloth != NULL;
    prepared->texcoords[0] |= prepared->cloth != NULL;
    prepared->sheen_e = sheen_e;
    Surface surface = frame_surface(prepared->untextured);
    stack_make(&prepared->stack, &surface, &prepared->choices, prepared->sheen_e);
    prepared->transmits = prepared->stack.transmission > 0.0f || material_has_glass(material);
    prepared->measured = material->measured ? scene->measured[material->measured - 1] : NULL;
    if (prepared->cloth) {
        const Lobe yarn = lobe_default(LOBE_YARN);
        stack_put_base(&prepared->stack, &yarn, rgb_grey(1.0f), rgb_grey(1.0f));
    }
    prepare_solid(prepared, &surface);
    prepared->pane = scene_is_pane(scene, k);
    const bool settles = dust_settles(prepared->untextured);
    const bool usual = !prepared->measured && !settles && is_without_coming(prepared);
    prepared->kind = usual ? stack_kind(&prepared->stack, &prepared->choices) : NULL;
    prepared->emits = material_emits(material);
    prepared->needs_tangents = !prepared->kind || prepared->cloth || prepared->material.inputs[INPUT_normal].texture ||
                               prepared->material.inputs[INPUT_clearcoat_normal].texture ||
                               prepared->untextured.anisotropy > 0.0f;
}

/* Lets a material's base colour be multiplied by those of vertices. */
static void color(PathMaterial *prepared) { prepared->colored = prepared->textured = true; }

PathMaterial *path_materials_create(const WeftScene *scene, const SheenTables *tables) {
    size_t count = (size_t)scene_shaded_materials(scene);
    PathMaterial *materials = alloc_array(count, sizeof(PathMaterial));
    if (!materials) return NULL;
    for (size_t k = 0; k < count; k++) prepare(scene, (int)k, sheen_tables_of(tables, (int)k), &materials[k]);
    for (int k = 0; k < scene->mesh_count; k++) {
        const int front = scene->meshes[k].material, back = scene_back(scene, front);
        if (!scene->meshes[k].color) continue;
        color(&materials[front]);
        if (back >= 0) color(&materials[back]);
    }
    return materials;
}

bool path_materials_solid(const PathMaterial *materials, int count) {
    bool any = false;
    for (int k = 0; k < count; k++) any |= materials[k].solid;
    return any;
}

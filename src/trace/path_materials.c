#include "trace/path_materials.h"

#include "scene/material_at.h"
#include "scene/polygons.h"
#include "shading/frame.h"

static void prepare(const WeftScene *scene, const Material *material, TableRef sheen_e, PathMaterial *known) {
    known->material = *material;
    known->material.inputs[INPUT_occlusion].texture = 0; /* the paths find it out for themselves */
    known->material.inputs[INPUT_opacity].texture = 0;   /* opacity is decided by the hit itself */
    known->plain = material_plain(material);
    known->choices = material_choices(material);
    for (int input = 0; input < INPUT_COUNT; input++) {
        const Input *of = &known->material.inputs[input];
        known->textured |= of->texture != 0;
        known->texcoords[of->texcoord] |= of->texture != 0;
    }
    known->cloth = material->cloth ? scene->cloths[material->cloth - 1] : NULL;
    known->textured |= known->cloth != NULL;
    known->texcoords[0] |= known->cloth != NULL;
    known->sheen_e = sheen_e;
    Surface surface = frame_surface(known->plain);
    stack_make(&known->stack, &surface, &known->choices, known->sheen_e);
    known->transmits = known->stack.transmission > 0.0f;
    known->measured = material->measured ? scene->measured[material->measured - 1] : NULL;
    if (known->cloth) {
        const Lobe yarn = lobe_default(LOBE_YARN);
        stack_put_base(&known->stack, &yarn, rgb_grey(1.0f), rgb_grey(1.0f));
    }
    known->kind = known->measured ? NULL : stack_kind(&known->stack, &known->choices);
    known->shines = material_emits(material);
    known->bent = !known->kind || known->cloth || known->material.inputs[INPUT_normal].texture ||
                  known->material.inputs[INPUT_clearcoat_normal].texture || known->plain.anisotropy > 0.0f;
}

PathMaterial *path_materials_create(const WeftScene *scene, const SheenTables *tables) {
    size_t count = (size_t)scene->material_count;
    PathMaterial *materials = alloc_array(count, sizeof(PathMaterial));
    if (!materials) return NULL;
    for (size_t k = 0; k < count; k++)
        prepare(scene, &scene->materials[k], sheen_tables_of(tables, (int)k), &materials[k]);
    for (int k = 0; k < scene->mesh_count; k++) {
        PathMaterial *known = &materials[scene->meshes[k].material];
        known->colored |= scene->meshes[k].color != NULL;
        known->textured |= known->colored;
    }
    return materials;
}

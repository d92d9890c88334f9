#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "raster/programs.h"

#include <string.h>

#include <epoxy/gl.h>

#include "base/fail.h"
#include "raster/program.h"
#include "raster/tables.h"

typedef struct Sampler {
    const char *name;
    int unit;
} Sampler;

static const Sampler samplers[] = {{"weft_tables", UNIT_TABLES},
                                   {"environment_cube", UNIT_ENVIRONMENT},
                                   {"shadow_map", UNIT_SHADOW},
                                   {"shadow_depth", UNIT_SHADOW_DEPTH}};

/* Leaves the program in use: the one that was may be the one it replaces, and be gone. */
static void set_units(Program *self) {
    static const int units[UNIT_TABLES] = {0, 1, 2, 3, 4, 5, 6, 7};
    GLint maps = glGetUniformLocation(self->name, "material_maps");
    glUseProgram(self->name);
    self->samplers = 0;
    if (maps >= 0) {
        GLuint index;
        GLint size = 0;
        const char *name = "material_maps[0]";
        glGetUniformIndices(self->name, 1, &name, &index);
        if (index != GL_INVALID_INDEX) glGetActiveUniformsiv(self->name, 1, &index, GL_UNIFORM_SIZE, &size);
        glUniform1iv(maps, size, units);
        self->samplers += size;
    }
    for (size_t k = 0; k < sizeof samplers / sizeof samplers[0]; k++) {
        GLint at = glGetUniformLocation(self->name, samplers[k].name);
        if (at < 0) continue;
        glUniform1i(at, samplers[k].unit);
        self->samplers++;
    }
}

static void bind_blocks(GLuint program) {
    GLuint picture = glGetUniformBlockIndex(program, "Picture");
    GLuint material = glGetUniformBlockIndex(program, "Material");
    if (picture != GL_INVALID_INDEX) glUniformBlockBinding(program, picture, BLOCK_PICTURE);
    GLuint environment = glGetUniformBlockIndex(program, "Environment");
    if (environment != GL_INVALID_INDEX) glUniformBlockBinding(program, environment, BLOCK_ENVIRONMENT);
    if (material != GL_INVALID_INDEX) glUniformBlockBinding(program, material, BLOCK_MATERIAL);
}

/* The tables of the text, then those of the sheens; 0 where there are none, or on failure. */
static GLuint make_tables(const Programs *programs, const Text *text, WeftError *error) {
    int count = sheen_tables_count(programs->sheens), all = text->table_count + count;
    if (!all) return 0;
    TextTable *tables = alloc_array((size_t)all, sizeof *tables);
    if (!tables) {
        fail(error, WEFT_MESSAGE_MEMORY, "tables", NULL);
        return 0;
    }
    memcpy(tables, text->tables, (size_t)text->table_count * sizeof *tables);
    for (int k = 0; k < count; k++) {
        const AlbedoTable *table = sheen_tables_at(programs->sheens, k);
        TableRef e = albedo_table_ref(table);
        tables[text->table_count + k] = (TextTable){e.texels, table->maps * e.rows, e.columns + 1};
    }
    GLuint texture = tables_create(tables, all, error);
    free(tables);
    return texture;
}

static void drop(Program *self) {
    glDeleteProgram(self->name);
    glDeleteTextures(1, &self->tables);
}

/* Compiles; what was there before stays where that fails. */
static void build(Programs *programs, Program *self) {
    Text vertex = {0}, fragment = {0};
    WeftError error = {0};
    GLuint made = 0, tables = 0;
    shader_vertex_text(&programs->desc, &vertex);
    shader_text(&self->key, &programs->desc, &programs->fits, &fragment);
    if (text_end(&vertex, &error) == WEFT_OK && text_end(&fragment, &error) == WEFT_OK)
        made = program_create("material shader", (ShaderSource){vertex.bytes, &vertex},
                              (ShaderSource){fragment.bytes, &fragment}, &error);
    if (made) tables = make_tables(programs, &fragment, &error);
    text_free(&vertex);
    text_free(&fragment);
    programs->compiled++;
    self->stale = false;
    self->error = error;
    if (error.result != WEFT_OK) {
        glDeleteProgram(made);
        return;
    }
    drop(self);
    self->name = made;
    self->tables = tables;
    bind_blocks(made);
    set_units(self);
}

const Program *programs_get(Programs *programs, const ShaderKey *key, WeftError *error) {
    Program *p = programs->first;
    while (p && memcmp((const char *)&p->key, (const char *)key, sizeof *key) != 0) p = p->next;
    if (!p) {
        p = alloc_array(1, sizeof *p);
        if (!p) {
            fail(error, WEFT_MESSAGE_MEMORY, "shaders", NULL);
            return NULL;
        }
        memcpy(&p->key, key, sizeof *key);
        p->stale = true;
        p->next = programs->first;
        programs->first = p;
    }
    if (p->stale) build(programs, p);
    *error = p->error;
    return p->name ? p : NULL;
}

void programs_refresh(Programs *programs) {
    for (Program *p = programs->first; p; p = p->next) p->stale = true;
}

const char *programs_complaint(const Programs *programs) {
    const char *first = "";
    for (const Program *p = programs->first; p; p = p->next)
        if (!p->stale && p->error.result != WEFT_OK) first = p->error.text;
    return first;
}

void programs_destroy(Programs *programs) {
    for (Program *p = programs->first, *next; p; p = next) {
        next = p->next;
        drop(p);
        free(p);
    }
    programs->first = NULL;
    fits_destroy(&programs->fits);
}

unsigned programs_background(const Programs *programs, WeftError *error) {
    Text vertex, fragment;
    GLuint made = 0;
    shader_background_text(&programs->desc, &vertex, &fragment);
    if (text_end(&vertex, error) == WEFT_OK && text_end(&fragment, error) == WEFT_OK)
        made = program_create("background", (ShaderSource){vertex.bytes, &vertex},
                              (ShaderSource){fragment.bytes, &fragment}, error);
    text_free(&vertex);
    text_free(&fragment);
    if (made) {
        bind_blocks(made);
        glUseProgram(made);
        glUniform1i(glGetUniformLocation(made, "environment_map"), UNIT_BACKGROUND);
        glUseProgram(0);
    }
    return made;
}

#include <stdlib.h> /* before the dialect, whose abs() shadows its own */

#include "raster/material/programs.h"

#include <string.h>

#include <epoxy/gl.h>

#include "base/cache.h"
#include "base/fail.h"
#include "base/memory.h"
#include "base/thread.h"
#include "raster/gl/program.h"
#include "raster/material/gl_tables.h"
#include "text/flat/flatten.h"
#include "weft/progress.h"

typedef struct TextureSampler {
    const char *name;
    int unit;
} TextureSampler;

static const TextureSampler samplers[] = {{"weft_tables", UNIT_TABLES},      {"environment_cube", UNIT_ENVIRONMENT},
                                          {"shadow_map", UNIT_SHADOW},       {"soft_map", UNIT_SOFT_SHADOW},
                                          {"weave_cells", UNIT_CLOTH_CELLS}, {"weave_colors", UNIT_CLOTH_COLORS},
                                          {"ray_texels", UNIT_RAYS},         {"sky_table", UNIT_SKY},
                                          {"ray_masks", UNIT_MASKS},         {"environment_map", UNIT_BACKGROUND},
                                          {"floor_sky", UNIT_FLOOR},         {"floor_mirror", UNIT_FLOOR + 1},
                                          {"floor_depth", UNIT_FLOOR + 2},   {"coarse_light", UNIT_COARSE}};

/* Sets the texture units of a program's samplers and counts these. Leaves the program in use, since the one in use
 * before may be the one it replaces, which is deleted. */
static void set_units(Program *self) {
    static const int units[UNIT_TABLES] = {0, 1, 2, 3, 4, 5, 6, 7};
    GLint maps = glGetUniformLocation(self->name, "material_maps");
    glUseProgram(self->name);
    self->samplers = 0;
    self->least_opacity = glGetUniformLocation(self->name, "least_opacity");
    self->hair_half = glGetUniformLocation(self->name, "hair_half");
    self->surface_number = glGetUniformLocation(self->name, "surface_number");
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

/* Returns an array texture of the program's own tables, then those of the sheens; 0 if there are none, or on
 * failure. */
static GLuint make_tables(const Programs *programs, const TextTable *own, int own_count, WeftError *error) {
    int count = sheen_tables_count(programs->sheens), all = own_count + count;
    if (!all) return 0;
    TextTable *tables = alloc_array((size_t)all, sizeof *tables);
    if (!tables) {
        fail(error, WEFT_MESSAGE_MEMORY, "tables", NULL);
        return 0;
    }
    memcpy(tables, own, (size_t)own_count * sizeof *tables);
    for (int k = 0; k < count; k++) {
        const AlbedoTable *table = sheen_tables_at(programs->sheens, k);
        TableRef e = albedo_table_ref(table);
        tables[own_count + k] = (TextTable){e.texels, table->maps * e.rows, e.columns + 1, NULL};
    }
    GLuint texture = tables_create(tables, all, error);
    free(tables);
    return texture;
}

/* Deletes what a program has in the driver, but for a name that another program has too. */
static void drop(const Programs *programs, const Program *self) {
    bool shared = false;
    for (const Program *p = programs->first; p; p = p->next) shared |= p != self && p->name == self->name;
    if (!shared) glDeleteProgram(self->name);
    glDeleteTextures(1, &self->tables);
}

/* A program to compile, with its text. */
typedef struct CompileJob {
    Program *program;
    Text vertex, fragment;
    bool as_written; /* the text is not flattened: messages then name its lines */
    Buffer flat;     /* the fragment's flat text, which drivers compile in a fraction of the time; may be empty */
    uint64_t text;   /* hash of it and the vertex's text, until it fails to compile; 0: none */
    bool waits;      /* for a job before it that compiles the same text */
    WeftError error;
    GLuint made;
} CompileJob;

typedef struct CompileBatch {
    CompileJob *jobs;
    int count, threads;
    GlContext *contexts[WEFT_THREADS_MAX]; /* a thread */
} CompileBatch;

static void write_text(Programs *programs, CompileJob *job) {
    shader_vertex_text(&job->program->key, &programs->desc, &job->vertex);
    shader_text(&job->program->key, &programs->desc, &programs->fits, &job->fragment);
    job->as_written = programs->desc.folder != NULL;
    if (text_end(&job->vertex, &job->error) == WEFT_OK) text_end(&job->fragment, &job->error);
}

static void flatten_in_thread(void *user, int item, int thread) {
    CompileJob *job = &((CompileJob *)user)[item];
    if (job->error.result != WEFT_OK || job->as_written || !flatten_text(job->fragment.bytes, &job->flat, NULL)) return;
    job->text = cache_hash(CACHE_HASH, job->flat.bytes, job->flat.size);
    job->text = cache_hash(job->text, job->vertex.bytes, job->vertex.size);
}

/* Compiles the flat text. If that fails, the text as it is written says why. */
static void compile_flat(CompileJob *job) {
    WeftError error = {0};
    job->made = program_create("flat shader", (ShaderSource){job->vertex.bytes, NULL},
                               (ShaderSource){job->flat.bytes, NULL}, &error);
    if (!job->made) job->text = 0;
}

static void compile(CompileJob *job) {
    if (job->error.result != WEFT_OK) return;
    if (job->text) compile_flat(job);
    if (!job->made)
        job->made = program_create("material shader", (ShaderSource){job->vertex.bytes, &job->vertex},
                                   (ShaderSource){job->fragment.bytes, &job->fragment}, &job->error);
}

/* Returns the name that a text was compiled to before, or 0. A stale program may drop its own. */
static GLuint find_text(const Programs *programs, uint64_t text) {
    for (const Program *p = programs->first; p && text; p = p->next)
        if (p->text == text && !p->stale) return p->name;
    return 0;
}

/* Gives jobs whose flat text was compiled before that program, and lets jobs of one text wait for the first. */
static void share_texts(const Programs *programs, CompileJob *jobs, int count) {
    for (int k = 0; k < count; k++) {
        jobs[k].made = find_text(programs, jobs[k].text);
        for (int j = 0; j < k && jobs[k].text; j++) jobs[k].waits |= jobs[j].text == jobs[k].text;
    }
}

/* Returns what the first job of a text made. */
static GLuint made_before(const CompileJob *jobs, int job) {
    for (int k = 0; k < job; k++)
        if (jobs[k].text == jobs[job].text) return jobs[k].made;
    return 0;
}

static void compile_in_thread(void *user, int item, int thread) {
    const CompileBatch *batch = user;
    GlContext *context = batch->contexts[thread];
    GlOuter outer;
    if (batch->jobs[item].made || batch->jobs[item].waits) return;
    if (!context_enter(context, &outer)) return;
    compile(&batch->jobs[item]);
    glFinish();
    context_leave(context, &outer);
    context_thread_ends();
}

/* Takes over a compiled program. If compiling failed, the earlier one stays. */
static void take(Programs *programs, CompileJob *job) {
    Program *self = job->program;
    const Text *text = &job->fragment;
    GLuint tables = 0;
    if (job->made) tables = make_tables(programs, text->tables, text->table_count, &job->error);
    programs->compiled++;
    self->stale = false;
    self->error = job->error;
    if (job->error.result == WEFT_OK) {
        const Program before = *self;
        self->name = job->made;
        self->text = job->text;
        drop(programs, &before);
        self->tables = tables;
        self->own_count = text->table_count;
        self->sheens_version = programs->sheens_version;
        memcpy(self->own, text->tables, sizeof self->own);
        bind_blocks(self->name);
        set_units(self);
    } else {
        drop(programs, &(Program){.name = job->made});
        job->made = 0;
    }
    text_free(&job->vertex);
    text_free(&job->fragment);
    buffer_free(&job->flat);
}

/* Makes the tables of a program again, with changed ones of the sheens behind its own. */
static bool take_sheens(const Programs *programs, Program *self, WeftError *error) {
    WeftError said = {0};
    GLuint tables = make_tables(programs, self->own, self->own_count, &said);
    if (said.result != WEFT_OK) {
        *error = said;
        return false;
    }
    glDeleteTextures(1, &self->tables);
    self->tables = tables;
    self->sheens_version = programs->sheens_version;
    return true;
}

/* Returns a context to compile in, or NULL if none can be shared, or entered. */
static GlContext *share_context(const GlContext *context) {
    GlOuter outer;
    GlContext *self = context_share(context);
    if (self && context_enter(self, &outer)) {
        context_leave(self, &outer);
        return self;
    }
    context_destroy(self);
    return NULL;
}

/* Creates a context for each thread. */
static void share_contexts(CompileBatch *batch, const GlContext *context, int threads) {
    if (threads <= 0) threads = thread_count();
    if (threads > batch->count) threads = batch->count;
    while (batch->threads < threads && (batch->contexts[batch->threads] = share_context(context))) batch->threads++;
}

static void compile_all(void *user) {
    CompileBatch *batch = user;
    parallel_for(batch->threads, batch->count, compile_in_thread, batch);
}

/* Compiles the jobs in several threads. Drivers compile and link in the calling thread, which takes as long as
 * everything else together. The caller's thread does not compile: each thread has its own part of the heap, so that the
 * few blocks which a compiler keeps do not lie among the caller's and hold whole pages. */
static void build(Programs *programs, const GlContext *context, CompileJob *jobs, int count) {
    CompileBatch batch = {.jobs = jobs, .count = count};
    for (int k = 0; k < count; k++) write_text(programs, &jobs[k]);
    parallel_for(programs->fits.threads, count, flatten_in_thread, jobs);
    share_texts(programs, jobs, count);
    share_contexts(&batch, context, programs->fits.threads);
    if (batch.threads) run_in_thread(compile_all, &batch);
    for (int k = 0; k < batch.threads; k++) context_destroy(batch.contexts[k]);
    for (int k = 0; k < count; k++) {
        if (jobs[k].waits) jobs[k].made = made_before(jobs, k);
        /* where no context is shared, or a thread could not enter its own */
        if (!jobs[k].made) compile(&jobs[k]);
        take(programs, &jobs[k]);
    }
    memory_return();
}

/* Returns the program of a key, or NULL. */
static Program *find(const Programs *programs, const ShaderKey *key) {
    Program *p = programs->first;
    while (p && memcmp((const char *)&p->key, (const char *)key, sizeof *key) != 0) p = p->next;
    return p;
}

/* Returns the program of a key, or a new one that is stale; NULL if memory is short. */
static Program *find_or_add(Programs *programs, const ShaderKey *key) {
    Program *p = find(programs, key);
    if (p) return p;
    p = alloc_array(1, sizeof *p);
    if (!p) return NULL;
    memcpy(&p->key, key, sizeof *key);
    p->stale = true;
    p->next = programs->first;
    programs->first = p;
    return p;
}

bool programs_want(Programs *programs, const ShaderKey *key) {
    Program *p = find_or_add(programs, key);
    if (!p) return false;
    p->used = programs->tick;
    if (p->stale && !p->wanted) programs->wanted++;
    p->wanted = p->stale;
    return true;
}

bool programs_has(Programs *programs, const ShaderKey *key) {
    const Program *p = find(programs, key);
    return p && !p->stale;
}

/* Deletes a program and takes it out of the list, in which `at` points to it. */
static void forget_at(Programs *programs, Program **at) {
    Program *p = *at;
    *at = p->next;
    drop(programs, p);
    free(p);
}

void programs_forget(Programs *programs, bool (*is_spare)(const ShaderKey *key)) {
    for (Program **at = &programs->first; *at;) {
        if (is_spare(&(*at)->key))
            forget_at(programs, at);
        else
            at = &(*at)->next;
    }
}

/* Returns true if a program shades: others are small. */
static bool shades(const Program *self) { return !self->key.depth && !self->key.resolve; }

/* Deletes the program that was used longest ago, of those that shade. Returns false if all were used in the last
 * PROGRAMS_LATE pictures. */
static bool forget_oldest(Programs *programs) {
    Program **oldest = NULL;
    for (Program **at = &programs->first; *at; at = &(*at)->next)
        if (shades(*at) && (!oldest || (*at)->used <= (*oldest)->used)) oldest = at;
    if (!oldest || programs->tick - (*oldest)->used < PROGRAMS_LATE) return false;
    forget_at(programs, oldest);
    return true;
}

/* Deletes programs until PROGRAMS_KEPT are left, among which are those to be compiled. */
static void forget(Programs *programs) {
    int count = 0;
    for (const Program *p = programs->first; p; p = p->next) count += shades(p);
    while (count > PROGRAMS_KEPT && forget_oldest(programs)) count--;
}

bool programs_build(Programs *programs, const GlContext *context) {
    int count = 0;
    programs->tick++;
    if (!programs->wanted) return true;
    forget(programs);
    CompileJob *jobs = alloc_array((size_t)programs->wanted, sizeof *jobs);
    if (!jobs) return false;
    for (Program *p = programs->first; p; p = p->next) {
        if (p->wanted) jobs[count++].program = p;
        p->wanted = false;
    }
    programs->wanted = 0;
    build(programs, context, jobs, count);
    free(jobs);
    return true;
}

const Program *programs_get(Programs *programs, const ShaderKey *key, WeftError *error) {
    Program *p = find(programs, key);
    if (!p) return NULL;
    if (p->name && p->sheens_version != programs->sheens_version && !take_sheens(programs, p, error)) return NULL;
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
    for (Program *p = programs->first; p; p = programs->first) {
        programs->first = p->next;
        drop(programs, p);
        free(p);
    }
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

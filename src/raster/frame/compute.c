#include "raster/frame/compute.h"

#include <stdio.h>
#include <stdlib.h>

#include <epoxy/gl.h>

#include "base/fail.h"
#include "base/memory.h"
#include "raster/gl/gl_check.h"
#include "raster/gl/program.h"
#include "raster/material/gl_tables.h"

/* Samples lie in rows of a texture. More samples than WIDTH * HEIGHT take several runs. */
enum { WIDTH = 1024, HEIGHT = 256, TARGETS = 4, PASSES_MAX = COMPUTE_OUTPUTS_MAX / TARGETS };

struct Compute {
    GlContext *context;
    int inputs, outputs, passes;
    GLuint programs[PASSES_MAX];
    GLuint input, tables; /* array textures */
    GLuint targets[TARGETS], framebuffer, vertices;
    int height; /* rows that input and targets have */
};

static const char vertex_body[] = "void main() {\n"
                                  "    vec2 corner = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2));\n"
                                  "    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);\n}\n";

static const char *version_line(TextLanguage language) {
    return language == TEXT_GLSL_ES_300 ? "#version 300 es\n" : "#version 330 core\n";
}

/* Appends the caller's text, and a main around the body that writes the outputs of a pass. */
static void put_fragment(Buffer *out, const ComputeDesc *desc, int pass) {
    char line[160];
    int first = pass * TARGETS, last = first + TARGETS < desc->outputs ? first + TARGETS : desc->outputs;
    buffer_put_text(out, desc->text->bytes);
    buffer_put_text(out, "\nuniform highp sampler2DArray compute_inputs;\n");
    for (int k = first; k < last; k++) {
        snprintf(line, sizeof line, "layout(location = %d) out highp vec4 compute_out%d;\n", k - first, k);
        buffer_put_text(out, line);
    }
    buffer_put_text(out, "\nvoid main() {\n    ivec2 compute_at = ivec2(gl_FragCoord.xy);\n");
    for (int k = 0; k < desc->inputs; k++) {
        snprintf(line, sizeof line, "    vec4 in%d = texelFetch(compute_inputs, ivec3(compute_at, %d), 0);\n", k, k);
        buffer_put_text(out, line);
    }
    for (int k = 0; k < desc->outputs; k++) {
        snprintf(line, sizeof line, "    vec4 out%d = vec4(0.0);\n", k);
        buffer_put_text(out, line);
    }
    buffer_put_text(out, desc->body);
    for (int k = first; k < last; k++) {
        snprintf(line, sizeof line, "\n    compute_out%d = out%d;", k, k);
        buffer_put_text(out, line);
    }
    buffer_put_text(out, "\n}\n");
}

static WeftResult build_programs(Compute *self, const ComputeDesc *desc, WeftError *error) {
    Buffer vertex = {0};
    buffer_put_text(&vertex, version_line(context_language(self->context)));
    buffer_put_text(&vertex, vertex_body);
    WeftResult result = WEFT_OK;
    for (int pass = 0; pass < self->passes && result == WEFT_OK; pass++) {
        Buffer fragment = {0};
        put_fragment(&fragment, desc, pass);
        if (vertex.failed || fragment.failed) {
            result = fail(error, WEFT_MESSAGE_MEMORY, desc->name, NULL);
        } else {
            WeftError local = {0};
            GLuint program = program_create(desc->name, (ShaderSource){vertex.bytes, NULL},
                                            (ShaderSource){fragment.bytes, desc->text}, &local);
            self->programs[pass] = program;
            if (!program) {
                result = local.result;
                if (error) *error = local;
            } else {
                glUseProgram(program);
                glUniform1i(glGetUniformLocation(program, "compute_inputs"), 0);
                glUniform1i(glGetUniformLocation(program, "weft_tables"), 1);
            }
        }
        buffer_free(&fragment);
    }
    buffer_free(&vertex);
    return result;
}

/* Makes the textures large enough for n samples, at most WIDTH * HEIGHT. Fails as compute_run does. */
static WeftResult reserve(Compute *self, size_t n, WeftError *error) {
    size_t rows = (n + WIDTH - 1) / WIDTH;
    int height = rows < HEIGHT ? (int)rows : HEIGHT;
    if (height <= self->height) return WEFT_OK;
    glBindTexture(GL_TEXTURE_2D_ARRAY, self->input);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, WIDTH, height, self->inputs, 0, GL_RGBA, GL_FLOAT, NULL);
    glBindFramebuffer(GL_FRAMEBUFFER, self->framebuffer);
    int targets = self->outputs < TARGETS ? self->outputs : TARGETS;
    for (int k = 0; k < targets; k++) {
        glBindTexture(GL_TEXTURE_2D, self->targets[k]);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, WIDTH, height, 0, GL_RGBA, GL_FLOAT, NULL);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0 + (GLenum)k, GL_TEXTURE_2D, self->targets[k], 0);
    }
    WeftResult result = gl_check(error, "memory for the samples");
    if (result != WEFT_OK) return result;
    GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        return fail(error, WEFT_MESSAGE_GL_CONTEXT, "drawing floating-point numbers", "driver error 0x%x", status);
    self->height = height;
    return WEFT_OK;
}

static void make_objects(Compute *self) {
    glGenVertexArrays(1, &self->vertices);
    glGenFramebuffers(1, &self->framebuffer);
    glGenTextures(1, &self->input);
    glBindTexture(GL_TEXTURE_2D_ARRAY, self->input);
    texture_unfiltered(GL_TEXTURE_2D_ARRAY);
    glGenTextures(TARGETS, self->targets);
    for (int k = 0; k < TARGETS; k++) {
        glBindTexture(GL_TEXTURE_2D, self->targets[k]);
        texture_unfiltered(GL_TEXTURE_2D);
    }
}

WeftResult compute_create(GlContext *context, const ComputeDesc *desc, Compute **out, WeftError *error) {
    *out = NULL;
    if (desc->inputs < 1 || desc->inputs > COMPUTE_INPUTS_MAX || desc->outputs < 1 ||
        desc->outputs > COMPUTE_OUTPUTS_MAX)
        return fail(error, WEFT_MESSAGE_DESC, desc->name, "%d inputs and %d outputs", desc->inputs, desc->outputs);
    Compute *self = alloc_array(1, sizeof *self);
    if (!self) return fail(error, WEFT_MESSAGE_MEMORY, desc->name, NULL);
    self->context = context;
    self->inputs = desc->inputs;
    self->outputs = desc->outputs;
    self->passes = (desc->outputs + TARGETS - 1) / TARGETS;
    GlOuter outer;
    if (!context_enter(context, &outer)) {
        free(self);
        return fail(error, WEFT_MESSAGE_GL_CONTEXT, desc->name, "its context is in use");
    }
    make_objects(self);
    WeftResult result = build_programs(self, desc, error);
    context_leave(context, &outer);
    if (result != WEFT_OK) {
        compute_destroy(self);
        return result;
    }
    *out = self;
    return WEFT_OK;
}

void compute_destroy(Compute *self) {
    GlOuter outer;
    if (!self) return;
    if (context_enter(self->context, &outer)) {
        for (int k = 0; k < self->passes; k++) glDeleteProgram(self->programs[k]);
        glDeleteTextures(1, &self->input);
        glDeleteTextures(1, &self->tables);
        glDeleteTextures(TARGETS, self->targets);
        glDeleteFramebuffers(1, &self->framebuffer);
        glDeleteVertexArrays(1, &self->vertices);
        context_leave(self->context, &outer);
    }
    free(self);
}

WeftResult compute_tables(Compute *self, const TextTable *tables, int count, WeftError *error) {
    GlOuter outer;
    WeftError local = {0};
    if (!context_enter(self->context, &outer))
        return fail(error, WEFT_MESSAGE_GL_CONTEXT, "tables", "their context is in use");
    glActiveTexture(GL_TEXTURE1);
    glDeleteTextures(1, &self->tables);
    self->tables = count ? tables_create(tables, count, &local) : 0;
    context_leave(self->context, &outer);
    if (error && local.result != WEFT_OK) *error = local;
    return local.result;
}

/* Uploads samples [first, first + count): the full rows, then the row that is left. */
static void upload(Compute *self, size_t first, int count, const float *const in[]) {
    int full = count / WIDTH, rest = count % WIDTH;
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D_ARRAY, self->input);
    for (int k = 0; k < self->inputs; k++) {
        const float *from = in[k] + 4 * first, *left = from + 4 * (size_t)full * WIDTH;
        if (full) glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, k, WIDTH, full, 1, GL_RGBA, GL_FLOAT, from);
        if (rest) glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, full, k, rest, 1, 1, GL_RGBA, GL_FLOAT, left);
    }
}

static void draw_pass(Compute *self, int pass, size_t first, int count, float *const out[]) {
    int start = pass * TARGETS, full = count / WIDTH, rest = count % WIDTH;
    int targets = self->outputs - start < TARGETS ? self->outputs - start : TARGETS;
    GLenum attachments[TARGETS];
    for (int k = 0; k < TARGETS; k++) attachments[k] = k < targets ? GL_COLOR_ATTACHMENT0 + (GLenum)k : GL_NONE;
    glDrawBuffers(targets, attachments);
    glViewport(0, 0, WIDTH, full + (rest > 0));
    glUseProgram(self->programs[pass]);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    for (int k = 0; k < targets; k++) {
        float *to = out[start + k] + 4 * first, *left = to + 4 * (size_t)full * WIDTH;
        glReadBuffer(attachments[k]);
        if (full) glReadPixels(0, 0, WIDTH, full, GL_RGBA, GL_FLOAT, to);
        if (rest) glReadPixels(0, full, rest, 1, GL_RGBA, GL_FLOAT, left);
    }
}

WeftResult compute_run(Compute *self, size_t n, const float *const in[], float *const out[], WeftError *error) {
    GlOuter outer;
    if (!context_enter(self->context, &outer))
        return fail(error, WEFT_MESSAGE_GL_CONTEXT, "a computation", "its context is in use");
    glActiveTexture(GL_TEXTURE0);
    WeftResult result = reserve(self, n, error);
    glBindFramebuffer(GL_FRAMEBUFFER, self->framebuffer);
    glBindVertexArray(self->vertices);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D_ARRAY, self->tables);
    for (size_t first = 0; first < n && result == WEFT_OK;) {
        int count = n - first < (size_t)WIDTH * HEIGHT ? (int)(n - first) : WIDTH * HEIGHT;
        upload(self, first, count, in);
        for (int pass = 0; pass < self->passes; pass++) draw_pass(self, pass, first, count, out);
        result = gl_check(error, "a computation");
        first += (size_t)count;
    }
    glActiveTexture(GL_TEXTURE0);
    context_leave(self->context, &outer);
    return result;
}

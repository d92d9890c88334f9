#include "raster/gl/program.h"

#include <epoxy/gl.h>

#include "raster/gl/complaint.h"

static GLuint compile(GLenum stage, const char *name, ShaderSource source, WeftError *error) {
    GLuint shader = glCreateShader(stage);
    GLint done = 0;
    glShaderSource(shader, 1, &source.bytes, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (done) return shader;
    char log[4096] = "";
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    complain(name, log, source.text, error);
    glDeleteShader(shader);
    return 0;
}

unsigned program_create(const char *name, ShaderSource vertex, ShaderSource fragment, WeftError *error) {
    GLuint v = compile(GL_VERTEX_SHADER, name, vertex, error), f = 0, program = 0;
    if (v) f = compile(GL_FRAGMENT_SHADER, name, fragment, error);
    if (f) {
        GLint done = 0;
        program = glCreateProgram();
        glAttachShader(program, v);
        glAttachShader(program, f);
        glLinkProgram(program);
        glDetachShader(program, v); /* an attached shader would keep as much memory as the program itself */
        glDetachShader(program, f);
        glGetProgramiv(program, GL_LINK_STATUS, &done);
        if (!done) {
            char log[4096] = "";
            glGetProgramInfoLog(program, sizeof log, NULL, log);
            complain(name, log, NULL, error);
            glDeleteProgram(program);
            program = 0;
        }
    }
    if (v) glDeleteShader(v);
    if (f) glDeleteShader(f);
    return program;
}

WeftResult program_on_screen(const char *name, const char *file, const TextDesc *desc, unsigned *program,
                             WeftError *error) {
    const TextDesc no_tables = {.language = desc->language, .folder = desc->folder};
    Text vertex, fragment;
    WeftError failure = {0};
    unsigned made = 0;
    text_begin(&vertex, &no_tables);
    text_include(&vertex, "raster/glsl/screen.glsl");
    text_begin(&fragment, &no_tables);
    text_include(&fragment, file);
    if (text_end(&vertex, &failure) == WEFT_OK && text_end(&fragment, &failure) == WEFT_OK)
        made = program_create(name, (ShaderSource){vertex.bytes, &vertex}, (ShaderSource){fragment.bytes, &fragment},
                              &failure);
    text_free(&vertex);
    text_free(&fragment);
    if (made) {
        *program = made;
        return WEFT_OK;
    }
    if (error) *error = failure;
    return failure.result;
}

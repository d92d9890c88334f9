#include "raster/program.h"

#include <string.h>

#include <epoxy/gl.h>

#include "base/fail.h"

/* The first line of the driver's words that is about an error; the first of all where none is. */
static void fail_log(const char *name, const char *log, WeftError *error) {
    const char *line = log, *marked = strstr(log, "error");
    if (!marked) marked = strstr(log, "ERROR");
    for (const char *c = log; marked && c < marked; c++)
        if (*c == '\n') line = c + 1;
    fail(error, WEFT_MESSAGE_GL_COMPILE, name, "%.*s", (int)strcspn(line, "\r\n"), line);
}

static GLuint compile(GLenum stage, const char *name, const char *text, WeftError *error) {
    GLuint shader = glCreateShader(stage);
    GLint done = 0;
    glShaderSource(shader, 1, &text, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
    if (done) return shader;
    char log[4096] = "";
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    fail_log(name, log, error);
    glDeleteShader(shader);
    return 0;
}

unsigned program_create(const char *name, const char *vertex, const char *fragment, WeftError *error) {
    GLuint v = compile(GL_VERTEX_SHADER, name, vertex, error), f = 0, program = 0;
    if (v) f = compile(GL_FRAGMENT_SHADER, name, fragment, error);
    if (f) {
        GLint done = 0;
        program = glCreateProgram();
        glAttachShader(program, v);
        glAttachShader(program, f);
        glLinkProgram(program);
        glGetProgramiv(program, GL_LINK_STATUS, &done);
        if (!done) {
            char log[4096] = "";
            glGetProgramInfoLog(program, sizeof log, NULL, log);
            fail_log(name, log, error);
            glDeleteProgram(program);
            program = 0;
        }
    }
    if (v) glDeleteShader(v);
    if (f) glDeleteShader(f);
    return program;
}

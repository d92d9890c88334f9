#include "raster/gl/display.h"

#include <math.h>

#include <epoxy/gl.h>

#include "raster/gl/gl_check.h"
#include "raster/gl/program.h"

static void set_program(Display *self, GLuint program) {
    glDeleteProgram(self->program);
    self->program = program;
    self->place = glGetUniformLocation(program, "show_place");
    self->back = glGetUniformLocation(program, "show_back");
    self->curve = glGetUniformLocation(program, "show_curve");
    self->white = glGetUniformLocation(program, "show_white");
    glUseProgram(program);
    glUniform1i(glGetUniformLocation(program, "picture_mean"), 0);
}

/* Compiles the program. If that fails, the one before stays in use. */
static void build(Display *self, const TextDesc *desc) {
    unsigned made = 0;
    self->stale = false;
    self->error = (WeftError){0};
    if (program_on_screen("display", "raster/glsl/display.glsl", desc, &made, &self->error) == WEFT_OK)
        set_program(self, made);
}

WeftResult display_draw(Display *self, const TextDesc *desc, const Target *target, const WeftRasterShow *show,
                        WeftError *error) {
    if (self->stale || (!self->program && self->error.result == WEFT_OK)) build(self, desc);
    if (!self->program) {
        if (error) *error = self->error;
        return self->error.result;
    }
    float white[9];
    weft_white_matrix(show->white, white);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, show->framebuffer);
    glViewport(show->x, show->y, show->width, show->height);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    if (show->clip[2] > 0) {
        glEnable(GL_SCISSOR_TEST);
        glScissor(show->clip[0], show->clip[1], show->clip[2], show->clip[3]);
    }
    glUseProgram(self->program);
    glUniform4f(self->place, (float)show->x, (float)show->y, (float)show->width, (float)show->height);
    glUniform4f(self->back, show->background[0], show->background[1], show->background[2], exp2f(show->exposure));
    glUniform1i(self->curve, (int)show->tonemap);
    glUniform3fv(self->white, 3, white);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, target->mean);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_SCISSOR_TEST);
    return gl_check(error, "showing a picture");
}

void display_destroy(Display *self) {
    glDeleteProgram(self->program);
    *self = (Display){0};
}

#include "raster/gl/gl_check.h"

#include <epoxy/gl.h>

#include "base/fail.h"

WeftResult gl_check(WeftError *error, const char *what) {
    GLenum code = glGetError();
    if (code == GL_NO_ERROR) return WEFT_OK;
    /* a driver may have one pending of each kind; a lost context reports errors for ever */
    for (int k = 0; k < 8 && glGetError() != GL_NO_ERROR; k++) continue;
    if (code == GL_OUT_OF_MEMORY) return fail(error, WEFT_MESSAGE_GL_MEMORY, what, NULL);
    return fail(error, WEFT_MESSAGE_GL_CONTEXT, what, "driver error 0x%x", code);
}

void texture_unfiltered(unsigned target) {
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

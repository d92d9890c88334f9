#include "raster/material/gl_tables.h"

#include <epoxy/gl.h>

#include "raster/gl/gl_check.h"

unsigned tables_create(const TextTable *tables, int count, WeftError *error) {
    int rows = 1, columns = 1;
    for (int k = 0; k < count; k++) {
        if (tables[k].rows > rows) rows = tables[k].rows;
        if (tables[k].columns > columns) columns = tables[k].columns;
    }
    GLuint texture;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D_ARRAY, texture);
    texture_unfiltered(GL_TEXTURE_2D_ARRAY);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R32F, columns, rows, count, 0, GL_RED, GL_FLOAT, NULL);
    for (int k = 0; k < count; k++)
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, k, tables[k].columns, tables[k].rows, 1, GL_RED, GL_FLOAT,
                        tables[k].texels);
    if (gl_check(error, "tables") == WEFT_OK) return texture;
    glDeleteTextures(1, &texture);
    return 0;
}

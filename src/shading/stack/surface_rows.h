/* surface_rows.h - surfaces as arrays: a row of numbers for each input of inputs.h */
#pragma once

#include "shading/stack/surface.h"

/* Elements are worked on in whole groups of ROW_LANES. Rows lie no power of two apart, or some sets of the
 * near cache would have to hold all of them. */
enum { ROW_LANES = 16, ROW_MOST = 256, ROW_CAPACITY = ROW_MOST + ROW_LANES };

static inline int row_whole(int n) { return (n + ROW_LANES - 1) & ~(ROW_LANES - 1); }

/* Element k of three rows. */
#define ROW_DIR(rows, k) dir((rows)[0][k], (rows)[1][k], (rows)[2][k])

#define ROW_RGB(rows, k) rgb((rows)[0][k], (rows)[1][k], (rows)[2][k])

#define ROWS_OF_SCALAR(name)                                                                 float name[ROW_CAPACITY];
#define ROWS_OF_COLOR(name)                                                                  float name[3][ROW_CAPACITY];
#define ROWS_OF_NORMAL(name)                                                                 float name[3][ROW_CAPACITY];
#define ROWS_OF_DIRECTION(name)                                                              float name[3][ROW_CAPACITY];
#define ROWS_OF_ANGLE(name)                                                                  float name[ROW_CAPACITY];
#define SURFACE_ROWS(kind, name, label, initial, low, high, hard_low, hard_high, role, help) ROWS_OF_##kind(name)
typedef struct SurfaceRows {
    SURFACE_INPUTS(SURFACE_ROWS)
} SurfaceRows;

#define ROW_GET_SCALAR(name)                                                                s.name = rows->name[k];
#define ROW_GET_COLOR(name)                                                                 s.name.r = rows->name[0][k], s.name.g = rows->name[1][k], s.name.b = rows->name[2][k];
#define ROW_GET_NORMAL(name)                                                                s.name.x = rows->name[0][k], s.name.y = rows->name[1][k], s.name.z = rows->name[2][k];
#define ROW_GET_DIRECTION(name)                                                             ROW_GET_NORMAL(name)
#define ROW_GET_ANGLE(name)                                                                 ROW_GET_SCALAR(name)
#define SURFACE_GET(kind, name, label, initial, low, high, hard_low, hard_high, role, help) ROW_GET_##kind(name)
FN Surface surface_of_row(const SurfaceRows *rows, size_t k) {
    Surface s;
    SURFACE_INPUTS(SURFACE_GET)
    return s;
}

#define ROW_PUT_SCALAR(name)                                                                rows->name[k] = s->name;
#define ROW_PUT_COLOR(name)                                                                 rows->name[0][k] = s->name.r, rows->name[1][k] = s->name.g, rows->name[2][k] = s->name.b;
#define ROW_PUT_NORMAL(name)                                                                rows->name[0][k] = s->name.x, rows->name[1][k] = s->name.y, rows->name[2][k] = s->name.z;
#define ROW_PUT_DIRECTION(name)                                                             ROW_PUT_NORMAL(name)
#define ROW_PUT_ANGLE(name)                                                                 ROW_PUT_SCALAR(name)
#define SURFACE_PUT(kind, name, label, initial, low, high, hard_low, hard_high, role, help) ROW_PUT_##kind(name)
FN void surface_to_row(SurfaceRows *rows, size_t k, const Surface *s) { SURFACE_INPUTS(SURFACE_PUT) }

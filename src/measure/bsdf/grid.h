/* grid.h - the hemisphere of wi cut into cells that are small where lobes change fast
 *
 * A square [-1, 1]^2 is stretched about the direction that mirrors wo: theta and phi move slowly there, and
 * also at the far ends (normal, horizon, backscatter). Integrals are midpoint sums over it. */
#pragma once

#include "measure/bsdf/bsdf.h"

enum { GRID_MAX = 400 };

typedef struct Grid {
    int cells;         /* along one side */
    double theta, phi; /* of the mirror direction */
    float cos_phi[GRID_MAX], sin_phi[GRID_MAX];
    double width[GRID_MAX]; /* of a column, in phi */
} Grid;

/* One row of cells: a ring of constant theta. */
typedef struct Ring {
    float x[GRID_MAX], y[GRID_MAX], z[GRID_MAX];
    double area[GRID_MAX]; /* solid angle, sr */
} Ring;

void grid_make(Grid *grid, Dir o, int cells);

/* A line of the square: cosine and sine of phi, or of theta, and the derivative of phi, or of -cos theta,
 * along the side of the square. ds dt of the square is row.slope column.slope sr. */
typedef struct GridLine {
    float cosine, sine;
    double slope;
} GridLine;

/* Returns the line at a place t or s in [-1, 1]. */
GridLine grid_column(const Grid *grid, double t);
GridLine grid_row(const Grid *grid, double s);

/* Fills row k and returns its directions. */
Dirs grid_ring(const Grid *grid, int k, Ring *ring);

/* Returns the cell of a direction if each side is cut into `bins`: row * bins + column. */
int grid_bin(const Grid *grid, Dir i, int bins);

/* Returns a direction by its cosine, exact near both ends, at an azimuth in radians. */
Dir grid_direction(double cosine, double phi);

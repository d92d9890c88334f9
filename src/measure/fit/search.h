/* search.h - the minimum of an error over a few numbers, each within its range
 *
 * A grid of points finds where to begin. A simplex search goes on, roughly, from the best of them and from
 * the start of the caller, and then accurately from the best place that it found. No random numbers are used:
 * the same input gives the same result. */
#pragma once

#include "measure/bsdf/progress_loop.h"

enum { SEARCH_MOST = 16 };

/* A number and its range. If low is above 0 and high at least ten times as much, steps are steps of its logarithm. */
typedef struct SearchAxis {
    double low, high;
} SearchAxis;

/* The accuracy to which an error is computed. */
typedef enum SearchCare {
    SEARCH_GLANCE, /* for a point of the grid, fast; x may be changed to something better nearby */
    SEARCH_ROUGH,  /* for a rough descent */
    SEARCH_FULL    /* for the final descent and the result */
} SearchCare;

typedef struct Search {
    int axes; /* 0 .. SEARCH_MOST */
    SearchAxis axis[SEARCH_MOST];
    double (*error)(void *user, double *x, SearchCare care); /* at x[axes] */
    void *user;
    int grid;     /* points of the grid, 0: none */
    int descents; /* rough descents, from so many of the best points and from the caller's start */
    int most;     /* most evaluations of a rough descent; an accurate one has half of it, six times at most */
    ItemProgress *item_progress; /* may be NULL; can stop the search */
} Search;

/* Searches from x, sets x to the best place found and returns the error there. Adds the number of evaluations
 * to *evaluations (may be NULL). */
double search_run(const Search *search, double *x, long long *evaluations);

/* Returns the least error of `points` points of the grid, computed roughly, to choose between searches. */
double search_glance(const Search *search, int points, long long *evaluations);

/* search.h - the least error over a few numbers, each within its range
 *
 * A grid of points finds where to begin; a simplex search goes on, roughly, from the best of them and from
 * where the caller begins, and then with all care from the best of what that found. Nothing is drawn at
 * random: the same question has the same answer. */
#ifndef WEFT_MEASURE_SEARCH_H
#define WEFT_MEASURE_SEARCH_H

#include "measure/bsdf/progress_loop.h"

enum { SEARCH_MOST = 16 };

/* A number and its range. Where low is above 0 and high ten times that or more, steps are steps of its
 * logarithm. */
typedef struct SearchAxis {
    double low, high;
} SearchAxis;

/* The accuracy to which an error is computed. */
typedef enum SearchCare {
    SEARCH_GLANCE, /* of a point of the grid: quickly; x may be changed to something better nearby */
    SEARCH_ROUGH,  /* on the way */
    SEARCH_FULL    /* in the end */
} SearchCare;

typedef struct Search {
    int axes; /* 0 .. SEARCH_MOST */
    SearchAxis axis[SEARCH_MOST];
    double (*error)(void *user, double *x, SearchCare care); /* at x[axes] */
    void *user;
    int grid;     /* points of it, 0: none */
    int descents; /* rough ones, from so many of the best, and from the caller's start */
    int most;     /* evaluations of a rough descent; careful: half of that, six times at most */
    ItemProgress *item_progress; /* may be NULL; where it says that the item should end, the search does */
} Search;

/* x comes as the start and leaves as the best that was found; returns its error. *evaluations (may be NULL)
 * grows by what it took. */
double search_run(const Search *search, double *x, long long *evaluations);

/* The least error of so many points of the grid, computed roughly: for a choice between searches. */
double search_glance(const Search *search, int points, long long *evaluations);

#endif

/* search.h - the least error over a few numbers, each within its range
 *
 * A grid of points finds where to begin, a simplex search goes on from the best of them and from where the
 * caller begins. Nothing is drawn at random: the same question has the same answer. */
#ifndef WEFT_MEASURE_SEARCH_H
#define WEFT_MEASURE_SEARCH_H

#include <stdbool.h>

enum { SEARCH_MOST = 16 };

/* A number and its range. Where low is above 0 and high ten times that or more, steps are steps of its
 * logarithm. */
typedef struct SearchAxis {
    double low, high;
} SearchAxis;

typedef struct Search {
    int axes; /* 0 .. SEARCH_MOST */
    SearchAxis axis[SEARCH_MOST];
    /* The error at x[axes], quickly about or as well as it can be told. Asked for quickly, of a point of the
     * grid, it may change x to something better nearby. */
    double (*error)(void *user, double *x, bool quick);
    void *user;
    int grid;     /* points of it, 0: none */
    int descents; /* from so many of the best, and from the caller's start */
    int most;     /* evaluations of a descent */
} Search;

/* x comes as the start and leaves as the best that was found; returns its error. *evaluations (may be NULL)
 * grows by what it
 * took. */
double search_run(const Search *search, double *x, long long *evaluations);

#endif

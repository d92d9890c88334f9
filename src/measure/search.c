#include "measure/search.h"

#include <math.h>
#include <string.h>

#include <nlopt.h>

enum { GRID_MOST = 1024, DESCENTS_MOST = 8 };

/* A place in the unit cube, and the error there. */
typedef struct Place {
    double at[SEARCH_MOST], error;
} Place;

typedef struct Walk {
    const Search *search;
    Place best;
    long long evaluations;
} Walk;

static bool by_logarithm(const SearchAxis *axis) { return axis->low > 0.0 && axis->high >= 10.0 * axis->low; }

static double value_of(const SearchAxis *axis, double at) {
    double t = fmin(fmax(at, 0.0), 1.0);
    double value =
        by_logarithm(axis) ? axis->low * pow(axis->high / axis->low, t) : axis->low + (axis->high - axis->low) * t;
    return fmin(fmax(value, axis->low), axis->high);
}

static double place_of(const SearchAxis *axis, double value) {
    if (!(axis->high > axis->low)) return 0.0;
    double t = by_logarithm(axis) ? log(value / axis->low) / log(axis->high / axis->low)
                                  : (value - axis->low) / (axis->high - axis->low);
    return fmin(fmax(t, 0.0), 1.0);
}

static void values_of(const Search *search, const double *at, double *x) {
    for (int k = 0; k < search->axes; k++) x[k] = value_of(&search->axis[k], at[k]);
}

static void places_of(const Search *search, const double *x, double *at) {
    for (int k = 0; k < search->axes; k++) at[k] = place_of(&search->axis[k], x[k]);
}

static double error_at(Walk *walk, const double *at, bool quick, double *x) {
    values_of(walk->search, at, x);
    walk->evaluations++;
    double error = walk->search->error(walk->search->user, x, quick);
    return error < 1e30 ? error : 1e30; /* NaN too */
}

static double objective(unsigned n, const double *at, double *gradient, void *user) {
    (void)gradient;
    Walk *walk = user;
    double x[SEARCH_MOST], error = error_at(walk, at, false, x);
    if (error < walk->best.error) {
        walk->best.error = error;
        memcpy(walk->best.at, at, n * sizeof *at);
    }
    return error;
}

/* Thomas Harvey Rowan, "Functional Stability Analysis of Numerical Algorithms", PhD thesis, University of
 * Texas at Austin, 1990, as Steven G. Johnson wrote it for NLopt: no random numbers. */
static void descend_once(Walk *walk, const double *from, double step) {
    unsigned n = (unsigned)walk->search->axes;
    double at[SEARCH_MOST], least;
    nlopt_opt method = nlopt_create(NLOPT_LN_SBPLX, n);
    if (!method) return;
    memcpy(at, from, n * sizeof *at);
    nlopt_set_min_objective(method, objective, walk);
    nlopt_set_lower_bounds1(method, 0.0);
    nlopt_set_upper_bounds1(method, 1.0);
    nlopt_set_initial_step1(method, step);
    nlopt_set_maxeval(method, walk->search->most);
    nlopt_set_ftol_rel(method, 1e-7);
    nlopt_set_xtol_abs1(method, 1e-6);
    nlopt_set_stopval(method, 1e-8);
    nlopt_optimize(method, at, &least);
    nlopt_destroy(method);
}

/* A simplex that has shrunk along a valley is opened again, where it stands. */
static Place descend(Walk *walk, const Place *from) {
    double step = 0.1;
    walk->best = *from;
    walk->best.error = 1e30;
    for (int round = 0; round < 6; round++, step = fmax(0.5 * step, 0.01)) {
        double before = walk->best.error;
        Place start = walk->best;
        descend_once(walk, start.at, step);
        if (!(walk->best.error < 0.999 * before && walk->best.error > 1e-7)) break;
    }
    return walk->best;
}

/* Point number k of the sequence of John H. Halton, 1960: even over the cube, however many there are. */
static double halton(int k, int axis) {
    static const int primes[SEARCH_MOST] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53};
    double value = 0.0, digit = 1.0 / primes[axis];
    for (; k > 0; k /= primes[axis], digit /= primes[axis]) value += (k % primes[axis]) * digit;
    return value;
}

static double distance(const Place *a, const Place *b, int axes) {
    double most = 0.0;
    for (int k = 0; k < axes; k++) most = fmax(most, fabs(a->at[k] - b->at[k]));
    return most;
}

/* Keeps a point among the best, of which none is near another. */
static void keep(Place *best, int *count, int room, int axes, const Place *place) {
    for (int k = 0; k < *count; k++) {
        if (distance(&best[k], place, axes) >= 0.1) continue;
        if (place->error < best[k].error) best[k] = *place;
        return;
    }
    int worst = 0;
    for (int k = 1; k < *count; k++)
        if (best[k].error > best[worst].error) worst = k;
    if (*count < room)
        best[(*count)++] = *place;
    else if (place->error < best[worst].error)
        best[worst] = *place;
}

double search_run(const Search *search, double *x, long long *evaluations) {
    Walk walk = {.search = search};
    Place best = {.error = 0.0}, place, starts[DESCENTS_MOST];
    int count = 0, room = search->descents < DESCENTS_MOST ? search->descents : DESCENTS_MOST;
    int grid = search->grid < GRID_MOST ? search->grid : GRID_MOST;
    double y[SEARCH_MOST];
    places_of(search, x, best.at);
    best.error = error_at(&walk, best.at, false, y);
    Place start = best;
    bool moves = search->axes > 0 && best.error > 1e-7;
    for (int k = 0; k < grid && moves && room > 0; k++) {
        for (int a = 0; a < search->axes; a++) place.at[a] = halton(k + 1, a);
        place.error = error_at(&walk, place.at, true, y);
        places_of(search, y, place.at);
        keep(starts, &count, room, search->axes, &place);
    }
    for (int k = -1; k < count && moves && best.error > 1e-7; k++) {
        Place found = descend(&walk, k < 0 ? &start : &starts[k]);
        if (found.error < best.error) best = found;
    }
    if (best.error < start.error) values_of(search, best.at, x);
    if (evaluations) *evaluations += walk.evaluations;
    return best.error;
}

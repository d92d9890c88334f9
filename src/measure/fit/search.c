#include "measure/fit/search.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include <nlopt.h>

#include "measure/bsdf/halton.h"

enum { GRID_MOST = 1024, DESCENTS_MOST = 8 };

/* A place in the unit cube, and the error there. */
typedef struct SearchPlace {
    double at[SEARCH_MOST], error;
} SearchPlace;

typedef struct SearchDescent {
    const Search *search;
    SearchCare care;
    SearchPlace best;
    long long evaluations;
    nlopt_opt method; /* of the current descent */
    bool stopped;
} SearchDescent;

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

/* Returns the most evaluations that a search takes. */
static double evaluations_most(const Search *search) {
    return 1.0 + search->grid + (1.0 + search->descents) * search->most + 3.0 * search->most;
}

/* Evaluates the error, or returns 1e30 if the search should end. */
static double error_at(SearchDescent *walk, const double *at, SearchCare care, double *x) {
    values_of(walk->search, at, x);
    walk->stopped = walk->stopped || !progress_report(walk->search->item_progress,
                                                      (double)walk->evaluations / evaluations_most(walk->search));
    if (walk->stopped) return 1e30;
    walk->evaluations++;
    double error = walk->search->error(walk->search->user, x, care);
    return error < 1e30 ? error : 1e30; /* NaN too */
}

static double objective(unsigned n, const double *at, double *gradient, void *user) {
    (void)gradient;
    SearchDescent *walk = user;
    double x[SEARCH_MOST], error = error_at(walk, at, walk->care, x);
    if (error < walk->best.error) {
        walk->best.error = error;
        memcpy(walk->best.at, at, n * sizeof *at);
    }
    if (walk->stopped) nlopt_force_stop(walk->method);
    return error;
}

/* Descends once by NLopt's Subplex, which uses no random numbers: Thomas Harvey Rowan, "Functional Stability Analysis
 * of Numerical Algorithms", PhD thesis, University of Texas at Austin, 1990, as reimplemented by Steven G. Johnson. */
static void descend_once(SearchDescent *walk, const double *from, double step) {
    unsigned n = (unsigned)walk->search->axes;
    double at[SEARCH_MOST], least;
    nlopt_opt method = nlopt_create(NLOPT_LN_SBPLX, n);
    if (!method) return;
    walk->method = method;
    memcpy(at, from, n * sizeof *at);
    nlopt_set_min_objective(method, objective, walk);
    nlopt_set_lower_bounds1(method, 0.0);
    nlopt_set_upper_bounds1(method, 1.0);
    nlopt_set_initial_step1(method, step);
    nlopt_set_maxeval(method, walk->care == SEARCH_FULL ? walk->search->most / 2 : walk->search->most);
    nlopt_set_ftol_rel(method, 1e-7);
    nlopt_set_xtol_abs1(method, 1e-6);
    nlopt_set_stopval(method, 1e-8);
    nlopt_optimize(method, at, &least);
    nlopt_destroy(method);
}

/* Descends in rounds: a simplex that has shrunk along a valley is opened again at its place. */
static SearchPlace descend(SearchDescent *walk, const SearchPlace *from, SearchCare care) {
    double step = care == SEARCH_FULL ? 0.03 : 0.1;
    int rounds = care == SEARCH_FULL ? 6 : 1;
    walk->care = care;
    walk->best = *from;
    walk->best.error = 1e30;
    for (int round = 0; round < rounds && !walk->stopped; round++, step = fmax(0.5 * step, 0.01)) {
        double before = walk->best.error;
        SearchPlace start = walk->best;
        descend_once(walk, start.at, step);
        if (!(walk->best.error < 0.999 * before && walk->best.error > 1e-7)) break;
    }
    return walk->best;
}

static const int primes[SEARCH_MOST] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53};

static double distance(const SearchPlace *a, const SearchPlace *b, int axes) {
    double most = 0.0;
    for (int k = 0; k < axes; k++) most = fmax(most, fabs(a->at[k] - b->at[k]));
    return most;
}

/* Keeps a place among the best ones, no two of which are near each other. */
static void keep(SearchPlace *best, int *count, int capacity, int axes, const SearchPlace *place) {
    for (int k = 0; k < *count; k++) {
        if (distance(&best[k], place, axes) >= 0.1) continue;
        if (place->error < best[k].error) best[k] = *place;
        return;
    }
    int worst = 0;
    for (int k = 1; k < *count; k++)
        if (best[k].error > best[worst].error) worst = k;
    if (*count < capacity)
        best[(*count)++] = *place;
    else if (place->error < best[worst].error)
        best[worst] = *place;
}

/* Returns the best of the rough descents. */
static SearchPlace roughly(SearchDescent *walk, const SearchPlace *start) {
    const Search *search = walk->search;
    SearchPlace starts[DESCENTS_MOST], place;
    int count = 0, capacity = search->descents < DESCENTS_MOST ? search->descents : DESCENTS_MOST;
    int grid = search->grid < GRID_MOST ? search->grid : GRID_MOST;
    for (int k = 0; k < grid && capacity > 0 && !walk->stopped; k++) {
        double x[SEARCH_MOST];
        for (int a = 0; a < search->axes; a++) place.at[a] = halton(k + 1, primes[a]);
        place.error = error_at(walk, place.at, SEARCH_GLANCE, x);
        places_of(search, x, place.at);
        keep(starts, &count, capacity, search->axes, &place);
    }
    SearchPlace best = descend(walk, start, SEARCH_ROUGH);
    for (int k = 0; k < count && best.error > 1e-7 && !walk->stopped; k++) {
        place = descend(walk, &starts[k], SEARCH_ROUGH);
        if (place.error < best.error) best = place;
    }
    return best;
}

double search_run(const Search *search, double *x, long long *evaluations) {
    SearchDescent walk = {.search = search};
    SearchPlace start = {.error = 0.0}, best;
    double y[SEARCH_MOST];
    places_of(search, x, start.at);
    start.error = error_at(&walk, start.at, SEARCH_FULL, y);
    best = start;
    if (search->axes > 0 && start.error > 1e-7) {
        SearchPlace rough = roughly(&walk, &start);
        best = descend(&walk, &rough, SEARCH_FULL);
    }
    bool better = best.error < start.error;
    if (better) values_of(search, best.at, x);
    if (evaluations) *evaluations += walk.evaluations;
    return better ? best.error : start.error;
}

double search_glance(const Search *search, int points, long long *evaluations) {
    SearchDescent walk = {.search = search};
    double least = 1e30, at[SEARCH_MOST], x[SEARCH_MOST];
    for (int k = 0; k < points && !walk.stopped; k++) {
        for (int a = 0; a < search->axes; a++) at[a] = halton(k + 1, primes[a]);
        least = fmin(least, error_at(&walk, at, SEARCH_ROUGH, x));
    }
    if (evaluations) *evaluations += walk.evaluations;
    return least;
}

/* progress.h - a line on the terminal with the progress of a render or another long loop; nothing where there
 * is no terminal */
#pragma once

#include <stdbool.h>

typedef struct Progress {
    bool shown;
    const char *prefix; /* before all else, such as "2/3 " */
    int spp;            /* samples per pixel requested; 0: as many as the time allows */
    int spp_most;       /* samples per pixel at fraction 1 */
    double pixels;      /* in the picture */
    double limit;       /* s; 0: none */
    const char *unit;   /* of what is counted, "texels"; NULL: samples of a render */
    double count;       /* of these in all; 0: unknown */
    double started, drawn;
    int width; /* of the terminal, characters */
} Progress;

/* Begins a line, which is shown only where standard error is a terminal and quiet is false. spp may be 0, see above.
 * prefix must outlive the line. */
Progress progress_start(bool quiet, const char *prefix, int spp, int spp_most, double pixels, double limit);

/* Works as progress_start, for `count` things of another kind, such as texels. count 0 means unknown; unit must
 * outlive the line. */
Progress progress_start_count(bool quiet, const char *unit, double count);

/* Redraws the line, at most ten times a second. fraction is of the samples or things requested. */
void progress_draw(Progress *progress, double fraction);

/* Redraws the line, as a WeftProgress whose user is a Progress; stops after a signal. */
int progress_heed(void *progress, double fraction);

/* Erases the line. */
void progress_finish(Progress *progress);

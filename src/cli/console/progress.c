#include "cli/console/progress.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "base/steady_clock.h"
#include "cli/console/interrupt.h"

Progress progress_start(bool quiet, const char *prefix, int spp, int spp_most, double pixels, double limit) {
    Progress progress = {.shown = !quiet && isatty(STDERR_FILENO),
                         .prefix = prefix,
                         .spp = spp,
                         .spp_most = spp_most,
                         .pixels = pixels,
                         .limit = limit,
                         .started = clock_now(),
                         .width = 80};
    struct winsize size;
    if (progress.shown && ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1) progress.width = size.ws_col;
    return progress;
}

Progress progress_start_count(bool quiet, const char *unit, double count) {
    Progress progress = progress_start(quiet, "", 0, 0, 0.0, 0.0);
    progress.unit = unit;
    progress.count = count;
    return progress;
}

enum { TIME_SIZE = 24 };

/* Writes seconds as "0:07" or "2:00:07". */
static void clock_text(double seconds, char text[TIME_SIZE]) {
    long s = lround(fmin(seconds, 1e9));
    if (s >= 3600)
        snprintf(text, TIME_SIZE, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
    else
        snprintf(text, TIME_SIZE, "%ld:%02ld", s / 60, s % 60);
}

void progress_draw(Progress *progress, double fraction) {
    double clock = clock_now(), elapsed = clock - progress->started;
    if (!progress->shown || clock - progress->drawn < 0.1) return;
    progress->drawn = clock;

    double done = fraction; /* of the work: samples or time, whichever ends first */
    if (progress->limit > 0.0) done = fmin(fmax(done, elapsed / progress->limit), 1.0);
    char bar[] = "....................", requested[16] = "", past[TIME_SIZE], left[TIME_SIZE] = "-", line[160];
    memset(bar, '#', (size_t)(done * (double)(sizeof bar - 1)));
    clock_text(elapsed, past);
    if (done > 0.0) clock_text(elapsed * (1.0 - done) / done, left);
    if (progress->unit && !(progress->count > 0.0)) {
        snprintf(line, sizeof line, "%3.0f%% %s %s  %s elapsed, %s left", floor(100.0 * done), bar, progress->unit,
                 past, left);
    } else if (progress->unit) {
        double made = fraction * progress->count, rate = elapsed > 0.0 ? made / elapsed : 0.0;
        snprintf(line, sizeof line, "%3.0f%% %s %.0f/%.0f %s  %s elapsed, %s left  %.3g %s/s", floor(100.0 * done), bar,
                 made, progress->count, progress->unit, past, left, rate, progress->unit);
    } else {
        if (progress->spp) snprintf(requested, sizeof requested, "/%d", progress->spp);
        double samples = fraction * progress->spp_most;
        double rate = elapsed > 0.0 ? samples * progress->pixels / elapsed : 0.0;
        snprintf(line, sizeof line, "%s%3.0f%% %s %.*f%s spp  %s elapsed, %s left  %.2f M samples/s", progress->prefix,
                 floor(100.0 * done), bar, samples < 10.0 ? 1 : 0, samples, requested, past, left, 1e-6 * rate);
    }
    fprintf(stderr, "\r\033[K%.*s", progress->width - 1, line);
    fflush(stderr);
}

int progress_heed(void *progress, double fraction) {
    progress_draw(progress, fraction);
    return interrupt_seen();
}

void progress_finish(Progress *progress) {
    if (progress->shown && progress->drawn > 0.0) fputs("\r\033[K", stderr);
    progress->shown = false;
}

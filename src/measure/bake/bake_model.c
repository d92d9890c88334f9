/* bake_model.c - weft_bake_fibre_model: fits the model of the lobe fibre and returns its text */
#include <stdio.h>
#include <stdlib.h>

#include "base/fail.h"
#include "fibre/fitted_model.h"
#include "weft/bake.h"

/* Progress over the solved sets and the rounds of all stages, by their approximate cost. */
typedef struct FitCounter {
    const WeftFibreModelDesc *desc;
    int phases; /* reference and fit of each stage: a phase ends when its count is full */
    bool stopped;
} FitCounter;

static bool count(void *user, int done, int all) {
    FitCounter *counter = user;
    const double total = 2.0 * FIBRE_STAGES;
    double fraction = (counter->phases + (double)done / all) / total;
    if (done == all) counter->phases++;
    counter->stopped = counter->desc->progress && counter->desc->progress(counter->desc->user, fraction) != 0;
    return !counter->stopped;
}

WeftResult weft_bake_fibre_model(const WeftFibreModelDesc *desc, const char *command, char **text, WeftError *error) {
    FibreModelFit model;
    FitCounter counter = {desc, 0, false};
    size_t size;
    *text = NULL;
    if (desc->rounds < 0 || desc->rounds > 1000 || desc->threads < 0)
        return fail(error, WEFT_MESSAGE_DESC, "rounds", "%d", desc->rounds);
    if (!fibre_model_fit(FIBRE_STAGES - 1, desc->rounds ? desc->rounds : 120, desc->threads, count, &counter, &model))
        return counter.stopped ? WEFT_INTERRUPTED : fail(error, WEFT_MESSAGE_MEMORY, "fibre-model", NULL);
    FILE *stream = open_memstream(text, &size);
    if (stream) {
        bool written = fibre_model_write(&model, command, stream);
        if (fclose(stream) != 0 || !written) {
            free(*text);
            *text = NULL;
        }
    }
    fibre_model_free(&model);
    return *text ? WEFT_OK : fail(error, WEFT_MESSAGE_MEMORY, "fibre-model", NULL);
}

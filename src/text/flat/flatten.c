#include "text/flat/flatten.h"

#include <stdio.h>
#include <stdlib.h>

#include "text/flat/placement.h"
#include "text/flat/print.h"
#include "text/flat/run.h"

/* Writes what was not understood, and the name that was being looked for. */
static void describe(const Run *run, FlattenGap *gap) {
    const Token name = run->syntax.symbols.names[run->wrong_name];
    snprintf(gap->what, sizeof gap->what, "%s%s%.*s", run->wrong, name.size ? ": " : "", (int)name.size,
             name.size ? name.at : "");
}

bool flatten_text(const char *text, Buffer *out, FlattenGap *gap) {
    const size_t size = out->size;
    Run *run = alloc_array(1, sizeof *run);
    bool done = run && run_text(text, run);
    if (done) {
        placement_of(&run->graph);
        print_shader(run, out);
        done = !out->failed;
    } else if (gap && run) {
        describe(run, gap);
    }
    if (!done) out->size = size;
    if (run) run_free(run);
    free(run);
    return done;
}

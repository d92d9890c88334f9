#include "weave/weave_draft.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/mark.h"
#include "base/memory.h"
#include "base/printable.h"
#include "weave/dtx.h"
#include "weave/loom.h"
#include "weave/wpo.h"

enum { FILE_MAX = 16 << 20, START_MAX = 1 << 16 }; /* bytes of a WIF, and where [WIF] must stand */

WeftResult draft_create(const char *name, long warps, long picks, WeftMessage refusal, WeftDraft **out,
                        WeftError *error) {
    *out = NULL;
    if (warps < 1 || picks < 1) return fail(error, refusal, name, "it has no threads");
    if (warps > WEFT_DRAFT_SIDE_MAX || picks > WEFT_DRAFT_SIDE_MAX || warps * picks > WEFT_DRAFT_CELLS_MAX)
        return fail(error, refusal, name, "%ld x %ld threads are too many: %d a side and %d crossings are the limit",
                    warps, picks, WEFT_DRAFT_SIDE_MAX, WEFT_DRAFT_CELLS_MAX);
    WeftDraft *draft = alloc_array(1, sizeof *draft);
    if (!draft) return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    draft->count[WEFT_WARP] = (int)warps;
    draft->count[WEFT_WEFT] = (int)picks;
    draft->up = alloc_array((size_t)warps * (size_t)picks, 1);
    for (int t = 0; t < 2; t++) draft->threads[t] = alloc_array((size_t)draft->count[t], sizeof(WeftThread));
    if (!draft->up || !draft->threads[0] || !draft->threads[1]) {
        weft_draft_free(draft);
        return fail(error, WEFT_MESSAGE_MEMORY, name, NULL);
    }
    for (int t = 0; t < 2; t++)
        for (int k = 0; k < draft->count[t]; k++)
            draft->threads[t][k] = (WeftThread){
                .color = {(float)t, (float)t, (float)t}, .spacing = DRAFT_SPACING, .thickness = DRAFT_THICKNESS};
    *out = draft;
    return WEFT_OK;
}

void weft_draft_free(WeftDraft *draft) {
    if (!draft) return;
    free(draft->up);
    free(draft->threads[0]);
    free(draft->threads[1]);
    free(draft);
}

bool draft_same(const WeftDraft *a, const WeftDraft *b) {
    const size_t crossings = (size_t)a->count[0] * (size_t)a->count[1];
    if (a->count[0] != b->count[0] || a->count[1] != b->count[1]) return false;
    bool same = memcmp(a->up, b->up, crossings) == 0;
    for (int t = 0; t < 2; t++)
        same &= memcmp((const char *)a->threads[t], (const char *)b->threads[t],
                       (size_t)a->count[t] * sizeof(WeftThread)) == 0;
    return same;
}

static size_t utf8_size(const unsigned char *text) {
    unsigned code;
    return (size_t)utf8_read(text, &code);
}

/* Takes bytes that are no UTF-8 for Latin-1, in which old files are. */
void draft_title(WeftDraft *draft, const char *text) {
    const unsigned char *from = (const unsigned char *)text;
    bool is_utf8 = true;
    for (const unsigned char *at = from; is_utf8 && *at; at += utf8_size(at)) is_utf8 = utf8_size(at) != 0;
    size_t size = 0;
    while (*from) {
        const size_t read = is_utf8 ? utf8_size(from) : 1, written = read == 1 && *from >= 0x80 ? 2 : read;
        if (size + written >= sizeof draft->title) break;
        const bool is_control = *from < ' ' || *from == 0x7f || (!is_utf8 && *from >= 0x80 && *from < 0xa0);
        if (is_control)
            draft->title[size++] = ' ';
        else if (written > read) {
            draft->title[size++] = (char)(0xc0 | *from >> 6);
            draft->title[size++] = (char)(0x80 | (*from & 0x3f));
        } else
            for (size_t k = 0; k < read; k++) draft->title[size++] = (char)from[k];
        from += read;
    }
    draft->title[size] = '\0';
}

/* Returns true if a line of the text is [WIF]. Lines before it are for people. */
static bool is_wif(const unsigned char *data, size_t size) {
    static const char mark[] = "[wif]";
    size_t at = mark_size(data, size);
    while (at < size) {
        while (at < size && data[at] && strchr(" \t\r\n", data[at])) at++;
        if (size - at >= sizeof mark - 1 && strncasecmp((const char *)data + at, mark, sizeof mark - 1) == 0)
            return true;
        while (at < size && data[at] != '\n' && data[at] != '\r') at++;
    }
    return false;
}

static WeftResult read_wif(const char *path, WeftDraft **out, const WeftLog *log, WeftError *error) {
    FileBytes bytes;
    WeftResult result = file_read(path, FILE_MAX, &bytes, error);
    if (result != WEFT_OK) return result;
    result = weft_draft_read_memory(bytes.data, bytes.size, path, out, log, error);
    free(bytes.data);
    return result;
}

bool draft_names_file(const char *what) {
    const char *dot = strrchr(what, '.');
    size_t letters = 0;
    for (const char *at = dot ? dot + 1 : ""; *at; at++) {
        if (!isalnum((unsigned char)*at)) return false; /* a pattern of # and . */
        letters += isalpha((unsigned char)*at) != 0;
    }
    return dot ? letters > 0 : strchr(what, '/') && !strchr(what, ' ');
}

/* Returns true if the bytes contain no control characters but white space. */
static bool is_text(FileBytes bytes) {
    size_t at = 0;
    while (at < bytes.size && (bytes.data[at] >= ' ' || strchr("\t\r\n\f", bytes.data[at])) && bytes.data[at]) at++;
    return at == bytes.size;
}

/* Returns the program that writes files of that name, which weft does not read; NULL for any other. */
static const char *other_program(const char *path) {
    static const struct {
        const char *suffix, *program;
    } programs[] = {{".wpo", "WeavePoint, of a kind that is not known"},
                    {".twa", "TempoWeave"},
                    {".ada", "AdaCAD"},
                    {".dbw", "DB-WEAVE"}};
    const char *dot = strrchr(path, '.');
    for (size_t k = 0; dot && k < sizeof programs / sizeof *programs; k++)
        if (strcasecmp(dot, programs[k].suffix) == 0) return programs[k].program;
    return NULL;
}

WeftResult weft_draft_read(const char *what, WeftDraft **out, const WeftLog *log, WeftError *error) {
    *out = NULL;
    struct stat status;
    if (!draft_names_file(what) && stat(what, &status) != 0) return weft_draft_parse(what, out, error);
    FileBytes start;
    WeftResult result = file_read_start(what, START_MAX, &start, error);
    if (result != WEFT_OK) return result;
    const bool text = is_text(start), known = is_wif(start.data, start.size) || dtx_is(start.data, start.size) ||
                                              wpo_is(start.data, start.size);
    const bool wide = start.size > 1 && ((start.data[0] == 0xff && start.data[1] == 0xfe) ||
                                         (start.data[0] == 0xfe && start.data[1] == 0xff));
    const char *program = other_program(what);
    free(start.data);
    if (wide) return fail(error, WEFT_MESSAGE_DRAFT, what, "it is text in UTF-16: save it as UTF-8");
    if (known) return read_wif(what, out, log, error);
    if (program) return fail(error, WEFT_MESSAGE_DRAFT, what, "it is a file of %s: save it there as WIF", program);
    return draft_from_picture(what, text, out, log, error);
}

/* Returns index modulo count, 0 .. count - 1. */
static int wrapped(int index, int count) {
    const int k = index % count;
    return k < 0 ? k + count : k;
}

int weft_draft_warp_up(const WeftDraft *draft, int warp, int pick) {
    return draft->up[(size_t)wrapped(pick, draft->count[WEFT_WEFT]) * (size_t)draft->count[WEFT_WARP] +
                     (size_t)wrapped(warp, draft->count[WEFT_WARP])];
}

WeftThread weft_draft_thread(const WeftDraft *draft, WeftThreads threads, int index) {
    return draft->threads[threads][wrapped(index, draft->count[threads])];
}

/* Returns 1 if thread k of a system is on top at its crossing with thread c of the other. */
static int on_top(const WeftDraft *draft, WeftThreads threads, int k, int c) {
    return threads == WEFT_WARP ? weft_draft_warp_up(draft, k, c) : !weft_draft_warp_up(draft, c, k);
}

/* Returns the longest run on top of one thread, cyclic; the whole length if it never goes below. */
static int longest_run(const WeftDraft *draft, WeftThreads threads, int k) {
    const int length = draft->count[!threads];
    int longest = 0, run = 0;
    for (int c = 0; c < 2 * length && longest < length; c++) {
        run = on_top(draft, threads, k, c) ? run + 1 : 0;
        if (run > longest) longest = run;
    }
    return longest;
}

/* Returns true if thread k is always on top, or always below. */
static bool is_endless(const WeftDraft *draft, WeftThreads threads, int k) {
    for (int c = 1; c < draft->count[!threads]; c++)
        if (on_top(draft, threads, k, c) != on_top(draft, threads, k, 0)) return false;
    return true;
}

WeftDraftInfo weft_draft_info(const WeftDraft *draft) {
    WeftDraftInfo info = {.count = {draft->count[0], draft->count[1]}};
    memcpy(info.title, draft->title, sizeof info.title);
    Loom loom;
    if (loom_of(draft, &loom)) info.shafts = loom.shafts, info.treadles = loom.treadles;
    loom_free(&loom);
    const size_t cells = (size_t)draft->count[0] * (size_t)draft->count[1];
    size_t up = 0;
    for (size_t k = 0; k < cells; k++) up += draft->up[k];
    info.warp_share = (float)((double)up / (double)cells);
    for (int t = 0; t < 2; t++)
        for (int k = 0; k < draft->count[t]; k++) {
            const int run = longest_run(draft, (WeftThreads)t, k);
            if (run > info.longest_float[t]) info.longest_float[t] = run;
            info.endless[t] += is_endless(draft, (WeftThreads)t, k);
            info.size[t] += draft->threads[t][k].spacing;
        }
    return info;
}

WeftResult weft_draft_back(const WeftDraft *draft, WeftDraft **out, WeftError *error) {
    const int warps = draft->count[WEFT_WARP], picks = draft->count[WEFT_WEFT];
    WeftResult result =
        draft_create(draft->title[0] ? draft->title : "draft", warps, picks, WEFT_MESSAGE_DRAFT, out, error);
    if (!*out) return result;
    memcpy((*out)->title, draft->title, sizeof draft->title);
    memcpy((*out)->threads[WEFT_WEFT], draft->threads[WEFT_WEFT], (size_t)picks * sizeof(WeftThread));
    for (int warp = 0; warp < warps; warp++) {
        (*out)->threads[WEFT_WARP][warp] = draft->threads[WEFT_WARP][warps - 1 - warp];
        for (int pick = 0; pick < picks; pick++)
            (*out)->up[(size_t)pick * (size_t)warps + (size_t)warp] =
                !draft->up[(size_t)pick * (size_t)warps + (size_t)(warps - 1 - warp)];
    }
    return WEFT_OK;
}

WeftResult weft_draft_copy(const WeftDraft *draft, WeftDraft **out, WeftError *error) {
    const int warps = draft->count[WEFT_WARP], picks = draft->count[WEFT_WEFT];
    WeftResult result = draft_create(draft->title, warps, picks, WEFT_MESSAGE_DRAFT, out, error);
    if (!*out) return result;
    memcpy((*out)->title, draft->title, sizeof draft->title);
    memcpy((*out)->up, draft->up, (size_t)warps * (size_t)picks);
    for (int t = 0; t < 2; t++)
        memcpy((*out)->threads[t], draft->threads[t], (size_t)draft->count[t] * sizeof(WeftThread));
    return WEFT_OK;
}

void weft_draft_set_up(WeftDraft *draft, int warp, int pick, int up) {
    const size_t warps = (size_t)draft->count[WEFT_WARP], row = (size_t)wrapped(pick, draft->count[WEFT_WEFT]);
    draft->up[row * warps + (size_t)wrapped(warp, draft->count[WEFT_WARP])] = up != 0;
}

WeftResult weft_draft_set_sett(WeftDraft *draft, WeftThreads threads, float per_metre, WeftError *error) {
    if (!(per_metre >= 1.0f && per_metre <= 1e6f))
        return fail(error, WEFT_MESSAGE_DESC, "sett", "%g per metre; 1 to 1e6 is possible", (double)per_metre);
    double length = 0.0;
    for (int k = 0; k < draft->count[threads]; k++) length += (double)draft->threads[threads][k].spacing;
    const float scale = (float)((double)draft->count[threads] / length / (double)per_metre);
    for (int k = 0; k < draft->count[threads]; k++) {
        draft->threads[threads][k].spacing *= scale;
        draft->threads[threads][k].thickness *= scale;
    }
    return WEFT_OK;
}

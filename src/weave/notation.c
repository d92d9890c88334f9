/* notation.c - parser of drafts in one line of words: "WEAVE[; CLAUSE ...]"; docs/weave.md has the grammar
 *
 *   twill a/b z   up(i, j) = (j - i) mod (a + b) < a; s: (j + i). Longer lists alternate over and under.
 *   satin n/c     warp-faced: the weft is on top where i = c j mod n; sateen is the opposite
 *   basket n m    up(i, j) = floor(i / n) + floor(j / m) is even; plain is basket 1
 *   picks #.. .#. a word a pick, from the first one on, # where the warp is on top
 *   herringbone   n threads of a twill z, then n of its mirror image, moved by a picks so that the line breaks instead
 *                 of doubling a thread where it changes direction */
#include <stdlib.h>
#include <string.h>

#include "base/fail.h"
#include "base/memory.h"
#include "weave/weave_draft.h"

enum { WORDS_MAX = 512, RUNS_MAX = 64 };

/* The words of one clause. */
typedef struct Clause {
    const char *words[WORDS_MAX];
    int count;
} Clause;

typedef struct Notation {
    const char *text; /* the whole line, the subject of errors */
    WeftError *error;
} Notation;

#define REFUSE(n, ...) fail((n)->error, WEFT_MESSAGE_DRAFT_NOTATION, (n)->text, __VA_ARGS__)

/* Reads a whole number from 1 to most, and moves the cursor behind it; returns false if there is none. */
static bool count_of(const char **cursor, long most, int *count) {
    char *end;
    if (**cursor < '0' || **cursor > '9') return false;
    const long number = strtol(*cursor, &end, 10);
    if (number < 1 || number > most) return false;
    *cursor = end;
    *count = (int)number;
    return true;
}

static bool word_count(const char *word, long most, int *count) {
    return count_of(&word, most, count) && *word == '\0';
}

/* Reads "a/b/c..." into runs; returns how many there are, 0 for anything else. */
static int runs_of(const char *word, int runs[RUNS_MAX]) {
    int count = 0;
    while (count < RUNS_MAX && count_of(&word, WEFT_DRAFT_SIDE_MAX, &runs[count])) {
        count++;
        if (*word == '\0') return count;
        if (*word++ != '/') return 0;
    }
    return 0;
}

/* ---- weaves ---- */

static const struct {
    const char *name, *help;
} weaves[] = {
    {"plain", "over one, under one"},
    {"basket", "basket N [M]: N warp threads and M picks go together"},
    {"twill", "twill A/B[/A/B...] [z|s]: over A, under B; the line rises to the right (z) or to the left (s)"},
    {"satin", "satin N/C: of N crossings the weft is on top at one, which moves by C threads from pick to pick"},
    {"sateen", "sateen N/C: the same with the weft on top at all but one"},
    {"herringbone", "herringbone A/B N: N threads of a twill, then N of its mirror image"},
    {"houndstooth", "a twill 2/2 of four black threads and four white ones, both ways"},
    {"picks", "picks #.. .#. ..#: any weave, a word a pick, where # has the warp on top"},
};
enum { WEAVES = sizeof weaves / sizeof *weaves };

const char *weft_weave_name(int index) { return index >= 0 && index < WEAVES ? weaves[index].name : NULL; }
const char *weft_weave_help(int index) { return index >= 0 && index < WEAVES ? weaves[index].help : NULL; }

static WeftResult make_basket(const Notation *notation, int ends, int picks, WeftDraft **out) {
    WeftResult result =
        draft_create(notation->text, 2L * ends, 2L * picks, WEFT_MESSAGE_DRAFT_NOTATION, out, notation->error);
    for (int j = 0; result == WEFT_OK && j < 2 * picks; j++)
        for (int i = 0; i < 2 * ends; i++) (*out)->up[j * 2 * ends + i] = (i / ends + j / picks) % 2 == 0;
    return result;
}

/* Returns 1 if a warp thread that passes over, under, over ... picks by `runs` is on top at pick j. */
static int is_over(const int *runs, int count, int length, int j) {
    int at = j % length;
    if (at < 0) at += length;
    int k = 0;
    while (k < count - 1 && at >= runs[k]) at -= runs[k++];
    return k % 2 == 0;
}

/* Makes a twill, or with mirrored > 0 that many threads of it and their mirror image. */
static WeftResult make_twill(const Notation *notation, const char *word, int slope, int mirrored, WeftDraft **out) {
    int runs[RUNS_MAX];
    long length = 0;
    const int count = runs_of(word, runs);
    if (count < 2 || count % 2) return REFUSE(notation, "\"%.40s\" is no twill; 2/2 or 3/1/1/3 would be", word);
    for (int k = 0; k < count; k++) length += runs[k];
    const int warps = (int)(mirrored ? 2L * mirrored : length), offset = runs[0];
    WeftResult result = draft_create(notation->text, mirrored ? warps : length, length, WEFT_MESSAGE_DRAFT_NOTATION,
                                     out, notation->error);
    for (int j = 0; result == WEFT_OK && j < (int)length; j++)
        for (int i = 0; i < warps; i++) {
            const int line = mirrored && i >= mirrored ? mirrored - 1 + offset - (i - mirrored) : i;
            (*out)->up[j * warps + i] = (unsigned char)is_over(runs, count, (int)length, j - slope * line);
        }
    return result;
}

static int divisor(int a, int b) {
    while (b) {
        const int rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

static WeftResult make_satin(const Notation *notation, const char *word, bool warp_faced, WeftDraft **out) {
    int runs[RUNS_MAX];
    if (runs_of(word, runs) != 2) return REFUSE(notation, "\"%.40s\" is no satin; 5/2 or 8/3 would be", word);
    const int n = runs[0], c = runs[1];
    if (n < 5 || c < 2 || c > n - 2 || divisor(n, c) != 1)
        return REFUSE(notation,
                      "a satin of %d threads cannot move by %d: a move is 2 to %d and shares no divisor with %d", n, c,
                      n - 2, n);
    WeftResult result = draft_create(notation->text, n, n, WEFT_MESSAGE_DRAFT_NOTATION, out, notation->error);
    for (int j = 0; result == WEFT_OK && j < n; j++)
        for (int i = 0; i < n; i++) (*out)->up[j * n + i] = (i == (int)((long)c * j % n)) != warp_faced;
    return result;
}

/* Makes the weave of words such as "#..#", one a pick. */
static WeftResult make_picks(const Notation *notation, const Clause *clause, WeftDraft **out) {
    const size_t warps = clause->count > 1 ? strlen(clause->words[1]) : 0;
    for (int j = 1; j < clause->count; j++)
        if (strspn(clause->words[j], "#.") != warps || clause->words[j][warps])
            return REFUSE(notation, "\"%.40s\" is no pick: a # or a . for each of %zu warp threads", clause->words[j],
                          warps);
    WeftResult result = draft_create(notation->text, (long)warps, clause->count - 1L, WEFT_MESSAGE_DRAFT_NOTATION, out,
                                     notation->error);
    for (int j = 0; result == WEFT_OK && j < clause->count - 1; j++)
        for (size_t i = 0; i < warps; i++) (*out)->up[(size_t)j * warps + i] = clause->words[j + 1][i] == '#';
    return result;
}

/* Reads the direction of a twill, "z" or "s": 1 or -1; without a word it is z. Returns false for anything else. */
static bool slope_of(const Clause *clause, int at, int *slope) {
    *slope = 1;
    if (at == clause->count) return true;
    *slope = strcmp(clause->words[at], "s") == 0 ? -1 : 1;
    return at + 1 == clause->count && (*slope < 0 || strcmp(clause->words[at], "z") == 0);
}

static WeftResult make_weave(const Notation *notation, const Clause *clause, WeftDraft **out) {
    const char *name = clause->count ? clause->words[0] : "", *second = clause->count > 1 ? clause->words[1] : "";
    const int count = clause->count;
    int n = 0, m = 0, slope = 1;
    if (strcmp(name, "plain") == 0 && count == 1) return make_basket(notation, 1, 1, out);
    if (strcmp(name, "houndstooth") == 0 && count == 1) return make_twill(notation, "2/2", 1, 0, out);
    if (strcmp(name, "basket") == 0 && count >= 2 && count <= 3 && word_count(second, WEFT_DRAFT_SIDE_MAX / 2, &n)) {
        m = n;
        if (count == 2 || word_count(clause->words[2], WEFT_DRAFT_SIDE_MAX / 2, &m))
            return make_basket(notation, n, m, out);
    }
    if (strcmp(name, "picks") == 0 && count >= 2) return make_picks(notation, clause, out);
    if (strcmp(name, "twill") == 0 && count >= 2 && slope_of(clause, 2, &slope))
        return make_twill(notation, second, slope, 0, out);
    if (strcmp(name, "herringbone") == 0 && count == 3 && word_count(clause->words[2], WEFT_DRAFT_SIDE_MAX / 2, &n))
        return make_twill(notation, second, 1, n, out);
    if ((strcmp(name, "satin") == 0 || strcmp(name, "sateen") == 0) && count == 2)
        return make_satin(notation, second, name[3] == 'i', out);
    return REFUSE(notation, "the weave is plain, basket N [M], twill A/B [z|s], satin N/C, sateen N/C, "
                            "herringbone A/B N, houndstooth or picks #.. .#. ...");
}

/* ---- colours ---- */

/* Colours by the letters of tartan counts, sRGB-encoded. d (dark) or l (light) may stand before a letter. The shades
 * are our choice. */
static const struct Dye {
    char letter;
    float color[3];
} dyes[] = {
    {'k', {0.06f, 0.06f, 0.07f}}, {'w', {0.93f, 0.92f, 0.88f}}, {'r', {0.75f, 0.07f, 0.10f}},
    {'g', {0.05f, 0.35f, 0.15f}}, {'b', {0.10f, 0.16f, 0.50f}}, {'y', {0.90f, 0.73f, 0.10f}},
    {'n', {0.50f, 0.50f, 0.50f}}, {'t', {0.40f, 0.24f, 0.12f}}, {'a', {0.40f, 0.62f, 0.82f}},
    {'o', {0.88f, 0.42f, 0.08f}}, {'p', {0.38f, 0.14f, 0.42f}},
};

static bool hex_color(const char *text, float color[3]) {
    if (strspn(text, "0123456789abcdefABCDEF") != 6 || text[6]) return false;
    const long value = strtol(text, NULL, 16);
    for (int c = 0; c < 3; c++) color[c] = (float)(value >> (16 - 8 * c) & 255) / 255.0f;
    return true;
}

static bool dye_color(const char *text, float color[3]) {
    if (*text == '#') return hex_color(text + 1, color);
    const bool dark = text[0] == 'd' && text[1], light = text[0] == 'l' && text[1];
    text += dark || light;
    for (size_t k = 0; k < sizeof dyes / sizeof *dyes; k++) {
        if (text[0] != dyes[k].letter || text[1]) continue;
        for (int c = 0; c < 3; c++)
            color[c] = dark ? 0.5f * dyes[k].color[c] : light ? 0.5f + 0.5f * dyes[k].color[c] : dyes[k].color[c];
        return true;
    }
    return false;
}

/* Neighbouring threads of one colour. */
typedef struct Stripe {
    int count;
    float color[3];
} Stripe;

/* Reads the stripes after the first word. "mirror" at the end appends them in reverse order, without the first and the
 * last. Returns how many there are, 0 after an error. */
static int stripes_of(const Notation *notation, const Clause *clause, Stripe stripes[2 * WORDS_MAX]) {
    int count = 0;
    for (int k = 1; k < clause->count; k++) {
        const char *word = clause->words[k];
        if (k > 1 && k == clause->count - 1 && strcmp(word, "mirror") == 0) {
            const int last = count;
            for (int s = last - 2; s >= 1; s--) stripes[count++] = stripes[s];
        } else if (count_of(&word, WEFT_DRAFT_SIDE_MAX, &stripes[count].count) && dye_color(word, stripes[count].color))
            count++;
        else {
            REFUSE(notation,
                   "\"%.40s\" is no stripe: a count and a colour, as in 24k or 4#c01020; letters are k w r g "
                   "b y n t a o p, d dark, l light",
                   clause->words[k]);
            return 0;
        }
    }
    if (!count) REFUSE(notation, "\"%.10s\" needs stripes, as in \"%.10s 24k 4r\"", clause->words[0], clause->words[0]);
    return count;
}

/* Repeats the weave to count[0] warp threads and count[1] picks, multiples of the present ones. */
static WeftResult widen(const Notation *notation, WeftDraft **draft, const long count[2]) {
    const WeftDraft *from = *draft;
    const int warps = from->count[WEFT_WARP];
    WeftDraft *wide;
    WeftResult result =
        draft_create(notation->text, count[0], count[1], WEFT_MESSAGE_DRAFT_NOTATION, &wide, notation->error);
    if (result != WEFT_OK) return result;
    for (int j = 0; j < (int)count[1]; j++) {
        const unsigned char *row = from->up + (size_t)(j % from->count[WEFT_WEFT]) * (size_t)warps;
        for (int i = 0; i < (int)count[0]; i += warps)
            memcpy(wide->up + (size_t)j * (size_t)count[0] + (size_t)i, row, (size_t)warps);
    }
    for (int t = 0; t < 2; t++)
        for (int k = 0; k < (int)count[t]; k++) wide->threads[t][k] = weft_draft_thread(from, (WeftThreads)t, k);
    weft_draft_free(*draft);
    *draft = wide;
    return WEFT_OK;
}

/* Repeats the weave until a whole number of stripe sequences fits, and dyes its threads. */
static WeftResult dye_threads(const Notation *notation, WeftDraft **draft, WeftThreads threads, const Stripe *stripes,
                              int stripe_count) {
    long length = 0;
    for (int k = 0; k < stripe_count; k++) length += stripes[k].count;
    long count[2] = {(*draft)->count[0], (*draft)->count[1]};
    if (length > WEFT_DRAFT_SIDE_MAX) return REFUSE(notation, "%ld threads are too many for one repeat", length);
    const long growth = length / divisor((int)length, (int)count[threads]);
    count[threads] *= growth;
    const WeftResult result = growth > 1 ? widen(notation, draft, count) : WEFT_OK;
    if (result != WEFT_OK) return result;
    WeftThread *dyed = (*draft)->threads[threads];
    for (int k = 0, stripe = 0, used = 0; k < (int)count[threads]; k++) {
        memcpy(dyed[k].color, stripes[stripe].color, sizeof stripes[stripe].color);
        if (++used < stripes[stripe].count) continue;
        used = 0;
        stripe = (stripe + 1) % stripe_count;
    }
    return WEFT_OK;
}

/* Sets the threads per centimetre, "sett A [B]". */
static WeftResult set_sett(const Notation *notation, const Clause *clause, WeftDraft *draft) {
    int sett[2] = {0, 0};
    if (clause->count < 2 || clause->count > 3 || !word_count(clause->words[1], 1000, &sett[WEFT_WARP]) ||
        !word_count(clause->words[clause->count - 1], 1000, &sett[WEFT_WEFT]))
        return REFUSE(notation, "a sett is one or two whole numbers of threads per centimetre, 1 to 1000");
    WeftResult result = WEFT_OK;
    for (int t = 0; result == WEFT_OK && t < 2; t++)
        result = weft_draft_set_sett(draft, (WeftThreads)t, 100.0f * (float)sett[t], notation->error);
    return result;
}

static WeftResult apply_clause(const Notation *notation, const Clause *clause, WeftDraft **draft) {
    if (!clause->count) return REFUSE(notation, "there is an empty clause");
    const char *name = clause->words[0];
    const bool both = strcmp(name, "both") == 0, warp = both || strcmp(name, "warp") == 0,
               weft = both || strcmp(name, "weft") == 0;
    if (strcmp(name, "sett") == 0) return set_sett(notation, clause, *draft);
    if (!warp && !weft) return REFUSE(notation, "\"%.40s\" is not warp, weft, both or sett", name);
    Stripe *stripes = alloc_array(2 * WORDS_MAX, sizeof *stripes);
    if (!stripes) return fail(notation->error, WEFT_MESSAGE_MEMORY, notation->text, NULL);
    const int count = stripes_of(notation, clause, stripes);
    WeftResult result = count ? WEFT_OK : WEFT_USAGE;
    if (count && warp) result = dye_threads(notation, draft, WEFT_WARP, stripes, count);
    if (result == WEFT_OK && weft) result = dye_threads(notation, draft, WEFT_WEFT, stripes, count);
    free(stripes);
    return result;
}

/* Splits the clause that begins at text into words, in place. Returns the next clause, NULL after the last. *fits
 * becomes false if it has too many words. */
static char *next_clause(char *text, Clause *clause, bool *fits) {
    char *end = text + strcspn(text, ";"), *next = *end ? end + 1 : NULL;
    *end = '\0';
    clause->count = 0;
    for (char *word = strtok_r(text, " \t\r\n", &end); word; word = strtok_r(NULL, " \t\r\n", &end)) {
        if (clause->count == WORDS_MAX) {
            *fits = false;
            return NULL;
        }
        clause->words[clause->count++] = word;
    }
    return next;
}

static WeftResult parse(const Notation *notation, char *text, WeftDraft **out) {
    Clause clause;
    bool fits = true;
    char *next = next_clause(text, &clause, &fits);
    if (!fits) return REFUSE(notation, "a clause has more than %d words", WORDS_MAX);
    const bool checks = !next && clause.count == 1 && strcmp(clause.words[0], "houndstooth") == 0;
    WeftResult result = make_weave(notation, &clause, out);
    if (!*out) return result;
    if (checks) {
        const Clause fours = {.words = {"both", "4k", "4w"}, .count = 3};
        result = apply_clause(notation, &fours, out);
    }
    while (result == WEFT_OK && next) {
        next = next_clause(next, &clause, &fits);
        if (!fits) return REFUSE(notation, "a clause has more than %d words", WORDS_MAX);
        result = apply_clause(notation, &clause, out);
    }
    return result;
}

WeftResult weft_draft_parse(const char *text, WeftDraft **out, WeftError *error) {
    const Notation notation = {text, error};
    const size_t size = strlen(text) + 1;
    *out = NULL;
    char *copy = alloc_array(size, 1);
    if (!copy) return fail(error, WEFT_MESSAGE_MEMORY, "draft", NULL);
    memcpy(copy, text, size);
    WeftResult result = parse(&notation, copy, out);
    free(copy);
    if (result == WEFT_OK) draft_title(*out, text);
    if (result == WEFT_OK) return WEFT_OK;
    weft_draft_free(*out);
    *out = NULL;
    return result;
}

/* drawdown.c - a weaving draft as weavers print it, and the files of drafts
 *
 * The threading is above, with shaft 1 at the bottom; the treadling is at the right, with treadle 1 at the left; the
 * tie-up is in the corner between them. The drawdown has the colours of the threads, with the first pick at the
 * bottom. */
#include <math.h>
#include <stdio.h>

#include "base/fail.h"
#include "base/file.h"
#include "base/path.h"
#include "plot/drawing.h"
#include "plot/page.h"
#include "weave/loom.h"

enum {
    MARGIN = 24,
    TYPE = 14,
    FOOT = 2 * TYPE,     /* the line of figures below */
    GAP = 1,             /* cells between the parts */
    LOOM_MAX = 48,       /* with more shafts or treadles only the drawdown is drawn */
    CELLS_MAX = 1 << 20, /* the most crossings that are drawn */
    SIDE = 1100          /* approximate size of a drawdown, pixels */
};

typedef struct DraftPage {
    const WeftDraft *draft;
    Loom loom;
    WeftDraftInfo info;
    int cell;       /* pixels of a crossing */
    int left, top;  /* of the drawdown, pixels */
    bool with_loom; /* threading, tie-up and treadling are drawn */
} DraftPage;

static void fill(cairo_t *cairo, const DraftPage *page, int column, int row, int width, const float color[3]) {
    cairo_set_source_rgb(cairo, (double)color[0], (double)color[1], (double)color[2]);
    cairo_rectangle(cairo, page->left + column * page->cell, page->top + row * page->cell, width * page->cell,
                    page->cell);
    cairo_fill(cairo);
}

/* Draws the lines between the cells of a part, if cells are large enough. */
static void draw_grid(cairo_t *cairo, const DraftPage *page, int column, int row, int columns, int rows) {
    const double x = page->left + column * page->cell, y = page->top + row * page->cell, width = columns * page->cell,
                 height = rows * page->cell;
    cairo_set_antialias(cairo, CAIRO_ANTIALIAS_NONE);
    cairo_set_source_rgb(cairo, 0.62, 0.62, 0.64);
    cairo_set_line_width(cairo, 1.0);
    for (int k = page->cell >= 6 ? 0 : columns; k <= columns; k++) {
        cairo_move_to(cairo, x + k * page->cell, y);
        cairo_rel_line_to(cairo, 0.0, height);
    }
    for (int k = page->cell >= 6 ? 0 : rows; k <= rows; k++) {
        cairo_move_to(cairo, x, y + k * page->cell);
        cairo_rel_line_to(cairo, width, 0.0);
    }
    cairo_stroke(cairo);
    cairo_set_antialias(cairo, CAIRO_ANTIALIAS_DEFAULT);
}

static const float *color_on_top(const WeftDraft *draft, int warp, int pick) {
    return weft_draft_warp_up(draft, warp, pick) ? draft->threads[WEFT_WARP][warp].color
                                                 : draft->threads[WEFT_WEFT][pick].color;
}

static bool same_color(const float a[3], const float b[3]) {
    return fabsf(a[0] - b[0]) + fabsf(a[1] - b[1]) + fabsf(a[2] - b[2]) < 1e-6f;
}

/* Draws the crossings; neighbours of one colour are one rectangle. */
static void draw_drawdown(cairo_t *cairo, const DraftPage *page) {
    const WeftDraft *draft = page->draft;
    const int warps = draft->count[WEFT_WARP], picks = draft->count[WEFT_WEFT];
    cairo_set_antialias(cairo, CAIRO_ANTIALIAS_NONE);
    for (int pick = 0; pick < picks; pick++)
        for (int warp = 0, next; warp < warps; warp = next) {
            const float *color = color_on_top(draft, warp, pick);
            for (next = warp + 1; next < warps && same_color(color, color_on_top(draft, next, pick)); next++) {
            }
            fill(cairo, page, warp, picks - 1 - pick, next - warp, color);
        }
    draw_grid(cairo, page, 0, 0, warps, picks);
}

static void draw_loom(cairo_t *cairo, const DraftPage *page) {
    static const float ink[3] = {0.10f, 0.10f, 0.11f};
    const Loom *loom = &page->loom;
    const int warps = page->draft->count[WEFT_WARP], picks = page->draft->count[WEFT_WEFT];
    const int right = warps + 1 + 2 * GAP, above = -1 - 2 * GAP; /* beyond the strips of colours */
    cairo_set_antialias(cairo, CAIRO_ANTIALIAS_NONE);
    for (int warp = 0; warp < warps; warp++) {
        fill(cairo, page, warp, -1 - GAP, 1, page->draft->threads[WEFT_WARP][warp].color);
        fill(cairo, page, warp, above - 1 - loom->threading[warp], 1, ink);
    }
    for (int pick = 0; pick < picks; pick++) {
        fill(cairo, page, warps + GAP, picks - 1 - pick, 1, page->draft->threads[WEFT_WEFT][pick].color);
        fill(cairo, page, right + loom->treadling[pick], picks - 1 - pick, 1, ink);
    }
    for (int treadle = 0; treadle < loom->treadles; treadle++)
        for (int shaft = 0; shaft < loom->shafts; shaft++)
            if (loom->tieup[treadle * loom->shafts + shaft])
                fill(cairo, page, right + treadle, above - 1 - shaft, 1, ink);
    draw_grid(cairo, page, 0, -1 - GAP, warps, 1);
    draw_grid(cairo, page, warps + GAP, 0, 1, picks);
    draw_grid(cairo, page, 0, above - loom->shafts, warps, loom->shafts);
    draw_grid(cairo, page, right, 0, loom->treadles, picks);
    draw_grid(cairo, page, right, above - loom->shafts, loom->treadles, loom->shafts);
}

static WeftResult draw_draft(cairo_t *cairo, void *user, WeftError *error) {
    const DraftPage *page = user;
    const WeftDraftInfo *info = &page->info;
    const double foot = page->top + info->count[WEFT_WEFT] * page->cell + TYPE + 8;
    char text[200];
    (void)error;
    cairo_set_source_rgb(cairo, 1.0, 1.0, 1.0);
    cairo_paint(cairo);
    draw_drawdown(cairo, page);
    if (page->with_loom) draw_loom(cairo, page);
    snprintf(text, sizeof text, "%d x %d threads, %d shafts, %d treadles", info->count[WEFT_WARP],
             info->count[WEFT_WEFT], info->shafts, info->treadles);
    set_font(cairo, TYPE, true);
    write_text(cairo, ink_dark, MARGIN, MARGIN + 4, HUGE_VAL, info->title);
    set_font(cairo, 0.85 * TYPE, false);
    write_text(cairo, ink_dim, page->left, foot, HUGE_VAL, text);
    return WEFT_OK;
}

static int larger(int a, int b) { return a > b ? a : b; }

static WeftResult write_page(const WeftDraft *draft, const char *path, WeftError *error) {
    const int warps = draft->count[WEFT_WARP], picks = draft->count[WEFT_WEFT];
    if ((long)warps * picks > CELLS_MAX || larger(warps, picks) > WEFT_PLOT_SIDE_MAX / 4)
        return fail(error, WEFT_MESSAGE_DESC, path, "%d x %d threads are too many to draw; write a .txt or .wif", warps,
                    picks);
    DraftPage page = {.draft = draft, .info = weft_draft_info(draft)};
    if (!loom_of(draft, &page.loom)) {
        loom_free(&page.loom);
        return fail(error, WEFT_MESSAGE_MEMORY, path, NULL);
    }
    page.with_loom = page.loom.shafts <= LOOM_MAX && page.loom.treadles <= LOOM_MAX;
    const int extra = 1 + 2 * GAP, right = page.with_loom ? extra + page.loom.treadles : 0,
              above = page.with_loom ? extra + page.loom.shafts : 0;
    page.cell = larger(3, SIDE / larger(warps + right, picks + above));
    if (page.cell > 24) page.cell = 24;
    page.left = MARGIN;
    page.top = MARGIN + TYPE + above * page.cell;
    const Drawing drawing = {.width = larger(2 * MARGIN + (warps + right) * page.cell, 420),
                             .height = page.top + picks * page.cell + FOOT + MARGIN,
                             .title = page.info.title[0] ? page.info.title : "weaving draft",
                             .draw = draw_draft,
                             .user = &page};
    WeftResult result = drawing_write(&drawing, path, error);
    loom_free(&page.loom);
    return result;
}

static void write_rows(const WeftDraft *draft, FILE *stream) {
    for (int pick = draft->count[WEFT_WEFT] - 1; pick >= 0; pick--) {
        for (int warp = 0; warp < draft->count[WEFT_WARP]; warp++)
            fputc(weft_draft_warp_up(draft, warp, pick) ? '#' : '.', stream);
        fputc('\n', stream);
    }
}

int weft_draft_suffix_known(const char *path) {
    return path_ends(path, ".wif") || path_ends(path, ".txt") || weft_plot_suffix_known(path);
}

WeftResult weft_draft_write(const WeftDraft *draft, const char *path, WeftError *error) {
    OutputFile file;
    if (!weft_draft_suffix_known(path))
        return fail(error, WEFT_MESSAGE_OUTPUT_SUFFIX, path, "drafts are .wif, .png, .svg, .pdf or .txt");
    if (weft_plot_suffix_known(path)) return write_page(draft, path, error);
    WeftResult result = output_open(&file, path, error);
    if (result != WEFT_OK) return result;
    if (path_ends(path, ".wif"))
        result = wif_write(draft, file.stream, path, error);
    else
        write_rows(draft, file.stream);
    if (result == WEFT_OK) return output_commit(&file, error);
    output_discard(&file);
    return result;
}

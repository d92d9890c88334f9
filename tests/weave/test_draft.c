/* Weaving drafts: notation, the files of weavers with all that they leave out, pictures, and what is broken.
 * Tables of crossings were made by hand from the notation or the file; '#' has the warp on top, the first row
 * is the last pick. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "scratch.h"
#include "weave/weave_draft.h"
#include "weft/weft.h"

#define SHARED WEFT_SOURCE_DIR "/../shared/data/weave/"

static WeftDraft *parsed(const char *notation) {
    WeftDraft *draft;
    WeftError error;
    if (weft_draft_parse(notation, &draft, &error) != WEFT_OK) fail_msg("%s", error.text);
    return draft;
}

/* Rows from the last pick to the first, each as wide as the repeat. */
static void assert_rows(const WeftDraft *draft, const char *const *rows, int count) {
    const WeftDraftInfo info = weft_draft_info(draft);
    assert_int_equal(info.count[WEFT_WEFT], count);
    assert_int_equal(info.count[WEFT_WARP], strlen(rows[0]));
    for (int pick = 0; pick < count; pick++)
        for (int warp = 0; warp < info.count[WEFT_WARP]; warp++)
            if (weft_draft_warp_up(draft, warp, pick) != (rows[count - 1 - pick][warp] == '#'))
                fail_msg("warp %d, pick %d differs", warp + 1, pick + 1);
}

static void assert_notation(const char *notation, const char *const *rows, int count) {
    WeftDraft *draft = parsed(notation);
    assert_rows(draft, rows, count);
    weft_draft_free(draft);
}

#define ROWS(...) (const char *const[]){__VA_ARGS__}, sizeof(const char *const[]){__VA_ARGS__} / sizeof(char *)

static void notation_gives_the_crossings_of_textbooks(void **state) {
    (void)state;
    assert_notation("plain", ROWS(".#", "#."));
    assert_notation("basket 2", ROWS("..##", "..##", "##..", "##.."));
    assert_notation("basket 1 2", ROWS(".#", ".#", "#.", "#."));
    assert_notation("twill 2/2 z", ROWS("..##", ".##.", "##..", "#..#"));
    assert_notation("twill 2/2 s", ROWS(".##.", "..##", "#..#", "##.."));
    assert_notation("twill 3/1", ROWS(".###", "###.", "##.#", "#.##"));
    assert_notation("twill 1/2", ROWS("..#", ".#.", "#.."));
    assert_notation("twill 2/1/1/1", ROWS(".#.##", "#.##.", ".##.#", "##.#.", "#.#.#"));
    assert_notation("picks #.. .## #.#", ROWS("#.#", ".##", "#.."));
    assert_notation("satin 5/2", ROWS("###.#", "#.###", "####.", "##.##", ".####"));
    assert_notation("sateen 5/2", ROWS("...#.", ".#...", "....#", "..#..", "#...."));
    assert_notation("herringbone 2/2 4", ROWS("..##..##", ".##.#..#", "##..##..", "#..#.##."));
    assert_notation("  twill   2/2\tz ", ROWS("..##", ".##.", "##..", "#..#"));
}

/* The lines of a herringbone break at both of its turns: neighbours there are never on top together. */
static void herringbone_breaks_at_its_turns(void **state) {
    (void)state;
    WeftDraft *draft = parsed("herringbone 2/2 8");
    for (int pick = 0; pick < 4; pick++) {
        assert_true(weft_draft_warp_up(draft, 7, pick) != weft_draft_warp_up(draft, 8, pick));
        assert_true(weft_draft_warp_up(draft, 15, pick) != weft_draft_warp_up(draft, 16, pick));
    }
    weft_draft_free(draft);
}

static void notation_without_sense_is_refused_in_one_line(void **state) {
    (void)state;
    static const char *const bad[] = {"",
                                      " ",
                                      "plainer",
                                      "plain 2",
                                      "twill",
                                      "twill 2",
                                      "twill 2/",
                                      "twill 2/2/1",
                                      "twill 0/2",
                                      "twill -1/2",
                                      "twill 2/2 x",
                                      "twill 2/2 z z",
                                      "twill a/b",
                                      "twill 9000/1",
                                      "picks",
                                      "picks #.. .#",
                                      "picks #.x",
                                      "picks 3",
                                      "satin 4/1",
                                      "satin 5/1",
                                      "satin 5/4",
                                      "satin 6/2",
                                      "satin 6/3",
                                      "satin 5",
                                      "satin 8/3 z",
                                      "sateen 10/5",
                                      "basket",
                                      "basket 0",
                                      "basket 5000",
                                      "basket 2 2 2",
                                      "herringbone 2/2",
                                      "herringbone 2/2 0",
                                      "herringbone 2/2 5000",
                                      "herringbone 8 2/2",
                                      "plain;",
                                      "plain; ",
                                      "plain;;",
                                      "plain; warp",
                                      "plain; warp k",
                                      "plain; warp 4",
                                      "plain; warp 4q",
                                      "plain; warp 0k",
                                      "plain; warp 4#12345",
                                      "plain; warp 4#1234567",
                                      "plain; warp mirror",
                                      "plain; both 9000k",
                                      "plain; warp 4k mirror 4r",
                                      "plain; sett",
                                      "plain; sett 0",
                                      "plain; sett 20 x",
                                      "plain; sett 1 2 3",
                                      "plain; sett 2000",
                                      "plain; colour 4k",
                                      "plain; both 4093k 4099w",
                                      "twill 2/2; warp 8191k; weft 4099w"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        WeftDraft *draft = NULL;
        WeftError error = {0};
        if (weft_draft_parse(bad[k], &draft, &error) == WEFT_OK) fail_msg("\"%s\" was read", bad[k]);
        assert_null(draft);
        assert_true(error.message == WEFT_MESSAGE_DRAFT_NOTATION || error.message == WEFT_MESSAGE_DRAFT);
        assert_true(error.text[0] && !strchr(error.text, '\n'));
    }
}

static void stripes_repeat_with_the_weave_and_mirror(void **state) {
    (void)state;
    WeftDraft *draft = parsed("twill 2/2; warp 2k 3r 1w mirror; weft 5#102030");
    const WeftDraftInfo info = weft_draft_info(draft);
    static const char order[] = "kkrrrwrrr";     /* 2k 3r 1w and 3r on the way back */
    assert_int_equal(info.count[WEFT_WARP], 36); /* of 4 and 9 */
    assert_int_equal(info.count[WEFT_WEFT], 20); /* of 4 and 5 */
    for (int k = 0; k < 36; k++) {
        const float red = weft_draft_thread(draft, WEFT_WARP, k).color[0];
        const char dye = order[k % 9];
        assert_true(dye == 'k' ? red < 0.2f : dye == 'r' ? red > 0.6f && red < 0.85f : red > 0.85f);
    }
    assert_true(fabsf(weft_draft_thread(draft, WEFT_WEFT, 7).color[1] - 32.0f / 255.0f) < 1e-6f);
    assert_int_equal(weft_draft_warp_up(draft, 0, 0), 1);
    assert_int_equal(weft_draft_warp_up(draft, -4, 20), 1); /* a cloth repeats */
    weft_draft_free(draft);
}

/* The last of many clauses counts; a repeat that has grown to its limit is not made anew for each. */
static void clauses_that_come_again_dye_in_place(void **state) {
    (void)state;
    enum { CLAUSES = 1000 };
    static const char weave[] = "twill 9/1/1/2; both 315w", clause[] = "; both 20k 15r";
    static char text[sizeof weave + CLAUSES * sizeof clause];
    size_t used = (size_t)snprintf(text, sizeof text, "%s", weave);
    for (int k = 0; k < CLAUSES; k++) used += (size_t)snprintf(text + used, sizeof text - used, "%s", clause);
    WeftDraft *many = parsed(text), *one = parsed("twill 9/1/1/2; both 315w; both 20k 15r");
    assert_int_equal(weft_draft_info(many).count[WEFT_WARP], 4095);
    assert_true(draft_same(many, one));
    for (int k = 0; k < 100; k++)
        assert_int_equal(weft_draft_warp_up(one, 7 * k, 31 * k), weft_draft_warp_up(one, 7 * k % 13, 31 * k % 13));
    weft_draft_free(many);
    weft_draft_free(one);
}

static void figures_of_a_satin_are_those_of_its_name(void **state) {
    (void)state;
    WeftDraft *draft = parsed("satin 8/3; sett 40 20");
    const WeftDraftInfo info = weft_draft_info(draft);
    assert_true(fabsf(info.warp_share - 0.875f) < 1e-6f);
    assert_int_equal(info.longest_float[WEFT_WARP], 7);
    assert_int_equal(info.longest_float[WEFT_WEFT], 1);
    assert_int_equal(info.shafts, 8);
    assert_int_equal(info.treadles, 8);
    assert_true(fabsf(info.size[WEFT_WARP] - 0.002f) < 1e-7f && fabsf(info.size[WEFT_WEFT] - 0.004f) < 1e-7f);
    assert_int_equal(info.endless[WEFT_WARP] + info.endless[WEFT_WEFT], 0);
    weft_draft_free(draft);
}

/* What lies below in front is on top behind, and the back of the back is the front. */
static void back_of_a_draft_is_its_inverse(void **state) {
    (void)state;
    WeftDraft *front = parsed("twill 3/1 z; warp 1r 7k"), *back, *again;
    assert_int_equal(weft_draft_back(front, &back, NULL), WEFT_OK);
    assert_int_equal(weft_draft_back(back, &again, NULL), WEFT_OK);
    const WeftDraftInfo info = weft_draft_info(front);
    for (int pick = 0; pick < info.count[WEFT_WEFT]; pick++)
        for (int warp = 0; warp < info.count[WEFT_WARP]; warp++) {
            const int mirrored = info.count[WEFT_WARP] - 1 - warp;
            assert_int_equal(weft_draft_warp_up(back, warp, pick), !weft_draft_warp_up(front, mirrored, pick));
            assert_int_equal(weft_draft_warp_up(again, warp, pick), weft_draft_warp_up(front, warp, pick));
        }
    assert_true(weft_draft_thread(back, WEFT_WARP, 7).color[0] > 0.6f); /* the red thread */
    weft_draft_free(front);
    weft_draft_free(back);
    weft_draft_free(again);
}

/* WIF. */

static int warnings;
static char told[4096]; /* the warnings of one draft, a line each */

/* Counts all warnings but the one that most small files here would have: a line for their Spacing. */
static int spacings_told;
static void count_warning(void *user, WeftMessage message, const char *text) {
    if (strstr(text, "no Spacing: 20 threads a centimetre were taken")) {
        spacings_told++;
        return;
    }
    (void)user;
    assert_true(message == WEFT_MESSAGE_DRAFT_COMPLETED && text[0] && !strchr(text, '\n'));
    if (warnings++ == 0) told[0] = '\0';
    const size_t used = strlen(told);
    snprintf(told + used, sizeof told - used, "%s\n", text);
}

static const WeftLog counting = {.fn = count_warning};

static WeftDraft *read_text(const char *text) {
    WeftDraft *draft;
    WeftError error;
    warnings = 0;
    told[0] = '\0';
    if (weft_draft_read_memory(text, strlen(text), "test.wif", &draft, &counting, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return draft;
}

static void assert_text(const char *text, int expected_warnings, const char *const *rows, int count) {
    WeftDraft *draft = read_text(text);
    assert_rows(draft, rows, count);
    if (warnings != expected_warnings) fail_msg("%d warnings, not %d, of\n%s", warnings, expected_warnings, text);
    weft_draft_free(draft);
}

#define TWO_BY_TWO "[WARP]\nThreads=2\n[WEFT]\nThreads=2\n[THREADING]\n1=1\n2=2\n"

static void unusual_forms_of_real_files_are_read_as_meant(void **state) {
    (void)state;
    /* a tie-up and treadling, the plain case */
    assert_text("[WIF]\nVersion=1.1\n" TWO_BY_TWO "[TIEUP]\n1=1\n2=2\n[TREADLING]\n1=1\n2=2\n", 0, ROWS(".#", "#."));
    /* a lift plan; blanks around "="; any case; comments; CR LF; a byte order mark; version 1.2 */
    assert_text("\xef\xbb\xbf; made by hand\r\n[wif]\r\nVERSION = 1.2\r\n[Warp]\r\nthreads = 2\r\n[WEFT]\r\n "
                "THREADS=2\r\n"
                "[threading]\r\n1 = 1\r\n2 =2\r\n; between\r\n[LiftPlan]\r\n1= 1 ; first\r\n2= 2\r\n",
                0, ROWS(".#", "#."));
    /* old Macintosh lines */
    assert_text("[WIF]\rVersion=1.1\r[THREADING]\r1=1\r2=2\r[LIFTPLAN]\r1=1\r2=2\r", 0, ROWS(".#", "#."));
    /* a sinking shed, in all the words that mean no */
    for (int k = 0; k < 6; k++) {
        static const char *const no[] = {"no", "FALSE", "f", "n", "off", "0"};
        char text[400];
        snprintf(text, sizeof text,
                 "[WIF]\nVersion=1.1\n[WEAVING]\nRising Shed=%s\n" TWO_BY_TWO "[LIFTPLAN]\n1=1\n2=2\n", no[k]);
        assert_text(text, 0, ROWS("#.", ".#"));
    }
    /* threads on several shafts, treadles pressed together, the same shaft twice */
    assert_text("[WIF]\nVersion=1.1\n[WARP]\nThreads=3\n[WEFT]\nThreads=2\n[THREADING]\n1=1\n2=1,2\n3=3\n"
                "[TIEUP]\n1=1,1\n2=3\n[TREADLING]\n1=1\n2=1,2\n",
                0, ROWS("###", "##."));
    /* more threads than threaded; an empty pick, and one that is missing; a treadle without tie-up; shaft 0
     */
    assert_text("[WIF]\nVersion=1.1\n[WARP]\nThreads=3\n[WEFT]\nThreads=4\n[THREADING]\n1=1\n2=0\n"
                "[TIEUP]\n1=1\n[TREADLING]\n1=1\n2=\n3=2\n",
                2, ROWS("...", "...", "...", "#.."));
    /* lines beyond the threads that are declared */
    assert_text("[WIF]\nVersion=1.1\n[WARP]\nThreads=1\n[WEFT]\nThreads=1\n[THREADING]\n1=1\n2=2\n[LIFTPLAN]"
                "\n1=1\n2=2\n",
                2, ROWS("#"));
    /* both a lift plan and treadling: the treadling is taken, and a difference is told; one that is empty is missing */
    assert_text("[WIF]\nVersion=1.1\n" TWO_BY_TWO "[LIFTPLAN]\n1=1\n2=2\n[TIEUP]\n1=1\n2=2\n[TREADLING]\n1=1\n2=2\n", 0,
                ROWS(".#", "#."));
    assert_text("[WIF]\nVersion=1.1\n" TWO_BY_TWO "[LIFTPLAN]\n1=1\n2=2\n[TIEUP]\n1=1\n2=2\n[TREADLING]\n1=2\n2=1\n", 1,
                ROWS("#.", ".#"));
    assert_non_null(strstr(told, "tie-up and treadling were taken"));
    assert_text("[WIF]\nVersion=1.1\n" TWO_BY_TWO "[LIFTPLAN]\n1=1\n2=2\n[TIEUP]\n1=\n2=0\n[TREADLING]\n1=2\n2=1\n", 0,
                ROWS(".#", "#."));
    assert_text("[WIF]\nVersion=1.1\n" TWO_BY_TWO "[LIFTPLAN]\n1=0\n2=\n[TIEUP]\n1=1\n2=2\n[TREADLING]\n1=2\n2=1\n", 0,
                ROWS("#.", ".#"));
    /* no counts at all; private sections with lines of any kind; the last of two lines with one key, which is told */
    assert_text("[WIF]\nVersion=1.1\n[PRIVATE SOURCE X]\nanything "
                "goes\n=\n[THREADING]\n1=2\n1=1\n2=2\n[LIFTPLAN]\n1=1\n2=2\n",
                1, ROWS(".#", "#."));
    assert_non_null(strstr(told, "line 8: [THREADING] 1=1: the key stands there twice"));
}

#define SATIN                                                                                                          \
    "[WIF]\nVersion=1.1\n[WARP]\nThreads=2\nUnits=Inches\nSpacing=0.05\n[WEFT]\nThreads=2\nUnits=Inches\n"             \
    "Spacing=0.05\n[THREADING]\n1=1\n2=2\n[LIFTPLAN]\n1=1\n2=2\n"

/* A comment may follow a number, a list or a flag; after a text it is part of the text. Nothing of it is told. */
static void a_comment_behind_a_value_changes_nothing(void **state) {
    (void)state;
    WeftDraft *plain = read_text(SATIN "[COLOR PALETTE]\nRange=0,999\n[COLOR TABLE]\n1=999,0,0\n2=0,999,0\n"
                                       "[WARP COLORS]\n1=1\n2=2\n[WARP THICKNESS]\n1=.04\n[WEAVING]\nRising Shed=no\n");
    assert_int_equal(warnings, 0);
    WeftDraft *remarked = read_text(
        "[WIF]\nVersion=1.1\n[WARP]\nThreads=2 ;ends\nUnits=Inches  ;of Spacing\nSpacing=0.05;20 epi\n[WEFT]\n"
        "Threads=2;\nUnits=inches;\nSpacing=0.05\t; 20 ppi\n[THREADING]\n1=1 ;first\n2=2;\n[LIFTPLAN]\n1=1 ; 2\n"
        "2=2\n[COLOR PALETTE]\nRange=0,999 ;of Fiberworks\n[COLOR TABLE]\n1=999,0,0 ;red\n2=0,999,0;\n"
        "[WARP COLORS]\n1=1 ;red\n2=2;\n[WARP THICKNESS]\n1=.04 ;thin\n[WEAVING]\nRising Shed=no ; it sinks\n"
        "[TEXT]\nTitle=red; green\n");
    assert_int_equal(warnings, 0);
    assert_true(draft_same(plain, remarked));
    assert_string_equal(weft_draft_info(remarked).title, "red; green");
    weft_draft_free(plain);
    weft_draft_free(remarked);
}

/* Whatever is read and not understood is told with its line and value, and the cloth is woven all the same. */
static void values_that_are_not_understood_are_told(void **state) {
    (void)state;
    static const struct {
        const char *lines, *told;
    } cases[] = {
        {"[WARP]\nUnits=ells\n", "[WARP] Units=ells: it is not a unit"},
        {"[WARP]\nUnits=\n", "[WARP] Spacing=0.05: there are no Units for it; centimeters were taken"},
        {"[WARP]\nSpacing=0,05\n", "[WARP] Spacing=0,05: the value is not understood"},
        {"[WARP]\nSpacing=1 1/2\n", "[WARP] Spacing=1 1/2: the value is not understood"},
        {"[WARP]\nThickness=0\n", "[WARP] Thickness=0: it is no length"},
        {"[WEFT]\nThreads=two\n", "[WEFT] Threads=two: the value is not understood"},
        {"[WEFT]\nThreads=0\n", "[WEFT] Threads=0: the value is not understood"},
        {"[WEFT]\nThread=9\n", "[WEFT] Thread=9: WIF has no such key there"},
        {"[WEAVING]\nRising Shed=maybe\n", "[WEAVING] Rising Shed=maybe: it is neither yes nor no"},
        {"[WEAVING]\nShafts=1\n", "[WEAVING] Shafts=1: more are used"},
        {"[THREDING]\n1=1\n2=2\n", "line 18: [THREDING] 1=1: WIF has no such section; it was passed over (and 1 more"},
        {"[Version=1.1]\n", "[LIFTPLAN] [Version=1.1]: WIF has no such key there"},
        {"[WARP]\nonly words\n", "[WARP] only words: WIF has no such key there"},
        {"[WARP]\nColor=7\n", "[WARP] Color=7: the [COLOR TABLE] has no such colour"},
        {"[WARP]\nColor=red\n", "[WARP] Color=red: the value is not understood"},
        {"[WARP COLORS]\n1=3\n2=4\n",
         "line 18: [WARP COLORS] 1=3: the [COLOR TABLE] has no such colour; the common one "
         "was taken (and 1 more"},
        {"[WARP COLORS]\n1\n", "line 18: [WARP COLORS] 1: there is no \"=\""},
        {"[WARP COLORS]\nfirst=1\n", "[WARP COLORS] first=1: the value is not understood"},
        {"[WEFT COLORS]\n3=1,1,1\n", "[WEFT COLORS] 3=1,1,1: there are fewer threads"},
        {"[COLOR PALETTE]\nRange=999\n", "[COLOR PALETTE] Range=999: two numbers are expected; from 0 to this"},
        {"[COLOR PALETTE]\nForm=CMYK\n", "[COLOR PALETTE] Form=CMYK: the value is not understood"},
        {"[COLOR TABLE]\n1=0,0,300\n", "[COLOR TABLE] 1=0,0,300: it is outside the Range"},
        {"[COLOR TABLE]\n1\n", "[COLOR TABLE] 1: there is no \"=\""},
        {"[LIFTPLAN]\nsecond\n", "[LIFTPLAN] second: WIF has no such key there"},
    };
    static const char head[] = SATIN;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[600];
        snprintf(text, sizeof text, "%s%s", head, cases[k].lines);
        WeftDraft *draft = read_text(text);
        assert_rows(draft, ROWS(".#", "#."));
        if (!strstr(told, cases[k].told)) fail_msg("of\n%sit was told:\n%s", cases[k].lines, told);
        weft_draft_free(draft);
    }
    /* an unknown unit is no centimetre */
    WeftDraft *draft = read_text(SATIN "[WARP]\nUnits=ells\nSpacing=0.2\n");
    assert_true(fabsf(weft_draft_thread(draft, WEFT_WARP, 0).spacing - DRAFT_SPACING) < 1e-9f);
    assert_true(fabsf(weft_draft_thread(draft, WEFT_WEFT, 0).spacing - 0.05f * 0.0254f) < 1e-7f);
    weft_draft_free(draft);
    /* Range=999 is that of Fiberworks */
    draft = read_text(SATIN "[COLOR PALETTE]\nRange=999\n[COLOR TABLE]\n1=999,0,0\n[WARP]\nColor=1\n");
    assert_true(weft_draft_thread(draft, WEFT_WARP, 0).color[0] > 0.999f);
    weft_draft_free(draft);
}

/* Words for people before the first section, a thread without "=", empty values, zeros among shafts. */
static void a_careless_file_is_read_as_meant(void **state) {
    (void)state;
    assert_text(
        "exported by hand\nfor a friend\n[WIF]\nVersion=1.1\n[CONTENTS]\nTIEUP=false\nTIEUP=maybe\n[THREADING]\n1=3\n"
        "2=2\n; no sign here\n3 \n5=0\n[LIFTPLAN]\n1=1,2,4\n2=\n3=0\n4=0,3,4\n[WARP]\nThreads=4\n[WEFT]\nThreads=6\n"
        "[WARP COLORS]\n2=\n[TEXT]\nAuthor=\n[NOTES]\n1=\n",
        5, ROWS("....", "....", "#...", "....", "....", ".#.."));
    assert_non_null(
        strstr(told, "line 1: exported by hand: it stands before the first section and was passed over (and 1"));
    assert_non_null(strstr(told, "line 12: [THREADING] 3: there is no \"=\""));
    /* a stray line in brackets below [WIF], alone there */
    assert_text("[WIF]\n[Version=1.1]\n" TWO_BY_TWO "[LIFTPLAN]\n1=1\n2=2\n", 1, ROWS(".#", "#."));
    /* the colour behind an index counts where the palette has none; Latin-1 in a title */
    WeftDraft *draft = read_text(SATIN "[WARP]\nColor=1,255,0,0\n[TEXT]\nTitle=Gr\xfcn\n");
    assert_true(weft_draft_thread(draft, WEFT_WARP, 0).color[0] > 0.999f);
    assert_string_equal(weft_draft_info(draft).title, "Gr\xc3\xbcn");
    weft_draft_free(draft);
}

/* Fiberworks. */

#define DTX "@@StartDTX\n%%version 1\n\n@@Description\nown: draft\n\n@@Contents\nInfo\nThreading\nEndDTX\n\n@@Info\n"

/* The last row of a tie-up is shaft 1, colours count from 0, four steps are 2.12 mm. */
static void drafts_of_fiberworks_are_read(void **state) {
    (void)state;
    assert_text(DTX "%%shafts 3\n%%treadles 4\n%%ends 4\n%%picks 3\n@@Threading\n1 2\n3  2\n@@Tieup\n0010\n0101\n1001\n"
                    "@@Treadling\n%%compound\n1, 3  4\n2\n@@EndDTX\n",
                0, ROWS(".#.#", "##.#", "#.#."));
    assert_text(DTX "%%ends 2\n%%picks 2\n@@Threading\n1 2\n@@Liftplan\n%%%%sinking\n1 0\n01\n", 0, ROWS("#.", ".#"));
    WeftDraft *draft =
        read_text(DTX "%%shafts 2\n%%ends 3 \n%%picks 2\n@@Threading\n1 2 1\n@@Liftplan\n10\n01\n@@Color Palet\n"
                      "255,0,0\n0,255,0\n0,0,255\n@@Warp Colors\n2 0\n@@Warp Spacing\n4 2\n@@Imprint\nPCW 4.2\n"
                      "@@Notes\n1=2; 3\n");
    assert_int_equal(warnings, 0);
    assert_string_equal(weft_draft_info(draft).title, "own: draft");
    static const int blue_red_red[] = {2, 0, 0}; /* the third has the common colour, the first of the palette */
    for (int k = 0; k < 3; k++) assert_true(weft_draft_thread(draft, WEFT_WARP, k).color[blue_red_red[k]] > 0.999f);
    assert_true(weft_draft_thread(draft, WEFT_WEFT, 0).color[1] > 0.999f);
    assert_true(fabsf(weft_draft_thread(draft, WEFT_WARP, 0).spacing - 2.12e-3f) < 1e-7f);
    assert_true(fabsf(weft_draft_thread(draft, WEFT_WARP, 1).spacing - 1.06e-3f) < 1e-7f);
    weft_draft_free(draft);
    draft =
        read_text(DTX "%%ends many\n%%picks 1\n@@Threading\n1\n@@Liftplan\n%%floating\n1\n@@Selvedge\n1 2\n3\n@@Warp "
                      "Colors\nred\n");
    assert_int_equal(warnings, 4);
    assert_non_null(strstr(told, "line 13: [WARP] Threads=many: the value is not understood"));
    assert_non_null(strstr(told, "line 18: @@Liftplan: %%floating: the key is not known"));
    assert_non_null(strstr(told, "line 21: @@Selvedge: 1 2: the section is not known"));
    assert_non_null(strstr(told, "line 24: [WARP COLORS] 1=red: the value is not understood"));
    weft_draft_free(draft);
    static const char *const bad[] = {"@@StartDTX",
                                      DTX,
                                      DTX "@@Threading\n1 x\n@@Liftplan\n1\n",
                                      DTX "@@Threading\n1\n@@Liftplan\n12\n",
                                      DTX "@@Threading\n1\n@@Tieup\n1\n",
                                      DTX "@@Threading\n1\n@@Tieup\nfoo\n1\n@@Treadling\n1\n",
                                      DTX "%%ends 9000\n@@Threading\n1\n@@Liftplan\n1\n"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        WeftError error;
        if (weft_draft_read_memory(bad[k], strlen(bad[k]), "bad.dtx", &draft, NULL, &error) == WEFT_OK)
            fail_msg("was read:\n%s", bad[k]);
        assert_int_equal(error.message, WEFT_MESSAGE_DRAFT);
    }
}

static void colours_follow_the_rules_of_each_program(void **state) {
    (void)state;
    /* Fiberworks' 0-999, the older form with a colour behind the index, and [WARP].Color for what has no line
     */
    WeftDraft *draft =
        read_text("[WIF]\nVersion=1.1\n[WARP]\nThreads=3\nColor=2\n[WEFT]\nThreads=2\nColor=999,999,0\n[THREADING]\n"
                  "1=1\n2=2\n3=1\n[LIFTPLAN]\n1=1\n2=2\n[COLOR PALETTE]\nRange=0,999\n[COLOR TABLE]\n"
                  "1=0,0,999\n2=999,0,0\n[WARP COLORS]\n2=1,5,5,5\n");
    assert_int_equal(warnings, 0);
    const float expected[][3] = {{1, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    for (int k = 0; k < 3; k++) assert_memory_equal(weft_draft_thread(draft, WEFT_WARP, k).color, expected[k], 12);
    assert_true(weft_draft_thread(draft, WEFT_WEFT, 1).color[1] > 0.999f);
    weft_draft_free(draft);
    /* nothing for the third thread: it takes the colour of the second, and that is told */
    draft = read_text("[WIF]\nVersion=1.1\n[WARP]\nThreads=3\n[WEFT]\nThreads=1\n[THREADING]\n1=1\n2=1\n3="
                      "1\n[LIFTPLAN]\n1=1\n"
                      "[COLOR TABLE]\n1=255,0,0\n2=0,255,0\n[WARP COLORS]\n1=1\n2=2\n");
    assert_int_equal(warnings, 1);
    assert_true(weft_draft_thread(draft, WEFT_WARP, 2).color[1] > 0.999f);
    weft_draft_free(draft);
    /* no colours at all: warp black and weft white, as drafts are printed */
    draft = read_text("[WIF]\nVersion=1.1\n[THREADING]\n1=1\n[LIFTPLAN]\n1=1\n");
    assert_int_equal(warnings, 0);
    assert_true(weft_draft_thread(draft, WEFT_WARP, 0).color[0] < 1e-6f);
    assert_true(weft_draft_thread(draft, WEFT_WEFT, 0).color[0] > 0.999f);
    weft_draft_free(draft);
}

static void lengths_are_metres_whatever_their_unit(void **state) {
    (void)state;
    static const struct {
        const char *units;
        float metres;
    } cases[] = {{"centimeters", 0.01f}, {"INCHES", 0.0254f}, {"decipoints", 0.0254f / 720.0f}};
    for (int k = 0; k < 3; k++) {
        char text[500];
        snprintf(text, sizeof text,
                 "[WIF]\nVersion=1.1\n[WARP]\nThreads=2\nUnits=%s\nSpacing=2\nThickness=1\n[WEFT]\nThreads="
                 "1\nSpacing=-3\n"
                 "[THREADING]\n1=1\n2=1\n[LIFTPLAN]\n1=1\n[WARP SPACING]\n2=3\n[WARP THICKNESS]\n2=nan\n",
                 cases[k].units);
        WeftDraft *draft = read_text(text);
        const WeftThread first = weft_draft_thread(draft, WEFT_WARP, 0),
                         second = weft_draft_thread(draft, WEFT_WARP, 1);
        assert_true(fabsf(first.spacing / cases[k].metres - 2.0f) < 1e-5f);
        assert_true(fabsf(first.thickness / cases[k].metres - 1.0f) < 1e-5f);
        assert_true(fabsf(second.spacing / cases[k].metres - 3.0f) < 1e-5f);
        assert_true(fabsf(second.thickness / cases[k].metres - 1.0f) < 1e-5f);
        assert_true(weft_draft_thread(draft, WEFT_WEFT, 0).spacing > 0.0f);
        weft_draft_free(draft);
    }
}

static void broken_draft_files_are_errors_of_one_line(void **state) {
    (void)state;
#define HEAD  "[WIF]\nVersion=1.1\n"
#define WOVEN "[LIFTPLAN]\n1=1\n"
    static const char *const bad[] = {
        "",
        "\n",
        "no draft",
        "[WARP]\nThreads=2\n",
        "[WIF]",
        HEAD,
        HEAD "[THREADING]\n1=1\n",
        HEAD WOVEN,
        HEAD "[THREADING]\n1=1\n[TIEUP]\n1=1\n",
        HEAD "[THREADING]\n1=1\n[TREADLING]\n1=1\n",
        HEAD "[THREADING]\n" WOVEN,
        HEAD "[THREADING]\nx=1\n" WOVEN,
        HEAD "[THREADING]\n0=1\n" WOVEN,
        HEAD "[THREADING]\n-1=1\n" WOVEN,
        HEAD "[THREADING]\n1=x\n" WOVEN,
        HEAD "[THREADING]\n1=-1\n" WOVEN,
        HEAD "[THREADING]\n1=1.5\n" WOVEN,
        HEAD "[THREADING]\n1=1x\n" WOVEN,
        HEAD "[THREADING]\n1=9000\n" WOVEN,
        HEAD "[THREADING]\n9000=1\n" WOVEN,
        HEAD "[THREADING]\n1=99999999999999999999\n" WOVEN,
        HEAD "[THREADING]\n99999999999999999999=1\n" WOVEN,
        HEAD "[THREADING]\n1=1\n[LIFTPLAN]\n1=a\n",
        HEAD "[THREADING]\n1=1\n[LIFTPLAN]\n=1\n",
        HEAD "[THREADING]\n1=1\n[LIFTPLAN]\n9000=1\n",
        HEAD "[THREADING]\n1=1\n[TIEUP]\n1=9000\n[TREADLING]\n1=1\n",
        HEAD "[THREADING]\n1=1\n[TIEUP]\n9000=1\n[TREADLING]\n1=1\n",
        HEAD "[THREADING]\n1=1\n[TIEUP]\n1=1\n[TREADLING]\n1=9000\n",
        HEAD "[THREADING]\n1=1\n[TIEUP]\n1=1\n[TREADLING]\n1=yes\n",
        HEAD "[THREADING]\n1=1\n[TIEUP]\n1=#\n[TREADLING]\n1=1\n",
        HEAD "[WARP]\nThreads=9000\n[THREADING]\n1=1\n" WOVEN,
        HEAD "[WEFT]\nThreads=9000\n[THREADING]\n1=1\n" WOVEN,
        HEAD "[WARP]\nThreads=5000\n[WEFT]\nThreads=5000\n[THREADING]\n1=1\n" WOVEN,
        HEAD "[WARP]\nThreads=99999999999999999999\n[THREADING]\n1=1\n" WOVEN,
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR PALETTE]\nRange=0,0\n",
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR PALETTE]\nRange=9,1\n",
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR PALETTE]\nRange=0,inf\n",
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR PALETTE]\nRange=nan,nan\n",
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR TABLE]\n1=1,2\n",
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR TABLE]\n1=1,2,3,4\n",
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR TABLE]\n1=red\n",
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR TABLE]\nx=1,2,3\n",
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR TABLE]\n0=1,2,3\n",
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR TABLE]\n70000=1,2,3\n",
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR TABLE]\n1=1,2,nan\n",
        HEAD "[THREADING\n1=1\n[LIFT\n1=1\n",
        HEAD "[THREADING]\n1=1,,x\n" WOVEN,
        HEAD "[THREADING]\n1=1 x\n" WOVEN,
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR PALETTE]\nRange=-1\n",
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR PALETTE]\nRange=0,9,9\n",
        HEAD "[THREADING]\n1=1\n" WOVEN "[COLOR TABLE]\n1=1;2,3\n",
        "{\"asset\": {\"version\": \"2.0\"}}",
    };
    const size_t count = sizeof bad / sizeof *bad;
    assert_true(count >= 50);
    for (size_t k = 0; k < count; k++) {
        WeftDraft *draft = NULL;
        WeftError error = {0};
        if (weft_draft_read_memory(bad[k], strlen(bad[k]), "bad.wif", &draft, NULL, &error) == WEFT_OK)
            fail_msg("was read:\n%s", bad[k]);
        assert_null(draft);
        assert_int_equal(error.message, WEFT_MESSAGE_DRAFT);
        assert_int_equal(error.result, WEFT_INPUT);
        assert_true(error.text[0] && !strchr(error.text, '\n'));
    }
    WeftDraft *draft;
    WeftError error;
    assert_int_equal(weft_draft_read_memory("[WIF]\0\n", 7, "zero.wif", &draft, NULL, &error), WEFT_INPUT);
}

/* Files. */

static char folder[SCRATCH_SIZE];

static int folder_begin(void **state) {
    (void)state;
    return scratch_enter(folder) ? 0 : -1;
}

static int folder_end(void **state) {
    (void)state;
    static const char *const files[] = {"a.wif",   "a.txt",     "a.png",     "a.svg",    "a.pdf",
                                        "two.png", "three.png", "draft.wpo", "draft.twa"};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) unlink(files[k]);
    return scratch_remove_empty(folder) ? 0 : -1;
}

static void missing_lengths_and_ranges_are_told_with_what_was_taken(void **state) {
    (void)state;
    static const char *const heads[] = {"[WIF]\nVersion=1.1\n", "[WIF]\nVersion=2.0\n", "[WIF\nVersion=1.1\n"},
                             *const said[] = {NULL, "line 2: [WIF] Version=2.0", "line 1: the section has no closing"};
    char text[1024];
    for (int k = 0; k < 3; k++) {
        spacings_told = 0;
        snprintf(text, sizeof text, "%s" TWO_BY_TWO "[LIFTPLAN]\n1=1\n2=2\n", heads[k]);
        assert_text(text, said[k] != NULL, ROWS(".#", "#."));
        assert_int_equal(spacings_told, 1);
        if (said[k] && !strstr(told, said[k])) fail_msg("%s", told);
    }
    snprintf(text, sizeof text,
             "[WIF]\nVersion=1.1\n" TWO_BY_TWO "[LIFTPLAN]\n1=1\n2=2\n[COLOR TABLE]\n1=%s\n2=1,1,0\n"
             "[WARP COLORS]\n1=1\n2=2\n[WARP]\nUnits=cm\nSpacing=0.1\n[WEFT]\nUnits=cm\nSpacing=0.1\n",
             "0.5,0,0.25");
    spacings_told = 0;
    WeftDraft *draft = read_text(text);
    assert_int_equal(spacings_told, 0);
    assert_int_equal(warnings, 1);
    if (!strstr(told, "0 to 1 was taken")) fail_msg("%s", told);
    assert_float_equal(weft_draft_thread(draft, WEFT_WARP, 0).color[0], 0.5f, 1e-6f);
    assert_float_equal(weft_draft_thread(draft, WEFT_WARP, 1).color[1], 1.0f, 1e-6f);
    weft_draft_free(draft);
}

/* A draft written as a WIF and read again is the same cloth, with the same threads. */
static void a_written_draft_reads_as_the_same(void **state) {
    (void)state;
    static const char *const notations[] = {"plain", "twill 3/1/1/2 s; warp 3#0102fe 5r 2w; weft 24b 4g mirror",
                                            "satin 8/3; sett 60 31", "herringbone 2/2 8", "basket 3 2"};
    for (size_t k = 0; k < sizeof notations / sizeof *notations; k++) {
        WeftDraft *draft = parsed(notations[k]), *again;
        WeftError error;
        assert_int_equal(weft_draft_write(draft, "a.wif", &error), WEFT_OK);
        warnings = 0;
        if (weft_draft_read("a.wif", &again, &counting, &error) != WEFT_OK) fail_msg("%s", error.text);
        assert_int_equal(warnings, 0);
        const WeftDraftInfo a = weft_draft_info(draft), b = weft_draft_info(again);
        assert_memory_equal(a.count, b.count, sizeof a.count);
        assert_string_equal(a.title, b.title);
        assert_int_equal(a.shafts, b.shafts);
        assert_int_equal(a.treadles, b.treadles);
        for (int pick = 0; pick < a.count[WEFT_WEFT]; pick++)
            for (int warp = 0; warp < a.count[WEFT_WARP]; warp++)
                assert_int_equal(weft_draft_warp_up(draft, warp, pick), weft_draft_warp_up(again, warp, pick));
        for (int t = 0; t < 2; t++)
            for (int i = 0; i < a.count[t]; i++) {
                const WeftThread x = weft_draft_thread(draft, (WeftThreads)t, i),
                                 y = weft_draft_thread(again, (WeftThreads)t, i);
                for (int c = 0; c < 3; c++) assert_true(fabsf(x.color[c] - y.color[c]) <= 0.5f / 255.0f + 1e-6f);
                assert_true(fabsf(x.spacing / y.spacing - 1.0f) < 1e-5f);
                assert_true(fabsf(x.thickness / y.thickness - 1.0f) < 1e-5f);
            }
        weft_draft_free(draft);
        weft_draft_free(again);
    }
}

static void write_picture(const char *path, int third) {
    WeftImage image;
    assert_int_equal(weft_image_create(3, 2, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    static const char rows[] = "#..##.";
    for (int k = 0; k < 6; k++) memset((uint8_t *)image.pixels + 3 * k, rows[k] == '#' ? 20 : 200, 3);
    if (third) memset(image.pixels, 90, 3);
    assert_int_equal(weft_image_write(path, &image, NULL), WEFT_OK);
    weft_image_free(&image);
}

static void a_picture_of_two_colours_is_a_jacquard_draft(void **state) {
    (void)state;
    WeftDraft *draft;
    WeftError error;
    write_picture("two.png", 0);
    assert_int_equal(weft_draft_read("two.png", &draft, NULL, &error), WEFT_OK);
    assert_rows(draft, ROWS("#..", "##."));
    weft_draft_free(draft);
    assert_int_equal(weft_draft_read("missing.png", &draft, NULL, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_OPEN);
}

/* JPEG leaves noise about the two colours, and dark on bright may be as narrow as a tenth of the range. */
static void a_picture_of_more_colours_is_parted_by_brightness(void **state) {
    (void)state;
    enum { SIDE = 48, CELL = 8 };
    WeftDraft *twill = parsed("twill 3/1"), *draft;
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(SIDE, SIDE, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    unsigned noise = 1;
    for (int k = 0; k < SIDE * SIDE; k++)
        for (int c = 0; c < 3; c++) {
            noise = noise * 1664525u + 1013904223u;
            const int up = weft_draft_warp_up(twill, k % SIDE / CELL, (SIDE - 1 - k / SIDE) / CELL);
            ((uint8_t *)image.pixels)[3 * k + c] = (uint8_t)((up ? 90 : 120) + (int)(noise >> 24) % 11 - 5);
        }
    assert_int_equal(weft_image_write("three.png", &image, NULL), WEFT_OK);
    weft_image_free(&image);
    warnings = 0;
    assert_int_equal(weft_draft_read("three.png", &draft, &counting, &error), WEFT_OK);
    assert_int_equal(warnings, 1);
    assert_non_null(strstr(told, "three.png: was completed: it has more than two colours"));
    for (int pick = 0; pick < SIDE; pick++)
        for (int warp = 0; warp < SIDE; warp++)
            assert_int_equal(weft_draft_warp_up(draft, warp, pick),
                             weft_draft_warp_up(twill, warp / CELL, pick / CELL));
    weft_draft_free(draft);
    weft_draft_free(twill);
    write_picture("three.png", 1); /* 90 beside 20 and 200 is dark */
    assert_int_equal(weft_draft_read("three.png", &draft, &counting, &error), WEFT_OK);
    assert_rows(draft, ROWS("#..", "##."));
    weft_draft_free(draft);
}

static void assert_other_program(const char *path, const char *bytes, size_t size, const char *said) {
    WeftDraft *draft;
    WeftError error;
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(weft_draft_read(path, &draft, NULL, &error), WEFT_INPUT);
    if (!strstr(error.text, said)) fail_msg("%s", error.text);
}

/* 9 shafts, so that a set of them takes two bytes; 20 threads an inch; colours of 0 to 63. */
static void drafts_of_weavepoint_are_read(void **state) {
    (void)state;
    static const unsigned char head[] = {123, 3, 0, 10, 9, 3, 0, 0, 0, 20, 10, 0, 0, 0, 3, 0, 4, 0, 0, 0,
                                         0,   0, 0, 0,  0, 3, 1, 9, 2, 0,  3,  0, 1, 0, 0, 4, 1, 1, 1, 1},
                               plan[] = {0, 4, 1, 0, 0, 1, 2, 0, 3, 1}, tied[] = {1, 0, 0, 1, 2, 0},
                               single[] = {0, 4, 1, 2, 3, 2}, several[] = {0, 4, 1, 2, 4, 7},
                               tail[] = {2, 63, 0, 0, 0, 0, 63};
    for (int kind = 0; kind < 3; kind++) {
        unsigned char file[256] = {0};
        size_t size = 0;
        const unsigned char *lift = kind == 0 ? plan : kind == 1 ? single : several;
        const size_t lift_size = kind == 0 ? sizeof plan : sizeof single;
        memcpy(file, head, sizeof head), size += sizeof head;
        if (kind) memcpy(file + size, tied, sizeof tied), size += sizeof tied;
        memcpy(file + size, lift, lift_size), size += lift_size + 66;
        memcpy(file + size, tail, sizeof tail), size += sizeof tail;
        file[2] = (unsigned char)(100 + kind);
        WeftDraft *draft;
        WeftError error;
        warnings = 0;
        if (weft_draft_read_memory(file, size, "draft.wpo", &draft, &counting, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        assert_int_equal(warnings, 0);
        if (kind == 1)
            assert_rows(draft, ROWS(".#.", "..#", ".#.", "#.."));
        else
            assert_rows(draft, ROWS("###", "..#", ".#.", "#.."));
        assert_true(weft_draft_thread(draft, WEFT_WARP, 1).color[2] > 0.999f);
        assert_true(weft_draft_thread(draft, WEFT_WARP, 2).color[0] > 0.999f);
        assert_true(fabsf(weft_draft_thread(draft, WEFT_WEFT, 0).spacing - 2.54e-3f) < 1e-7f);
        weft_draft_free(draft);
        for (size_t cut = 3; cut < size; cut++) {
            assert_int_equal(weft_draft_read_memory(file, cut, "draft.wpo", &draft, NULL, &error), WEFT_INPUT);
            assert_non_null(strstr(error.text, "cut short"));
        }
        file[7] = 1; /* it sinks */
        assert_int_equal(weft_draft_read_memory(file, size, "draft.wpo", &draft, NULL, &error), WEFT_OK);
        assert_int_equal(weft_draft_warp_up(draft, 0, 0), 0);
        weft_draft_free(draft);
    }
}

static void files_of_other_programs_are_named(void **state) {
    (void)state;
    assert_other_program("draft.wpo", "\x7b\x07\x09\x0a\x04\x04", 6,
                         "file of WeavePoint, of a kind that is not known: save");
    assert_other_program("a.txt", "\x7b\x07\x65\x0a\x04\x04", 6, "it is a file of WeavePoint that is cut short");
    assert_other_program("a.txt", "\xff\xfe[\0W\0I\0F\0]\0", 12, "it is text in UTF-16: save it as UTF-8");
    assert_other_program("draft.twa", "PK\3\4", 4, "file of TempoWeave: save it there as WIF");
    assert_other_program("a.txt", "{\x7b", 2, "that does not begin with [WIF]");
}

/* The threads in the corner of the drawing have the colours of the draft, and all forms are written. */
static void draft_is_drawn_and_written_in_every_form(void **state) {
    (void)state;
    WeftDraft *draft = parsed("plain; warp 1#ff0000; weft 1#0000ff");
    WeftError error;
    static const char *const paths[] = {"a.png", "a.svg", "a.pdf", "a.txt"};
    for (size_t k = 0; k < 4; k++) {
        assert_true(weft_draft_suffix_known(paths[k]));
        if (weft_draft_write(draft, paths[k], &error) != WEFT_OK) fail_msg("%s", error.text);
    }
    assert_int_equal(weft_draft_write(draft, "a.bmp", &error), WEFT_USAGE);
    WeftImage image;
    assert_int_equal(weft_image_read("a.png", &image, NULL, NULL), WEFT_OK);
    int red = 0, blue = 0;
    for (int k = 0; k < image.width * image.height; k++) {
        const uint8_t *pixel = (const uint8_t *)image.pixels + (size_t)k * (size_t)image.channels;
        red += pixel[0] == 255 && pixel[1] == 0 && pixel[2] == 0;
        blue += pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 255;
    }
    /* two crossings and two cells of the strip each, less the lines between them */
    assert_true(red > 4 * 20 * 20 && red <= 4 * 24 * 24);
    assert_int_equal(red, blue);
    weft_image_free(&image);
    weft_draft_free(draft);
    draft = parsed("basket 4096 1");
    assert_int_equal(weft_draft_write(draft, "a.png", &error), WEFT_USAGE);
    weft_draft_free(draft);
}

static void assert_file(const char *name, const char *const *rows, int count) {
    char path[400];
    WeftDraft *draft;
    WeftError error;
    snprintf(path, sizeof path, SHARED "%s", name);
    if (weft_draft_read(path, &draft, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    const WeftDraftInfo info = weft_draft_info(draft);
    const int width = (int)strlen(rows[0]);
    assert_true(info.count[WEFT_WARP] >= width && info.count[WEFT_WEFT] >= count);
    for (int pick = 0; pick < info.count[WEFT_WEFT]; pick++)
        for (int warp = 0; warp < info.count[WEFT_WARP]; warp++)
            if (weft_draft_warp_up(draft, warp, pick) != (rows[count - 1 - pick % count][warp % width] == '#'))
                fail_msg("%s: warp %d, pick %d differs", name, warp + 1, pick + 1);
    weft_draft_free(draft);
}

/* One repeat of each, read off the tie-up with pencil and paper. */
static void real_drafts_give_the_crossings_worked_by_hand(void **state) {
    (void)state;
    if (access(SHARED "2229.wif", R_OK) != 0) {
        print_message("skipped: no drafts at hand\n");
        skip();
    }
    assert_file("54235plain.wif", ROWS("#.", ".#"));
    assert_file("2parallel.wif", ROWS(".#.", "#.#"));
    assert_file("3parallelwarps.wif", ROWS("###", "...", "###"));
    assert_file("2229.wif", ROWS("#...", ".###", "...#", "#...", "###.", "...#"));
    assert_file("41753.wif",
                ROWS(".....#.....#", "#.....#...#.", ".#.....#.#..", "..#.....#...", ".#.#...#....", "#...#.#.....",
                     ".....#.....#", "....#.#...#.", "...#...#.#..", "..#.....#...", ".#.#.....#..", "#...#.....#."));
}

/* Too large for a table by hand: its threads run straight over 28 shafts three times, so that a pick is the
 * tie-up of its treadle. */
static void a_large_draft_has_the_picks_of_its_tie_up(void **state) {
    (void)state;
    if (access(SHARED "8452.wif", R_OK) != 0) {
        print_message("skipped: no drafts at hand\n");
        skip();
    }
    static const struct {
        int pick;
        const char *row;
    } picks[] = {
        {1, "#####...#.##...........#...#"},   {2, "####....#..###..........#..."},
        {5, "......##.#....######.....###"},   {46, "#......###...######......#.."},
        {100, "..####...###........###...#."},
    };
    WeftDraft *draft;
    assert_int_equal(weft_draft_read(SHARED "8452.wif", &draft, NULL, NULL), WEFT_OK);
    const WeftDraftInfo info = weft_draft_info(draft);
    assert_int_equal(info.count[WEFT_WARP], 84);
    assert_int_equal(info.count[WEFT_WEFT], 100);
    assert_int_equal(info.longest_float[WEFT_WEFT], 12);
    for (size_t k = 0; k < sizeof picks / sizeof *picks; k++)
        for (int warp = 0; warp < 84; warp++)
            if (weft_draft_warp_up(draft, warp, picks[k].pick - 1) != (picks[k].row[warp % 28] == '#'))
                fail_msg("warp %d, pick %d differs", warp + 1, picks[k].pick);
    weft_draft_free(draft);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(notation_gives_the_crossings_of_textbooks),
        cmocka_unit_test(herringbone_breaks_at_its_turns),
        cmocka_unit_test(notation_without_sense_is_refused_in_one_line),
        cmocka_unit_test(stripes_repeat_with_the_weave_and_mirror),
        cmocka_unit_test(clauses_that_come_again_dye_in_place),
        cmocka_unit_test(figures_of_a_satin_are_those_of_its_name),
        cmocka_unit_test(back_of_a_draft_is_its_inverse),
        cmocka_unit_test(unusual_forms_of_real_files_are_read_as_meant),
        cmocka_unit_test(a_comment_behind_a_value_changes_nothing),
        cmocka_unit_test(values_that_are_not_understood_are_told),
        cmocka_unit_test(a_careless_file_is_read_as_meant),
        cmocka_unit_test(drafts_of_fiberworks_are_read),
        cmocka_unit_test(colours_follow_the_rules_of_each_program),
        cmocka_unit_test(lengths_are_metres_whatever_their_unit),
        cmocka_unit_test(broken_draft_files_are_errors_of_one_line),
        cmocka_unit_test(missing_lengths_and_ranges_are_told_with_what_was_taken),
        cmocka_unit_test(a_written_draft_reads_as_the_same),
        cmocka_unit_test(a_picture_of_two_colours_is_a_jacquard_draft),
        cmocka_unit_test(a_picture_of_more_colours_is_parted_by_brightness),
        cmocka_unit_test(drafts_of_weavepoint_are_read),
        cmocka_unit_test(files_of_other_programs_are_named),
        cmocka_unit_test(draft_is_drawn_and_written_in_every_form),
        cmocka_unit_test(real_drafts_give_the_crossings_worked_by_hand),
        cmocka_unit_test(a_large_draft_has_the_picks_of_its_tie_up),
    };
    return cmocka_run_group_tests(tests, folder_begin, folder_end);
}

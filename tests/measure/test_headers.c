/* The opening comment of every lobe's file ends with what `weft check ID --header` prints, but for the last
 * digit of a number: machines round differently. WEFT_TEST_SHORT=1 asks for some lobes only. */
#include "cli/run.h"

#include <ctype.h>
#include <math.h>

#include "weft/lobe.h"

/* A number at text[0]: its value, the unit of its last digit, its length. */
typedef struct Number {
    double value, unit;
    int length;
} Number;

static Number number_at(const char *text) {
    int length = 0, point = -1;
    while (isdigit((unsigned char)text[length]) || (point < 0 && text[length] == '.' && length > 0)) {
        if (text[length] == '.') point = length;
        length++;
    }
    return (Number){strtod(text, NULL), point < 0 ? 1.0 : pow(10.0, point + 1 - length), length};
}

/* Whether two texts are the same but for numbers with a decimal point, outside parentheses, that differ by
 * one unit of the last digit. */
static bool same_words(const char *a, const char *b) {
    int inside = 0;
    while (*a && *b) {
        Number m = number_at(a), n = number_at(b);
        if (m.length > 0 && n.length > 0 && !inside && m.unit < 1.0 && n.unit < 1.0) {
            if (fabs(m.value - n.value) > 1.01 * fmax(m.unit, n.unit)) return false;
            a += m.length, b += n.length;
            continue;
        }
        if (*a != *b) return false;
        inside += (*a == '(') - (*a == ')');
        a++, b++;
    }
    return *a == *b;
}

static void changed_number_of_a_header_is_noticed(void **state) {
    (void)state;
    assert_true(same_words("E at most 2.69 (alpha 0.01); x", "E at most 2.70 (alpha 0.01); x"));
    assert_false(same_words("E at most 2.69 (alpha 0.01); x", "E at most 2.71 (alpha 0.01); x"));
    assert_false(same_words("E at most 2.69 (alpha 0.01); x", "E at most 2.69 (alpha 0.02); x"));
    assert_false(same_words("cosines >= 2^-9", "cosines >= 2^-8"));
    assert_false(same_words("cosines >= 2^-9", "cosines >= 2^-9."));
    assert_false(same_words("E at most 2.69", "E at least 2.69"));
}

/* The measured lines of a file, without the mark that ends the comment; "" where there are none. */
static void header_lines(const char *id, char *lines, size_t size) {
    char path[512], *text, *start, *end;
    size_t length, used = (size_t)snprintf(path, sizeof path, WEFT_SOURCE_DIR "/src/shading/lobes/");
    for (const char *c = id; *c; c++) path[used++] = *c == '-' ? '_' : *c;
    snprintf(path + used, sizeof path - used, ".h");
    text = file_bytes(path, &length);
    if (!text) fail_msg("%s: is not there", path);
    lines[0] = '\0';
    start = strstr(text, " *   measured by weft check ");
    end = start ? strstr(start, " */") : NULL;
    if (end) snprintf(lines, size, "%.*s\n", (int)(end - start), start);
    free(text);
}

/* Where the compiler has no half floats, the program says less: the header is cut to match. */
static void cut_to_match(char *lines, const char *printed) {
    char *half = strstr(lines, " *     half precision");
    if (!half || half == lines || strstr(printed, "half precision")) return;
    strcpy(half - 2, ".\n");
}

static bool check_lobe(const char *id) {
    char lines[1024];
    Ran ran = RUN("check", id, "--header");
    assert_int_equal(ran.code, 0);
    header_lines(id, lines, sizeof lines);
    cut_to_match(lines, ran.out);
    bool same = same_words(lines, ran.out);
    if (!same) print_message("%s: its header has\n%snot\n%s", id, lines, ran.out);
    ran_free(&ran);
    return same;
}

static void headers_of_lobes_hold_their_measured_lines(void **state) {
    (void)state;
    const char *wish = getenv("WEFT_TEST_SHORT");
    bool some = wish && wish[0] == '1', same = true;
    for (int k = 0; k < weft_lobe_count(); k += some ? 10 : 1) same &= check_lobe(weft_lobe_info(k)->id);
    if (!same) fail_msg("script/headers and then script/docs bring them up to date");
}

/* Takes out the line with a p value: counts in bins move that by more than its last digit. */
static void cut_p(char *text) {
    char *line = strstr(text, "  chi-square"), *end = line ? strchr(line, '\n') : NULL;
    if (end) memmove(line, end, strlen(end) + 1);
}

static void passport_in_the_docs_is_up_to_date(void **state) {
    (void)state;
    static const char mark[] = "<!-- passport: charlie-neubelt -->\n```text\n";
    size_t size;
    char *page = file_bytes(WEFT_SOURCE_DIR "/docs/check.md", &size), *shown = page ? strstr(page, mark) : NULL;
    assert_non_null(shown);
    shown += sizeof mark - 1;
    char *end = strstr(shown, "```\n");
    assert_non_null(end);
    *end = '\0';
    Ran ran = RUN("check", "charlie-neubelt", "--no-gpu");
    assert_int_equal(ran.code, 0);
    char *half = strstr(ran.out, "\nHalf precision"), *shown_half = strstr(shown, "\nHalf precision");
    if (half && strstr(half, "not measured") && shown_half) *half = *shown_half = '\0';
    cut_p(shown);
    cut_p(ran.out);
    if (!same_words(shown, ran.out)) fail_msg("docs/check.md: script/headers brings it up to date");
    free(page);
    ran_free(&ran);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(changed_number_of_a_header_is_noticed),
                                       cmocka_unit_test(headers_of_lobes_hold_their_measured_lines),
                                       cmocka_unit_test(passport_in_the_docs_is_up_to_date)};
    return cmocka_run_group_tests(tests, work_begin, work_end);
}

/* A job as commands for many machines: run by a shell, by GNU parallel and by a queue they write the bytes of one run. */
#include "run.h"

/* Names that a shell would take apart. */
#define OUT "it's $HOME; \"a\".exr"
#define ONE "scene.gltf", "--width=90", "--height=70", "--spp=20", "--aov=albedo", "--set=cloth.sheen_color=1,0,0.5"

static void done(Ran ran) {
    if (ran.code != 0) fail_msg("exit %d: %s%s", ran.code, ran.out, ran.err);
    ran_free(&ran);
}

static void assert_same_files(const char *a, const char *b) {
    size_t size;
    char *bytes = file_bytes(a, &size);
    assert_non_null(bytes);
    if (!same_bytes(b, bytes, size)) fail_msg("%s is not %s", b, a);
    free(bytes);
}

static void whole_make(void) {
    done(RUN("render", ONE, "--quiet", "-o", "whole.exr"));
    unlink(OUT);
}

/* Writes the script of a picture in three parts. */
static void script_make(const char *kind) {
    done(RUN("farm", kind, "--array=3", "--program", WEFT_PROGRAM, "-o", "job.sh", "--", "render", ONE, "-o", OUT));
}

static void list_is_run_by_a_shell(void **state) {
    (void)state;
    whole_make();
    script_make("list");
    done(run_shell("sh -eu job.sh"));
    assert_same_files("whole.exr", OUT);
    Ran ran = run_shell("grep -c -- '--chunk' job.sh; grep -v '^#' job.sh | wc -l");
    assert_string_equal(ran.out, "3\n4\n");
    ran_free(&ran);
}

static void script_of_parallel_writes_the_picture(void **state) {
    (void)state;
    whole_make();
    script_make("parallel");
    Ran ran = run_shell("command -v parallel");
    const bool there = ran.code == 0;
    ran_free(&ran);
    if (!there) {
        print_message("no GNU parallel (package parallel): skipped\n");
        skip();
    }
    done(run_shell("sh job.sh --jobs 2"));
    assert_same_files("whole.exr", OUT);
}

/* A queue of one machine in a few lines: it runs an array at once, and what waits for it then. */
static void script_of_slurm_submits_an_array_and_the_merge(void **state) {
    (void)state;
    static const char queue[] =
        "#!/bin/sh\nset -eu\necho \"$@\" >>asked.txt\nlast=1\n"
        "for a; do case $a in --array=1-*) last=${a#--array=1-} ;; esac; done\n"
        "cat >task.sh\nfor k in $(seq 1 $last); do SLURM_ARRAY_TASK_ID=$k sh task.sh >&2; done\n"
        "echo 71\n";
    whole_make();
    script_make("slurm");
    file_make("sbatch", queue, sizeof queue - 1);
    done(run_shell("chmod +x sbatch; : >asked.txt; PATH=.:$PATH sh job.sh --partition=short"));
    assert_same_files("whole.exr", OUT);
    Ran ran = run_shell("cat asked.txt");
    assert_string_equal(ran.out, "--parsable --job-name=weft --array=1-3 --requeue --partition=short\n"
                                 "--parsable --job-name=weft-merge --dependency=afterok:71 --kill-on-invalid-dep=yes "
                                 "--partition=short\n");
    ran_free(&ran);
}

static void turntable_is_dealt_out_by_pictures(void **state) {
    (void)state;
    done(RUN("render", ONE, "--quiet", "--turntable=5", "-o", "turn.exr"));
    done(run_shell("for k in turn-*.exr; do mv $k whole-$k; done"));
    done(RUN("farm", "list", "--array=2", "--program", WEFT_PROGRAM, "-o", "job.sh", "--", "render", ONE,
             "--turntable=5", "-o", "turn.exr"));
    done(run_shell("test $(wc -l <job.sh) = 2; sh -eu job.sh; for k in 0 1 2 3 4; do cmp turn-00$k.exr "
                   "whole-turn-00$k.exr; done"));
}

static void other_jobs_have_their_natural_pieces(void **state) {
    (void)state;
    done(run_shell("$0 farm list -- check all --json >checks.txt; $0 models >models.txt; "
                   "grep -q '^weft check ggx --json$' checks.txt; test $(wc -l <checks.txt) -gt 40"));
    Ran ran = RUN("farm", "list", "--", "doctor", "a b.glb", "c.glb", "--fix", "-o", "new/");
    assert_string_equal(ran.out, "weft doctor 'a b.glb' --fix -o new/\nweft doctor c.glb --fix -o new/\n");
    ran_free(&ran);
    ran = RUN("farm", "list", "--", "render", "a.glb", "c.glb", "-o", "new/{}.png");
    assert_string_equal(ran.out, "weft render a.glb -o 'new/{}.png'\nweft render c.glb -o 'new/{}.png'\n");
    ran_free(&ran);
    done(run_shell("printf 'echo 1 >one.txt\\n\\necho 2 >two.txt\\n' | $0 farm slurm --commands - >job.sh; "
                   ": >asked.txt; PATH=.:$PATH sh job.sh; cmp one.txt - <<E\n1\nE\ntest -s two.txt"));
}

static void jobs_that_cannot_be_cut_are_refused(void **state) {
    (void)state;
    static const struct {
        const char *arguments[9], *line;
    } wrong[] = {
        {{"farm", "pbs", "--", "render", "scene.gltf", NULL}, "farm: \"pbs\" is not slurm, parallel or list"},
        {{"farm", "list", NULL}, "farm: needs a job"},
        {{"farm", "list", "--", "view", NULL}, "farm: view is not render, check, doctor or match"},
        {{"farm", "list", "--", "render", "scene.gltf", NULL}, "farm: render needs -o OUT"},
        {{"farm", "list", "--", "render", "scene.gltf", "-o", "a.png", "--noise=1"}, "--chunk: not with --noise"},
        {{"farm", "list", "--", "render", "scene.gltf", "-o", "a.png", "--chunk=1/2"}, "farm: not with --chunk"},
        {{"farm", "list", "--", "render", "scene.gltf", "-o", "a.png", "--spp=x"}, "--spp: \"x\""},
        {{"farm", "list", "--", "render", "scene.gltf", "-o", "a\nb.png", NULL}, "line break"},
        {{"farm", "list", "--", "check", "ggx", NULL}, "farm: of check only `all` has pieces"},
        {{"farm", "list", "--commands=none.txt", NULL}, "none.txt: cannot be opened"},
        {{"farm", "list", "--commands=/dev/null", NULL}, "farm: there is nothing to do"},
        {{"farm", "list", "--array=0", "--", "render", "scene.gltf", "-o", "a.png"}, "--array: "},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        const char *arguments[10] = {NULL};
        for (int a = 0; a < 9; a++) arguments[a] = wrong[k].arguments[a];
        Ran ran = run_with(NULL, arguments);
        if (ran.code < 2 || !one_complaint(ran.err) || !strstr(ran.err, wrong[k].line) || ran.out[0])
            fail_msg("expected \"%s\", got %d, \"%s\"", wrong[k].line, ran.code, ran.err);
        ran_free(&ran);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(list_is_run_by_a_shell),
        cmocka_unit_test(script_of_parallel_writes_the_picture),
        cmocka_unit_test(script_of_slurm_submits_an_array_and_the_merge),
        cmocka_unit_test(turntable_is_dealt_out_by_pictures),
        cmocka_unit_test(other_jobs_have_their_natural_pieces),
        cmocka_unit_test(jobs_that_cannot_be_cut_are_refused),
    };
    return cmocka_run_group_tests(tests, scene_begin, work_end);
}

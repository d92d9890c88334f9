/* Whole files in, whole files out */
#include <dirent.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/file.h"
#include "scratch.h"

static char folder[SCRATCH_SIZE];

static int make_folder(void **state) {
    (void)state;
    return scratch_make(folder) ? 0 : -1;
}

static const char *in_folder(char path[128], const char *name) {
    snprintf(path, 128, "%.63s/%.60s", folder, name);
    return path;
}

static int count_files(void) {
    int files = 0;
    DIR *open = opendir(folder);
    assert_non_null(open);
    for (struct dirent *entry; (entry = readdir(open));) files += entry->d_name[0] != '.';
    closedir(open);
    return files;
}

static void write_text(const char *path, const char *text) {
    OutputFile file;
    assert_int_equal(output_open(&file, path, NULL), WEFT_OK);
    assert_true(fputs(text, file.stream) >= 0);
    assert_int_equal(output_commit(&file, NULL), WEFT_OK);
}

static void check_text(const char *path, const char *text) {
    FileBytes bytes;
    assert_int_equal(file_read(path, 1000, &bytes, NULL), WEFT_OK);
    assert_int_equal(bytes.size, strlen(text));
    assert_memory_equal(bytes.data, text, bytes.size + 1); /* with the zero behind */
    free(bytes.data);
}

static void a_file_appears_complete_or_not_at_all(void **state) {
    (void)state;
    char path[128];
    in_folder(path, "a");
    write_text(path, "old");
    OutputFile file;
    assert_int_equal(output_open(&file, path, NULL), WEFT_OK);
    fputs("half of the new", file.stream);
    fflush(file.stream);
    check_text(path, "old");
    output_discard(&file);
    check_text(path, "old");
    assert_int_equal(count_files(), 1);
    output_discard(&file); /* twice does no harm */
    write_text(path, "new");
    check_text(path, "new");
    assert_int_equal(count_files(), 1);
    unlink(path);
}

static void two_writers_of_one_path_use_different_temporary_files(void **state) {
    (void)state;
    enum { WRITERS = 50 };
    char path[128];
    OutputFile files[WRITERS];
    in_folder(path, "g");
    for (int k = 0; k < WRITERS; k++) {
        assert_int_equal(output_open(&files[k], path, NULL), WEFT_OK);
        fprintf(files[k].stream, "writer %d", k);
    }
    assert_int_equal(count_files(), WRITERS);
    for (int k = 0; k < WRITERS; k++) {
        char text[16];
        snprintf(text, sizeof text, "writer %d", k);
        assert_int_equal(output_commit(&files[k], NULL), WEFT_OK);
        check_text(path, text);
    }
    assert_int_equal(count_files(), 1);
    unlink(path);
}

static void written_file_has_the_permissions_of_the_umask(void **state) {
    (void)state;
    char path[128];
    struct stat status;
    mode_t before = umask(022);
    write_text(in_folder(path, "b"), "x");
    umask(before);
    assert_int_equal(stat(path, &status), 0);
    assert_int_equal(status.st_mode & 0777, 0644);
    unlink(path);
}

static void unwritable_path_is_an_error(void **state) {
    (void)state;
    char path[128], inner[192];
    OutputFile file;
    WeftError error;
    snprintf(inner, sizeof inner, "%s/x", in_folder(path, "missing"));
    assert_int_equal(output_open(&file, inner, &error), WEFT_RESOURCES);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
    assert_null(file.stream);
    assert_int_equal(output_open(&file, "", &error), WEFT_RESOURCES);
    assert_memory_equal(error.text, "\"\": ", 4);
    /* renaming over a folder that is not empty fails: the temporary is gone, the folder stands */
    in_folder(path, "d");
    assert_int_equal(output_open(&file, path, NULL), WEFT_OK);
    assert_int_equal(mkdir(path, 0755), 0);
    snprintf(inner, sizeof inner, "%s/x", path);
    write_text(inner, "kept");
    assert_int_equal(output_commit(&file, &error), WEFT_RESOURCES);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
    assert_int_equal(count_files(), 1);
    check_text(inner, "kept");
    unlink(inner);
    rmdir(path);
}

/* What is no plain file is left alone: a pipe, a folder, a link to nowhere. */
static void only_plain_files_are_replaced(void **state) {
    (void)state;
    char pipe[128], inside[128], link[128];
    struct stat status;
    assert_int_equal(mkfifo(in_folder(pipe, "pipe"), 0600), 0);
    assert_int_equal(mkdir(in_folder(inside, "folder"), 0755), 0);
    assert_int_equal(symlink("nowhere", in_folder(link, "link")), 0);
    const char *const paths[] = {pipe, inside, link};
    for (int k = 0; k < 3; k++) {
        OutputFile file;
        WeftError error;
        assert_int_equal(output_open(&file, paths[k], &error), WEFT_RESOURCES);
        assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
        assert_null(file.stream);
    }
    assert_int_equal(count_files(), 3);
    assert_true(lstat(pipe, &status) == 0 && S_ISFIFO(status.st_mode));
    unlink(pipe);
    rmdir(inside);
    unlink(link);
}

/* The test would hang if one of them were opened as a plain file is. */
static void pipes_and_devices_are_refused_at_once(void **state) {
    (void)state;
    char pipe[128];
    FileBytes bytes;
    WeftError error;
    assert_int_equal(mkfifo(in_folder(pipe, "pipe"), 0600), 0);
    const char *const paths[] = {pipe, "/dev/zero", "/dev/tty"};
    for (int k = 0; k < 3; k++) {
        assert_int_equal(file_read(paths[k], 1000, &bytes, &error), WEFT_INPUT);
        if (k < 2) assert_int_equal(error.message, WEFT_MESSAGE_FILE_READ); /* there may be no terminal */
        assert_null(bytes.data);
        assert_int_equal(file_read_start(paths[k], 1000, &bytes, &error), WEFT_INPUT);
    }
    unlink(pipe);
}

static void file_written_through_a_link_keeps_the_link(void **state) {
    (void)state;
    char real[128], link[128];
    struct stat status;
    write_text(in_folder(real, "real"), "old");
    assert_int_equal(symlink("real", in_folder(link, "link")), 0);
    write_text(link, "new");
    check_text(real, "new");
    assert_true(lstat(link, &status) == 0 && S_ISLNK(status.st_mode));
    assert_int_equal(count_files(), 2);
    unlink(link);
    unlink(real);
}

static void a_full_disk_is_an_error(void **state) {
    (void)state;
    char path[128];
    OutputFile file;
    WeftError error;
    write_text(in_folder(path, "e"), "old");
    assert_int_equal(output_open(&file, path, NULL), WEFT_OK);
    /* /dev/full answers every write with "no space left" */
    FILE *full = freopen("/dev/full", "wb", file.stream);
    if (!full) skip();
    for (int k = 0; k < 100000; k++) fputc('x', file.stream);
    assert_int_equal(output_commit(&file, &error), WEFT_RESOURCES);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_WRITE);
    check_text(path, "old");
    assert_int_equal(count_files(), 1);
    unlink(path);
}

static void unreadable_path_is_an_error(void **state) {
    (void)state;
    char path[128];
    FileBytes bytes;
    WeftError error;
    assert_int_equal(file_read(in_folder(path, "none"), 10, &bytes, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_OPEN);
    assert_null(bytes.data);
    assert_int_equal(file_read(folder, 10, &bytes, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_READ);
    write_text(in_folder(path, "f"), "0123456789");
    assert_int_equal(file_read(path, 9, &bytes, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_LARGE);
    assert_null(bytes.data);
    assert_int_equal(file_read(path, 10, &bytes, &error), WEFT_OK);
    assert_int_equal(bytes.size, 10);
    free(bytes.data);
    /* the size alone is enough: all of this in memory would not be */
    assert_int_equal(truncate(path, (off_t)1 << 40), 0);
    assert_int_equal(file_read(path, (size_t)1 << 39, &bytes, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_LARGE);
    write_text(path, "");
    check_text(path, "");
    unlink(path);
    /* files of /proc say that they are empty */
    assert_int_equal(file_read("/proc/self/maps", 10, &bytes, &error), WEFT_INPUT);
    assert_int_equal(error.message, WEFT_MESSAGE_FILE_LARGE);
}

static int remove_folder(void **state) {
    (void)state;
    return scratch_remove_empty(folder) ? 0 : -1; /* fails if a test left something behind */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_file_appears_complete_or_not_at_all),
        cmocka_unit_test(two_writers_of_one_path_use_different_temporary_files),
        cmocka_unit_test(written_file_has_the_permissions_of_the_umask),
        cmocka_unit_test(unwritable_path_is_an_error),
        cmocka_unit_test(only_plain_files_are_replaced),
        cmocka_unit_test(pipes_and_devices_are_refused_at_once),
        cmocka_unit_test(file_written_through_a_link_keeps_the_link),
        cmocka_unit_test(a_full_disk_is_an_error),
        cmocka_unit_test(unreadable_path_is_an_error),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}

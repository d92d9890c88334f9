/* starve.cpp - makes memory run out: preloaded before a program, it lets an allocation fail
 *
 * WEFT_STARVE_AT=n: the n-th, counted from 1, of those that weft, Embree, TBB, jansson or a codec ask for.
 * What the graphics driver and the C library ask for by themselves is neither counted nor refused: that is
 * theirs to survive. WEFT_STARVE_ON=1: all that follow it fail too. WEFT_STARVE_COUNT: a file for how many
 * there were. Who asks is told by the module that the call returns to. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE
#endif
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <new>

extern "C" {
void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);
}

namespace {

std::atomic<long> count{0};
long fail_at = -1;
bool fail_on = false;

__attribute__((constructor)) void begin() {
    const char *at = getenv("WEFT_STARVE_AT"), *on = getenv("WEFT_STARVE_ON");
    fail_on = on && *on == '1';
    fail_at = at ? atol(at) : -1;
}

__attribute__((destructor)) void end() {
    const char *path = getenv("WEFT_STARVE_COUNT");
    FILE *file = path ? fopen(path, "w") : nullptr;
    if (!file) return;
    fprintf(file, "%ld\n", count.load());
    fclose(file);
}

bool is_ours(const void *caller) {
    static const char *const modules[] = {"/weft",          "libweft", "libembree", "libtbb", "libjansson",
                                          "libOpenEXRCore", "libpng",  "libjpeg",   "libz."};
    Dl_info info;
    if (!dladdr(caller, &info) || !info.dli_fname) return false;
    const char *name = strrchr(info.dli_fname, '/');
    name = name ? name : info.dli_fname;
    for (const char *module : modules)
        if (strncmp(name + (*name == '/' && *module != '/'), module, strlen(module)) == 0) return true;
    return false;
}

bool is_refused(const void *caller) {
    if (fail_at < 0 || !is_ours(caller)) return false;
    const long number = ++count;
    return number == fail_at || (fail_on && number > fail_at);
}

void *refuse() {
    errno = ENOMEM;
    return nullptr;
}

void *must(void *memory) {
    if (!memory) throw std::bad_alloc();
    return memory;
}

} // namespace

#define CALLER __builtin_extract_return_addr(__builtin_return_address(0))

extern "C" {
void *malloc(size_t size) { return is_refused(CALLER) ? refuse() : __libc_malloc(size); }
void *calloc(size_t number, size_t size) { return is_refused(CALLER) ? refuse() : __libc_calloc(number, size); }
void *realloc(void *block, size_t size) { return is_refused(CALLER) ? refuse() : __libc_realloc(block, size); }
void *memalign(size_t alignment, size_t size) {
    return is_refused(CALLER) ? refuse() : __libc_memalign(alignment, size);
}
void *aligned_alloc(size_t alignment, size_t size) {
    return is_refused(CALLER) ? refuse() : __libc_memalign(alignment, size);
}
int posix_memalign(void **out, size_t alignment, size_t size) {
    void *memory = is_refused(CALLER) ? nullptr : __libc_memalign(alignment, size);
    if (!memory) return ENOMEM;
    *out = memory;
    return 0;
}
}

void *operator new(size_t size) { return must(is_refused(CALLER) ? nullptr : __libc_malloc(size)); }
void *operator new[](size_t size) { return must(is_refused(CALLER) ? nullptr : __libc_malloc(size)); }
void *operator new(size_t size, const std::nothrow_t &) noexcept {
    return is_refused(CALLER) ? refuse() : __libc_malloc(size);
}

/* Versions 1 and 2 of the library share these functions of its C interface; version 2 renamed two of them. Attila T.
 * Afra, "Intel Open Image Denoise", https://www.openimagedenoise.org. */
#include "image/oidn.h"

#include <dlfcn.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "base/fail.h"

typedef struct OIDNDeviceImpl *OidnDevice;
typedef struct OIDNFilterImpl *OidnFilter;

enum { OIDN_CPU_DEVICE = 1, OIDN_FLOAT3 = 3 };

typedef struct OidnLibrary {
    void *handle;
    OidnDevice (*new_device)(int type);
    void (*set_device_int)(OidnDevice device, const char *name, int value);
    void (*commit_device)(OidnDevice device);
    int (*get_error)(OidnDevice device, const char **text);
    void (*release_device)(OidnDevice device);
    OidnFilter (*new_filter)(OidnDevice device, const char *type);
    void (*set_image)(OidnFilter filter, const char *name, void *pixels, int format, size_t width, size_t height,
                      size_t offset, size_t pixel_stride, size_t row_stride);
    void (*set_filter_bool)(OidnFilter filter, const char *name, bool value);
    void (*commit_filter)(OidnFilter filter);
    void (*execute_filter)(OidnFilter filter);
    void (*release_filter)(OidnFilter filter);
} OidnLibrary;

/* Sets a pointer to the function of one of two names; C has no cast from an object's address to a function's. */
static bool symbol(const OidnLibrary *library, const char *name, const char *old, void *function) {
    void *found = dlsym(library->handle, name);
    if (!found) found = dlsym(library->handle, old);
    memcpy(function, &found, sizeof found);
    return found != NULL;
}

#define SYMBOL(member, name, old) symbol(library, name, old, &library->member)

static bool library_open(OidnLibrary *library) {
    static const char *const names[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1"};
    *library = (OidnLibrary){0};
    for (size_t k = 0; k < sizeof names / sizeof *names && !library->handle; k++)
        library->handle = dlopen(names[k], RTLD_NOW | RTLD_LOCAL);
    return library->handle && SYMBOL(new_device, "oidnNewDevice", "oidnNewDevice") &&
           SYMBOL(set_device_int, "oidnSetDeviceInt", "oidnSetDevice1i") &&
           SYMBOL(commit_device, "oidnCommitDevice", "oidnCommitDevice") &&
           SYMBOL(get_error, "oidnGetDeviceError", "oidnGetDeviceError") &&
           SYMBOL(release_device, "oidnReleaseDevice", "oidnReleaseDevice") &&
           SYMBOL(new_filter, "oidnNewFilter", "oidnNewFilter") &&
           SYMBOL(set_image, "oidnSetSharedFilterImage", "oidnSetSharedFilterImage") &&
           SYMBOL(set_filter_bool, "oidnSetFilterBool", "oidnSetFilter1b") &&
           SYMBOL(commit_filter, "oidnCommitFilter", "oidnCommitFilter") &&
           SYMBOL(execute_filter, "oidnExecuteFilter", "oidnExecuteFilter") &&
           SYMBOL(release_filter, "oidnReleaseFilter", "oidnReleaseFilter");
}

static void run(const OidnLibrary *library, OidnDevice device, const OidnPicture *picture) {
    const struct {
        const char *name;
        float *pixels;
    } images[] = {{"color", picture->color},
                  {"albedo", picture->albedo},
                  {"normal", picture->normal},
                  {"output", picture->color}};
    OidnFilter filter = library->new_filter(device, "RT");
    if (!filter) return;
    for (size_t k = 0; k < sizeof images / sizeof *images; k++)
        library->set_image(filter, images[k].name, images[k].pixels, OIDN_FLOAT3, (size_t)picture->width,
                           (size_t)picture->height, 0, 0, 0);
    library->set_filter_bool(filter, "hdr", true);
    library->commit_filter(filter);
    library->execute_filter(filter);
    library->release_filter(filter);
}

/* Fails with the library's error message, if there is an error. */
static WeftResult verdict(const OidnLibrary *library, OidnDevice device, WeftError *error) {
    const char *text = NULL;
    if (!library->get_error(device, &text)) return WEFT_OK;
    return fail(error, WEFT_MESSAGE_DENOISER, "libOpenImageDenoise", "%.200s", text ? text : "no reason given");
}

/* Opens the library. Returns false, with the error, if it is not installed or lacks a function. */
static bool library_find(OidnLibrary *library, WeftError *error) {
    if (library_open(library)) return true;
    if (library->handle) dlclose(library->handle);
    fail(error, WEFT_MESSAGE_DENOISER, "libOpenImageDenoise", "version 1 or 2 of it is not installed");
    return false;
}

WeftResult oidn_check(WeftError *error) {
    OidnLibrary library;
    if (!library_find(&library, error)) return WEFT_RESOURCES;
    dlclose(library.handle);
    return WEFT_OK;
}

WeftResult oidn_denoise(const OidnPicture *picture, int threads, WeftError *error) {
    OidnLibrary library;
    WeftResult result = WEFT_OK;
    if (!library_find(&library, error)) return WEFT_RESOURCES;
    OidnDevice device = library.new_device(OIDN_CPU_DEVICE);
    if (device) {
        library.set_device_int(device, "numThreads", threads);
        library.commit_device(device);
        result = verdict(&library, device, error);
        if (result == WEFT_OK) run(&library, device, picture);
    }
    if (result == WEFT_OK) result = verdict(&library, device, error); /* without a device: the reason */
    if (device) library.release_device(device);
    dlclose(library.handle);
    return result;
}

/* version.h - the version of weft that a program was built for, and the one that it runs with
 *
 *   if (strcmp(weft_version(), WEFT_VERSION) != 0) ...
 *
 * docs/library.md lists what may change between versions. */
#ifndef WEFT_VERSION_H
#define WEFT_VERSION_H

/* Marks every function that the library exports. */
#if defined(WEFT_BUILD)
#define WEFT_API __attribute__((visibility("default")))
#else
#define WEFT_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this header, as numbers for the preprocessor and as text. */
#define WEFT_VERSION_MAJOR 0
#define WEFT_VERSION_MINOR 1
#define WEFT_VERSION_PATCH 0
#define WEFT_VERSION       "0.1.0"

/* The number in libweft.so.NUMBER. Programs built with the same number run with this library. */
#define WEFT_VERSION_ABI 0

/* Returns the version of the library that runs, "major.minor.patch". */
WEFT_API const char *weft_version(void);

#ifdef __cplusplus
}
#endif

#endif

/* weave.h - weaving drafts: which thread lies on top where warp and weft cross
 *
 *   WeftDraft *draft;
 *   weft_draft_read("twill 2/2 z; both 4k 4w", &draft, NULL, &error);
 *   weft_draft_write(draft, "houndstooth.wif", &error);
 *   weft_draft_free(draft);
 *
 * A draft is one repeat of a cloth. Warp threads run along +y and are counted from 0 at the left; picks, the
 * passes of the weft, run along +x and are counted from 0 at the bottom, both as one looks at the front. The
 * file formats do not say which corner comes first: another choice swaps twills to the right (Z) and to the
 * left (S). Lengths are metres. */
#ifndef WEFT_WEAVE_H
#define WEFT_WEAVE_H

#include <stddef.h>

#include "weft/result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A weaving draft. Opaque; release with weft_draft_free. */
typedef struct WeftDraft WeftDraft;

/* The two systems of threads. */
typedef enum WeftThreads { WEFT_WARP = 0, WEFT_WEFT = 1 } WeftThreads;

/* The limits of a repeat: threads of either system, and their crossings. */
enum { WEFT_DRAFT_SIDE_MAX = 8192, WEFT_DRAFT_CELLS_MAX = 1 << 24 };

/* One thread. */
typedef struct WeftThread {
    float color[3];  /* sRGB-encoded, 0 .. 1 */
    float spacing;   /* from this thread to the next, metres, > 0 */
    float thickness; /* width of the thread, metres, > 0; may exceed the spacing */
} WeftThread;

/* The figures of a draft. */
typedef struct WeftDraftInfo {
    char title[128];      /* UTF-8, one line; "" without one */
    int count[2];         /* threads of the repeat: warp ends, picks */
    int shafts;           /* the fewest shafts that weave it: its different warp threads */
    int treadles;         /* the fewest treadles, one pressed for each pick: its different picks */
    float size[2];        /* of the repeat: width across the warp, length along it, metres */
    float warp_share;     /* of the crossings where the warp lies on top, 0 .. 1 */
    int longest_float[2]; /* crossings that a thread of each system passes over in a row, cyclic */
    int endless[2];       /* threads of each system that are on top of, or below, every crossing */
} WeftDraftInfo;

/* Makes a draft of a file or of words. A file that is there is read by content: a WIF (Weaving Information
 * File 1.1, and what programs write under that name), or a picture of two colours, one pixel a crossing,
 * where the darker has the warp on top. Anything else is notation (docs/weave.md): "plain", "twill 2/2 z",
 * "satin 5/2", "herringbone 2/2 8; warp 24k 4r". log (may be NULL) receives what was completed. Fails with
 * WEFT_MESSAGE_DRAFT, _DRAFT_NOTATION, _MEMORY, and as weft_image_read does; *out is then NULL. */
WEFT_API WeftResult weft_draft_read(const char *what, WeftDraft **out, const WeftLog *log, WeftError *error);

/* A WIF of size bytes at data; errors begin with name. */
WEFT_API WeftResult weft_draft_read_memory(const void *data, size_t size, const char *name, WeftDraft **out,
                                           const WeftLog *log, WeftError *error);

/* A draft of notation alone. Fails with WEFT_MESSAGE_DRAFT_NOTATION, for too many threads too, or _MEMORY. */
WEFT_API WeftResult weft_draft_parse(const char *notation, WeftDraft **out, WeftError *error);

/* The cloth turned over about its warp: left and right change places, and what was on top lies below. Fails
 * with WEFT_MESSAGE_MEMORY. */
WEFT_API WeftResult weft_draft_back(const WeftDraft *draft, WeftDraft **out, WeftError *error);

/* Releases a draft. draft may be NULL. */
WEFT_API void weft_draft_free(WeftDraft *draft);

/* The figures of a draft; shafts and treadles are 0 where memory is short. */
WEFT_API WeftDraftInfo weft_draft_info(const WeftDraft *draft);

/* Returns 1 where that warp thread lies on top of that pick, else 0. Indices wrap around: a cloth repeats. */
WEFT_API int weft_draft_warp_up(const WeftDraft *draft, int warp, int pick);

/* One thread of either system; the index wraps around. */
WEFT_API WeftThread weft_draft_thread(const WeftDraft *draft, WeftThreads threads, int index);

/* Sets the spacing of all threads of a system, per metre of cloth (a sett of 24 per cm is 2400), and scales
 * their thickness alike. Fails with WEFT_MESSAGE_DESC unless 1 <= per_metre <= 1e6. */
WEFT_API WeftResult weft_draft_set_sett(WeftDraft *draft, WeftThreads threads, float per_metre,
                                        WeftError *error);

/* Writes a draft by suffix: .wif (1.1, threading, tie-up and treadling of the fewest shafts and treadles),
 * .png, .svg or .pdf (the draft as weavers print it: threading above, treadling at the right, the tie-up in
 * the corner, the drawdown in the colours of the threads), .txt (a line a pick, # where the warp is on top).
 * The file appears complete or not at all. Fails with WEFT_MESSAGE_OUTPUT_SUFFIX, _DESC (too large to be
 * drawn), _FILE_WRITE or _MEMORY. */
WEFT_API WeftResult weft_draft_write(const WeftDraft *draft, const char *path, WeftError *error);

/* Returns 1 if weft_draft_write knows the suffix, else 0. */
WEFT_API int weft_draft_suffix_known(const char *path);

#ifdef __cplusplus
}
#endif

#endif

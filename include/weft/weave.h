/* weave.h - weaving drafts, yarns, and cloths woven from them
 *
 *   WeftDraft *draft;
 *   weft_draft_read("twill 2/2 z; both 4k 4w", &draft, NULL, &error);
 *   weft_draft_write(draft, "houndstooth.wif", &error);
 *   weft_draft_free(draft);
 *
 * A draft is one repeat of a cloth: which thread lies on top at each crossing of warp and weft. Seen from the front,
 * warp threads run along +y and are counted from 0 at the left; picks, the passes of the weft, run along +x and are
 * counted from 0 at the bottom. The file formats do not define which corner comes first; another choice would swap
 * twills to the right (Z) and to the left (S). Lengths are metres. */
#ifndef WEFT_WEAVE_H
#define WEFT_WEAVE_H

#include <stddef.h>

#include "weft/image.h"
#include "weft/scene.h"

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

/* Makes a draft of a file or of notation. If `what` is the path of a file, it is read by content: a WIF (Weaving
 * Information File 1.1 and its common variants), a .dtx of Fiberworks, or an image, one pixel a crossing, where the
 * darker colour has the warp on top; more than two colours are parted by brightness, with a warning. Anything else is
 * notation (docs/weave.md): "plain", "twill 2/2 z", "satin 5/2",
 * "herringbone 2/2 8; warp 24k 4r". log (may be NULL) receives a warning for each value that was completed. Fails with
 * WEFT_MESSAGE_DRAFT, _DRAFT_NOTATION, _MEMORY, and as weft_image_read does; *out is then NULL. */
WEFT_API WeftResult weft_draft_read(const char *what, WeftDraft **out, const WeftLog *log, WeftError *error);

/* Makes a draft of a WIF of size bytes at data; errors begin with name. */
WEFT_API WeftResult weft_draft_read_memory(const void *data, size_t size, const char *name, WeftDraft **out,
                                           const WeftLog *log, WeftError *error);

/* Makes a draft of notation. Fails with WEFT_MESSAGE_DRAFT_NOTATION, for too many threads too, or _MEMORY. */
WEFT_API WeftResult weft_draft_parse(const char *notation, WeftDraft **out, WeftError *error);

/* Returns the word by which notation names a weave, and what may follow it with what it means; NULL past the end. */
WEFT_API const char *weft_weave_name(int index);
WEFT_API const char *weft_weave_help(int index);

/* Makes the draft of the back, flipped about the warp: left and right change places, and threads on top lie below.
 * Fails with WEFT_MESSAGE_MEMORY. */
WEFT_API WeftResult weft_draft_back(const WeftDraft *draft, WeftDraft **out, WeftError *error);

/* Copies a draft. Fails with WEFT_MESSAGE_MEMORY. */
WEFT_API WeftResult weft_draft_copy(const WeftDraft *draft, WeftDraft **out, WeftError *error);

/* Releases a draft. draft may be NULL. */
WEFT_API void weft_draft_free(WeftDraft *draft);

/* Returns the figures of a draft; shafts and treadles are 0 where memory is short. */
WEFT_API WeftDraftInfo weft_draft_info(const WeftDraft *draft);

/* Returns 1 if that warp thread lies on top of that pick, else 0. Indices wrap around. */
WEFT_API int weft_draft_warp_up(const WeftDraft *draft, int warp, int pick);

/* Puts the warp (1) or the weft (0) on top at one crossing; indices wrap around. */
WEFT_API void weft_draft_set_up(WeftDraft *draft, int warp, int pick, int up);

/* Returns one thread of either system; the index wraps around. */
WEFT_API WeftThread weft_draft_thread(const WeftDraft *draft, WeftThreads threads, int index);

/* Sets the spacing of all threads of a system by their number per metre (a sett of 24 per cm is 2400), and scales
 * their thickness alike. Fails with WEFT_MESSAGE_DESC unless 1 <= per_metre <= 1e6. */
WEFT_API WeftResult weft_draft_set_sett(WeftDraft *draft, WeftThreads threads, float per_metre, WeftError *error);

/* Writes a draft by suffix: .wif (1.1, threading, tie-up and treadling of the fewest shafts and treadles),
 * .png, .svg or .pdf (the draft as weavers print it: threading above, treadling at the right, the tie-up in
 * the corner, the drawdown in the colours of the threads), .txt (a line a pick, # where the warp is on top).
 * The file appears complete or not at all. Fails with WEFT_MESSAGE_OUTPUT_SUFFIX, _DESC (too large to be
 * drawn), _FILE_WRITE or _MEMORY. */
WEFT_API WeftResult weft_draft_write(const WeftDraft *draft, const char *path, WeftError *error);

/* Returns 1 if weft_draft_write supports the suffix, else 0. */
WEFT_API int weft_draft_suffix_known(const char *path);

/* The yarn of one system, as it lies in a cloth; weft_yarn_number lists the ranges. */
typedef struct WeftYarn {
    float alpha;       /* of its fibres, as in lobe yarn: silk 0.1, linen 0.3, cotton 0.4, wool 0.5 */
    float crimp;       /* steepest angle along the thread, where it dives below another, radians */
    float roundness;   /* slope at the edges of a thread */
    float twist;       /* of the fibres about the thread, radians: 0 filament, below 0 a Z twist, above 0 an S twist */
    float white;       /* fraction of the light that one fibre reflects at its surface, without its dye */
    float width;       /* of a thread, relative to the draft's; below 1 there are gaps */
    float bulge;       /* extra width in the middle of a long float */
    float floats;      /* flatness of floats: the power of the slope is 1 + floats (crossings - 1) */
    float streaks;     /* slope at the edges of a fibre, with variation of its direction and dye */
    float dye;         /* variation of colour from thread to thread */
    float slub;        /* variation of thickness along a thread */
    float wander;      /* variation of a thread's place */
    float hairiness;   /* loose fibres on the cloth: 1 is about one for each crossing */
    float slub_length; /* distance along a thread from a thin place to a thick one, millimetres */
    float barre;       /* variation of dye from lot to lot of the yarn: bars over many threads */
    float barre_width; /* of the widest bars, millimetres */
    float uneven;      /* variation of dye over the cloth, in patches */
    float uneven_size; /* of the largest patches, millimetres */
    float core;        /* reflectance inside the thread, which the material's input wear lays bare */
} WeftYarn;

/* Returns the name of a named yarn, and a line on it; NULL past the end. */
WEFT_API const char *weft_yarn_name(int index);
WEFT_API const char *weft_yarn_help(int index);

/* Finds a yarn by name. Fails with WEFT_MESSAGE_YARN_NAME. */
WEFT_API WeftResult weft_yarn_find(const char *name, WeftYarn *out, WeftError *error);

/* A number of a yarn. */
typedef struct WeftYarnNumber {
    const char *name, *help; /* name in a material file, and a line on its effect */
    size_t offset;           /* in WeftYarn */
    float low, high;         /* possible range */
    int angle;               /* not 0: radians here, degrees in material files */
} WeftYarnNumber;

/* Returns a number of a yarn by index; NULL past the end. */
WEFT_API const WeftYarnNumber *weft_yarn_number(int index);

/* A draft woven of yarns, of which the highest thread at each place is visible. Opaque; release with
 * weft_cloth_free. */
typedef struct WeftCloth WeftCloth;

/* Weaves a draft, whose colours are the reflectance of the threads; seed selects the random variation. The draft may be
 * freed. Fails with WEFT_MESSAGE_DESC (a number outside WeftYarnNumber's range) or _MEMORY. */
WEFT_API WeftResult weft_cloth_create(const WeftDraft *draft, const WeftYarn yarns[2], unsigned seed, WeftCloth **out,
                                      WeftError *error);

/* Releases a cloth. cloth may be NULL. */
WEFT_API void weft_cloth_free(WeftCloth *cloth);

/* The figures of a cloth. */
typedef struct WeftClothInfo {
    float share[2]; /* visible area of warp and weft, as fractions of the cloth; the rest is gaps */
    float size[2];  /* of the repeat, metres */
    float sett[2];  /* threads of warp and weft per centimetre, in the mean */
    float metres;   /* spanned by a unit of texture coordinates */
    int automatic;  /* not 0: metres follows from the mesh */
    float rotation; /* of the weave on the texture coordinates, degrees, from u towards -v */
    float relief;   /* length over which the normal map of the asset is smoothed, metres; infinite: it is flat */
    int seed;       /* of the random variation */
} WeftClothInfo;

/* Returns the draft of a cloth of a scene by its number, WeftMaterial.cloth, and fills in its yarns (may be NULL). The
 * draft is owned by the scene. NULL where there is none of that number. */
WEFT_API const WeftDraft *weft_scene_cloth(const WeftScene *scene, int cloth, WeftYarn yarns[2]);

/* Copies a cloth of a scene by its number, WeftMaterial.cloth: release it with weft_cloth_free. Fails with
 * WEFT_MESSAGE_DESC (there is none of that number) or _MEMORY; *out is then NULL. */
WEFT_API WeftResult weft_scene_cloth_copy(const WeftScene *scene, int cloth, WeftCloth **out, WeftError *error);

/* Weaves a new cloth for a material, of another draft and other yarns. Its earlier cloth stays in the scene, since
 * other materials and copies of this one may have it. Fails with WEFT_MESSAGE_DESC (the material is not woven, or a
 * yarn's number is out of range), _MATERIAL_FILE (too many crossings) or _MEMORY; the scene is then as it was. */
WEFT_API WeftResult weft_scene_set_weave(WeftScene *scene, int material, const WeftDraft *draft,
                                         const WeftYarn yarns[2], WeftError *error);

/* Sets a key of the weave of a material, named as in weft_scene_assign_material (NULL: the cloth of the scene). One
 * that is not woven becomes plain cotton without a sheen first. Keys: draft (words, or a file: a WIF or a picture), sett
 * (threads per centimetre, or WARP,WEFT), metres (that a unit of texture coordinates spans, or auto: as the mesh has
 * it), seed, rotation (of the weave, degrees), relief (of the normal map under the cloth: folds, all, none, or the metres
 * that it is smoothed over), warp and weft (names of yarns), and of these color ("#rrggbb", or r,g,b in linear
 * reflectance) and the numbers of weft_yarn_number, such as warp.alpha. An empty key sets the whole weave: a draft, or
 * the JSON of a material file, which leaves all other inputs as they are.
 * weft_scene_set takes the same as MATERIAL.weave.KEY. Fails with WEFT_MESSAGE_MATERIAL_NAME, _PARAM_NAME, _PARAM_VALUE
 * and as reading a material file does. */
WEFT_API WeftResult weft_scene_weave(WeftScene *scene, const char *material, const char *key, const char *value,
                                     const WeftLog *log, WeftError *error);

/* Returns the weave of a cloth of a scene, WeftMaterial.cloth, as the JSON of a material file, in which a draft that
 * was a file is its path. weft_scene_weave with an empty key makes the same cloth of it. Release with free; NULL where
 * there is none of that number, or memory is short. */
WEFT_API char *weft_scene_weave_text(const WeftScene *scene, int cloth);

/* Returns the figures of a cloth. */
WEFT_API WeftClothInfo weft_cloth_info(const WeftCloth *cloth);

/* Returns the figures of a cloth of a scene by its number, WeftMaterial.cloth; all 0 where there is none. */
WEFT_API WeftClothInfo weft_scene_cloth_info(const WeftScene *scene, int cloth);

/* Writes a cloth as tiling textures and a material into a folder, as weft_material_bake (weft/match.h) does for a cloth
 * without a sheen, with gaps as holes, for a viewer of profile khronos. Fails as it does. */
WEFT_API WeftResult weft_cloth_bake(const WeftCloth *cloth, int pixels, double metres, const char *folder,
                                    WeftError *error);

/* Draws a square of a cloth from above, lit from the upper left, as U8: `threads` of the warp over so many
 * pixels, 1 .. 8192. Fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_cloth_draw(const WeftCloth *cloth, int pixels, float threads, WeftImage *out,
                                    WeftError *error);

#ifdef __cplusplus
}
#endif

#endif

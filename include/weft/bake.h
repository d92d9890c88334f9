/* bake.h - look-up tables (LUTs) of lobes for engines to read, and an audit of existing tables
 *
 * A table of directional albedo is a WeftImage of F32. Its texels run over the cosine cos_o of the view along
 * one axis and over the lobe's first parameter along the other; a WeftTableForm describes both axes.
 * docs/bake.md shows how to use them. */
#ifndef WEFT_BAKE_H
#define WEFT_BAKE_H

#include "weft/image.h"
#include "weft/lobe.h"
#include "weft/progress.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The meaning of a table's axes. All zero means cos_o to the right, an artist's roughness downwards, both at
 * texel centres, which is what most engines read. */
typedef struct WeftTableForm {
    int transposed;     /* the parameter to the right and cos_o downwards */
    int root;           /* uniform in sqrt(cos_o) in place of cos_o */
    int alpha;          /* uniform in the first parameter itself in place of roughness */
    int edges;          /* the first texel at 0 and the last at 1; else texel k of n at (k + 0.5) / n */
    int flip_x, flip_y; /* the first texel is the last */
    int total; /* for a lobe of two colours: the channels are the f90 part and the sum, not the f0 and f90 parts */
} WeftTableForm;

/* Returns the forms that engines use, by index: the name, a line with its elements and the engines that use it, and
 * the form. A name or line past the end is NULL. */
WEFT_API const char *weft_table_form_name(int index);
WEFT_API const char *weft_table_form_help(int index);
WEFT_API WeftTableForm weft_table_form_at(int index);

/* Returns the index of the first of them that has the same axes, whatever its `total`; -1: none. */
WEFT_API int weft_table_form_find(const WeftTableForm *form);

/* Reads a name, or elements separated by commas: what runs along x and along y (cos or sqrt-cos, and
 * roughness or alpha), then any of centres or edges, flip-x, flip-y, total. Fails with
 * WEFT_MESSAGE_TABLE_FORM. */
WEFT_API WeftResult weft_table_form_parse(const char *text, WeftTableForm *out, WeftError *error);

/* Writes the elements of a form as weft_table_form_parse reads them. Returns text. */
enum { WEFT_TABLE_FORM_TEXT = 80 };
WEFT_API char *weft_table_form_text(const WeftTableForm *form, char text[WEFT_TABLE_FORM_TEXT]);

/* Computes what texel (x, y) of a table of that size stands for: cos_o in [0, 1], and the lobe's first parameter,
 * which may be beyond its hard range. Roughness r means r^2 where the parameter is called alpha, r where it
 * is called roughness, and else its plausible range from low to high. A lobe without parameters has 0. */
WEFT_API void weft_table_form_texel(const WeftTableForm *form, int lobe, int width, int height, int x, int y,
                                    float *cos_o, float *value);

/* A kind of table that can be baked. */
typedef struct WeftBakeKind {
    const char *id, *help; /* live as long as the program */
    int lobe;              /* 0: none is taken; 1: one may be given; 2: one must be given */
    int formed;            /* not 0: heeds WeftTableForm; 0: has axes of its own, which WeftBakeInfo.words describes */
    int width, height;     /* default size, texels */
} WeftBakeKind;

/* Returns a kind by index; NULL past the end. */
WEFT_API const WeftBakeKind *weft_bake_kind(int index);

/* Sides are 1 to 65536, and a table has at most this many texels. */
enum { WEFT_BAKE_TEXELS_MAX = 1 << 24 };

/* Zero means default, in every member but kind. */
typedef struct WeftBakeDesc {
    const char *kind;      /* the id of a WeftBakeKind */
    const WeftLobe *lobe;  /* counts as white */
    int width, height;     /* texels */
    WeftTableForm form;    /* the axes; not read where the kind is not formed */
    double tolerance;      /* absolute, of each value's quadrature; 0: 1e-4. Floats are exact to about 1e-6 */
    int threads;           /* 0: all */
    WeftProgress progress; /* may be NULL; a result other than 0 stops */
    void *user;            /* of progress */
    const WeftLog *log;    /* of warnings: a damaged cache is one; may be NULL */
} WeftBakeDesc;

/* The result of a bake, in words and numbers. */
typedef struct WeftBakeInfo {
    char words[160];   /* what the table holds */
    char channels[80]; /* what each channel is, comma between */
    double error;      /* the quadrature's largest estimate of its own error */
    long long unmet;   /* values whose estimate is above the tolerance */
    long long beyond;  /* texels whose parameter is beyond the lobe's hard range, and counts as its end */
    float low, high;   /* the least and the largest value */
} WeftBakeInfo;

/* Makes a table: F32, released with weft_image_free. Below 1e-6, cos_o counts as 1e-6. The numbers do not depend
 * on the threads. Returns WEFT_INTERRUPTED, without an error's text and without a table, if progress stops it;
 * fails with WEFT_MESSAGE_BAKE_KIND, _DESC or _MEMORY. info may be NULL. */
WEFT_API WeftResult weft_bake(const WeftBakeDesc *desc, WeftBakeInfo *info, WeftImage *out, WeftError *error);

/* The fit behind the lobe `fibre`. Zero means default, in every member. */
typedef struct WeftFibreModelDesc {
    int rounds;            /* of the search in each stage, at most 1000; 0: 120 */
    int threads;           /* 0: all; no influence on the numbers */
    WeftProgress progress; /* may be NULL; a result other than 0 stops */
    void *user;            /* of progress */
} WeftFibreModelDesc;

/* Solves slabs of fibres, fits the polynomial model of `fibre` to them, and writes its coefficients as the header
 * shading/tables/fibre_model.h, which begins with `command`. Takes minutes. *text is released with free().
 * Returns WEFT_INTERRUPTED if progress stops it; fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_bake_fibre_model(const WeftFibreModelDesc *desc, const char *command, char **text,
                                          WeftError *error);

/* Auditing a table of E. */

/* F(id, name in JSON): what can be wrong with a table. */
#define WEFT_TABLE_FAULTS(F)                                                                                           \
    F(NONE, "none")         /* as exact as its pixel type can be */                                                    \
    F(CONSTANT, "constant") /* one value everywhere, black among them, where E is not constant */                      \
    F(FORM, "axes")         /* right, but its axes are not those that were given */                                    \
    F(LATE, "shifted")      /* right, but shifted by one texel along the parameter */                                  \
    F(CLIPPED, "clipped")   /* right, but cut off where E goes on */                                                   \
    F(SCALED, "scaled")     /* right, but for one constant factor */                                                   \
    F(ENCODED, "encoded")   /* right, but sRGB-encoded */                                                              \
    F(OTHER_LOBE, "lobe")   /* of another lobe, or of none */                                                          \
    F(BIASED, "biased")     /* off by an error that neighbouring texels share */                                       \
    F(NOISY, "noisy")       /* off by an error that they do not share */                                               \
    F(CORNER, "corner")     /* off in a few texels only */

/* The fault of a table: WEFT_TABLE_NONE and the rest of WEFT_TABLE_FAULTS. */
typedef enum WeftTableFault {
#define WEFT_TABLE_FAULT_ENUM(id, name) WEFT_TABLE_##id,
    WEFT_TABLE_FAULTS(WEFT_TABLE_FAULT_ENUM)
#undef WEFT_TABLE_FAULT_ENUM
        WEFT_TABLE_FAULT_COUNT
} WeftTableFault;

/* Returns the name of a fault, such as "biased". */
WEFT_API const char *weft_table_fault_name(WeftTableFault fault);

/* The part of the albedo that a channel holds, for a lobe of two colours; a lobe of one colour has only the sum. */
typedef enum WeftTablePart { WEFT_TABLE_SUM = 0, WEFT_TABLE_F0, WEFT_TABLE_F90, WEFT_TABLE_PARTS } WeftTablePart;

/* Zero means default, in every member but image. */
typedef struct WeftAuditDesc {
    const WeftImage *image;    /* of any type; integers are linear, value / 255 or / 65535 */
    int channel;               /* of image */
    const WeftLobe *lobe;      /* counts as white; NULL: the nearest of those with at most four parameters */
    const WeftTableForm *form; /* NULL: the best of those that engines use, or of all there are */
    double scale;              /* multiplies the image's values; 0: 1 */
    double most;               /* the largest error that passes; 0: 0.01 */
    double tolerance;          /* of the quadrature; 0: 1e-4 */
    int threads;               /* 0: all */
    WeftProgress progress;     /* may be NULL; a result other than 0 stops */
    void *user;                /* of progress */
} WeftAuditDesc;

/* A texel, and the values there. */
typedef struct WeftTablePlace {
    int x, y;            /* from the top left */
    float cos_o, value;  /* value: of the lobe's first parameter */
    float table, albedo; /* the table's value times scale, and E */
} WeftTablePlace;

/* The most findings of an audit, and the size of a finding's text with its zero. */
enum { WEFT_AUDIT_FINDINGS = 6, WEFT_AUDIT_TEXT = 320 };

/* The result of an audit. */
typedef struct WeftAudit {
    WeftTableForm form;   /* the axes it was compared by: those given, else those found */
    int fits;             /* 0: the table is near neither to E in that form nor to a multiple of it */
    WeftTablePart part;   /* what the channel holds */
    long long texels;     /* compared: all but those at cos_o = 0 and beyond the lobe's hard range */
    long long left_out;   /* the rest */
    double largest;       /* |error|, error = table - E */
    WeftTablePlace place; /* of the largest error */
    double rms, mean;     /* of the error; the mean with its sign */
    double beyond;        /* fraction of texels whose |error| is above `most` */
    double together;      /* correlation of the errors of neighbouring texels, in [-1, 1]: 0 noise, 1 bias */
    double step;          /* between two values that the image's type can hold; 0: float */
    double error;         /* estimated error of E itself, by quadrature and between its samples */
    int faults;           /* found, at least 1: NONE is one */
    struct {
        WeftTableFault fault;
        char text[WEFT_AUDIT_TEXT]; /* one sentence */
    } found[WEFT_AUDIT_FINDINGS];   /* `faults` of them, the gravest first */
    int other;                      /* OTHER_LOBE: the lobe, -1 where none is near; else -1 */
    int lobe;                       /* whose E it was compared with */
} WeftAudit;

/* Compares a table with the quadrature of a lobe at the table's own texels. errors (may be NULL) becomes F32
 * of the table's size and three channels: error, table, E; all 0 where a texel is left out. Is interrupted and
 * fails as weft_bake. */
WEFT_API WeftResult weft_audit(const WeftAuditDesc *desc, WeftAudit *out, WeftImage *errors, WeftError *error);

/* A closed form of E, for shaders without a sampler to spare. */

enum { WEFT_FORM_TERMS = 49 };

/* E of a lobe over cos_o from 0 to 1 and roughness from `lowest` to 1: P(x, roughness), or exp P, cut off at 0, where
 * x is cos_o or its square root and P is the sum of terms[j * (across + 1) + i] x^i roughness^j, i to `across`, j to
 * `along`. */
typedef struct WeftAlbedoForm {
    int exponential, root;        /* exp P in place of P; x is the root */
    int across, along;            /* degrees */
    float terms[WEFT_FORM_TERMS]; /* coefficients of P, by the index above */
    double error;                 /* the largest, measured in floats on a grid other than that of the fit */
    float cos_o, roughness;       /* where */
} WeftAlbedoForm;

/* Zero means default, in every member but lobe and lowest. */
typedef struct WeftAlbedoFormDesc {
    const WeftLobe *lobe;  /* counts as white; its first parameter is alpha or roughness */
    WeftTablePart part;    /* of a lobe of two colours */
    double error;          /* the largest allowed; 0: 0.01 */
    double lowest;         /* roughness from which it holds, 0 to 0.9 */
    int threads;           /* 0: all; no influence on the numbers */
    WeftProgress progress; /* may be NULL; a result other than 0 stops */
    void *user;            /* of progress */
} WeftAlbedoFormDesc;

/* Finds the form of fewest terms within the error; where none of WEFT_FORM_TERMS terms is, that of the least error,
 * which is above desc->error then. Is interrupted as weft_bake; fails with WEFT_MESSAGE_DESC or _MEMORY. */
WEFT_API WeftResult weft_bake_form(const WeftAlbedoFormDesc *desc, WeftAlbedoForm *out, WeftError *error);

/* Returns the value of a form. */
WEFT_API float weft_form_at(const WeftAlbedoForm *form, float cos_o, float roughness);

#ifdef __cplusplus
}
#endif

#endif

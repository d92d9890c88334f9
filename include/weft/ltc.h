/* ltc.h - a lobe as linearly transformed cosines (LTC), over which polygon lights are integrated analytically
 *
 *   f cos_i = (amplitude f0 + amplitude_f90 f90) D,   D = max(v_z, 0) |M^-1| / (pi |v|^4),   v = M^-1 w
 *   v_xy = w_xy + (e t + b w_z) o,   v_z = z w_z + d t,   t = w_xy . o,   o = wo_xy,   e = q - 1,   d = -r b
 *
 * A table has one transform for each cosine of wo and value of the lobe's first parameter, interpolated between
 * nodes. Both colours share the transform, which is exact for the colours it was fitted to; the amplitudes hold
 * for any colours. Frame and units are those of weft/lobe.h; f90 is the lobe's second colour (eon derives one of
 * its own). docs/ltc.md lists the errors of the fits.
 *
 * DOES NOT: anisotropic lobes. */
#ifndef WEFT_LTC_H
#define WEFT_LTC_H

#include "weft/lobe.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The channels of a table's cell, by the letters above. */
typedef enum WeftLtcChannel {
    WEFT_LTC_Z = 0,             /* > 0 */
    WEFT_LTC_Q = 1,             /* >= 0 */
    WEFT_LTC_B = 2,             /* below 0 where the peak leans to the viewer's side */
    WEFT_LTC_R = 3,             /* >= 0 */
    WEFT_LTC_AMPLITUDE = 4,     /* E of the first colour, over the part of D that is above the horizon */
    WEFT_LTC_AMPLITUDE_F90 = 5, /* of the second; 0 without WEFT_LOBE_TWO_COLORS */
    WEFT_LTC_ERROR = 6, /* integral of |f cos_i - amplitude D| dwi over E, in [0, 2]: twice the misplaced light */
    WEFT_LTC_CHANNELS = 7
} WeftLtcChannel;

/* Returns "z", "q", "b", "r", "amplitude", "amplitude_f90" or "error"; NULL out of range. */
WEFT_API const char *weft_ltc_channel_name(int channel);

/* Zero means default, in every member. */
typedef struct WeftLtcDesc {
    int rows, columns; /* 2 .. 256; 0: 32. A lobe without parameters has one row */
    float low, high;   /* of the first parameter, clamped to its hard range; both 0: its plausible range */
    float f0, f90;     /* the colours that the transform is fitted to; both 0: white */
    int norm;          /* 1, 2 or 3: the power of |f cos_i - amplitude D| that is minimised; 0: 1 */
    int level;         /* not 0: r is 0, so that D ends at the horizon and f is finite there */
    int threads;       /* 0: one a processor */
    int no_cache;      /* not 0: the cache is neither read nor written */
    /* May be NULL. Called now and then from the calling thread with the finished fraction in [0, 1]; a result
     * other than 0 stops the work. */
    int (*progress)(void *user, double fraction);
    void *user;
} WeftLtcDesc;

/* A table of fits; may be read by any number of threads. */
typedef struct WeftLtc WeftLtc;

/* Fits a table with the lobe's other parameters as they are; its first parameter and its colours are not read.
 * A table is kept in $XDG_CACHE_HOME/weft (else ~/.cache/weft) and read from there the next time if the lobe's
 * text, its parameters and the descriptor are the same. A cache file that is damaged or cannot be written is a
 * warning (WEFT_MESSAGE_CACHE_IGNORED). The number of threads has no influence on the numbers. Fails with
 * WEFT_MESSAGE_LOBE_NAME, _LTC_LOBE (the lobe is anisotropic or WEFT_LOBE_REFERENCE), _DESC or _MEMORY, or
 * returns WEFT_INTERRUPTED. Release with weft_ltc_free. */
WEFT_API WeftResult weft_ltc_create(const WeftLobe *lobe, const WeftLtcDesc *desc, WeftLtc **out, const WeftLog *log,
                                    WeftError *error);

WEFT_API void weft_ltc_free(WeftLtc *ltc); /* may be NULL */

/* Size and error of a table. */
typedef struct WeftLtcInfo {
    int rows, columns; /* of every channel */
    float low, high;   /* of the parameter, in the first and the last row */
    int cached;        /* not 0 if read from the cache */
    double seconds;    /* s, to make or to read */
    /* Mean and largest error of the cells with E >= 1e-3, and the place of the largest. */
    float mean_error, worst_error, worst_cos_o, worst_value;
} WeftLtcInfo;

/* Returns size and error of a table. */
WEFT_API WeftLtcInfo weft_ltc_info(const WeftLtc *ltc);

/* Returns rows * columns floats, row after row, which live as long as ltc. NULL where there is no such channel. */
WEFT_API const float *weft_ltc_channel(const WeftLtc *ltc, int channel);

/* Returns the cosine of a column (0 is grazing) and the parameter of a row: uniform in the square root of cos_o
 * and of the parameter. */
WEFT_API float weft_ltc_cos_o(const WeftLtc *ltc, int column);
WEFT_API float weft_ltc_value(const WeftLtc *ltc, int row);

/* The transform for one wo. May be filled in by hand: z > 0, q >= 0, r >= 0. */
typedef struct WeftLtcLobe {
    float z, q, b, r;               /* the transform, as above */
    float amplitude, amplitude_f90; /* of the two colours */
} WeftLtcLobe;

/* Interpolates between the nodes; cos_o and value are clamped to the table. */
WEFT_API WeftLtcLobe weft_ltc_at(const WeftLtc *ltc, float cos_o, float value);

/* Fills m with M^-1 for that wo (unit, z >= 0), row after row, in the frame of wo. Its determinant is above 0. */
WEFT_API void weft_ltc_inverse(const WeftLtcLobe *lobe, const float wo[3], float m[9]);

/* Evaluates D at wi, 1/sr, the density of weft_ltc_sample; 0 where wi is not above the horizon. */
WEFT_API float weft_ltc_pdf(const WeftLtcLobe *lobe, const float wo[3], const float wi[3]);

/* Draws wi for u in [0, 1)^2 and returns its pdf; 0 means no sample, and wi must then not be used. */
WEFT_API float weft_ltc_sample(const WeftLtcLobe *lobe, const float wo[3], const float u[2], float wi[3]);

#ifdef __cplusplus
}
#endif

#endif

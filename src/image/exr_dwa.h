/* exr_dwa.h - the pixels of an OpenEXR file by OpenEXR's C++ interface, which alone has the compressions DWAA and
 * DWAB */
#pragma once

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The place of the pixels: channel names[c] of a part goes to values + c, `count` floats from pixel to pixel. */
typedef struct ExrPlanes {
    const char *names[4]; /* NULL: not read */
    int count;
    int left, top, width; /* of the data window */
    float *values;        /* width * height * count floats, interleaved */
} ExrPlanes;

typedef enum ExrDwa { EXR_DWA_READ = 0, EXR_DWA_DAMAGED, EXR_DWA_MEMORY } ExrDwa;

/* Reads them; `reason` receives why not. */
ExrDwa exr_dwa_read(const unsigned char *data, size_t size, int part, const ExrPlanes *planes, char *reason,
                    size_t reason_size);

#ifdef __cplusplus
}
#endif

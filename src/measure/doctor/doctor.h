/* doctor.h - an asset under examination: the data that the checks read, and the list that they add findings to */
#pragma once

#include <jansson.h>

#include "gltf/asset/asset.h"
#include "weft/doctor.h"

/* The repair that --fix makes at the place of a finding. */
typedef struct Repair {
    enum {
        REPAIR_NONE = 0,
        REPAIR_NUMBER,  /* the value becomes numbers[0] */
        REPAIR_NUMBERS, /* the value becomes an array of `count` numbers */
        REPAIR_REMOVE,  /* the member is removed */
        REPAIR_DECLARE, /* `extension` is added to extensionsUsed */
        REPAIR_ALPHA    /* a new picture gets `channel` of texture number `texture` as its alpha */
    } act;
    double numbers[4];
    int count, texture, channel;
    char extension[64];
} Repair;

/* The channels of a decoded image, 0 .. 1, as R G B A. */
typedef struct Pixels {
    bool done; /* true once computed */
    float low[4], high[4], mean[4];
    float linear[3]; /* mean of colours decoded from sRGB */
} Pixels;

typedef struct Energy Energy; /* both of doctor_energy.c */
typedef struct EnergyTables EnergyTables;

struct WeftDoctor {
    Asset asset;
    WeftScene *scene;
    WeftLog log;           /* the caller's; `own` passes warnings on to it */
    WeftLog own;           /* the log of the asset */
    WeftProgress progress; /* the caller's, may be NULL */
    void *user;            /* for progress */
    bool examining;        /* false while the file is being read */
    WeftError error;
    WeftFinding *items; /* the findings, and their repairs: `count`, with memory for `capacity` */
    Repair *repairs;
    int count, capacity;
    Pixels *pixels;   /* of the scene's images */
    Energy *energies; /* one for each set of material numbers that was measured */
    int energy_count, energy_capacity;
    EnergyTables *energy_tables; /* NULL until the first measurement */
    bool failed;                 /* memory was short */
    bool u3m;                    /* the file is a U3M (doctor_u3m.c): the asset has nothing but counts */
};

/* The place of a finding. */
typedef struct Place {
    WeftFindingOf of;
    int index;
    const char *path; /* within the thing, such as "extensions/NAME/key"; NULL: the thing itself */
} Place;

/* Adds a finding. engines: a bit mask of doctor_engine, 0 for whatever reads the file. figure: the value measured, or
 * NAN. repair: may be NULL. words: a printf format. */
__attribute__((format(printf, 7, 8))) void doctor_found(WeftDoctor *doctor, WeftFindingKind kind, Place place,
                                                        unsigned engines, double figure, const Repair *repair,
                                                        const char *words, ...);

/* Adds advice to the last finding; fix is a printf format. */
__attribute__((format(printf, 2, 3))) void doctor_advise(WeftDoctor *doctor, const char *fix, ...);

/* Makes the last finding a note without a repair: on a material that is no cloth the value may be intended. */
void doctor_soften(WeftDoctor *doctor);

/* Receives a warning of the reader and makes a finding of it: the fn of the asset's log, whose user is the doctor. */
void doctor_hear(void *doctor, WeftMessage message, const char *text);

/* Drops what the reader warned of where a check says more of the same value. */
void doctor_unite(WeftDoctor *doctor);

/* Returns the value at a path such as "a/b/c" below an object, or NULL if there is none. */
json_t *doctor_part(json_t *object, const char *path);

/* Returns the last part of such a path. */
const char *doctor_key(const char *path);

/* Returns the array of that name at the root of the JSON, such as "materials"; the second function, one of
 * its items. */
json_t *doctor_list(const WeftDoctor *doctor, const char *name);
json_t *doctor_item(const WeftDoctor *doctor, const char *name, int index);

/* Reads `count` numbers at a path, as an array or, if count is 1, as a number. Returns false and leaves `out` alone if
 * they are not there. */
bool doctor_numbers(json_t *object, const char *path, double *out, int count);

/* Returns the index of the texture that a textureInfo names; -1 if it names no existing texture. */
int doctor_texture(const WeftDoctor *doctor, json_t *texture_info);

/* Returns the decoded image that a textureInfo names; the second function, the range and mean of its
 * channels. NULL if none was read. */
const WeftImage *doctor_image(WeftDoctor *doctor, json_t *texture_info);
const Pixels *doctor_pixels(WeftDoctor *doctor, json_t *texture_info);

/* Reads the pixel nearest to u, v, each in [0, 1): as data, or as a linear colour. */
void doctor_texel(const WeftImage *image, float u, float v, float rgb[3]);
void doctor_texel_linear(const WeftDoctor *doctor, const WeftImage *image, float u, float v, float rgb[3]);

/* Writes the factor of an input, clamped to 0 .. 1, times the mean of its texture: a linear colour, or one number. */
void doctor_input(WeftDoctor *doctor, json_t *material, InputId input, float *out);

/* Returns the field that an input of this material is read from. */
const struct MaterialField *doctor_row(json_t *material, InputId input);

/* Returns the bit of a profile by its id, and the bits of all profiles of engines that read
 * KHR_materials_sheen; doctor_readers are their ids. */
unsigned doctor_engine(const char *profile);
unsigned doctor_engines(void);
extern const char *const doctor_readers[]; /* ends with NULL */

/* Any material of the asset, with the numbers that the checks of sheens read: factors times the means of textures. */
typedef struct Cloth {
    int index;
    json_t *json, *sheen; /* the material, and its KHR_materials_sheen or NULL */
    float color[3];       /* colour of the sheen */
    float roughness;      /* roughness of the sheen */
    float base[3], metallic;
} Cloth;
Cloth doctor_cloth(WeftDoctor *doctor, int material);
bool cloth_shows(const Cloth *cloth); /* true if there is a sheen that is not black */

/* The checks, in doctor_NAME.c: each examines the whole asset, one material or one mesh, and adds its
 * findings to the doctor. */
/* Finds extensions that weft lacks, or that are used but not listed. */
void check_extensions(WeftDoctor *doctor);
/* Finds images that are read in two colour spaces, or marked as linear. */
void check_spaces(WeftDoctor *doctor);
/* Finds what KHR_texture_basisu does not allow in an image: file, its bytes; color, data: the textures by which it is decoded
 * from sRGB and not, or NULL. */
void check_basis(WeftDoctor *doctor, int image, Span file, const char *color, const char *data);
/* Finds a sheen and a transmission in one asset. */
void check_glass(WeftDoctor *doctor);
/* Finds a scene without a surface. */
void check_empty(WeftDoctor *doctor);
/* Finds cloth whose texture coordinates have several scales. */
void check_scale(WeftDoctor *doctor, const Cloth *cloth);
/* Finds materials of an extension that Khronos has archived. */
void check_archived(WeftDoctor *doctor, const Cloth *cloth);
/* Finds factors outside their range. */
void check_ranges(WeftDoctor *doctor, const Cloth *cloth);
/* Finds numbers that are left out and whose default readers do not agree on. */
void check_defaults(WeftDoctor *doctor, const Cloth *cloth);
/* Finds textures that are multiplied by 0. */
void check_factors(WeftDoctor *doctor, const Cloth *cloth);
/* Finds textures whose transform has a scale of 0. */
void check_transforms(WeftDoctor *doctor, const Cloth *cloth);
/* Finds sheens that are black. */
void check_black(WeftDoctor *doctor, const Cloth *cloth);
/* Finds textures whose number is read from an alpha that is 1 everywhere. */
void check_channels(WeftDoctor *doctor, const Cloth *cloth);
/* Finds engines that return too much light, or that differ. */
void check_energy(WeftDoctor *doctor, const Cloth *cloth);
/* Finds inputs that conflict with a sheen. */
void check_neighbours(WeftDoctor *doctor, const Cloth *cloth);
/* Finds numbers that no real material has. */
void check_plausible(WeftDoctor *doctor, const Cloth *cloth);
/* Finds normals, tangents and texture coordinates that are missing, and open edges of single-sided cloth. */
void check_mesh(WeftDoctor *doctor, int mesh);

/* Returns E of the whole material, strongest channel, as check_energy measures it. reader: index into
 * doctor_readers. cosine: one that check_energy samples. Negative if not measured. */
float doctor_albedo(WeftDoctor *doctor, const Cloth *cloth, int reader, float cosine);

/* Examines a U3M. Fails as reading one does. */
WeftResult doctor_u3m(WeftDoctor *doctor, const char *path, WeftError *error);

/* Applies a repair to the JSON of a rewrite. */
struct Rewrite;
WeftResult doctor_repair(const WeftDoctor *doctor, struct Rewrite *rewrite, int finding, WeftError *error);

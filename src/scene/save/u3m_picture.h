/* u3m_picture.h - a texture of a scene as the picture of a U3M: its pixels, its millimetres and its repeat */
#pragma once

#include <jansson.h>

#include "scene/record/scene.h"
#include "scene/u3m/u3m_package.h"

/* Tells what of the texture the picture has. */
typedef enum U3mPixels {
    U3M_AS_IS = 0, /* colours or normals, as the file has them where it is a PNG or JPEG */
    U3M_CHANNEL,   /* one channel, in all three */
    U3M_LUMINANCE, /* the luminance of its colours, linear */
    U3M_ANGLE      /* the angle of its directions as part of a whole turn */
} U3mPixels;

typedef struct U3mPicture {
    int image, channel;
    U3mPixels pixels;
    bool color; /* U3M_AS_IS: colours in sRGB */
    char path[160];
    float mean[3]; /* linear; of a number [0] */
    float scale;   /* of a number: that of the texture is so many times the picture's */
} U3mPicture;

/* The pictures of a U3M that is written. */
typedef struct U3mPictures {
    const WeftScene *scene;
    int material;
    const char *path;  /* of the .u3m or .u3ma */
    const char *taken; /* the text of the U3M that was read, whose files keep their names; NULL: none */
    double metres;     /* a unit of texture coordinates spans them; 0: as the mesh tells */
    U3mPackage *package;
    const WeftLog *log;
    WeftError *error;
    U3mPicture made[2 * INPUT_COUNT]; /* one for each texture and use */
    int count;
} U3mPictures;

/* Adds the picture of an input's texture to the package, once; name is that of the member it is for, such as
 * "front-roughness". *out stays with the pictures. Fails with WEFT_MESSAGE_MEMORY and as reading a file does. */
WeftResult u3m_picture_add(U3mPictures *pictures, const Input *input, U3mPixels pixels, bool color, const char *name,
                           const U3mPicture **out);

/* Returns the member "image" of a texture: the file, its millimetres on the mesh of the material and its repeat, with a
 * warning of what these cannot say. NULL if memory is short. */
json_t *u3m_picture_image(const U3mPictures *pictures, const Input *input, const U3mPicture *picture, const char *name);

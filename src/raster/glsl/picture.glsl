/* picture.glsl - what all shaders of a picture share: the camera, lights and their shadows */
layout(std140) uniform Picture {
    highp mat4 to_clip; /* from the world, less the eye */
    highp vec4 eye;     /* w: 0 where all rays are parallel */
    highp vec4 forward; /* of the camera; w: how many punctual lights there are */
    highp mat4 shadow_clip[4]; /* from the world, less shadow_eye */
    highp vec4 shadow_eye[4];  /* w: width of a texel, m; below 0 of one at distance 1 */
    highp vec4 shadow_soft[4]; /* half the width of the map at distance 1; first of its layers */
    highp vec4 shadow_points[220]; /* 55 each: of the light, from shadow_eye, along x and y in such halves and along
                                      w in m; how x and y of what it sees are moved, by these two */
    highp vec4 lights[256]; /* four each: position and kind (0 directional, 1 point, 2 spot); direction that it
                               travels and range; colour times intensity, and shadow map or -1; cosines of the
                               cones */
    highp vec4 polygon_corners[64]; /* eight each */
    highp vec4 polygon_normals[8];
    highp vec4 polygon_radiance[8];
    highp vec4 floor_place; /* middle and radius */
    highp vec4 floor_light; /* luminance of the sky's on it, share that it mirrors, 1 where it is in shadow */
    highp vec4 floor_lens;  /* of the mirror: depth is x + y / w, of parallel rays x w + y; half width of its
                               cone over the picture's, and how much more that is upward */
};

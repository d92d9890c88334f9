/* picture.glsl - what all shaders of a picture share: the camera and the punctual lights */
layout(std140) uniform Picture {
    highp mat4 to_clip; /* from the world, less the eye */
    highp vec4 eye;     /* w: 0 where all rays are parallel */
    highp vec4 forward; /* of the camera; w: how many lights there are */
    highp vec4 lights[256]; /* four each: position and kind (0 directional, 1 point, 2 spot); direction that it
                               travels and range; colour times intensity and shadow map; cosines of the cones */
};

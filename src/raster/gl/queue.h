/* queue.h - the order in which meshes are drawn: solid ones from the front, so that hidden pixels are not shaded, then
 * blended ones from the back */
#pragma once

#include "scene/record/camera.h"

typedef struct Queue {
    int *order; /* meshes; `solid` of them before those that blend */
    int count, solid;
    float *depth; /* of a mesh, as last sorted */
    Vec3 *middle; /* of a mesh's box */
    float *reach; /* from the middle to a corner, m */
} Queue;

/* Fails with WEFT_MESSAGE_MEMORY; it is then empty. */
WeftResult queue_create(const WeftScene *scene, Queue *out, WeftError *error);
void queue_destroy(Queue *queue);

/* Updates the order after a change of materials, which decide which meshes blend. */
void queue_update(Queue *queue, const WeftScene *scene);

/* Updates the queue after a change of shapes of lights. Fails as queue_create does; the queue is then as it was. */
WeftResult queue_reshape(Queue *queue, const WeftScene *scene, WeftError *error);

/* Sorts for a view. Allocates nothing, and is fast if the view has moved little. */
void queue_sort(Queue *queue, const WeftScene *scene, const View *view);

#include "view/render/cloth_reflection.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

struct ClothReflection {
    WeftMaterial material;
    WeftDraft *draft;
    WeftYarn yarns[2];
    unsigned seed;
    Window *window;
    WeftReflection *reflection;
    pthread_t thread;
    atomic_bool done;
};

static void *work(void *user) {
    ClothReflection *self = user;
    WeftCloth *cloth;
    if (weft_cloth_create(self->draft, self->yarns, self->seed, &cloth, NULL) == WEFT_OK)
        weft_reflection_create_woven(&self->material, cloth, &self->reflection, NULL);
    weft_cloth_free(cloth);
    atomic_store(&self->done, true);
    window_wake(self->window);
    return NULL;
}

ClothReflection *cloth_reflection_start(const WeftMaterial *material, const FactCloth *cloth, Window *window) {
    ClothReflection *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    self->material = *material;
    memcpy(self->yarns, cloth->yarns, sizeof self->yarns);
    self->seed = (unsigned)cloth->info.seed;
    self->window = window;
    atomic_init(&self->done, false);
    if (weft_draft_copy(cloth->draft, &self->draft, NULL) == WEFT_OK &&
        pthread_create(&self->thread, NULL, work, self) == 0)
        return self;
    weft_draft_free(self->draft);
    free(self);
    return NULL;
}

bool cloth_reflection_done(ClothReflection *self) { return atomic_load(&self->done); }

WeftReflection *cloth_reflection_end(ClothReflection *self) {
    if (!self) return NULL;
    pthread_join(self->thread, NULL);
    WeftReflection *reflection = self->reflection;
    weft_draft_free(self->draft);
    free(self);
    return reflection;
}

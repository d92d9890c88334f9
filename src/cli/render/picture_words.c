#include "cli/render/picture_words.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "weft/weft.h"

WeftResult picture_words(const Job *job, const WeftRenderDesc *desc, char *words, WeftError *error) {
    const Request *request = job->request;
    const SceneOptions *shown = &request->scene_options;
    const bool laid = shown->background == WEFT_BACKGROUND_COLOR;
    const float *behind = shown->background_color;
    const WeftTone *tone = &shown->tone;
    const size_t used = strlen(words);
    WeftCamera camera;
    WeftResult result =
        weft_scene_camera(job->scene, desc->camera, (float)desc->width / (float)desc->height, &camera, error);
    if (result != WEFT_OK) return result;
    snprintf(words + used, PART_WORDS - used,
             "version=%s isa=%s scene=%016llx camera=%.9g,%.9g,%.9g;%.9g,%.9g,%.9g;%.9g "
             "picture=%dx%d crop=%d,%d,%d,%d spp=%d seed=%u depth=%d sampling=%d background=%d floor=%d,%.9g,%.9g "
             "lights=%d halves=%d aovs=%u tone=%d,%.9g,%.9g,%.9g,%d,%d behind=%d,%.9g,%.9g,%.9g",
             weft_version(), weft_isa(), (unsigned long long)weft_scene_hash(job->scene), (double)camera.eye[0],
             (double)camera.eye[1], (double)camera.eye[2], (double)camera.target[0], (double)camera.target[1],
             (double)camera.target[2], (double)camera.fov, desc->width, desc->height, desc->crop[0], desc->crop[1],
             desc->crop[2], desc->crop[3], request->spp, (unsigned)desc->seed, desc->max_depth, (int)desc->sampling,
             (int)desc->background, desc->floor.on, (double)desc->floor.reflection, (double)desc->floor.roughness,
             !desc->hide_lights, desc->halves, request->aovs, (int)tone->curve, (double)tone->exposure,
             (double)tone->white[0], (double)tone->white[1], shown->meter_exposure, shown->find_white, laid,
             laid ? (double)behind[0] : 0.0, laid ? (double)behind[1] : 0.0, laid ? (double)behind[2] : 0.0);
    return WEFT_OK;
}

const char *word_value(const char *words, const char *key, size_t *length) {
    const size_t size = strlen(key);
    for (const char *at = words; at; at = strchr(at, ' ') ? strchr(at, ' ') + 1 : NULL)
        if (strncmp(at, key, size) == 0 && at[size] == '=') {
            *length = strcspn(at + size + 1, " ");
            return at + size + 1;
        }
    return NULL;
}

bool word_numbers(const char *words, const char *key, int wanted, double *numbers) {
    size_t length;
    const char *value = word_value(words, key, &length);
    int found = 0;
    while (value && found < wanted) {
        char *end;
        numbers[found] = strtod(value, &end);
        if (end == value || !isfinite(numbers[found])) return false;
        found++;
        value = found < wanted ? *end == ',' || *end == 'x' ? end + 1 : NULL : *end && *end != ' ' ? NULL : end;
    }
    return value && found == wanted;
}

/* Returns true if a word has this key. */
static bool has_key(const char *word, const char *key) {
    const size_t size = strlen(key);
    return strncmp(word, key, size) == 0 && word[size] == '=';
}

bool words_same(const char *words, const char *wanted, const char *const *but, char text[WORDS_DIFFERENCE]) {
    const char *a = wanted, *b = words;
    while (*a || *b) {
        const size_t m = strcspn(a, " "), n = strcspn(b, " ");
        bool same = m == n && strncmp(a, b, m) == 0;
        for (int k = 0; !same && but[k]; k++) same = has_key(a, but[k]) && has_key(b, but[k]);
        if (!same) {
            snprintf(text, WORDS_DIFFERENCE, "%.*s, and not %.*s", (int)(n < 60 ? n : 60), b, (int)(m < 60 ? m : 60),
                     a);
            return false;
        }
        a += m + (a[m] == ' ');
        b += n + (b[n] == ' ');
    }
    return true;
}

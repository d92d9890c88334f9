/* studies.h - a small picture of the scene with one material under every profile, one at a time, and the
 * sheet of them all */
#pragma once

#include "view/render/orbit.h"
#include "view/render/scene_state.h"
#include "weft/raster.h"

enum { STUDY_MOST = 40 };

/* Zero-initialise: none is under way. */
typedef struct Study {
    bool under_way;
    unsigned stamp;
    SceneState state;
    int material;
    WeftRasterView view;
    char camera[ORBIT_TEXT];
    WeftTone tone;
    int next; /* picture: 0 is without a profile, k that of profile k - 1 */
    WeftImage pictures[STUDY_MOST];
} Study;

/* Starts a sheet of a state, and gives up one under way. */
void study_start(Study *study, const SceneState *state, int material, const WeftRasterView *view, const char *camera,
                 const WeftTone *tone, unsigned stamp);
void study_stop(Study *study);

/* Fills the state of the next picture; false, with an empty state, if memory is short. study_view returns its view. */
bool study_state(const Study *study, SceneState *state);
WeftRasterView study_view(const Study *study);
void study_add(Study *study, WeftImage *linear); /* takes it over */
bool study_done(const Study *study);

/* Composes the sheet, U8 RGB. False where memory is short. */
bool study_sheet(const Study *study, WeftImage *sheet);

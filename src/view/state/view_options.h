/* view_options.h - the options of the view: mode, part, background, exposure, tool, open panel */
#pragma once

#include "view/state/viewer.h"

/* The content of the stage: OpenGL, the path tracer, or their difference. */
typedef enum Mode { MODE_LIVE, MODE_REFERENCE, MODE_DIFFERENCE } Mode;
typedef enum Tool { TOOL_ORBIT, TOOL_PROBE, TOOL_BRUSH } Tool;

/* The panels at the side, in the order of their tabs. */
enum { PANEL_MATERIAL, PANEL_LIGHT, PANEL_VIEW, PANEL_INSPECT, PANEL_DOCTOR };

typedef struct ViewOptions {
    Mode mode;
    float split_at; /* position of the line between A and B, fraction of the width */
    WeftBackground background;
    float background_color[3];
    WeftFloor floor;
    bool stage; /* the floor follows the scene: the user has not decided on one */
    bool hide_lights;
    bool bounced; /* light bounces once between surfaces, where frames are summed */
    WeftTonemap tonemap;
    float exposure; /* stops */
    bool metered;   /* exposure follows the picture */
    float kelvin;   /* of the light that shows as white; WHITE_NONE with tint 0: that of the display */
    float tint;     /* of it, as weft_white has it */
    bool balanced;  /* the white is that of the picture, in place of both */
    float white[2]; /* as it was found there; 0: not yet, or it has no light to balance */
    WeftPart part;
    WeftAmbient ambient;
    Tool tool;
    float brush_radius;   /* m */
    float brush_strength; /* of a stroke, 0 to 1 */
    int panel;            /* the open panel: PANEL_MATERIAL ... */
} ViewOptions;

void options_begin(Viewer *v);

#define WHITE_NONE 6504.0f

/* Fills the white of the options, as WeftTone has it. */
void options_white(const ViewOptions *options, float white[2]);

/* Takes the exposure and the white of a picture in which they were metered, where the options follow it, unless they differ
 * by less than the picture's noise. */
void options_take_metered(Viewer *v, float stops, const float white[2]);

/* Sets all options, clamped to their ranges. */
void options_set(Viewer *v, const ViewOptions *options);
void options_set_mode(Viewer *v, Mode mode);

/* Sets the mode, or MODE_LIVE if it is that mode already. */
void options_toggle_mode(Viewer *v, Mode mode);
void options_set_part(Viewer *v, WeftPart part);
void options_set_panel(Viewer *v, int panel);

/* Sets the tool; the probe opens the panel that shows its results. */
void options_set_tool(Viewer *v, Tool tool);
void options_toggle_floor(Viewer *v);

/* Gives a new scene the floor that suits it, unless the user has decided on one. */
void options_set_stage(Viewer *v, const WeftFloor *floor);
void options_toggle_lights(Viewer *v);

/* panels.h - the panels, bars and keys of the window, one file each */
#pragma once

#include "view/state/viewer.h"

void menu_draw(Viewer *v);
void status_draw(Viewer *v);
void material_panel(Viewer *v);
void weave_section(Viewer *v, const WeftMaterial *m); /* of the material's panel */
void light_panel(Viewer *v);
void view_panel(Viewer *v);
void photograph_section(Viewer *v); /* of the view's panel */
void inspect_panel(Viewer *v);
void doctor_panel(Viewer *v);
void keys_input(Viewer *v);

/* Shows the window of presets, which is drawn in every frame, or hides it. */
void presets_show(Viewer *v);
void presets_hide(Viewer *v);
void presets_draw(Viewer *v);

/* Takes pictures of presets that were made; returns true if there were any. presets_busy: more are being made. */
bool presets_poll(Viewer *v);
bool presets_busy(const Viewer *v);
void presets_free(struct PresetWindow *presets);

/* Returns true if the examination goes on in the next frame. */
bool doctor_busy(const Viewer *v);

/* Forgets the findings about a file that is no longer open. */
void doctor_forget(Viewer *v);

/* Returns true if measuring goes on in the next frame. */
bool inspection_busy(const struct Inspection *inspection);
void inspection_free(struct Inspection *inspection);

/* Writes the share of even light that the inspected material reflects; false while it is not measured. */
bool inspection_furnace(const struct Inspection *inspection, float share[3]);

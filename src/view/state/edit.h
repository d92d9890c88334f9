/* edit.h - the edited state of the scene, or both of A and B: history, chosen material and light, changes by tasks */
#pragma once

#include "view/state/history.h"
#include "view/state/viewer.h"

enum { ASSIGNMENTS = 16 };

/* A material that a task is about to replace, as it was when the task was sent. */
typedef struct Assignment {
    unsigned stamp;
    int material;
    WeftMaterial was;
} Assignment;

typedef struct EditState {
    SceneState state;  /* as edited */
    SceneState first;  /* as read */
    SceneState before; /* a frame ago */
    SceneState other;  /* the other of A and B; empty before the first comparison */
    int side;          /* side that `state` has: 0 is A */
    Split split;
    History history, other_history;
    int material, light; /* chosen in the panels */
    WeftMaterial copied;
    bool has_copied;
    Assignment assignments[ASSIGNMENTS]; /* under way, in the order they were sent */
    int assignment_count;
    unsigned stamp;    /* of the last assignment */
    SceneState saved;  /* as it was saved last, or read */
    SceneState saving; /* as it was when the last task that saves was sent */
    unsigned saving_stamp;
    int saving_material; /* the one that it saves; -1: the scene */
} EditState;

/* Begins with the states of a scene, which it takes over. Call edit_forget before. */
void edit_begin(Viewer *v, const SceneState *state, const SceneState *before, const SceneState *first);
void edit_forget(Viewer *v);

/* Takes the other of A and B of a session, of which a copy is made; empty: there was none. */
void edit_restore_other(Viewer *v, const SceneState *other, Split split, int side);

/* Returns true if the scene differs from what was read, or saved last. */
bool edit_is_unsaved(const Viewer *v);

/* Notes that the edited state is about to be saved, or one material of it (-1: all); returns a stamp for the task. */
unsigned edit_saving(Viewer *v, int material);
void edit_end_saving(Viewer *v, unsigned stamp, bool failed);

/* Keeps what differs at the end of a frame as a step of history. goes_on: a drag or typing continues in the next frame,
 * whose changes belong to the same step. */
void edit_note_changes(Viewer *v, bool goes_on);
void edit_undo(Viewer *v);
void edit_redo(Viewer *v);

void edit_choose_material(Viewer *v, int material);
void edit_choose_light(Viewer *v, int light);

/* Chooses the next of the materials that something uses; by is 1 or -1. */
void edit_next_material(Viewer *v, int by);

/* Changes the edited state. Indices must be valid. */
void edit_set_material(Viewer *v, int index, const WeftMaterial *material);
void edit_set_preset(Viewer *v, int material, int preset);
void edit_set_variant(Viewer *v, int variant);
void edit_set_environment(Viewer *v, const EnvironmentState *environment);
void edit_set_light(Viewer *v, int index, const WeftLight *light);

/* Adds a light and chooses it; there must be fewer than STATE_LIGHTS. */
void edit_add_light(Viewer *v, const WeftLight *light);
void edit_remove_light(Viewer *v, int index);

/* Takes over a nap. Returns false if no more materials can have one. */
bool edit_set_nap(Viewer *v, BrushedNap *nap);

/* Gives the chosen material a sheen of the lobe fibre, with a nap to brush. */
void edit_make_fibre(Viewer *v);

void edit_copy_material(Viewer *v);
void edit_paste_material(Viewer *v);
void edit_forget_copy(Viewer *v);

/* Begins or ends the comparison of A and B. The state that is not edited is kept while it is off. */
void edit_set_split(Viewer *v, Split split);

/* Edits the other of A and B. */
void edit_swap_sides(Viewer *v);

/* Makes the other of A and B equal to the edited one. */
void edit_match_other(Viewer *v);

/* Takes an environment that the renderer has read. A file that was reread makes no step of history, since its earlier
 * contents are gone. */
void edit_take_light(Viewer *v, const EnvironmentState *environment);

/* Returns a stamp for a task that replaces a material; 0 if none is left. */
unsigned edit_assign(Viewer *v, int material);
void edit_end_assign(Viewer *v, unsigned stamp);

/* Takes over the state that a task has made. If the stamp is that of an assignment, changes of its material since the
 * task was sent stay. */
void edit_take_assigned(Viewer *v, SceneState *state, unsigned stamp);

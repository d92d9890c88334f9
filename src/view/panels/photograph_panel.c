/* The section of the view's panel for a photograph to compare with. */
#include "view/files/paths.h"
#include "view/panels/panels.h"
#include "view/state/dialogs.h"
#include "view/state/photographs.h"

void photograph_section(Viewer *v) {
    static const char *const places[] = {"Off", "Beside", "Line", "Over", NULL};
    static const char *const tips[] = {"The picture alone.", "The photograph at the right of the picture.",
                                       "The photograph at the right of a line that can be dragged.",
                                       "The photograph over the picture, as opaque as you like."};
    static const UiRange opacity = {0.0f, 1.0f, 0.5f, NULL, false}, size = {0.1f, 10.0f, 1.0f, NULL, true},
                         shift = {-1.0f, 1.0f, 0.0f, NULL, false};
    PhotographView view = v->photographs->view;
    int place = (int)view.place;
    if (ui_button("Choose a photograph ...")) dialogs_open(v, "Choose a photograph");
    ui_tip(
        "Any picture that can be read. Photographs of 8 or 16 bits are shown as they are; linear ones (.hdr .exr) have "
        "the exposure and the tone map of the picture.");
    if (!v->photographs->path[0]) return;
    ui_same_line();
    const bool removed = ui_button("Remove");
    ui_tip("Takes the photograph away.");
    ui_dim(path_name(v->photographs->path));
    if (ui_tabs("place", places, tips, &place)) view.place = (PhotographPlace)place;
    if (view.place == PHOTOGRAPH_OVER) {
        ui_slider("opacity", &opacity, &view.opacity);
        ui_tip("Of the photograph over the picture.");
    }
    ui_slider("photo size", &size, &view.size);
    ui_tip("1 is as large as fits.");
    ui_slider("photo right", &shift, &view.shift[0]);
    ui_tip("Moves it to the right, in heights of the picture.");
    ui_slider("photo down", &shift, &view.shift[1]);
    ui_tip("Moves it down, in heights of the picture.");
    ui_checkbox("Zoom with the camera", &view.follows);
    ui_tip("The photograph grows as the camera comes nearer or its field of view narrows.");
    photographs_set(v, &view);
    if (removed) photographs_remove(v);
}

/* rooms.h - the window's state for those who write it: each room for the one file that viewer.h names */
#ifndef WEFT_VIEW_ROOMS_H
#define WEFT_VIEW_ROOMS_H

#include "view/state/viewer.h"

struct Rooms {
    WindowRoom frame;
    OpeningRoom opening;
    ShownRoom shown;
    EditRoom edit;
    ViewOptions options;
    CameraRoom camera;
    RequestsRoom requests;
    DialogsRoom dialogs;
    DragRoom drag;
    WeaveRoom weave;
};

#endif

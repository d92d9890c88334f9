/* states.h - the window's state for those who write it: each member for the .c file named like the header of its record */
#pragma once

#include "view/state/bakings.h"
#include "view/state/dialogs.h"
#include "view/state/edit.h"
#include "view/state/frame_requests.h"
#include "view/state/leaving.h"
#include "view/state/opening.h"
#include "view/state/photographs.h"
#include "view/state/sessions.h"
#include "view/state/stage.h"
#include "view/state/stills.h"
#include "view/state/view_camera.h"
#include "view/state/view_options.h"
#include "view/state/viewer.h"

struct States {
    WindowState frame;
    OpeningState opening;
    ShownScene shown;
    EditState edit;
    ViewOptions options;
    CameraState camera;
    RequestsState requests;
    DialogsState dialogs;
    DragState drag;
    StillsState stills;
    BakingsState bakings;
    LeavingState leaving;
    PhotographsState photographs;
    SessionsState sessions;
};

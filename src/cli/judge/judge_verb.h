/* judge_verb.h - one run of `weft judge`: a scene with its reference, and the pictures judged by it */
#pragma once

#include <stdio.h>

#include "cli/console/options.h"
#include "cli/render/scene_options.h"
#include "weft/judge.h"

typedef struct JudgeRun {
    const Options *options;
    SceneOptions scene_options;
    WeftJudgeDesc desc;
    bool quiet;
    WeftScene *scene; /* owned, as are the rest; see judge_close */
    WeftJudge *judge;
    WeftImage *images;          /* count of them */
    WeftJudgePicture *pictures; /* likewise */
    WeftVerdict *verdicts;      /* likewise; zero until they are judged */
    const char *const *paths;   /* of the pictures, not owned */
    int count;
} JudgeRun;

/* Reads the options. Returns false after one line on standard error. */
bool judge_read(JudgeRun *run, const Options *options, const char *scene);

/* Loads the scene and lights it as stated. Returns 0 or an exit code after one line, as the next ones do. */
int judge_load(JudgeRun *run);

/* Renders the reference and finds the objects. */
int judge_make(JudgeRun *run);

/* Reads the pictures, whose size the reference has unless it is given. */
int judge_pictures_read(JudgeRun *run, const char *const *paths, int count);

/* Judges the pictures. */
int judge_pictures(JudgeRun *run);

void judge_close(JudgeRun *run);

/* Prints the reference, with what it was lit by, and the verdicts. */
void judge_text(const JudgeRun *run);

/* Writes the same as a JSON object. sweep (may be NULL) has a text for each of sweep_count materials of a scene, what
 * it is. */
void judge_json(const JudgeRun *run, FILE *stream, const char (*sweep)[64], int sweep_count);

enum { LIGHT_TEXT = 320 };

/* Writes a light as --light takes it. */
void judge_light_text(const WeftLight *light, char text[LIGHT_TEXT]);

/* Writes the environment as words: "none", a radiance, or a file. */
void judge_environment_text(const JudgeRun *run, char text[LIGHT_TEXT]);

/* Returns the best cause of a kind of a verdict, or NULL where none was tried. */
const WeftCauseShare *judge_best(const WeftVerdict *verdict, WeftCauseKind kind);

/* Writes weft's own sweeps, of weave, nap and measured fabric, to a folder: each a .glb, and a .json of what is
 * expected of it. */
int judge_sweeps(const Options *options, const char *folder);

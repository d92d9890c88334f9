/* What the panels offer: variants and presets that undo brings back, folders that stay on a scene that is
 * read again, maps for every number, reference materials, the doctor's findings.
 *
 * Labels: slow unsanitized */
#include "drive.h"

#include "box.h"

static const char quads[] =
    "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_variants\",\"KHR_materials_sheen\"]"
    ","
    "\"extensions\":{\"KHR_materials_variants\":{\"variants\":[{\"name\":\"red\"},{\"name\":\"blue\"}]}},"
    "\"scenes\":[{\"nodes\":[0,1]}],"
    "\"nodes\":[{\"mesh\":0,\"scale\":[3,3,3]},{\"mesh\":1,\"translation\":[0,-1.2,0]}],"
    "\"materials\":[{\"name\":\"Spare\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,1,1]}},"
    "{\"name\":\"Small\",\"extensions\":{\"KHR_materials_sheen\":{\"sheenRoughnessFactor\":0.5}}},"
    "{\"name\":\"Large\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0,0,1]}}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":2,"
    "\"extensions\":"
    "{\"KHR_materials_variants\":{\"mappings\":[{\"material\":0,\"variants\":[1]}]}}}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":1}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":6,\"type\":\"VEC3\","
    "\"min\":[-0.5,0,0],\"max\":[0.5,1,0]},"
    "{\"bufferView\":1,\"componentType\":5126,\"count\":6,\"type\":\"VEC2\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":72},{\"buffer\":0,\"byteOffset\":72,\"byteLength\":48}],"
    "\"buffers\":[{\"byteLength\":120,\"uri\":\"quad.bin\"}]}";

#define FLAT "--env", "1,1,1", "--occlusion", "0"

static void write_quads(void) {
    static const float corners[30] = {-0.5f, 0, 0, 0.5f, 0, 0, 0.5f, 1, 0, -0.5f, 0, 0, 0.5f, 1, 0,
                                      -0.5f, 1, 0, 0,    1, 1, 1,    1, 0, 0,     1, 1, 0,    0, 0};
    file_make("quad.bin", (const char *)corners, sizeof corners);
    file_make("quads.gltf", quads, sizeof quads - 1);
}

static void write_map(const char *path, int red) {
    WeftImage image;
    WeftError error;
    assert_int_equal(weft_image_create(8, 8, 3, WEFT_PIXEL_U8, &image, NULL), WEFT_OK);
    unsigned char *p = image.pixels;
    for (int k = 0; k < 64; k++, p += 3) p[0] = (unsigned char)red, p[1] = 60, p[2] = 20;
    if (weft_image_write(path, &image, &error) != WEFT_OK) fail_msg("%s", error.text);
    weft_image_free(&image);
}

static void undo_restores_a_variant(void **state) {
    (void)state;
    need_gl();
    write_quads();
    script_begin();
    say_rested_picture("own.png");
    say("choose Material/variant blue\nwait 3\n");
    say_rested_picture("blue.png");
    say("choose Material/variant red\nwait 3\n"); /* which says nothing of the quad */
    say_rested_picture("red.png");
    say("key control+z\nwait 3\n");
    say_rested_picture("undone.png");
    say("key control+z\nwait 3\n");
    say_rested_picture("first.png");
    Drive drive = drive_start(script, LIST(UNSEEN, "quads.gltf", FLAT));
    static const char *const pictures[] = {"own.png", "blue.png", "red.png", "undone.png", "first.png"};
    static const int variants[] = {-1, 1, 0, 1, -1}, materials[] = {1, 0, 2, 0, 2};
    for (int k = 0; k < 5; k++) {
        json_t *now = drive_picture(&drive, pictures[k]);
        assert_int_equal(number_of(now, "variant"), variants[k]);
        if (k) assert_int_equal(number_of(now, "material"), materials[k]);
        json_decref(now);
    }
    drive_finish(&drive);
    assert_true(pictures_most("own.png", "blue.png") > 0.1);
    assert_true(pictures_most("own.png", "red.png") < 0.5 / 255.0);
    assert_true(pictures_most("blue.png", "undone.png") < 0.5 / 255.0);
    assert_true(pictures_most("own.png", "first.png") < 0.5 / 255.0);
}

static void the_menu_of_presets_follows_undo(void **state) {
    (void)state;
    need_gl();
    const char *preset = weft_preset_name(1);
    script_begin();
    say("wait rest\nchoose Material/preset %s\nwait 5\n", preset);
    say_rested_picture("worn.png");
    say("key control+z\nwait 3\n");
    say_rested_picture("undone.png");
    say("key control+shift+z\nwait 3\n");
    say_rested_picture("again.png");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    static const char *const pictures[] = {"worn.png", "undone.png", "again.png"};
    for (int k = 0; k < 3; k++) {
        json_t *now = drive_picture(&drive, pictures[k]);
        assert_string_equal(word_of(material_of(now, 0), "preset"), k == 1 ? "" : preset);
        json_decref(now);
    }
    drive_finish(&drive);
    assert_true(pictures_most("worn.png", "undone.png") > 0.02);
    assert_true(pictures_most("worn.png", "again.png") < 0.5 / 255.0);
}

/* An asset without light and floor has the stage of `weft render` until G is pressed; a scene with its own has none. */
static void a_bare_asset_stands_on_a_stage(void **state) {
    (void)state;
    need_gl();
    box_write("box.gltf", BOX_BARE);
    script_begin();
    say_rested_picture("staged.png");
    say("command staged.txt\nopen builtin:ball\nwait message builtin:ball\nwait rest\ncommand ball.txt\n"
        "open box.gltf\nwait message box.gltf\nkey g\nwait 3\n");
    say_rested_picture("bare.png");
    say("command bare.txt\nopen box.gltf\nwait message box.gltf\nwait rest\ncommand again.txt\n");
    drive_through(script, LIST(UNSEEN, "box.gltf", "--occlusion", "0"));
    assert_true(pictures_most("staged.png", "bare.png") > 0.1);
    Ran ran = run_shell(
        "grep -q -- '--floor --floor-reflection 0 ' staged.txt && ! grep -q -- '--floor' ball.txt &&"
        " grep -q -- '--stage none' bare.txt && grep -q -- '--stage none' again.txt && for k in staged bare; do"
        " eval \"\\\"$0\\\" $(sed \"s/^weft//; s/picture.png/$k-command.png/\" $k.txt) --occlusion 0\""
        " || exit 9; done");
    if (ran.code != 0) fail_msg("%d %s", ran.code, ran.err);
    ran_free(&ran);
    assert_true(pictures_most("staged.png", "staged-command.png") < 2.5 / 255.0);
    assert_true(pictures_most("bare.png", "bare-command.png") < 2.5 / 255.0);
}

/* A draft that is typed or dropped weaves the material; the saved scene and the copied command draw the same cloth. */
static void a_material_is_woven_of_a_draft(void **state) {
    (void)state;
    need_gl();
    static const char wif[] = "[WIF]\nVersion=1.1\n[CONTENTS]\nTHREADING=1\nTREADLING=1\nTIEUP=1\nWEAVING=1\nWARP=1\n"
                              "WEFT=1\n[WEAVING]\nShafts=2\nTreadles=2\n[WARP]\nThreads=2\n[WEFT]\nThreads=2\n"
                              "[THREADING]\n1=1\n2=2\n[TREADLING]\n1=1\n2=2\n[TIEUP]\n1=1\n2=2\n";
    file_make("own.wif", wif, sizeof wif - 1);
    Ran ran = RUN("render", "builtin:ball", "--save", "ball.glb");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    script_begin();
    say("wait rest\nclick Material/Weave\nwait 3\nclick Material/draft\n"
        "type twill 3/1 z; warp 1#26375c; weft 1#d8d4c8\nwait 2\nclick \"Material/Weave it\"\nwait 5\n");
    say_rested_picture("twill.png");
    say("choose Material/relief none\nwait 5\nset Material/seed 9\nwait 5\nwait rest\nsave twill.glb\nwait message "
        "wrote twill.glb\ncommand twill.txt\n"
        "drop own.wif\nwait 5\n");
    say_rested_picture("own.png");
    say("save own.glb\nwait message wrote own.glb\ncommand own.txt\n");
    drive_through(script, LIST(UNSEEN, "ball.glb", FLAT));
    assert_true(pictures_most("twill.png", "own.png") > 0.05);
    ran = run_shell(
        "for k in twill own; do"
        " sed 's/ --engine raster//; s/ -o picture.png//; s/^weft//' $k.txt >$k.arguments;"
        " eval \"\\\"$0\\\" $(cat $k.arguments) --crop 100,150,40,30 --spp 2 -o $k-command.npy\" &&"
        " eval \"\\\"$0\\\" $(sed \"s/ ball.glb / $k.glb /; s/ --set '[^']*'//g; s/ --set [^ ]*//g\" $k.arguments)"
        " --crop 100,150,40,30 --spp 2 -o $k-saved.npy\" && cmp $k-command.npy $k-saved.npy || exit 9; done; grep "
        "relief twill.txt | grep -q none");
    if (ran.code != 0) fail_msg("%d %s", ran.code, ran.err);
    ran_free(&ran);
}

/* Hair grows by its sliders, goes with undo, and the copied command and the saved scene have the same. */
static void hair_of_the_sliders_is_copied_saved_and_undone(void **state) {
    (void)state;
    need_gl();
    box_write("box.gltf", BOX_BARE);
    script_begin();
    say_rested_picture("bare.png");
    say("click Material/Hair\nwait 3\nset Material/hair_density 1\nset Material/hair_thickness 500\n"
        "set Material/hair_length 20\nwait 5\n");
    say_rested_picture("hairy.png");
    say("save hairy.glb\nwait message wrote hairy.glb\ncommand hairy.txt\n"
        "key control+z\nwait 5\n");
    say_rested_picture("undone.png");
    drive_through(script, LIST(UNSEEN, "box.gltf", "--occlusion", "0"));
    assert_true(pictures_most("bare.png", "hairy.png") > 0.1);
    assert_true(pictures_most("bare.png", "undone.png") < 0.5 / 255.0);
    Ran ran = run_shell("grep -q -- '--set 0.hair_length=0.0' hairy.txt || exit 8;"
                        " sed 's/ --engine raster//; s/ -o picture.png//; s/^weft//' hairy.txt >arguments;"
                        " eval \"\\\"$0\\\" $(cat arguments) --crop 100,150,40,30 --spp 2 -o command.npy\" &&"
                        " eval \"\\\"$0\\\" $(sed \"s/ box.gltf / hairy.glb /; s/ --set [^ ]*//g\" arguments)"
                        " --crop 100,150,40,30 --spp 2 -o saved.npy\" && cmp command.npy saved.npy");
    if (ran.code != 0) fail_msg("%d %s", ran.code, ran.err);
    ran_free(&ran);
}

/* A path-traced picture of another size than the window's is made in the background, with the bytes of `weft render`; at the
 * end of the window an unfinished one leaves no file. */
static void picture_of_any_size_is_path_traced_in_the_background(void **state) {
    (void)state;
    need_gl();
    Ran ran = RUN("render", "builtin:ball", "--save", "ball.glb");
    assert_int_equal(ran.code, 0);
    ran_free(&ran);
    for (int finished = 1; finished >= 0; finished--) {
        script_begin();
        say("wait rest\nset Material/roughness 0.7\nwait rest\nkey f12\nwait 3\nclick \"Save a picture/path traced\"\n"
            "set \"Save a picture/width\" %d\nset \"Save a picture/height\" 60\nset \"Save a picture/samples\" %d\n"
            "wait 2\nclick \"Save a picture/Save\"\n",
            finished ? 90 : 4000, finished ? 8 : 4000);
        if (finished) say("wait message wrote ball-weft.png\nsave changed.glb\nwait message wrote changed.glb\n");
        drive_through(script, LIST(UNSEEN, "ball.glb", FLAT));
        if (!finished) break;
        ran = run_shell("\"$0\" render changed.glb --env 1,1,1 --width 90 --height 60 --spp 8 -o again.png && "
                        "cmp again.png ball-weft.png && rm ball-weft.png");
        if (ran.code != 0) fail_msg("%s%s", ran.out, ran.err);
        ran_free(&ran);
    }
    assert_int_equal(access("ball-weft.png", F_OK), -1);
}

/* A click turns a crossing over, a number changes a yarn: either is a cloth of its own, and undo brings the one before. */
/* The share of even light that a preset reflects: 2 times the integral of E mu over mu, of the woven cloth. */
static void furnace_of(const char *preset, bool woven, double share[3]) {
    enum { STEPS = 40 };
    WeftMaterial material;
    WeftCloth *cloth;
    WeftReflection *reflection;
    WeftError error;
    if (weft_material_read_woven(preset, &material, &cloth, NULL, &error) != WEFT_OK) fail_msg("%s", error.text);
    assert_int_equal(weft_reflection_create_woven(&material, woven ? cloth : NULL, &reflection, &error), WEFT_OK);
    for (int c = 0; c < 3; c++) share[c] = 0.0;
    for (int k = 0; k < STEPS; k++) {
        const float mu = ((float)k + 0.5f) / STEPS;
        float albedo[3];
        weft_reflection_albedo(reflection, WEFT_PART_ALL, mu, albedo);
        for (int c = 0; c < 3; c++) share[c] += 2.0 * (double)(albedo[c] * mu) / STEPS;
    }
    weft_reflection_free(reflection);
    weft_cloth_free(cloth);
}

static void inspect_plots_the_cloth_of_a_woven_material(void **state) {
    (void)state;
    need_gl();
    script_begin();
    say("wait rest\nchoose Material/preset woven-tartan\nwait rest\nclick Panel/Inspect\nwait seconds 2\nwait rest\n");
    say("window inspect.png\nstay\n");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    json_t *now = drive_rest(&drive);
    for (double start = clock_now(); !json_object_get(now, "furnace") && clock_now() - start < 60.0;) {
        json_decref(now);
        now = drive_rest(&drive);
    }
    double cloth[3], grey[3], far = 0.0;
    furnace_of("preset:woven-tartan", true, cloth);
    furnace_of("preset:woven-tartan", false, grey);
    for (int c = 0; c < 3; c++) {
        const double share = json_number_value(json_array_get(json_object_get(now, "furnace"), (size_t)c));
        if (fabs(share - cloth[c]) > 0.02 * cloth[c])
            fail_msg("%d: %g is not %g (grey: %g)", c, share, cloth[c], grey[c]);
        far = fmax(far, fabs(grey[c] - cloth[c]) / cloth[c]);
    }
    assert_true(far > 0.5); /* the base alone is another material */
    json_decref(now);
    kill(drive.child, SIGKILL);
    Ran ran = program_end(drive.child);
    ran_free(&ran);
}

/* A denoised picture with layers has the bytes of the same command. */
static void denoised_picture_with_layers_is_that_of_its_command(void **state) {
    (void)state;
    need_gl();
    Ran ran = RUN("render", "builtin:ball", "--preset", "woven-denim", "--save", "denim.glb");
    if (ran.code != 0) fail_msg("%s", ran.err);
    ran_free(&ran);
    script_begin();
    say("wait rest\nkey f12\nwait 3\nclick \"Save a picture/path traced\"\nset \"Save a picture/width\" 90\n"
        "set \"Save a picture/height\" 60\nset \"Save a picture/samples\" 4\nclick \"Save a picture/denoised\"\n"
        "click \"Save a picture/layers\"\nclick \"Save a picture/file\"\ntype layers.exr\nwait 2\n"
        "click \"Save a picture/Save\"\nwait message wrote layers.exr\nsave denim2.glb\nwait message wrote "
        "denim2.glb\n");
    drive_through(script, LIST(UNSEEN, "denim.glb", FLAT));
    ran = run_shell(
        "\"$0\" render denim2.glb --env 1,1,1 --width 90 --height 60 --spp 4 --denoise -o again.exr --aov albedo,"
        "normal,depth,samples,position,uv,object,material,diffuse,specular,sheen,coat,dust,other && "
        "cmp again.exr layers.exr && grep -aq CryptoMaterial00 layers.exr");
    if (ran.code != 0) fail_msg("%s%s", ran.out, ran.err);
    ran_free(&ran);
}

/* A turntable with a floor, stopped at a noise level, denoised and of a colour behind has the bytes of `weft render
 * --turntable`; one that is cancelled keeps what was written. */
static void a_turntable_is_path_traced_in_the_background(void **state) {
    (void)state;
    need_gl();
    box_write("box.gltf", BOX_BARE);
    file_make("kept-002.png", "mine", 4);
    script_begin();
    say("wait rest\ncommand turn.txt\nkey f12\nwait 3\nclick \"Save a picture/path traced\"\n"
        "set \"Save a picture/width\" 60\nset \"Save a picture/height\" 40\nset \"Save a picture/samples\" 64\n"
        "click \"Save a picture/stop at a noise level\"\nset \"Save a picture/noise level\" 0.01\n"
        "click \"Save a picture/denoised\"\nset \"Save a picture/turntable\" 3\nwait 2\nwindow dialog.png\n"
        "click \"Save a picture/Save\"\nwait message wrote box-weft.png, 3 of 3 pictures\n"
        "key f12\nwait 3\nclick \"Save a picture/path traced\"\nclick \"Save a picture/file\"\nkey control+a\ntype "
        "kept.png\nset \"Save a picture/turntable\" 3\nwait 2\nclick \"Save a picture/Save\"\nwait 3\n" /* asks */
        "click \"Save a picture/file\"\nkey control+a\ntype long.png\n"
        "set \"Save a picture/samples\" 3000\nclick \"Save a picture/stop at a noise level\"\n"
        "set \"Save a picture/turntable\" 100\nwait 2\nclick \"Save a picture/Save\"\nwait seconds 4\n"
        "click Menu/File\nclick \"Menu/File/Cancel the path-traced pictures\"\nwait message cancelled: \n");
    drive_through(script, LIST(UNSEEN, "box.gltf", "--occlusion", "0", "--background", "0.2,0.3,0.4", "--floor"));
    Ran ran = run_shell(
        "eval \"\\\"$0\\\" $(sed 's/^weft//; s/--engine raster//; s/picture.png/again.png/; s/--width [0-9]*//;"
        " s/--height [0-9]*//' turn.txt) --width 60 --height 40 --spp 64 --noise 0.01 --denoise --turntable 3\" &&"
        " for k in 0 1 2; do cmp box-weft-00$k.png again-00$k.png || exit 9; done && ! cmp box-weft-000.png "
        "box-weft-001.png && [ \"$(cat kept-002.png)\" = mine ] && ! ls kept-000.png && ! ls long-099.png && ! ls "
        "long.png");
    if (ran.code != 0) fail_msg("%d %s%s", ran.code, ran.out, ran.err);
    ran_free(&ran);
}

/* A still picture is taken with or without a floor, whatever the window shows. */
static void a_picture_has_the_floor_that_is_chosen(void **state) {
    (void)state;
    need_gl();
    box_write("box.gltf", BOX_BARE);
    for (int traced = 0; traced < 2; traced++) {
        const char *const path = traced ? "traced.png" : "drawn.png";
        script_begin();
        say("wait rest\nkey f12\nwait 3\n%sset \"Save a picture/width\" 60\nset \"Save a picture/height\" 40\n"
            "click \"Save a picture/floor\"\nclick \"Save a picture/transparent\"\nset \"Save a picture/samples\" 8\n"
            "click \"Save a picture/file\"\nkey control+a\ntype %s\nwait 2\n"
            "click \"Save a picture/Save\"\nwait message wrote %s\nwait rest\n",
            traced ? "click \"Save a picture/path traced\"\n" : "", path, path);
        if (!traced) /* samples are for the path tracer alone */
            *strstr(script, "set \"Save a picture/samples\"") = '#';
        drive_through(script, LIST(UNSEEN, "box.gltf", "--occlusion", "0"));
        WeftImage image = picture_read(path);
        int shadow = 0, solid = 0;
        for (int k = 0; k < 60 * 40; k++) {
            const unsigned char alpha = ((const unsigned char *)image.pixels)[4 * k + 3];
            shadow += k / 60 > 36 && alpha > 0;
            solid += alpha == 255;
        }
        assert_int_equal(image.channels, 4);
        assert_true(shadow < 30 && solid > 600);
        weft_image_free(&image);
    }
}

static void a_weave_is_changed_by_clicks_and_numbers(void **state) {
    (void)state;
    need_gl();
    script_begin();
    say("wait rest\nchoose Material/preset woven-charmeuse\nwait 5\n");
    say_rested_picture("satin.png");
    say("click \"Material/crossing 2 1\"\nwait 5\n");
    say_rested_picture("clicked.png");
    say("click \"Material/yarn of warp\"\nwait 3\nset \"Material/warp alpha\" 0.9\nwait 5\n");
    say_rested_picture("matt.png");
    say("key control+z\nwait 5\n");
    say_rested_picture("undone.png");
    say("key control+z\nwait 5\n");
    say_rested_picture("first.png");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    static const char *const pictures[] = {"satin.png", "clicked.png", "matt.png", "undone.png", "first.png"};
    static const int cloths[] = {1, 2, 3, 2, 1};
    for (int k = 0; k < 5; k++) {
        json_t *now = drive_picture(&drive, pictures[k]);
        assert_int_equal(number_of(material_of(now, 0), "cloth"), cloths[k]);
        json_decref(now);
    }
    drive_finish(&drive);
    assert_true(pictures_most("clicked.png", "matt.png") > 0.02);
    assert_true(pictures_most("satin.png", "clicked.png") > 1.0 / 255.0);
    assert_true(pictures_most("undone.png", "clicked.png") < 0.5 / 255.0);
    assert_true(pictures_most("first.png", "satin.png") < 0.5 / 255.0);
}

static void a_scene_that_is_read_again_keeps_its_folder(void **state) {
    (void)state;
    need_gl();
    write_quads();
    assert_int_equal(mkdir("folder", 0700), 0);
    write_map("folder/cloth_basecolor.png", 250);
    script_begin();
    say("wait rest\nmove 0.5 0.2\npress left\nrelease left\nwait rest\n");
    say("drop folder\nwait message 1 maps of folder\nwait rest\nset Material/roughness 0.25\nwait rest\n");
    say_rested_picture("worn.png");
    say("wait message maps of folder\nwait 5\n");
    say_rested_picture("again.png");
    Drive drive = drive_start(script, LIST(UNSEEN, "quads.gltf", FLAT));
    json_t *now = drive_picture(&drive, "worn.png");
    int material = (int)number_of(now, "material");
    assert_true(input_of(now, 1, "base_color", 3) > 0.0); /* the cloth is what has a sheen */
    json_decref(now);
    sleep_seconds(0.1);
    file_make("quads.gltf", quads, sizeof quads - 1);
    now = drive_picture(&drive, "again.png");
    assert_true(input_of(now, 1, "base_color", 3) > 0.0);
    assert_true(fabs(input_of(now, material, "roughness", 0) - 0.25) < 1e-6);
    json_decref(now);
    drive_finish(&drive);
    assert_true(pictures_most("worn.png", "again.png") < 0.5 / 255.0);
    unlink("folder/cloth_basecolor.png");
    rmdir("folder");
}

static void every_number_takes_a_map_and_shows_it(void **state) {
    (void)state;
    need_gl();
    write_map("fine.png", 128);
    script_begin();
    say("wait rest\nclick \"Material/roughness choose\"\nwait 3\nclick \"Choose a map/path\"\nkey "
        "control+a\ntype fine.png\nkey enter\nwait 3\n");
    say_rested_picture("mapped.png");
    say("click \"Material/roughness map\"\nwait 3\n");
    say_rested_picture("plain.png");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    json_t *now = drive_picture(&drive, "mapped.png");
    assert_true(input_of(now, 0, "roughness", 3) > 0.0);
    assert_non_null(json_object_get(json_object_get(now, "controls"), "Material/roughness thumb"));
    assert_non_null(strstr(word_of(now, "command"), "--texture 0.roughness=fine.png"));
    assert_string_equal(word_of(now, "unsaid"), "");
    json_decref(now);
    now = drive_picture(&drive, "plain.png");
    assert_int_equal(input_of(now, 0, "roughness", 3), 0);
    assert_null(json_object_get(json_object_get(now, "controls"), "Material/roughness thumb"));
    json_decref(now);
    drive_finish(&drive);
}

static void swatch_sets_the_values_of_the_chart(void **state) {
    (void)state;
    need_gl();
    script_begin();
    say("wait rest\nclick \"Material/known base_color\"\nwait 3\nclick \"Material/colour gold\"\nwait "
        "rest\n");
    say_rested_picture("gold.png");
    say("click \"Material/colour brick\"\nwait 3\nclick \"Material/known ior\"\nwait 3\nclick \"Material/F0 "
        "water\"\nwait rest\n");
    say_rested_picture("brick.png");
    say("click \"Material/Models\"\nwait 3\nchoose Material/workflow specular\nwait 3\nclick "
        "\"Material/colour "
        "gold\"\nwait rest\n");
    say_rested_picture("specular.png");
    Drive drive = drive_start(script, LIST(UNSEEN, CHEAP));
    json_t *now = drive_picture(&drive, "gold.png");
    assert_true(fabs(input_of(now, 0, "base_color", 1) - 0.782) < 1e-6);
    assert_true(fabs(input_of(now, 0, "metallic", 0) - 1.0) < 1e-6);
    json_decref(now);
    now = drive_picture(&drive, "brick.png");
    assert_true(fabs(input_of(now, 0, "base_color", 0) - 0.262) < 1e-6);
    assert_true(fabs(input_of(now, 0, "metallic", 0)) < 1e-6);
    assert_true(fabs(input_of(now, 0, "ior", 0) - 1.333) < 1e-6);
    json_decref(now);
    now = drive_picture(&drive, "specular.png");
    assert_true(fabs(input_of(now, 0, "base_color", 0)) < 1e-6);
    assert_true(fabs(input_of(now, 0, "specular_color", 2) - 0.344) < 1e-6);
    json_decref(now);
    drive_finish(&drive);
}

static void a_finding_of_the_doctor_chooses_its_material(void **state) {
    (void)state;
    need_gl();
    write_quads();
    script_begin();
    say("wait rest\nkey m\nclick Panel/Doctor\nwait rest\nwait 3\nwindow doctor.png\nwait 3\n");
    say_rested_picture("open.png");
    say("open builtin:cloth\nwait message triangles\nwait rest\n");
    Drive drive = drive_start(script, LIST(UNSEEN, "quads.gltf", FLAT));
    json_t *now = drive_picture(&drive, "open.png");
    assert_non_null(json_object_get(json_object_get(now, "controls"), "Doctor/finding 0"));
    json_decref(now);
    drive_finish(&drive);
    script_begin();
    say("wait rest\nclick Panel/Doctor\nwait rest\nclick \"Doctor/finding 0\"\nwait message Spare\nwait "
        "rest\nclick \"Doctor/finding 1\"\nwait message Small\nwait "
        "rest\n");
    drive_through(script, LIST(UNSEEN, "quads.gltf", FLAT));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(undo_restores_a_variant),
                                       cmocka_unit_test(hair_of_the_sliders_is_copied_saved_and_undone),
                                       cmocka_unit_test(a_bare_asset_stands_on_a_stage),
                                       cmocka_unit_test(the_menu_of_presets_follows_undo),
                                       cmocka_unit_test(a_material_is_woven_of_a_draft),
                                       cmocka_unit_test(denoised_picture_with_layers_is_that_of_its_command),
                                       cmocka_unit_test(picture_of_any_size_is_path_traced_in_the_background),
                                       cmocka_unit_test(a_turntable_is_path_traced_in_the_background),
                                       cmocka_unit_test(a_picture_has_the_floor_that_is_chosen),
                                       cmocka_unit_test(inspect_plots_the_cloth_of_a_woven_material),
                                       cmocka_unit_test(a_weave_is_changed_by_clicks_and_numbers),
                                       cmocka_unit_test(a_scene_that_is_read_again_keeps_its_folder),
                                       cmocka_unit_test(every_number_takes_a_map_and_shows_it),
                                       cmocka_unit_test(swatch_sets_the_values_of_the_chart),
                                       cmocka_unit_test(a_finding_of_the_doctor_chooses_its_material)};
    return cmocka_run_group_tests(tests, drive_begin, drive_end);
}

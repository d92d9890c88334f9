/* convert.c - `weft convert`: a picture in another format, or a U3M as folder or archive */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/path.h"
#include "cli/console/output.h"
#include "cli/console/report.h"
#include "cli/files/save.h"
#include "cli/verbs/verbs.h"
#include "weft/weft.h"

typedef struct Convert {
    const Options *options;
    const char *path, *output;
    bool data, quiet;
    double exposure;
    WeftImage image, shown; /* shown: in the pixels that the output takes */
} Convert;

static int convert_read(Convert *convert) {
    const Options *options = convert->options;
    WeftError error;
    const WeftLog log = {.fn = report_warning};
    convert->path = options->operands[0];
    convert->output = option_text(options, "-o");
    convert->data = option_given(options, "--data");
    convert->quiet = option_given(options, "--quiet");
    if (!option_number(options, "--exposure", &convert->exposure)) return WEFT_USAGE;
    if (!convert->output) return report(WEFT_USAGE, "convert: needs -o OUT, a .ktx2, .png, .exr, .hdr or .npy file");
    if (!weft_image_suffix_known(convert->output))
        return report(WEFT_USAGE, "%s: %s", convert->output, weft_message_text(WEFT_MESSAGE_OUTPUT_SUFFIX));
    const int probed = output_probe_other(options, convert->output);
    if (probed != 0) return probed;
    return weft_image_read(convert->path, &convert->image, &log, &error) == WEFT_OK ? 0 : report_error(&error);
}

/* Makes bytes of floats: as a display shows light, or of data a share of 255. */
static WeftResult bytes_of_floats(const Convert *convert, WeftImage *out, WeftError *error) {
    const WeftImage *in = &convert->image;
    const WeftTone tone = {.curve = WEFT_TONEMAP_NONE, .exposure = (float)convert->exposure};
    if (!convert->data && in->channels >= 3) return weft_image_show(in, &tone, NULL, out, error);
    WeftResult result = weft_image_create(in->width, in->height, in->channels, WEFT_PIXEL_U8, out, error);
    const size_t count = (size_t)in->width * (size_t)in->height * (size_t)in->channels;
    const float *from = in->pixels;
    unsigned char *to = out->pixels;
    for (size_t k = 0; k < count && result == WEFT_OK; k++)
        to[k] = (unsigned char)(fminf(fmaxf(from[k], 0.0f), 1.0f) * 255.0f + 0.5f);
    return result;
}

/* Fills `shown` where the output takes other pixels than the picture has. */
static WeftResult pixels_convert(Convert *convert, WeftError *error) {
    const bool floats = convert->image.type == WEFT_PIXEL_F32, wanted = weft_image_suffix_linear(convert->output);
    if (floats == wanted) return WEFT_OK;
    return wanted ? weft_image_convert_f32(&convert->image, !convert->data, &convert->shown, error)
                  : bytes_of_floats(convert, &convert->shown, error);
}

/* Tells what a .ktx2 lacks for glTF, and how near its blocks are to the picture. */
static WeftResult written_say(const Convert *convert, const WeftImage *written, WeftError *error) {
    if (!path_ends(convert->output, ".ktx2")) {
        report(0, "wrote %s: %d x %d", convert->output, written->width, written->height);
        return WEFT_OK;
    }
    WeftImage back, a = {0}, b = {0};
    WeftResult result = weft_image_read(convert->output, &back, NULL, error);
    if (result == WEFT_OK) result = weft_image_convert_f32(written, 0, &a, error);
    if (result == WEFT_OK) result = weft_image_convert_f32(&back, 0, &b, error);
    if (result == WEFT_OK) {
        const size_t texels = (size_t)a.width * (size_t)a.height, from = (size_t)a.channels, to = (size_t)b.channels;
        double sum = 0.0;
        for (size_t n = 0; n < texels; n++)
            for (size_t c = 0; c < to; c++) {
                const size_t k = c == 3 ? from - 1 : from < 3 ? 0 : c; /* grey became colours */
                const double d = (double)((float *)a.pixels)[n * from + k] - (double)((float *)b.pixels)[n * to + c];
                sum += d * d;
            }
        report(0, "wrote %s: %d x %d, UASTC, %.1f dB%s", convert->output, a.width, a.height,
               sum > 0.0 ? fmin(10.0 * log10((double)texels * (double)to / sum), 99.9) : 99.9,
               a.width % 4 || a.height % 4 ? "; sides that are no multiples of 4 are not for glTF" : "");
    }
    weft_image_free(&back);
    weft_image_free(&a);
    weft_image_free(&b);
    return result;
}

/* Packs a .u3m into a .u3ma, or unpacks one: what it has stays byte for byte. */
static int material_convert(const Options *options) {
    const char *path = options->operands[0], *output = option_text(options, "-o");
    const WeftLog log = {.fn = option_given(options, "--quiet") ? NULL : report_warning};
    WeftScene *scene = NULL;
    WeftError error;
    if (!path_is_u3m(path))
        return report(WEFT_USAGE, "%s: is no U3M: weft render %s --save %s writes the material of a scene as one", path,
                      path, output);
    if (!output || !path_is_u3m(output))
        return report(WEFT_USAGE, "%s: a U3M becomes a .u3m or a .u3ma: -o OUT.u3ma", output ? output : path);
    if (option_given(options, "--data") || option_given(options, "--exposure"))
        return report(WEFT_USAGE, "%s: --data and --exposure go with a picture, not with a U3M", path);
    const int probed = output_probe_other(options, output);
    if (probed != 0) return probed;
    WeftResult result = weft_scene_load(path, &scene, &log, &error);
    if (result == WEFT_OK) result = weft_scene_save_u3m(scene, save_cloth_of(scene), output, NULL, &log, &error);
    weft_scene_free(scene);
    if (result != WEFT_OK) return report_error(&error);
    if (!option_given(options, "--quiet")) report(0, "wrote %s", output);
    return 0;
}

static int convert_run(const Options *options) {
    Convert convert = {.options = options};
    const char *output = option_text(options, "-o");
    if (path_is_u3m(options->operands[0]) || (output && path_is_u3m(output))) return material_convert(options);
    WeftError error = {0};
    int checked = convert_read(&convert);
    if (checked == 0) {
        const WeftImageWriting how = {.data = convert.data};
        WeftResult result = pixels_convert(&convert, &error);
        const WeftImage *written = convert.shown.pixels ? &convert.shown : &convert.image;
        if (result == WEFT_OK) result = weft_image_write_as(convert.output, written, &how, &error);
        if (result == WEFT_OK && !convert.quiet) result = written_say(&convert, written, &error);
        if (result != WEFT_OK) checked = report_error(&error);
    }
    weft_image_free(&convert.image);
    weft_image_free(&convert.shown);
    return checked;
}

static const Option convert_options[] = {
    OPTION_TEXT(
        "-o", "OUT", NULL,
        "write the picture: .ktx2 as UASTC with all mip levels, .png; .exr, .hdr and .npy as linear light; or the U3M: "
        "a .u3m with its pictures beside it, or a .u3ma"),
    OPTION_SWITCH("--data", "numbers and no colours, such as normals or roughness: no sRGB curve, and marked so"),
    OPTION_NUMBER("--exposure", "STOPS", "0", -64, 64, "multiply the light of floats by 2^STOPS for .png and .ktx2"),
    OPTION_SWITCH("--quiet", "no summary"),
    OPTION_END,
};

const Verb verb_convert = {
    .name = "convert",
    .operands = "PICTURE -o OUT",
    .help = "converts a picture, such as to KTX 2, and packs a U3M",
    .operands_least = 1,
    .operands_most = 1,
    .options = convert_options,
    .notes = "PICTURE is of any format that weft reads. A .ktx2 is what glTF's\n"
             "KHR_texture_basisu takes: blocks of UASTC in Zstandard, with all mip levels,\n"
             "which viewers turn into blocks of their GPU. The summary has the ratio of peak\n"
             "to noise of the blocks. A .u3m is packed with its pictures into a .u3ma, or a\n"
             ".u3ma unpacked, and every byte of it stays.\n\n"
             "Examples\n"
             "  weft convert color.png -o color.ktx2\n"
             "  weft convert normal.png --data -o normal.ktx2\n"
             "  weft convert studio.hdr --exposure -1 -o studio.png\n"
             "  weft convert cloth.u3m -o cloth.u3ma\n",
    .run = convert_run,
};

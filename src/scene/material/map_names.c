/* map_names.c - the words of painting programs, engines and libraries of textures for the inputs of a material */
#include "scene/material/map_names.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "scene/record/material.h"

enum { NOTHING = INPUT_COUNT, WORDS_MOST = 32, NAME_MOST = 256 };

/* A word, without separators and in small letters. A word of several inputs has a row for each; NOTHING is what no
 * input takes, which keeps its last word from being taken for another. */
typedef struct MapWord {
    const char *word;
    int input, channel;
    bool inverted;
} MapWord;

static const MapWord map_words[] = {
    {"albedo", INPUT_base_color, 0, false},
    {"alb", INPUT_base_color, 0, false},
    {"diffuse", INPUT_base_color, 0, false},
    {"diffusecolor", INPUT_base_color, 0, false},
    {"diff", INPUT_base_color, 0, false},
    {"dif", INPUT_base_color, 0, false},
    {"d", INPUT_base_color, 0, false},
    {"color", INPUT_base_color, 0, false},
    {"colour", INPUT_base_color, 0, false},
    {"col", INPUT_base_color, 0, false},
    {"basecolour", INPUT_base_color, 0, false},
    {"basecol", INPUT_base_color, 0, false},
    {"base", INPUT_base_color, 0, false},
    {"bc", INPUT_base_color, 0, false},
    {"b", INPUT_base_color, 0, false},
    {"main", INPUT_base_color, 0, false},
    {"albedotransparency", INPUT_base_color, 0, false},
    {"albedotransparency", INPUT_opacity, 3, false},
    {"albedoopacity", INPUT_base_color, 0, false},
    {"albedoopacity", INPUT_opacity, 3, false},
    {"alphamasked", INPUT_base_color, 0, false},
    {"alphamasked", INPUT_opacity, 3, false},
    {"bo", INPUT_base_color, 0, false},
    {"bo", INPUT_opacity, 3, false},
    {"metalness", INPUT_metallic, 0, false},
    {"metal", INPUT_metallic, 0, false},
    {"met", INPUT_metallic, 0, false},
    {"mtl", INPUT_metallic, 0, false},
    {"m", INPUT_metallic, 0, false},
    {"rough", INPUT_roughness, 0, false},
    {"rgh", INPUT_roughness, 0, false},
    {"r", INPUT_roughness, 0, false},
    {"glossiness", INPUT_roughness, 0, true},
    {"gloss", INPUT_roughness, 0, true},
    {"gls", INPUT_roughness, 0, true},
    {"smoothness", INPUT_roughness, 0, true},
    {"normals", INPUT_normal, 0, false},
    {"nor", INPUT_normal, 0, false},
    {"norm", INPUT_normal, 0, false},
    {"nrm", INPUT_normal, 0, false},
    {"nrml", INPUT_normal, 0, false},
    {"nml", INPUT_normal, 0, false},
    {"n", INPUT_normal, 0, false},
    {"ao", INPUT_occlusion, 0, false},
    {"ambientocclusion", INPUT_occlusion, 0, false},
    {"occ", INPUT_occlusion, 0, false},
    {"emissive", INPUT_emission, 0, false},
    {"emissivecolor", INPUT_emission, 0, false},
    {"emissioncolor", INPUT_emission, 0, false},
    {"emit", INPUT_emission, 0, false},
    {"e", INPUT_emission, 0, false},
    {"alpha", INPUT_opacity, 0, false},
    {"specular", INPUT_specular_color, 0, false},
    {"spec", INPUT_specular_color, 0, false},
    {"spc", INPUT_specular_color, 0, false},
    {"reflection", INPUT_specular_color, 0, false},
    {"reflect", INPUT_specular_color, 0, false},
    {"refl", INPUT_specular_color, 0, false},
    {"s", INPUT_specular_color, 0, false},
    {"specularsmoothness", INPUT_specular_color, 0, false},
    {"specularsmoothness", INPUT_roughness, 3, true},
    {"specgloss", INPUT_specular_color, 0, false},
    {"specgloss", INPUT_roughness, 3, true},
    {"speculargloss", INPUT_specular_color, 0, false},
    {"speculargloss", INPUT_roughness, 3, true},
    {"specularglossiness", INPUT_specular_color, 0, false},
    {"specularglossiness", INPUT_roughness, 3, true},
    {"metallicroughness", INPUT_roughness, 1, false}, /* as in glTF */
    {"metallicroughness", INPUT_metallic, 2, false},
    {"metalroughness", INPUT_roughness, 1, false},
    {"metalroughness", INPUT_metallic, 2, false},
    {"metalnessroughness", INPUT_roughness, 1, false},
    {"metalnessroughness", INPUT_metallic, 2, false},
    {"metalrough", INPUT_roughness, 1, false},
    {"metalrough", INPUT_metallic, 2, false},
    {"metallicsmoothness", INPUT_metallic, 0, false}, /* as in Unity */
    {"metallicsmoothness", INPUT_roughness, 3, true},
    {"metallicgloss", INPUT_metallic, 0, false},
    {"metallicgloss", INPUT_roughness, 3, true},
    {"ord", INPUT_occlusion, 0, false}, /* the third is displacement */
    {"ord", INPUT_roughness, 1, false},
    {"ordp", INPUT_occlusion, 0, false},
    {"ordp", INPUT_roughness, 1, false},
    {"maskmap", INPUT_metallic, 0, false},
    {"maskmap", INPUT_occlusion, 1, false},
    {"maskmap", INPUT_roughness, 3, true},
    {"anisotropic", INPUT_anisotropy, 0, false},
    {"sheen", INPUT_sheen_color, 0, false},
    {"sheenopacity", INPUT_sheen, 0, false},
    {"coatopacity", INPUT_clearcoat, 0, false},
    {"coatroughness", INPUT_clearcoat_roughness, 0, false},
    {"coatnormal", INPUT_clearcoat_normal, 0, false},
    {"fuzz", INPUT_sheen_color, 0, false}, /* as in OpenPBR */
    {"fuzzcolor", INPUT_sheen_color, 0, false},
    {"fuzzcolour", INPUT_sheen_color, 0, false},
    {"fuzzweight", INPUT_sheen, 0, false},
    {"fuzzroughness", INPUT_sheen_roughness, 0, false},
    {"nap", INPUT_nap_direction, 0, false},
    {"nap", INPUT_nap, 2, false},
    {"roughnessmetalness", NOTHING, 0, false},
    {"roughnessmetal", NOTHING, 0, false},
    {"roughnessmetallic", NOTHING, 0, false}, /* red and green, or as in glTF: the name does not tell */
    {"diffuseroughness", NOTHING, 0, false},
    {"backcolor", NOTHING, 0, false}, /* of the back of a cloth */
    {"backcolour", NOTHING, 0, false},
    {"backdiffuse", NOTHING, 0, false},
    {"backalbedo", NOTHING, 0, false},
    {"backroughness", NOTHING, 0, false},
    {"backnormal", NOTHING, 0, false},
    {"coatcolor", NOTHING, 0, false},
    {"coatnormals", NOTHING, 0, false},
    {"detailalbedo", NOTHING, 0, false},
    {"detailcolor", NOTHING, 0, false},
    {"detailnormal", NOTHING, 0, false},
    {"detailroughness", NOTHING, 0, false},
    {"idcolor", NOTHING, 0, false},
    {"materialcolor", NOTHING, 0, false},
    {"vertexcolor", NOTHING, 0, false},
    {"objectnormal", NOTHING, 0, false},
    {"objectspacenormal", NOTHING, 0, false},
    {"worldnormal", NOTHING, 0, false},
    {"worldspacenormal", NOTHING, 0, false},
    {"bentnormal", NOTHING, 0, false},
    {"bentnormals", NOTHING, 0, false},
    {"specularao", NOTHING, 0, false},
    {"specularocclusion", NOTHING, 0, false},
    {"subsurfacecolor", NOTHING, 0, false},
    {"scatteringcolor", NOTHING, 0, false},
    {"scatteringdistance", NOTHING, 0, false},
    {"transmissioncolor", NOTHING, 0, false},
    {"translucencycolor", NOTHING, 0, false},
    {"absorptioncolor", NOTHING, 0, false},
    {"edgecolor", NOTHING, 0, false},
    {"specularedgecolor", NOTHING, 0, false},
};
enum { MAP_WORDS = sizeof map_words / sizeof *map_words };

/* The parts of a picture that holds one input in each channel, as "OcclusionRoughnessMetallic" or "orm". */
static const struct MapPart {
    const char *word;
    int input;
    bool inverted;
} map_parts[] =
    {
        {"ambientocclusion", INPUT_occlusion, false},
        {"occlusion", INPUT_occlusion, false},
        {"occ", INPUT_occlusion, false},
        {"ao", INPUT_occlusion, false},
        {"roughness", INPUT_roughness, false},
        {"rough", INPUT_roughness, false},
        {"smoothness", INPUT_roughness, true},
        {"glossiness", INPUT_roughness, true},
        {"gloss", INPUT_roughness, true},
        {"metallic", INPUT_metallic, false},
        {"metalness", INPUT_metallic, false},
        {"metal", INPUT_metallic, false},
        {"height", NOTHING, false},
        {"displacement", NOTHING, false},
        {"detail", NOTHING, false},
},
  map_letters[] = {
      {"ao", INPUT_occlusion, false}, {"a", INPUT_occlusion, false}, {"o", INPUT_occlusion, false},
      {"r", INPUT_roughness, false},  {"s", INPUT_roughness, true},  {"g", INPUT_roughness, true},
      {"m", INPUT_metallic, false},   {"d", NOTHING, false},         {"h", NOTHING, false},
};
enum { MAP_PARTS = sizeof map_parts / sizeof *map_parts, MAP_LETTERS = sizeof map_letters / sizeof *map_letters };

/* The words of a name, in small letters and without what lies between them. */
typedef struct NameWords {
    char text[NAME_MOST];
    int count;
    int start[WORDS_MOST];
    bool glued[WORDS_MOST]; /* a capital letter alone divides it from the word before */
} NameWords;

static bool is_separator(char c) { return strchr("_-. ()[]", c) != NULL; }

/* Returns true if the character at `at`, after two others of a word, is a capital letter that begins the next one. */
static bool begins_word(const char *at) {
    const unsigned char before = (unsigned char)at[-1], here = (unsigned char)at[0], after = (unsigned char)at[1];
    return isupper(here) && (islower(before) || (isdigit(before) && islower(after)));
}

/* Returns true if text is one of the words that a blank separates in a list. */
static bool is_listed(const char *list, const char *text) {
    const size_t length = strlen(text);
    for (const char *at = list; (at = strstr(at, text)) != NULL; at++)
        if ((at == list || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) return true;
    return false;
}

/* Returns true for a size, a number, a format or a level of detail: "2k", "4096", "jpg", "16bit", "lod0", "var2". */
static bool is_passed_over(const char *word) {
    static const char formats[] = "jpg jpeg png tif tiff exr tga hdr bmp bit bits srgb raw linear lin utility texture "
                                  "tex seamless tileable tiling lod udim px cm pbr rec709 acescg aces";
    static const char before[] = "lod var variant variation version v u x", after[] = "k px bit bits b cm";
    char head[NAME_MOST], tail[NAME_MOST];
    const size_t letters = strcspn(word, "0123456789"), digits = strspn(word + letters, "0123456789");
    if (is_listed(formats, word)) return true;
    if (!digits) return false;
    memcpy(head, word, letters);
    head[letters] = '\0';
    snprintf(tail, sizeof tail, "%s", word + letters + digits);
    if (tail[0] == 'x' && isdigit((unsigned char)tail[1])) return is_passed_over(tail + 1);
    return (!head[0] || is_listed(before, head)) && (!tail[0] || is_listed(after, tail));
}

static void forget_first(NameWords *words) {
    words->count--;
    memmove(words->start, words->start + 1, (size_t)words->count * sizeof *words->start);
    memmove(words->glued, words->glued + 1, (size_t)words->count * sizeof *words->glued);
}

/* Returns true if word k, which is not the last, names a map by itself. */
static bool is_map_word(const NameWords *words, int k) {
    const size_t length = (size_t)(words->start[k + 1] - words->start[k]);
    for (int n = 0; n < MAP_WORDS; n++)
        if (strlen(map_words[n].word) == length &&
            strncmp(words->text + words->start[k], map_words[n].word, length) == 0)
            return true;
    return false;
}

/* Cuts a name, as far as its suffix, into words. Of a name of very many words the last ones are kept. */
static NameWords cut(const char *file) {
    NameWords words = {.count = 0};
    const char *dot = strrchr(file, '.'), *end = dot ? dot : file + strlen(file);
    size_t used = 0;
    int sized = 0; /* words before the last size, such as "1k" */
    for (const char *at = file; at < end;) {
        if (is_separator(*at)) {
            at++;
            continue;
        }
        char *word = words.text + used;
        const char *start = at;
        const bool glued = at > file && !is_separator(at[-1]);
        size_t length = 0;
        while (at < end && !is_separator(*at) && !(at > start + 1 && begins_word(at)) && used + length + 1 < NAME_MOST)
            word[length++] = (char)tolower((unsigned char)*at++);
        word[length] = '\0';
        if (!length) break;
        if (is_passed_over(word)) {
            sized = words.count;
            continue;
        }
        if (words.count == WORDS_MOST) forget_first(&words);
        words.glued[words.count] = glued;
        words.start[words.count++] = (int)used;
        used += length;
    }
    words.text[used] = '\0';
    /* Poliigon writes the workflow behind the size: Fabric_COL_3K_METALNESS. */
    const bool is_workflow = sized > 0 && words.count == sized + 1 && is_map_word(&words, sized - 1) &&
                             is_listed("metalness metallic specular", words.text + words.start[sized]);
    if (is_workflow) words.text[words.start[--words.count]] = '\0';
    return words;
}

static void add_use(MapName *name, int input, int channel, bool inverted) {
    if (input != NOTHING && name->count < MAP_USES)
        name->uses[name->count++] = (MapUse){(InputId)input, channel, inverted};
}

/* Returns true if the name of an input is this word, '_' left out. */
static bool is_input(InputId input, const char *word) {
    const char *name = input_infos[input].name;
    for (; *name && *word; name += *name != '\0') {
        if (*name == '_') continue;
        if (*name != *word++) return false;
    }
    return !*name && !*word;
}

/* Takes what a whole word says; returns false for an unknown one. */
static bool take_word(const char *word, MapName *name) {
    bool known = false;
    for (int k = 0; k < MAP_WORDS; k++)
        if (strcmp(map_words[k].word, word) == 0) {
            add_use(name, map_words[k].input, map_words[k].channel, map_words[k].inverted);
            known = true;
        }
    for (int k = 0; k < INPUT_COUNT && !known; k++)
        if (is_input((InputId)k, word)) {
            add_use(name, k, 0, false);
            known = true;
        }
    return known;
}

/* Takes a word for normals with a word for where green points at its end or its start. */
static bool take_normal(const char *word, MapName *name) {
    static const struct {
        const char *word;
        MapGreen green;
    } greens[] = {{"opengl", GREEN_UP},    {"ogl", GREEN_UP},  {"gl", GREEN_UP},    {"yup", GREEN_UP},
                  {"directx", GREEN_DOWN}, {"dx", GREEN_DOWN}, {"d3d", GREEN_DOWN}, {"ydown", GREEN_DOWN}};
    const size_t length = strlen(word);
    for (size_t k = 0; k < sizeof greens / sizeof *greens; k++) {
        const size_t size = strlen(greens[k].word);
        for (int front = 0; front < 2 && size < length; front++) {
            char rest[NAME_MOST];
            MapName found = {.count = 0};
            if (strncmp(word + (front ? 0 : length - size), greens[k].word, size) != 0) continue;
            memcpy(rest, word + (front ? size : 0), length - size);
            rest[length - size] = '\0';
            if (!take_word(rest, &found) || found.count != 1) continue;
            if (input_infos[found.uses[0].input].kind != WEFT_INPUT_NORMAL) continue;
            found.green = greens[k].green;
            *name = found;
            return true;
        }
    }
    return false;
}

/* Takes a word that is parts one after another, each the contents of the next channel. Returns their number, or 0 if it
 * is more than such parts, or has one twice. */
static int take_parts(const char *word, const struct MapPart *parts, int count, MapName *name) {
    MapName found = {.count = 0};
    int channel = 0;
    for (bool seen[INPUT_COUNT + 1] = {false}; *word; channel++) {
        const struct MapPart *part = NULL;
        for (int k = 0; k < count && !part; k++)
            if (strncmp(word, parts[k].word, strlen(parts[k].word)) == 0) part = &parts[k];
        if (!part || seen[part->input] || channel == MAP_USES) return 0;
        seen[part->input] = true;
        add_use(&found, part->input, channel, part->inverted);
        word += strlen(part->word);
    }
    if (found.count < (parts == map_letters ? 3 : 2)) return 0;
    *name = found;
    return channel;
}

/* Takes the words from number `first` on as one. A noun for a cloth may come before a use, as "metal" does; only words
 * that nothing but capitals divides are parts of one picture in any order. */
static bool take_from(const NameWords *words, int first, MapName *name) {
    const char *word = words->text + words->start[first];
    bool whole = true;
    for (int k = first + 1; k < words->count; k++) whole &= words->glued[k];
    const bool single = first == words->count - 1, letter = !word[1], noun = strncmp(word, "metal", 5) == 0 && !whole;
    if (noun && strncmp(word, "metallic", 8) != 0 && strncmp(word, "metalness", 9) != 0) return false;
    if ((!letter || first > 0) && take_word(word, name)) return true;
    if (take_normal(word, name)) return true;
    if (single && take_parts(word, map_letters, MAP_LETTERS, name)) return true;
    MapName parts = {.count = 0};
    if (take_parts(word, map_parts, MAP_PARTS, &parts) < (whole ? 2 : 3)) return false;
    *name = parts;
    return true;
}

/* Shortens the last word by an ending that says nothing, digits only after other words; returns false without one. */
static bool drop_ending(NameWords *words) {
    static const char *const endings[] = {"map", "maps", "tex", "texture"};
    char *text = words->text;
    const size_t length = strlen(text);
    for (size_t k = 0; k < sizeof endings / sizeof *endings; k++) {
        const size_t size = strlen(endings[k]);
        if (size >= length || strcmp(text + length - size, endings[k]) != 0) continue;
        text[length - size] = '\0';
        return true;
    }
    if (words->count < 2 || !isdigit((unsigned char)text[length - 1])) return false;
    text[length - 1] = '\0';
    return true;
}

MapName map_name(const char *file) {
    NameWords words = cut(file);
    do {
        const int length = (int)strlen(words.text);
        while (words.count && words.start[words.count - 1] >= length) words.count--;
        for (int first = 0; first < words.count; first++) {
            MapName name = {.count = 0};
            if (!take_from(&words, first, &name)) continue;
            snprintf(name.stem, sizeof name.stem, "%.*s", words.start[first], words.text);
            return name;
        }
    } while (words.count && drop_ending(&words));
    return (MapName){.count = 0};
}

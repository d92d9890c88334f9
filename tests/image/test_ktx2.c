/* KTX 2 files put together here: numbers of each format, levels, Zstandard, cubes, blocks of UASTC and ETC1S, damage.
 *
 * What the blocks decode to is what the transcoder of three.js 0.187 makes of them; script/check extra compares the two on
 * more. */
#include "image/texel_numbers.h"

#include <zlib.h>
#include <zstd.h>

#include "image/ktx2/ktx2.h"
#include "image/ktx2/uastc_etc1.h"
#include "scene/record/levels.h"

/* What a file says of itself; 0 is what a plain picture of one level has. */
typedef struct Plan {
    uint32_t format, width, height, depth, layers, faces, levels, scheme;
    int model, first, second, flags; /* of the data format descriptor: first and second are channels of samples */
    const char *orientation;
} Plan;

static void put_long(Bytes *bytes, uint64_t number, int size) {
    for (int k = 0; k < size; k++) put_byte(bytes, (int)(number >> 8 * k & 255));
}

static void put_descriptor(Bytes *bytes, const Plan *plan) {
    const int samples = plan->second ? 2 : 1, size = 4 + 24 + 16 * samples;
    put_long(bytes, (uint64_t)size, 4);
    put_long(bytes, 0, 4);
    put_long(bytes, (uint64_t)(2 | (size - 4) << 16), 4);
    put(bytes, (unsigned char[]){(unsigned char)(plan->model ? plan->model : 1), 1, 1, (unsigned char)plan->flags}, 4);
    for (int k = 0; k < 12; k++) put_byte(bytes, 0);
    for (int s = 0; s < samples; s++) {
        put_long(bytes, (uint64_t)(s ? plan->second : plan->first) << 24, 4);
        put_long(bytes, 0, 8);
        put_long(bytes, 0xffffffff, 4);
    }
}

/* Packs a level by zlib; returns its size. */
static size_t deflated(unsigned char *to, size_t most, const Bytes *level) {
    uLongf size = most;
    assert_int_equal(compress2(to, &size, level->data, level->size, 9), Z_OK);
    return size;
}

/* Returns a file of these levels, the largest first; packed by Zstandard or zlib if the plan says so. */
static Bytes file_of(const Plan *plan, const Bytes *levels) {
    static Bytes packed[4];
    const uint32_t count = plan->levels ? plan->levels : 1, key = plan->orientation ? 20 : 0;
    const uint64_t start = 80 + 24 * count, described = plan->second ? 60 : 44, keys = key ? 4 + key : 0;
    uint64_t at = start + described + keys;
    Bytes bytes = {.size = 0};
    put(&bytes, "\xabKTX 20\xbb\r\n\x1a\n", 12);
    const uint32_t words[9] = {
        plan->format, 1,           plan->width, plan->height, plan->depth, plan->layers, plan->faces ? plan->faces : 1,
        plan->levels, plan->scheme};
    for (int k = 0; k < 9; k++) put_long(&bytes, words[k], 4);
    put_long(&bytes, start, 4);
    put_long(&bytes, described, 4);
    put_long(&bytes, keys ? start + described : 0, 4);
    put_long(&bytes, keys, 4);
    put_long(&bytes, 0, 8);
    put_long(&bytes, 0, 8);
    for (uint32_t k = 0; k < count; k++) {
        packed[k] = levels[k];
        if (plan->scheme == 2)
            packed[k].size = ZSTD_compress(packed[k].data, sizeof packed[k].data, levels[k].data, levels[k].size, 1);
        if (plan->scheme == 3) packed[k].size = deflated(packed[k].data, sizeof packed[k].data, &levels[k]);
        put_long(&bytes, at, 8);
        put_long(&bytes, packed[k].size, 8);
        put_long(&bytes, levels[k].size, 8);
        at += packed[k].size;
    }
    put_descriptor(&bytes, plan);
    if (keys) {
        put_long(&bytes, 18, 4);
        put(&bytes, "KTXorientation", 15);
        put(&bytes, plan->orientation, 3);
        put_long(&bytes, 0, 2);
    }
    for (uint32_t k = 0; k < count; k++) put(&bytes, packed[k].data, packed[k].size);
    return bytes;
}

/* Returns the bytes of "0a1b...". */
static Bytes bytes_of(const char *hex) {
    Bytes bytes = {.size = 0};
    for (; hex[0]; hex += 2) {
        const char pair[3] = {hex[0], hex[1], 0};
        put_byte(&bytes, (int)strtol(pair, NULL, 16));
    }
    return bytes;
}

static void numbers_of_every_format_are_read(void **state) {
    (void)state;
    static const struct {
        uint32_t format;
        int channels, size;
        bool floats, reversed;
    } formats[] = {
        {9, 1, 1, false, false},  {15, 1, 1, false, false}, {16, 2, 1, false, false}, {22, 2, 1, false, false},
        {23, 3, 1, false, false}, {29, 3, 1, false, false}, {30, 3, 1, false, true},  {37, 4, 1, false, false},
        {43, 4, 1, false, false}, {44, 4, 1, false, true},  {50, 4, 1, false, true},  {70, 1, 2, false, false},
        {77, 2, 2, false, false}, {91, 4, 2, false, false}, {76, 1, 2, true, false},  {83, 2, 2, true, false},
        {97, 4, 2, true, false},  {100, 1, 4, true, false}, {103, 2, 4, true, false}, {106, 3, 4, true, false},
        {109, 4, 4, true, false},
    };
    for (size_t f = 0; f < sizeof formats / sizeof *formats; f++)
        for (uint32_t scheme = 0; scheme <= 3; scheme += scheme ? 1 : 2) {
            Bytes level = {.size = 0};
            const int stored = formats[f].channels, shown = stored == 2 ? 3 : stored; /* blue 0 beside red and green */
            put_numbers(&level, formats[f].size, formats[f].floats, 2 * stored);
            const Plan plan = {.format = formats[f].format, .width = 2, .height = 1, .scheme = scheme};
            const Bytes bytes = file_of(&plan, &level);
            WeftImage image = read_bytes(&bytes);
            assert_shape(&image, 2, 1, shown,
                         formats[f].floats      ? WEFT_PIXEL_F32
                         : formats[f].size == 2 ? WEFT_PIXEL_U16
                                                : WEFT_PIXEL_U8);
            for (int k = 0; k < 2 * stored; k++) {
                const int c = k % stored, from = formats[f].reversed && c < 3 ? k - c + 2 - c : k;
                assert_near((float)value_at(&image, k / stored * shown + c), (float)(from + 1) / 16.0f, 4e-3f);
            }
            if (shown > stored) assert_near((float)value_at(&image, 5), 0.0f, 0.0f);
            weft_image_free(&image);
            refuse_prefixes(&bytes);
        }
}

/* The bits by Khronos' "Data Format Specification" 1.3.1, tables 22 and 23: 1, 0.5 and 3; 65408, 1/4 and 0. */
static void packed_floats_are_read(void **state) {
    (void)state;
    Bytes level = {.size = 0};
    put_long(&level, 15u << 6 | (14u << 6) << 11 | (16u << 5 | 16u) << 22, 4);
    const Plan eleven = {.format = 122, .width = 1, .height = 1}, shared = {.format = 123, .width = 1, .height = 1};
    Bytes bytes = file_of(&eleven, &level);
    WeftImage image = read_bytes(&bytes);
    assert_shape(&image, 1, 1, 3, WEFT_PIXEL_F32);
    const float want[] = {1.0f, 0.5f, 3.0f};
    for (int c = 0; c < 3; c++) assert_near(((float *)image.pixels)[c], want[c], 0.0f);
    weft_image_free(&image);
    level.size = 0;
    put_long(&level, 511u | 256u << 9 | 0u << 18 | 16u << 27, 4);
    bytes = file_of(&shared, &level);
    image = read_bytes(&bytes);
    const float others[] = {511.0f / 256.0f, 1.0f, 0.0f};
    for (int c = 0; c < 3; c++) assert_near(((float *)image.pixels)[c], others[c], 0.0f);
    weft_image_free(&image);
}

/* The first row of a file may be the lowest, and the first texel of a row the right one. */
static void orientation_turns_the_picture(void **state) {
    (void)state;
    Bytes level = {.size = 0};
    put(&level, (unsigned char[]){1, 2, 3, 4}, 4);
    const struct {
        const char *orientation;
        unsigned char want[4];
    } cases[] = {{"rd", {1, 2, 3, 4}}, {"ru", {3, 4, 1, 2}}, {"ld", {2, 1, 4, 3}}, {"lu", {4, 3, 2, 1}}};
    for (size_t k = 0; k < 4; k++) {
        const Plan plan = {.format = 9, .width = 2, .height = 2, .orientation = cases[k].orientation};
        const Bytes bytes = file_of(&plan, &level);
        WeftImage image = read_bytes(&bytes);
        assert_memory_equal(image.pixels, cases[k].want, 4);
        weft_image_free(&image);
    }
}

/* Reads one face of a level. */
static WeftImage picture_of(const Bytes *bytes, int level, int face) {
    const ImageSource source = {.data = bytes->data, .size = bytes->size, .name = "bytes", .log = NULL};
    Ktx2 file;
    WeftError error = {0};
    WeftImage image = {0};
    if (ktx2_open(&source, &file, &error) != WEFT_OK || ktx2_picture(&file, level, face, &image, &error) != WEFT_OK)
        fail_msg("%s", error.text);
    return image;
}

static void levels_and_faces_are_found(void **state) {
    (void)state;
    Bytes levels[2] = {{.size = 0}, {.size = 0}};
    for (int k = 0; k < 24; k++) put_byte(&levels[0], k);
    for (int k = 0; k < 6; k++) put_byte(&levels[1], 100 + k);
    for (uint32_t scheme = 0; scheme <= 3; scheme += scheme ? 1 : 2) {
        const Plan plan = {.format = 9, .width = 2, .height = 2, .faces = 6, .levels = 2, .scheme = scheme};
        const Bytes bytes = file_of(&plan, levels);
        for (int face = 0; face < 6; face++) {
            WeftImage image = picture_of(&bytes, 0, face);
            for (int k = 0; k < 4; k++) assert_int_equal(((unsigned char *)image.pixels)[k], 4 * face + k);
            weft_image_free(&image);
            image = picture_of(&bytes, 1, face);
            assert_shape(&image, 1, 1, 1, WEFT_PIXEL_U8);
            assert_int_equal(((unsigned char *)image.pixels)[0], 100 + face);
            weft_image_free(&image);
        }
        WeftImage image = read_bytes_said(&bytes, "it shows the first face of its cube");
        weft_image_free(&image);
    }
    const Plan array = {.format = 9, .width = 2, .height = 2, .layers = 6};
    const Bytes bytes = file_of(&array, levels);
    WeftImage image = read_bytes_said(&bytes, "it shows the first picture of its array");
    weft_image_free(&image);
    const Plan multiplied = {.format = 9, .width = 2, .height = 2, .flags = 1};
    const Bytes other = file_of(&multiplied, levels);
    image = read_bytes_said(&other, "multiplied by alpha");
    weft_image_free(&image);
}

static void levels_said(void *user, WeftMessage message, const char *text) {
    assert_int_equal(message, WEFT_MESSAGE_IMAGE_REPAIRED);
    snprintf(user, 200, "%s", text);
}

/* The picture is read all the same, and one line tells which level is not. */
static void damaged_levels_are_told(void **state) {
    (void)state;
    Bytes levels[2] = {{.size = 0}, {.size = 0}};
    for (int k = 0; k < 4; k++) put_byte(&levels[0], k);
    put_byte(&levels[1], 100);
    for (int damaged = 0; damaged < 2; damaged++) {
        const Plan plan = {.format = 9, .width = 2, .height = 2, .levels = 2, .scheme = 2};
        Bytes bytes = file_of(&plan, levels);
        size_t magic = bytes.size - 4; /* of Zstandard, before the last level */
        while (memcmp(bytes.data + magic, "\x28\xb5\x2f\xfd", 4) != 0) magic--;
        if (damaged) bytes.data[magic] ^= 1;
        char said[200] = "";
        const WeftLog log = {levels_said, said};
        TextureLevels *own;
        WeftImage image;
        WeftError error;
        if (levels_decode(bytes.data, bytes.size, "x.ktx2", &image, &own, &log, &error) != WEFT_OK)
            fail_msg("%s", error.text);
        assert_shape(&image, 2, 2, 1, WEFT_PIXEL_U8);
        assert_true((own == NULL) == (damaged == 1));
        assert_true((strstr(said, "x.ktx2: was repaired: mip level 1 ") == said) == (damaged == 1));
        levels_free(own);
        weft_image_free(&image);
    }
}

/* A block of each mode, and its texels of red, green, blue and alpha. */
static const struct {
    const char *block, *texels;
} uastc_blocks[19] = {
    {"71f2d889ed0b27c6c69b4ce149c053f1",
     "62cf8aff7e4645ff7a574eff75735cff7e4645ff66be82ff5dea98ff832b38ff"
     "75735cff66be82ff5af79fff7e4645ff62cf8aff68b07bff5dea98ff861e31ff0909090909090909090909090909090909090909"},
    {"f5ff365e3044fd1b7ceb1d91bcb4779c",
     "cd63e0ffcd63e0ff82eae0ffa7a8e0ffa7a8e0ff82eae0ffcd63e0ff82eae0ff"
     "cd63e0fff121dfffcd63e0fff121dfffcd63e0ffa7a8e0fff121dfff82eae0ff0909090909090909090909090909090909090909"},
    {"fdfad746760a65689ff61f80bcad3ef6",
     "2976b0ff30aa5eff33bb44ff33bb44ff2455e5ff2244ffff2244ffff2c8993ff"
     "33bb55ff223388ff26597aff26597aff26597aff2e9563ff223388ff2c826aff0909090909090909090909090909090909090909"},
    {"e3199473ff8919f2c1066ef181671def",
     "17458bff17458bff17ff00ff17ff00ff1ecaabff17ffa3ff17ffa3ff17ffa3ff"
     "0fba83ff2ee874ff0fba83ff1fd27cff17825dff17825dff17ff00ff17825dff0909090909090909090909090909090909090909"},
    {"536de092a8ff0c8d9f440ae83cab7769",
     "13f28aff7491d5ff7491d5ffa461f9fff220fffffb245cffff270dfff722b0ff"
     "fb245cfff722b0fff722b0fff722b0ffff270dffff270dfffb245cffff270dff0909090909090909090909090909090909090909"},
    {"2be5bb7d7d15586dd3d32d864a6046eb",
     "db5dbfffd78136ffdb5dbfffd87563ffda6992ffda6992ffdb5dbfffd87b4cff"
     "db57d5ffda63a8ffd87563ffd96f79ffdb57d5ffdb57d5ffda6992ffd87b4cff0909090909090909090909090909090909090909"},
    {"db8aa93355ee13f6eab67fee6fb217d9",
     "ebc374ffbe46a6ffbe4674ffa7098effa709a6ffa70974ffbe46a6ffbe46a6ff"
     "a709a6ffbe4674ffbe465cffa7098effa70974ffd5865cffd5868effd586a6ff0909090909090909090909090909090909090909"},
    {"472f99ea0eaf714fcee81f519019534a",
     "d2e591ffe58ac5ff6e9875ff6e9875ffd2e591ffe58ac5ff6e9875ffe58ac5ff"
     "8ae541ffd2e591ff8ae541ffd2e591ffa2e55bffbbe577ffa2e55bffa2e55bff0909090909090909090909090909090909090909"},
    {"976980e0868074b4d6668247e472b099",
     "4c0304374c0304374c0304374c0304374c0304374c0304374c0304374c030437"
     "4c0304374c0304374c0304374c0304374c0304374c0304374c0304374c0304370909090909090909090909090909090909090909"},
    {"0f260f250e10b4eefac034aa359b52b2",
     "dd00aa55505b8e77272c7177505b8e77994443b1505b8e77000055777788aa77"
     "bc217882505b8e77272c7177272c7177dd00aa55505b8e77272c7177505b8e770909090909090909090909090909090909090909"},
    {"8a3a8380bded76950c123dbb99ecb807",
     "856eae497c30ae5c7f44ae567d3aae5990bbae31804eae538da5ae388da5ae38"
     "8a91ae3e8a91ae3e8fb1ae3492c5ae2e8987ae418da5ae388678ae467c30ae5c0909090909090909090909090909090909090909"},
    {"e45cc7ff44d4d1b40e96791f2dfe8d1a",
     "f8d6627df4d92093f8d3a867fcd6627dfcd6627df8cfea51ffcfea51f4d6627d"
     "ffd6627df4d3a867ffd3a867ffcfea51ffd6627dfcd92093fcd3a867f4d6627d0909090909090909090909090909090909090909"},
    {"4ef82d3f7ef53a19b1ffd5881217c09f",
     "75c8258575c825856fc42b8568bf328481d11a8662ba388468bf328481d11a86"
     "56b1448375c8258581d11a8681d11a8668bf328456b1448356b1448368bf32840909090909090909090909090909090909090909"},
    {"3f37db7e3cc3dc6724ed6a138630f9dc",
     "f17391abf17391abf173914d0c9fb4abf17391abf173914df17391abf17391ab"
     "0c9fb44df17391ab0c9fb4abf173914d0c9fb44d0c9fb44df17391ab0c9fb44d0909090909090909090909090909090909090909"},
    {"eddf9b3da2064bf2d8f3471eba0f2fb2",
     "3a8274a023b08f7f23b08f7f3a8274a06a243de43a8274a06a243de46a243de4"
     "3a8274a023b08f7f535258c36a243de43a8274a03a8274a023b08f7f3a8274a00909090909090909090909090909090909090909"},
    {"059853985e0a4dcf336eead494f35f0b",
     "555555384848483975757534555555386b6b6b355f5f5f37555555384343433a"
     "5a5a5a374343433a3838383b484848392929293d2929293d4343433a5f5f5f370909090909090909090909090909090909090909"},
    {"d5047379d0dda07025aa182d2ff7015d",
     "606060396060603960606039898989463737375c606060392a2a2acb2a2a2acb"
     "60606039747474288989894689898946606060392a2a2acb6a6a6a726a6a6a720909090909090909090909090909090909090909"},
    {"a58200754886119e664c3491486be0c8",
     "4343438c3d3d3df0434343f0434343cf3d3d3dcf434343cf373737ad3737378c"
     "3737378c3d3d3d8c3d3d3dcf373737ad3d3d3df04343438c434343f03d3d3d8c0909090909090909090909090909090909090909"},
    {"d9744c307d29dfde17de1094711e2592",
     "659f94ff74cc94ff75d294ff659f94ff4c4f94ff659f94ff4f5b94ff4d5594ff"
     "70c194ff608e94ff7fee94ff7fee94ff6bb094ff6cb694ff587794ff6cb694ff0909090909090909090909090909090909090909"},
};

static void uastc_of_every_mode_is_decoded(void **state) {
    (void)state;
    for (size_t m = 0; m < 19; m++)
        for (uint32_t scheme = 0; scheme <= 3; scheme += scheme ? 1 : 2) {
            const Bytes level = bytes_of(uastc_blocks[m].block), want = bytes_of(uastc_blocks[m].texels);
            const Plan plan = {.model = 166, .first = 3, .width = 4, .height = 4, .scheme = scheme};
            const Bytes bytes = file_of(&plan, &level);
            WeftImage image = read_bytes(&bytes);
            assert_shape(&image, 4, 4, 4, WEFT_PIXEL_U8);
            assert_memory_equal(image.pixels, want.data, 64);
            weft_image_free(&image);
        }
}

/* Channels of the descriptor, and sides that are no multiples of four. */
static void uastc_of_fewer_channels_and_sides_is_cut(void **state) {
    (void)state;
    static const struct {
        int first, channels, from[3];
    } cases[] = {{0, 3, {0, 1, 2}}, {4, 1, {0}}, {5, 3, {0, 3, -1}}, {6, 3, {0, 1, -1}}};
    const Bytes level = bytes_of(uastc_blocks[12].block), want = bytes_of(uastc_blocks[12].texels);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const Plan plan = {.model = 166, .first = cases[k].first, .width = 3, .height = 2};
        const Bytes bytes = file_of(&plan, &level);
        WeftImage image = read_bytes(&bytes);
        assert_shape(&image, 3, 2, cases[k].channels, WEFT_PIXEL_U8);
        for (int n = 0; n < 6; n++)
            for (int c = 0; c < image.channels; c++) {
                const int from = cases[k].from[c], texel = n / 3 * 4 + n % 3;
                assert_int_equal(((unsigned char *)image.pixels)[n * image.channels + c],
                                 from < 0 ? 0 : want.data[4 * texel + from]);
            }
        weft_image_free(&image);
    }
}

/* 12 x 8 texels with alpha, four levels, as the encoder of Basis Universal 2.5 packs them; and the texels of all levels. */
static const char etc1s_file[] =
    "ab4b5458203230bb0d0a1a0a00000000010000000c000000080000000000000000000000010000000400000001000000b000"
    "00003c000000ec0000002400000010010000000000002f010000000000004b020000000000000c0000000000000000000000"
    "0000000047020000000000000400000000000000000000000000000043020000000000000400000000000000000000000000"
    "00003f02000000000000040000000000000000000000000000003c0000000000000002003800a30102000303000008080000"
    "0000000000003f000000000000000000ffffffff40003f0f0000000000000000ffffffff1f0000004b545877726974657200"
    "426173697320556e6976657273616c20322e3530000013001200510000004900000031000000000000000000000000000000"
    "0600000006000000060000000000000000000000020000000200000002000000000000000000000002000000020000000200"
    "0000000000000000000002000000020000000200000018c01300010000204c943c1fc0138001008441fa04247506dce41fc0"
    "1b800000006199e8e96dc6260420028000000010681778ee7e2804b0359e0f8d336a931c4024c5f6ba7e568d47697b492459"
    "f2061004adafaf07ad77ff87ac77ff870477ff870475ff87044dff8784545f0700485555555555fd7fddd8f85fdbbaf857ad"
    "0af857ad027855b32878ddb230d0323030d8dad8d8f8ffffff0700c144000000000000f25f6d0298c23000c02000c0d6090c"
    "219c1ba061d3000083d28b84610800260000000000001040001601ae00ba012600f2038a28de72b8b6670082bf38959c01";
static const char etc1s_texels[] =
    "000400ff000400ff192a11ff192a11ff5a1841ff5a1841ff66244dff702e57ffac1883ffac1883ffb8248fffc22e99ff0718"
    "00ff071800fc2d3e25fc2d3e25f25a1841f05a1841f0702e57f07c3a63f0ac1883e3ac1883e3c22e99e3c22e99e3192a11ff"
    "2d3e25fc192a11f22d3e25f2702e57de7c3a63de702e57de7c3a63dec22e99c9ce3aa5c9c22e99c9ce3aa5c92d3e25ff2d3e"
    "25f22d3e25f22d3e25e67c3a63de7c3a63ca7c3a63ca7c3a63cace3aa5acce3aa5acce3aa5acce3aa5ac078b41ff078b41f0"
    "13974dde1da157de5a9407cf5a9407cf66a013b270aa1db2ac94c59fac94c59fb8a0d175c2aadb7513974dff13974df029ad"
    "63de29ad63ca5a9407cf5a9407b270aa1d9870aa1d98ac94c575ac94c575c2aadb75c2aadb511da157ff29ad63f01da157de"
    "29ad63ca66a013b270aa1d9870aa1d987cb6297bb8a0d175c2aadb51c2aadb51ceb6e72729ad63ff29ad63f029ad63de29ad"
    "63ca7cb629b27cb629987cb6297b7cb6297bceb6e751ceb6e751ceb6e727ceb6e727355625f0355625f0496a39f05b7c4bf0"
    "ac5a9cecac5a9cec355625f0355625f0496a39d35b7c4bd3ac5a9cb4ac5a9cb45b7c4bf05b7c4bd35b7c4bb96f905f9cc977"
    "b984e391d3846f905ff05b7c4bd35b7c4bb96f905f9ce391d34ce391d34c5a5a5ae65a5a5ae6919191b6777777e6777777b6"
    "aeaeae7e84847cc5";

static void etc1s_is_decoded(void **state) {
    (void)state;
    const Bytes bytes = bytes_of(etc1s_file), want = bytes_of(etc1s_texels);
    size_t at = 0;
    for (int level = 0; level < 4; level++) {
        WeftImage image = picture_of(&bytes, level, 0);
        const size_t size = value_total(&image);
        assert_int_equal(image.channels, 4);
        assert_int_equal(image.width, 12 >> level ? 12 >> level : 1);
        assert_memory_equal(image.pixels, want.data + at, size);
        at += size;
        weft_image_free(&image);
    }
    assert_int_equal(at, want.size);
}

/* Each byte of a good file is changed in turn: it is read or refused in one line. */
static void damaged_byte_is_read_or_refused(void **state) {
    (void)state;
    const Bytes good = bytes_of(etc1s_file);
    for (size_t at = 0; at < good.size; at++)
        for (int bit = 0; bit < 8; bit += 3) {
            Bytes bytes = good;
            bytes.data[at] ^= (unsigned char)(1 << bit);
            WeftImage image;
            WeftError error = {0};
            const WeftResult result = weft_image_read_memory(bytes.data, bytes.size, "bytes", &image, NULL, &error);
            if (result == WEFT_OK)
                weft_image_free(&image);
            else
                assert_true(error.text[0] && !strchr(error.text, '\n'));
        }
}

static void assert_refused(const Bytes *bytes, WeftMessage message, const char *part) {
    WeftImage image;
    WeftError error = {0};
    refuse(bytes, message);
    assert_int_equal(weft_image_read_memory(bytes->data, bytes->size, "bytes", &image, NULL, &error), WEFT_INPUT);
    if (!strstr(error.text, part)) fail_msg("\"%s\" has no \"%s\"", error.text, part);
}

/* Changes a number of the header. */
static Bytes changed(const Bytes *bytes, size_t at, uint64_t number, int size) {
    Bytes other = *bytes;
    other.size = at;
    put_long(&other, number, size);
    other.size = bytes->size;
    return other;
}

static void unread_formats_are_named(void **state) {
    (void)state;
    Bytes level = {.size = 0};
    for (int k = 0; k < 64; k++) put_byte(&level, k);
    const Plan plan = {.format = 37, .width = 4, .height = 4},
               blocks = {.model = 166, .first = 3, .width = 4, .height = 4};
    const Bytes plain = file_of(&plan, &level), uastc = file_of(&blocks, &level);
    const struct {
        const Bytes *of;
        size_t at;
        uint64_t number;
        int size;
        WeftMessage message;
        const char *part;
    } cases[] = {
        {&plain, 12, 131, 4, WEFT_MESSAGE_IMAGE_UNSUPPORTED, "VkFormat 131 (BC)"},
        {&plain, 12, 157, 4, WEFT_MESSAGE_IMAGE_UNSUPPORTED, "VkFormat 157 (ASTC)"},
        {&plain, 44, 4, 4, WEFT_MESSAGE_IMAGE_UNSUPPORTED, "supercompression 4"},
        {&plain, 44, 1, 4, WEFT_MESSAGE_IMAGE_DAMAGED, "BasisLZ without ETC1S"},
        {&plain, 24, 0, 4, WEFT_MESSAGE_IMAGE_UNSUPPORTED, "one dimension"},
        {&plain, 20, 70000, 4, WEFT_MESSAGE_IMAGE_SIZE, "70000 x 4"},
        {&plain, 20, 0, 4, WEFT_MESSAGE_IMAGE_SIZE, "0 x 4"},
        {&plain, 20, 60000, 4, WEFT_MESSAGE_IMAGE_SIZE, "at least"},
        {&plain, 36, 6, 4, WEFT_MESSAGE_IMAGE_SIZE, "at least"},
        {&plain, 36, 5, 4, WEFT_MESSAGE_IMAGE_DAMAGED, "faces"},
        {&plain, 40, 99, 4, WEFT_MESSAGE_IMAGE_DAMAGED, "level index"},
        {&plain, 80, 1 << 20, 8, WEFT_MESSAGE_IMAGE_SIZE, "level 0 lies behind its end"},
        {&plain, 80, ~(uint64_t)0, 8, WEFT_MESSAGE_IMAGE_SIZE, "level 0 lies behind its end"},
        {&plain, 88, 5, 8, WEFT_MESSAGE_IMAGE_SIZE, "less than its 64 bytes"},
        {&plain, 48, 0xfffffff0, 4, WEFT_MESSAGE_IMAGE_DAMAGED, "descriptor"},
        {&plain, 60, 0xfffffff0, 4, WEFT_MESSAGE_IMAGE_DAMAGED, "keys"},
        {&uastc, 104 + 12, 160, 1, WEFT_MESSAGE_IMAGE_UNSUPPORTED, "colour model 160"},
        {&uastc, 104 + 28 + 3, 9, 1, WEFT_MESSAGE_IMAGE_UNSUPPORTED, "channels are 9 and 0"},
        {&uastc, 52, 20, 4, WEFT_MESSAGE_IMAGE_DAMAGED, "descriptor is cut"},
        {&uastc, 104 + 44, 69, 1, WEFT_MESSAGE_IMAGE_DAMAGED, "UASTC block 0 to the right"},
        {&uastc, 104 + 12, 163, 1, WEFT_MESSAGE_IMAGE_DAMAGED, "ETC1S without BasisLZ"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const Bytes bytes = changed(cases[k].of, cases[k].at, cases[k].number, cases[k].size);
        assert_refused(&bytes, cases[k].message, cases[k].part);
    }
}

/* A level that unpacks to more or to less than it says, or is not packed. */
static void packed_level_that_lies_is_refused(void **state) {
    (void)state;
    for (uint32_t scheme = 2; scheme <= 3; scheme++) {
        Bytes level = {.size = 0};
        for (int k = 0; k < 64; k++) put_byte(&level, 7);
        const Plan plan = {.format = 37, .width = 4, .height = 4, .scheme = scheme};
        Bytes bytes = file_of(&plan, &level);
        Bytes other = changed(&bytes, 80 + 16, 32, 8);
        assert_refused(&other, WEFT_MESSAGE_IMAGE_SIZE, "less than its 64 bytes");
        other = changed(&bytes, 80 + 8, scheme == 2 ? 6 : 3, 8);
        assert_refused(&other, WEFT_MESSAGE_IMAGE_DAMAGED, "unpacks to");
        other = changed(&bytes, 104 + 44, 0, 4);
        assert_refused(&other, WEFT_MESSAGE_IMAGE_DAMAGED, scheme == 2 ? "Zstandard: " : "zlib: ");
        level.size = 32; /* of the 64 that are claimed */
        bytes = file_of(&plan, &level);
        other = changed(&bytes, 80 + 16, 64, 8);
        assert_refused(&other, WEFT_MESSAGE_IMAGE_DAMAGED, "unpacks to 32 bytes of 64");
        other = changed(&other, 20, 30000, 4);
        other = changed(&other, 24, 30000, 4);
        refuse(&other, WEFT_MESSAGE_IMAGE_SIZE);
    }
}

/* Kinds of pictures that are written. */
typedef enum Kind { NORMALS, NORMALS_OF_THREADS, RAMP, GREY, GREY_ALPHA, COLORS_ALPHA, EDGES, FLAT, KINDS } Kind;

/* Fills a texel, red, green, blue and alpha from 0 to 255. */
static void texel_of(Kind kind, int x, int y, double texel[4]) {
    const double u = kind == NORMALS ? 0.5 * sin(0.11 * x) * cos(0.05 * y) : 0.6 * sin(0.9 * x + 0.2 * y);
    const double v = kind == NORMALS ? 0.5 * cos(0.13 * y + 0.02 * x) : 0.5 * cos(0.7 * y);
    const double wave = 127.5 + 127.5 * sin(0.2 * x) * cos(0.15 * y);
    static const double edges[3][4] = {{250, 20, 30, 255}, {10, 200, 90, 255}, {20, 40, 240, 255}};
    const double kinds[KINDS][4] = {
        {127.5 + 127.5 * u, 127.5 + 127.5 * v, 127.5 + 127.5 * sqrt(1 - u * u - v * v), 255},
        {127.5 + 127.5 * u, 127.5 + 127.5 * v, 127.5 + 127.5 * sqrt(1 - u * u - v * v), 255},
        {4.0 * x, 5.0 * y, 2.0 * (x + y), 255},
        {wave, wave, wave, 255},
        {wave, wave, wave, 4.0 * x},
        {4.0 * x, 5.0 * y, 2.0 * (x + y), 255 - wave},
        {0},
        {200, 100, 50, 255},
    };
    memcpy(texel, kind == EDGES ? edges[((x >> 2) + (y >> 1)) % 3] : kinds[kind], 4 * sizeof *texel);
}

static WeftImage picture_made(Kind kind, int width, int height) {
    WeftImage image = make_image(width, height, 4, WEFT_PIXEL_U8);
    unsigned char *pixels = image.pixels;
    for (int n = 0; n < width * height; n++) {
        double texel[4];
        texel_of(kind, n % width, n / width, texel);
        for (int c = 0; c < 4; c++) pixels[4 * n + c] = (unsigned char)(fmin(fmax(texel[c], 0), 255) + 0.5);
    }
    return image;
}

/* Returns the ratio of peak to noise in dB, over all channels. */
static double ratio_of(const WeftImage *a, const WeftImage *b) {
    const unsigned char *p = a->pixels, *q = b->pixels;
    const size_t count = value_total(a);
    double sum = 1e-9;
    for (size_t k = 0; k < count; k++) sum += (double)(p[k] - q[k]) * (p[k] - q[k]);
    return 10.0 * log10(255.0 * 255.0 * (double)count / sum);
}

/* Pictures written as UASTC are near to what they were: as near, within a third of a decibel, as by Basis Universal 2.5 at
 * its highest level, whose ratios for 60 x 48 texels are 49.7 32.0 46.7 51.2 43.5 39.6 dB and no loss. */
static void written_picture_is_near(void **state) {
    (void)state;
    static const double least[KINDS] = {49.4, 31.6, 46.4, 50.8, 43.2, 39.3, 100, 100};
    for (Kind kind = 0; kind < KINDS; kind++) {
        WeftImage image = picture_made(kind, 60, 48), back = write_and_read(&image, ".ktx2");
        assert_shape(&back, 60, 48, 4, WEFT_PIXEL_U8);
        const double ratio = ratio_of(&image, &back);
        if (!(ratio >= least[kind])) fail_msg("kind %d: %.1f dB of %.0f", (int)kind, ratio, least[kind]);
        weft_image_free(&back);
        weft_image_free(&image);
    }
}

/* Levels are means of linear light, or of the numbers of data, or those of the caller; sides need not be multiples of 4. */
static void written_levels_are_means_or_given(void **state) {
    (void)state;
    char folder[SCRATCH_SIZE], path[300];
    assert_true(scratch_make(folder));
    snprintf(path, sizeof path, "%s/levels.ktx2", folder);
    WeftImage image = make_image(6, 4, 3, WEFT_PIXEL_U8), given = make_image(3, 2, 3, WEFT_PIXEL_U8);
    for (int n = 0; n < 24; n++) memset((unsigned char *)image.pixels + 3 * n, n % 2 ? 255 : 0, 3);
    memset(given.pixels, 77, value_total(&given));
    const struct {
        WeftImageWriting how;
        int levels, want;
    } cases[] = {{{.data = 0}, 3, 188}, {{.data = 1}, 3, 128}, {{.levels = &given, .level_count = 1}, 2, 77}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Bytes bytes = {.size = 0};
        WeftError error = {0};
        if (weft_image_write_as(path, &image, &cases[k].how, &error) != WEFT_OK) fail_msg("%s", error.text);
        FILE *file = fopen(path, "rb");
        assert_non_null(file);
        bytes.size = fread(bytes.data, 1, sizeof bytes.data, file);
        fclose(file);
        assert_int_equal(bytes.data[40], cases[k].levels);
        WeftImage level = picture_of(&bytes, 1, 0);
        assert_shape(&level, 3, 2, 3, WEFT_PIXEL_U8);
        for (size_t n = 0; n < 18; n++)
            assert_in_range(((unsigned char *)level.pixels)[n], cases[k].want - 1, cases[k].want + 1);
        weft_image_free(&level);
    }
    const WeftImageWriting wrong = {.levels = &image, .level_count = 1};
    WeftError error = {0};
    assert_int_equal(weft_image_write_as(path, &image, &wrong, &error), WEFT_USAGE);
    assert_non_null(strstr(error.text, "level 1 is not half"));
    assert_int_equal(unlink(path), 0);
    assert_int_equal(rmdir(folder), 0);
    weft_image_free(&given);
    weft_image_free(&image);
}

/* Halves of one colour each are cut where they meet; the base and step of a solid block give its colour;
 * a wider range of alpha has a greater multiplier. */
static void hints_for_etc_are_near(void **state) {
    (void)state;
    static const uint8_t halves[2][4] = {{240, 30, 20, 255}, {16, 40, 200, 255}};
    for (int flip = 0; flip < 2; flip++) {
        uint8_t texels[16][4];
        for (int t = 0; t < 16; t++) memcpy(texels[t], halves[flip ? t / 8 : t % 4 / 2], 4);
        const UastcEtc1 hint = uastc_etc1_find(texels);
        assert_int_equal(hint.flip, flip);
        assert_int_equal(hint.differential, 0); /* the colours are too far apart for a difference */
    }
    uint8_t near[16][4] = {{0}}, far[16][4] = {{0}};
    for (int t = 0; t < 16; t++) {
        near[t][3] = (uint8_t)(100 + t / 2);
        far[t][3] = (uint8_t)(17 * t);
    }
    assert_int_equal(uastc_etc2_alpha(near) >> 4, 1);
    assert_in_range(uastc_etc2_alpha(far) >> 4, 8, 15);
    static const int steps[8][2] = {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}};
    for (int k = 0; k < 512; k++) {
        const uint8_t color[4] = {(uint8_t)(k % 8 * 36), (uint8_t)(k / 8 % 8 * 36), (uint8_t)(k / 64 * 36), 255};
        const UastcEtc1Solid solid = uastc_etc1_solid(color);
        const int step = (solid.selector < 2 ? -1 : 1) * steps[solid.intensity][solid.selector % 3 == 0];
        for (int c = 0; c < 3; c++) {
            const int base = (int)solid.base[c],
                      value = step + (solid.differential ? base << 3 | base >> 2 : base * 17);
            assert_in_range(abs((value < 0 ? 0 : value > 255 ? 255 : value) - color[c]), 0, 5);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_of_every_format_are_read),
        cmocka_unit_test(packed_floats_are_read),
        cmocka_unit_test(orientation_turns_the_picture),
        cmocka_unit_test(levels_and_faces_are_found),
        cmocka_unit_test(damaged_levels_are_told),
        cmocka_unit_test(uastc_of_every_mode_is_decoded),
        cmocka_unit_test(uastc_of_fewer_channels_and_sides_is_cut),
        cmocka_unit_test(etc1s_is_decoded),
        cmocka_unit_test(damaged_byte_is_read_or_refused),
        cmocka_unit_test(unread_formats_are_named),
        cmocka_unit_test(packed_level_that_lies_is_refused),
        cmocka_unit_test(written_picture_is_near),
        cmocka_unit_test(written_levels_are_means_or_given),
        cmocka_unit_test(hints_for_etc_are_near),
    };
    return cmocka_run_group_tests_name("ktx2", tests, NULL, NULL);
}

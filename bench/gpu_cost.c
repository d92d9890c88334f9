/* gpu_cost - what each lobe and each term costs on a GPU, without one: Mesa's RADV compiles for any of AMD's
 * and says what it made
 *
 *   bench_gpu_cost          prints the page docs/cost.md
 *
 * Needs the RADV driver and glslangValidator. RADV_FORCE_FAMILY names the GPU (NAVI21, an RDNA2); one version
 * of the driver prints the same numbers in every run. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <vulkan/vulkan.h>

#include "base/file.h"
#include "scene/record/scene.h"
#include "shading/lobe/terms.h"
#include "shading/weave/weave_light.h"
#include "text/assemble/dispatch.h"
#include "text/assemble/tables.h"
#include "text/source/number_text.h"
#include "weave/weft_cloth.h"

/* The cycles are those of the busiest unit: so many multiplications beside the lines in question make sure
 * that it is the one that computes, not the one that reads. */
enum { BALLAST = 256, INPUTS_MOST = 8 + LOBE_PARAMS_MAX };

typedef struct Cost {
    double instructions, registers, cycles;
} Cost;

typedef struct Gpu {
    VkInstance instance;
    VkDevice device;
    VkPipelineLayout layout;
    VkPhysicalDeviceProperties2 properties;
    VkPhysicalDeviceDriverProperties driver;
    char folder[32];                /* for the compiler's files */
    Cost empty[2][INPUTS_MOST + 1]; /* of a shader that reads so many numbers, once it is known; [0]: no ballast */
} Gpu;

static void stop(const char *why) {
    fprintf(stderr, "gpu_cost: %s\n", why);
    exit(4);
}

static void check(VkResult result, const char *what) {
    if (result != VK_SUCCESS) stop(what);
}

/* RADV, among what the machine has. */
static VkPhysicalDevice find_device(Gpu *gpu) {
    VkPhysicalDevice devices[16];
    uint32_t count = 16;
    vkEnumeratePhysicalDevices(gpu->instance, &count, devices);
    for (uint32_t k = 0; k < count; k++) {
        gpu->driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
        gpu->properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
        gpu->properties.pNext = &gpu->driver;
        vkGetPhysicalDeviceProperties2(devices[k], &gpu->properties);
        if (gpu->driver.driverID == VK_DRIVER_ID_MESA_RADV) return devices[k];
    }
    stop("there is no RADV driver (Debian: mesa-vulkan-drivers)");
    return VK_NULL_HANDLE;
}

static void make_layout(Gpu *gpu) {
    static const VkDescriptorType types[] = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                             VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                             VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER};
    VkDescriptorSetLayoutBinding bindings[4] = {0};
    for (uint32_t k = 0; k < 4; k++) {
        bindings[k].binding = k;
        bindings[k].descriptorType = types[k];
        bindings[k].descriptorCount = 1;
        bindings[k].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    }
    VkDescriptorSetLayout set;
    VkDescriptorSetLayoutCreateInfo set_info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = 4, .pBindings = bindings};
    check(vkCreateDescriptorSetLayout(gpu->device, &set_info, NULL, &set), "no descriptor set layout");
    VkPipelineLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, .setLayoutCount = 1, .pSetLayouts = &set};
    check(vkCreatePipelineLayout(gpu->device, &info, NULL, &gpu->layout), "no pipeline layout");
    vkDestroyDescriptorSetLayout(gpu->device, set, NULL);
}

static void gpu_begin(Gpu *gpu) {
    setenv("RADV_FORCE_FAMILY", "NAVI21", 0);
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_2};
    VkInstanceCreateInfo instance = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &application};
    if (vkCreateInstance(&instance, NULL, &gpu->instance) != VK_SUCCESS) stop("there is no Vulkan driver");
    VkPhysicalDevice physical = find_device(gpu);
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
        .pipelineExecutableInfo = VK_TRUE};
    float priority = 1.0f;
    VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, .queueCount = 1, .pQueuePriorities = &priority};
    VkDeviceCreateInfo device = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                 .pNext = &statistics,
                                 .queueCreateInfoCount = 1,
                                 .pQueueCreateInfos = &queue,
                                 .enabledExtensionCount = 1,
                                 .ppEnabledExtensionNames =
                                     (const char *[]){VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME}};
    check(vkCreateDevice(physical, &device, NULL, &gpu->device), "the driver tells nothing of its shaders");
    make_layout(gpu);
    snprintf(gpu->folder, sizeof gpu->folder, "/tmp/weft-gpu-cost-XXXXXX");
    if (!mkdtemp(gpu->folder)) stop("no folder for the compiler");
}

static void gpu_end(Gpu *gpu) {
    rmdir(gpu->folder);
    vkDestroyPipelineLayout(gpu->device, gpu->layout, NULL);
    vkDestroyDevice(gpu->device, NULL);
    vkDestroyInstance(gpu->instance, NULL);
}

/* The text as SPIR-V. */
static FileBytes compile(const Gpu *gpu, const char *bytes) {
    char source[64], binary[64], command[256];
    snprintf(source, sizeof source, "%s/cost.comp", gpu->folder);
    snprintf(binary, sizeof binary, "%s/cost.spv", gpu->folder);
    FILE *stream = fopen(source, "wb");
    if (!stream || fputs(bytes, stream) < 0 || fclose(stream) != 0) stop("no file for the compiler");
    snprintf(command, sizeof command, "glslangValidator -V %s -o %s >/dev/null", source, binary);
    FileBytes spirv = {0};
    bool made = system(command) == 0 && file_read(binary, 1 << 24, &spirv, NULL) == WEFT_OK;
    unlink(source);
    unlink(binary);
    if (!made) {
        rmdir(gpu->folder);
        stop("glslangValidator made nothing (Debian: glslang-tools)");
    }
    return spirv;
}

static Cost read_cost(const Gpu *gpu, VkPipeline pipeline) {
    PFN_vkGetPipelineExecutableStatisticsKHR get_statistics =
        (PFN_vkGetPipelineExecutableStatisticsKHR)vkGetDeviceProcAddr(gpu->device,
                                                                      "vkGetPipelineExecutableStatisticsKHR");
    VkPipelineExecutableInfoKHR info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, .pipeline = pipeline};
    VkPipelineExecutableStatisticKHR statistics[64] = {0};
    uint32_t count = 64;
    for (uint32_t k = 0; k < count; k++) statistics[k].sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
    check(get_statistics(gpu->device, &info, &count, statistics), "no statistics");
    Cost cost = {-1.0, -1.0, -1.0};
    for (uint32_t k = 0; k < count; k++) {
        double value = (double)statistics[k].value.u64;
        if (strcmp(statistics[k].name, "Instructions") == 0) cost.instructions = value;
        if (strcmp(statistics[k].name, "VGPRs") == 0) cost.registers = value;
        if (strcmp(statistics[k].name, "Inverse Throughput") == 0) cost.cycles = value;
    }
    if (cost.instructions < 0.0 || cost.registers < 0.0 || cost.cycles < 0.0)
        stop("the driver does not count instructions, registers or cycles");
    return cost;
}

static Cost cost_of(const Gpu *gpu, const char *bytes) {
    FileBytes spirv = compile(gpu, bytes);
    VkShaderModule module;
    VkShaderModuleCreateInfo module_info = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                            .codeSize = spirv.size,
                                            .pCode = (const uint32_t *)(const void *)spirv.data};
    check(vkCreateShaderModule(gpu->device, &module_info, NULL, &module), "no shader module");
    free(spirv.data);
    VkPipeline pipeline;
    VkComputePipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                        .flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR,
                                        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                  .module = module,
                                                  .pName = "main"},
                                        .layout = gpu->layout};
    check(vkCreateComputePipelines(gpu->device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline), "no pipeline");
    Cost cost = read_cost(gpu, pipeline);
    vkDestroyPipeline(gpu->device, pipeline, NULL);
    vkDestroyShaderModule(gpu->device, module, NULL);
    return cost;
}

/* main: thread k reads `inputs` floats of its own into u, and writes their sum, so that all of them are read
 * in any case, and the two numbers f and s. */
static void put_main(Text *text, int inputs, bool loaded, const char *lines) {
    text_line(text, "\nlayout(local_size_x = 64) in;\n"
                    "layout(std430, set = 0, binding = 1) readonly buffer Inputs { float values[]; };\n"
                    "layout(std430, set = 0, binding = 2) writeonly buffer Outputs { vec4 answers[]; };\n");
    text_line(text, "void main() {\n    uint k = gl_GlobalInvocationID.x;\n    float u[%d], sum = 0.0;", inputs);
    for (int k = 0; k < inputs; k++)
        text_line(text, "    u[%d] = values[%du * k + %du];\n    sum += u[%d];", k, inputs, k, k);
    for (int k = 0; loaded && k < BALLAST; k++) text_line(text, "    sum = fma(sum, sum, u[0]);");
    text_line(text, "    float f = 0.0, s = 0.0;\n%s    answers[k] = vec4(sum, f, s, 0.0);\n}", lines);
}

/* The text with that main. */
static Cost cost_with(const Gpu *gpu, Text *text, int inputs, bool loaded, const char *lines) {
    WeftError error = {0};
    put_main(text, inputs, loaded, lines);
    if (text_end(text, &error) != WEFT_OK) stop(error.text);
    Cost cost = cost_of(gpu, text->bytes);
    text_free(text);
    return cost;
}

/* What the lines add to a shader that reads as many numbers; registers are those of the whole. */
static Cost cost_added(Gpu *gpu, Text *text, int inputs, bool loaded, const char *lines) {
    Cost *empty = &gpu->empty[loaded][inputs], cost = cost_with(gpu, text, inputs, loaded, lines);
    if (!(empty->instructions > 0.0)) {
        Text nothing;
        text_begin(&nothing, &(TextDesc){.language = TEXT_GLSL_450});
        *empty = cost_with(gpu, &nothing, inputs, loaded, "");
    }
    cost.instructions -= empty->instructions;
    cost.cycles -= empty->cycles;
    return cost;
}

#define ANGLES "    Angles a = angles_between(dir(u[0], u[1], u[2]), dir(u[3], u[4], u[5]));\n"

/* How a shader knows the parameters of a lobe. */
typedef enum Known { KNOWN_BY_THREAD, KNOWN_PREPARED, KNOWN_COMPILED, KNOWN_COUNT } Known;

/* The parameters as a Lobe m, read by the thread or constants; returns how many numbers a thread reads. */
static int put_params(Buffer *lines, int id, bool read) {
    const WeftLobeInfo *info = weft_lobe_info(id);
    const Lobe lobe = lobe_default(id);
    int inputs = 6;
    buffer_print(lines, "    Lobe m = lobe_default(%d);\n", id);
    for (int p = 0; p < info->param_count; p++) {
        if (info->params[p].choices || !read)
            buffer_print(lines, "    m.params[%d] = %s;\n", p, number(lobe.params[p]).text);
        else
            buffer_print(lines, "    m.params[%d] = u[%d];\n", p, inputs++);
    }
    return inputs;
}

/* The same as a record that was prepared before and lies in a uniform block. */
static void put_prepared(Text *text, Buffer *lines, int id) {
    const WeftLobeInfo *info = weft_lobe_info(id);
    const LobeNames *n = lobe_names(id);
    const Lobe lobe = lobe_default(id);
    text_line(text, "\nlayout(std140, set = 0, binding = 3) uniform Material { %sPrepared prepared; };", n->record);
    buffer_print(lines, "    %sPrepared p = prepared;\n", n->record);
    for (int p = 0; p < info->param_count; p++)
        if (info->params[p].choices)
            buffer_print(lines, "    p.m.%s = %d;\n", info->params[p].name, (int)lobe.params[p]);
}

/* f and s, without pdf. Choices are constants, as in a program made for a material. */
static Cost lobe_cost(Gpu *gpu, int id, Known known) {
    const LobeNames *n = lobe_names(id);
    Text text;
    Buffer lines = {0};
    int inputs = 6;
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_450, .tables = true});
    text_dispatch(&text, &id, 1);
    if (known == KNOWN_PREPARED)
        put_prepared(&text, &lines, id);
    else
        inputs = put_params(&lines, id, known == KNOWN_BY_THREAD);
    if (known != KNOWN_PREPARED)
        buffer_print(&lines, "    %sPrepared p;\n    %s_prepare(%s_of(m), p);\n", n->record, n->prefix, n->prefix);
    buffer_print(&lines,
                 ANGLES "    %sView w;\n    %s_view(p, a.o, w);\n    LobeValue v = %s_value(p, w, a);\n"
                        "    f = v.f;\n    s = v.s;\n",
                 n->record, n->prefix, n->prefix);
    if (lines.failed) stop("short of memory");
    Cost cost = cost_added(gpu, &text, inputs, true, lines.bytes);
    buffer_free(&lines);
    return cost;
}

static void lobe_row(Gpu *gpu, int id) {
    Cost c[KNOWN_COUNT];
    for (int k = 0; k < KNOWN_COUNT; k++) c[k] = lobe_cost(gpu, id, (Known)k);
    printf("| %s | %.0f | %.0f | %.0f | %.0f | %.0f | %.0f | %.0f | %.0f | %.0f |\n", weft_lobe_info(id)->id,
           c[0].instructions, c[1].instructions, c[2].instructions, c[0].cycles, c[1].cycles, c[2].cycles,
           c[0].registers, c[1].registers, c[2].registers);
}

/* u[6] is alpha, or the index of refraction; u[7] the width along x, or k. */
static void term_row(Gpu *gpu, WeftTermKind kind, int term) {
    static const char *const arguments[] = {[WEFT_TERM_D] = "u[6], u[7], u[6], a.h",
                                            [WEFT_TERM_V] = "u[6], u[7], u[6], a",
                                            [WEFT_TERM_F] = "u[6], u[7], a.d"};
    char lines[256];
    Text text;
    snprintf(lines, sizeof lines, ANGLES "    f = term_%c(%d, %s);\n", "dvf"[kind], term, arguments[kind]);
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_450});
    text_include(&text, "shading/lobe/terms.h");
    Cost cost = cost_added(gpu, &text, 8, true, lines);
    printf("| %c %s | %.0f | %.0f | %.0f |\n", "DVF"[kind], weft_term_name(kind, term), cost.instructions, cost.cycles,
           cost.registers);
}

/* Fibres as an engine has them, beside the tightest transformed cosine: tables are filtered by the GPU, four
 * numbers a texel, and what belongs to the material alone lies in a uniform buffer. Fibres stand upright.
 * u[6] is the row of a table that is read by pixel, u[6] and further what was kept of wo. Those that lean are
 * no sharper than alpha 0.19. */
#define UPRIGHT "    FibreModel m = model;\n    FibreNumbers n = numbers;\n    m.s = 0.0;\n    n.thin = 0.0;\n"
#define SINGLE  "    f = flake_single_upright(flakes, a.o, a.i);\n"
#define MULTIPLE(o)                                                                                                    \
    "    f += fibre_multiple(m, n, " o ", fibre_side(m, n, a.i.z, a.i.z), a.o.x * a.i.x + a.o.y * a.i.y);\n"
#define LEANING "    FibrePrepared p = leaning;\n    p.numbers.thin = 0.0;\n    FibreView w;\n"
#define COLOURED                                                                                                       \
    "    LobeReflected x = lobe_reflected(fibre_value(p, w, a), color, rgb_grey(1.0));\n"                              \
    "    f = x.f.r;\n    s = x.f.g + x.f.b;\n"
static const struct {
    const char *name;
    int inputs;
    const char *lines;
} fibre_rows[] = {
    {"ltc, tight", 7,
     "    vec4 t = textureLod(weft_tables, vec3(sqrt(u[2]), u[6], 0.0), 0.0);\n"
     "    vec2 v = t.x * vec2(u[3], u[4]) + (t.y * u[5]) * vec2(u[0], u[1]);\n"
     "    float r2 = dot(v, v) + u[5] * u[5], r = t.x / r2;\n"
     "    f = t.z * r * r;\n"},
    {"fibre-table, fixed material", 6,
     ANGLES SINGLE "    f += fibre_table_multiple(read_side(a.o.z, row), read_side(a.i.z, row), a.o, a.i,\n"
                   "                              alpha, power);\n"},
    {"fibre-table, alpha of the pixel", 7,
     ANGLES "    float l = log2(u[6]), y = 0.391289 * l + 0.96875;\n"
            "    f = flake_single_upright(flake_upright(u[6] * u[6], 1.0), a.o, a.i);\n"
            "    f += fibre_table_multiple(read_side(a.o.z, y), read_side(a.i.z, y), a.o, a.i,\n"
            "                              u[6], 1.4 - 2.5 * l);\n"},
    {"fibre, fixed material", 6, ANGLES UPRIGHT SINGLE MULTIPLE("fibre_side(m, n, a.o.z, a.o.z)")},
    {"fibre, fixed material, view side kept", 10,
     ANGLES UPRIGHT SINGLE "    FibreSide kept = side_of(a.o.z, vec4(u[6], u[7], u[8], u[9]));\n" MULTIPLE("kept")},
    {"fibre, fixed material, leaning, in a colour", 6, ANGLES LEANING "    fibre_view(p, a.o, w);\n" COLOURED},
    {"fibre, fixed material, leaning, in a colour, view side kept", 16,
     ANGLES LEANING "    w.side = FibreSide(a.o.z, u[6], u[7], u[8], u[9], u[10], u[11], u[12], u[13], u[14]);\n"
                    "    w.sigma = u[15];\n" COLOURED},
};

static Cost fibre_cost(Gpu *gpu, size_t row, bool loaded) {
    Text text;
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_450, .tables = true});
    text_include(&text, "shading/media/fibre_medium.h");
    text_lobe_tables(&text);
    text_include(&text, "shading/lobes/fibre_table.h");
    text_include(&text, "shading/dialect/rgb.h");
    text_include(&text, "shading/lobes/fibre.h");
    text_line(&text, "\nlayout(std140, set = 0, binding = 3) uniform Material {\n    FibreModel model;\n    "
                     "FibreNumbers numbers;\n"
                     "    FlakeUpright flakes;\n    float row, alpha, power;\n    FibrePrepared leaning;\n   "
                     " Rgb color;\n};\n\n"
                     "FibreSide side_of(float mu, vec4 t) {\n"
                     "    return FibreSide(mu, mu, t.x, t.y, t.z, t.w, 0.0, 0.0, 0.0, 0.0);\n}\n\n"
                     "FibreTableSide read_side(float mu, float y) {\n"
                     "    float x = sqrt(mu + 1e-3) * 0.989118 - 0.01044531;\n"
                     "    vec4 t = textureLod(weft_tables, vec3(x, y, 0.0), 0.0);\n"
                     "    return FibreTableSide(t.x, t.y, t.z, t.w);\n}");
    return cost_added(gpu, &text, fibre_rows[row].inputs, loaded, fibre_rows[row].lines);
}

static void fibre_costs(Gpu *gpu) {
    Cost first = {0}, first_alone = {0};
    for (size_t k = 0; k < sizeof fibre_rows / sizeof fibre_rows[0]; k++) {
        Cost cost = fibre_cost(gpu, k, true), alone = fibre_cost(gpu, k, false);
        if (k == 0) first = cost, first_alone = alone;
        printf("| %s | %.0f | %.0f | %.2f | %.0f | %.2f | %.0f |\n", fibre_rows[k].name, cost.instructions, cost.cycles,
               cost.cycles / first.cycles, alone.cycles, alone.cycles / first_alone.cycles, cost.registers);
    }
}

/* A woven cloth as the raster engine has it: its numbers in a uniform block, runs and albedos in a texture, and what
 * varies never comes again. u[6] and u[7] are the place, u[8] the spacing of points, u[9] the place across a fibre. f and
 * s are of all three channels. */
#define CLOTH "    Weave m = cloth;\n    m.cycle_x = 0.0;\n    m.cycle_y = 0.0;\n"
#define LIT                                                                                                            \
    "    YarnPrepared q;\n    YarnView w;\n    yarn_prepare(weave_yarn(m, p), q);\n    q.axis = p.fibre;\n"            \
    "    yarn_view(q, a.o, w);\n"                                                                                      \
    "    LobeReflected x = lobe_reflected(yarn_value(q, w, a), weave_single_rgb(m, p), "                               \
    "weave_multiple_rgb(m, "                                                                                           \
    "p));\n"                                                                                                           \
    "    f = x.f.r;\n    s = x.f.g + x.f.b;\n"
static const struct {
    const char *name, *lines;
} weave_rows[] = {
    {"place and slopes of the thread on top", CLOTH "    WeavePoint p = weave_top(m, u[6], u[7]);\n"
                                                    "    f = p.slope_x + p.height;\n    s = p.slope_y;\n"},
    {"the same with its fibres and colours",
     CLOTH "    WeavePoint p = weave_point_bound(m, u[6], u[7], u[8], u[9]);\n"
           "    Rgb once = weave_single_rgb(m, p), again = weave_multiple_rgb(m, p);\n"
           "    f = p.slope_x + p.height + once.r + once.g + once.b;\n"
           "    s = p.slope_y + dir_dot(p.fibre, dir(1.0, 2.0, 3.0)) + again.r + again.g + again.b;\n"},
    {"the same, lit by lobe `yarn`",
     ANGLES CLOTH "    WeavePoint p = weave_point_bound(m, u[6], u[7], u[8], u[9]);\n" LIT},
    {"the same under loose fibres", ANGLES CLOTH "    WeavePoint p = weave_point(m, u[6], u[7], u[8], u[9]);\n" LIT},
};

/* A structure of floats, by its constructor. */
static void put_floats(Text *text, const char *type, const void *structure, size_t size) {
    const float *numbers = structure;
    text_line(text, "    %s(", type);
    for (size_t k = 0; k < size / sizeof *numbers; k++)
        text_line(text, "    %s%s", k ? ", " : "", number(numbers[k]).text);
    text_line(text, "    ),");
}

/* Numbers that the compiler knows. */
static void put_cloth(Text *text, const Weave *m) {
    text_line(text, "const Weave cloth = Weave(%d, %d,", m->warps, m->picks);
    put_floats(text, "WeaveYarn", &m->warp, sizeof m->warp);
    put_floats(text, "WeaveYarn", &m->weft, sizeof m->weft);
    text_line(text, "    %s,", number(m->seed).text);
    put_floats(text, "WeaveFar", &m->warp_far, sizeof m->warp_far);
    put_floats(text, "WeaveFar", &m->weft_far, sizeof m->weft_far);
    text_line(text, "    %s, %s, %s, 0.0, 0.0, 0, 0);\n", number(m->low).text, number(m->high).text,
              number(m->openness).text);
}

/* known: NULL for numbers in a uniform block. */
static Cost weave_cost(Gpu *gpu, size_t row, const Weave *known) {
    Text text;
    text_begin(&text, &(TextDesc){.language = TEXT_GLSL_450, .tables = true});
    text_define(&text, "weave_texel(t, stride, row, column)", "weave_fetch(row, column)");
    text_define(&text, "weave_cell_texel(t, stride, row, at)", "weave_fetch_cell(row, at)");
    text_include(&text, "shading/weave/weave_cell.h");
    text_line(&text, "\nfloat weave_fetch(int row, int channel);\nWeaveCell weave_fetch_cell(int row, int at);");
    text_include(&text, "shading/weave/weave_light.h");
    text_line(&text, "\nlayout(set = 0, binding = 0) uniform highp sampler2D weave_cells;");
    if (known)
        put_cloth(&text, known);
    else
        text_line(&text, "layout(std140, set = 0, binding = 3) uniform Material { Weave cloth; };\n");
    text_line(&text, "WeaveCell weave_fetch_cell(int row, int at) {\n"
                     "    vec4 c = texelFetch(weave_cells, ivec2(at, row), 0);\n"
                     "    return WeaveCell(c.x, c.y, c.z, c.w);\n}\n\n"
                     "float weave_fetch(int row, int channel) {\n"
                     "    int up = int((float(row) + 0.5) / float(cloth.warps));\n"
                     "    ivec2 at = ivec2(row - cloth.warps * up, cloth.picks + up);\n"
                     "    return texelFetch(weave_cells, at, 0)[channel];\n}");
    return cost_added(gpu, &text, 10, true, weave_rows[row].lines);
}

/* The yarn without what varies from thread to thread and within it. */
static WeaveYarn even(WeaveYarn y) {
    y.streaks = y.dye = y.slub = y.wander = y.hairiness = 0.0f;
    return y;
}

static void weave_costs(Gpu *gpu) {
    WeftScene *scene;
    WeftError error;
    if (weft_scene_load("builtin:cloth", &scene, NULL, &error) != WEFT_OK ||
        weft_scene_assign_material(scene, "0", "preset:woven-denim", NULL, &error) != WEFT_OK)
        stop(error.text);
    const Weave *denim = &scene->cloths[scene->materials[0].cloth - 1]->weave;
    Weave alike = *denim;
    alike.warp = even(denim->warp), alike.weft = even(denim->weft);
    for (size_t k = 0; k < sizeof weave_rows / sizeof weave_rows[0]; k++) {
        const Cost costs[] = {weave_cost(gpu, k, NULL), weave_cost(gpu, k, denim), weave_cost(gpu, k, &alike)};
        printf("| %s |", weave_rows[k].name);
        for (int t = 0; t < 3; t++) printf(" %.0f |", costs[t].instructions);
        for (int t = 0; t < 3; t++) printf(" %.0f |", costs[t].cycles);
        for (int t = 0; t < 3; t++) printf(" %.0f |", costs[t].registers);
        printf("\n");
    }
    weft_scene_free(scene);
}

int main(void) {
    Gpu gpu = {0};
    gpu_begin(&gpu);
    printf("# What lobes and terms cost on a GPU\n\n"
           "Use these tables to choose a BRDF for a real-time budget: they have the instructions, cycles "
           "and registers of every lobe\n"
           "and term in a shader. `build/release/bench/bench_gpu_cost > docs/cost.md` makes them without a "
           "GPU: %s %s\n"
           "compiles each shader for %s and reports the figures.\n\n"
           "* Instructions and cycles are those that the code adds to a shader that only reads the same "
           "numbers. For a lobe\n"
           "  they include f, the weight of a second colour and the half vector, but not pdf and sampling; "
           "for a term, its\n"
           "  value and the half vector if it needs one.\n"
           "* Cycles are the driver's estimate of how long a wave of 64 threads occupies the compute "
           "units, without waiting\n"
           "  for memory, such as for a table of E.\n"
           "* Registers are the vector registers of the whole shader, allocated in steps of 8.\n"
           "* The terms of cook-torrance are its defaults, constants as in a program made for one "
           "material.\n\n"
           "There are three programs for each lobe: its parameters are read per thread, as from textures; "
           "prepared in a\n"
           "uniform block; or compile-time constants. The loop of `woven` counts once except with "
           "constants.\n\n"
           "| lobe | instructions, textured | prepared | constant | cycles, textured | prepared | constant "
           "| registers, textured | prepared | constant |\n"
           "|---|---|---|---|---|---|---|---|---|---|\n",
           gpu.driver.driverName, gpu.driver.driverInfo, gpu.properties.properties.deviceName);
    for (int id = 0; id < weft_lobe_count(); id++)
        if (!(weft_lobe_info(id)->traits & WEFT_LOBE_REFERENCE)) lobe_row(&gpu, id);
    printf("\n| term | instructions | cycles | registers |\n|---|---|---|---|\n");
    for (int kind = WEFT_TERM_D; kind <= WEFT_TERM_F; kind++)
        for (int term = 0; weft_term_name((WeftTermKind)kind, term); term++) term_row(&gpu, (WeftTermKind)kind, term);
    printf("\n"
           "Fibres as engines would use them: tables filtered by the GPU, four numbers per texel, and the "
           "material in a\n"
           "uniform buffer. *alone* has the cycles over a shader that does nothing else, where the busiest "
           "unit counts,\n"
           "reading included.\n\n"
           "| fibres | instructions | cycles | over ltc | alone | over ltc | registers |\n"
           "|---|---|---|---|---|---|---|\n");
    fibre_costs(&gpu);
    printf("\n"
           "A point of a woven cloth (docs/weave-model.md): with the cloth's numbers in a uniform buffer; "
           "with those of denim as\n"
           "constants; and with denim whose threads are all alike, without streaks, slubs, irregular dye "
           "and loose fibres.\n"
           "Possible loose fibres are a loop of sixteen rounds, whose code counts once.\n\n"
           "| point of a cloth | instructions, prepared | constant | threads alike | cycles, prepared | "
           "constant | threads alike | registers, prepared | constant | threads alike |\n"
           "|---|---|---|---|---|---|---|---|---|---|\n");
    weave_costs(&gpu);
    gpu_end(&gpu);
    return 0;
}

/* Specification: Khronos Group, "glTF 2.0 Specification", 2021, section 3.6.2 (accessors). */
#include "gltf/asset/accessor.h"

#include <math.h>
#include <string.h>

#include "base/little_endian.h"
#include "gltf/asset/buffer_views.h"
#include "gltf/asset/field.h"

static size_t component_size(Component component) {
    switch (component) {
    case COMPONENT_I8:
    case COMPONENT_U8: return 1;
    case COMPONENT_I16:
    case COMPONENT_U16: return 2;
    case COMPONENT_U32:
    case COMPONENT_F32: break;
    }
    return 4;
}

/* Returns the bytes from one column to the next: the columns of a matrix start at multiples of 4 bytes. */
static size_t column_size(const Accessor *a) {
    size_t size = component_size(a->component) * a->rows;
    return a->columns > 1 ? (size + 3) & ~(size_t)3 : size;
}

static size_t element_size(const Accessor *a) { return column_size(a) * a->columns; }

static Component component_read(const Field *field) {
    if (!field->json) field_fail(field, WEFT_MESSAGE_GLTF_SCHEMA, "missing an integer");
    size_t value = field_size(field, COMPONENT_F32, 0, SIZE_MAX);
    switch (value) {
    case COMPONENT_I8:
    case COMPONENT_U8:
    case COMPONENT_I16:
    case COMPONENT_U16:
    case COMPONENT_U32:
    case COMPONENT_F32: return (Component)value;
    default: field_fail(field, WEFT_MESSAGE_GLTF_SCHEMA, "%zu is not a component type", value);
    }
    return COMPONENT_F32;
}

static void shape_read(const Field *field, Accessor *a) {
    static const struct {
        const char *name;
        uint8_t columns, rows;
    } shapes[] = {{"SCALAR", 1, 1}, {"VEC2", 1, 2}, {"VEC3", 1, 3}, {"VEC4", 1, 4},
                  {"MAT2", 2, 2},   {"MAT3", 3, 3}, {"MAT4", 4, 4}};
    const char *type = field_text(field, "");
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        if (strcmp(type, shapes[i].name) == 0) {
            a->columns = shapes[i].columns;
            a->rows = shapes[i].rows;
            return;
        }
    field_fail(field, WEFT_MESSAGE_GLTF_SCHEMA, "%s", field->json ? "not an accessor type" : "missing");
    a->columns = a->rows = 1;
}

/* Fails unless count elements of size bytes, stride apart, from offset on, lie within the view. */
static void check_bounds(const Field *field, int view, size_t offset, size_t count, size_t size, size_t stride) {
    if (view < 0 || field->asset->result != WEFT_OK) return;
    size_t available = field->asset->views[view].span.size;
    if (stride < size)
        field_fail(field, WEFT_MESSAGE_GLTF_SCHEMA, "%zu bytes an element, but a stride of %zu", size, stride);
    else if (offset > available || size > available - offset || count - 1 > (available - offset - size) / stride)
        field_fail(field, WEFT_MESSAGE_GLTF_BOUNDS, "%zu elements from byte %zu on, in %zu bytes", count, offset,
                   available);
}

static size_t stride_of(const Asset *asset, int view, size_t size) {
    return view >= 0 && asset->views[view].stride ? asset->views[view].stride : size;
}

static void sparse_read(const Field *field, Accessor *a) {
    Asset *asset = field->asset;
    Field count = field_member(field, "count"), indices = field_member(field, "indices"),
          values = field_member(field, "values");
    Field index_view = field_member(&indices, "bufferView"), value_view = field_member(&values, "bufferView"),
          index_offset = field_member(&indices, "byteOffset"), value_offset = field_member(&values, "byteOffset"),
          component = field_member(&indices, "componentType");
    if (!count.json) field_fail(&count, WEFT_MESSAGE_GLTF_SCHEMA, "missing an integer");
    a->sparse_count = field_size(&count, 0, 1, a->count);
    a->index_view = field_needed_index(&index_view, asset->view_count);
    a->value_view = field_needed_index(&value_view, asset->view_count);
    a->index_offset = field_size(&index_offset, 0, 0, SIZE_MAX);
    a->value_offset = field_size(&value_offset, 0, 0, SIZE_MAX);
    a->index_component = component_read(&component);
    if (a->index_component != COMPONENT_U8 && a->index_component != COMPONENT_U16 &&
        a->index_component != COMPONENT_U32)
        field_fail(&component, WEFT_MESSAGE_GLTF_SCHEMA, "expected an unsigned integer type");
    size_t size = component_size(a->index_component);
    check_bounds(&indices, a->index_view, a->index_offset, a->sparse_count, size, size);
    check_bounds(&values, a->value_view, a->value_offset, a->sparse_count, element_size(a), element_size(a));
}

static void accessor_read(const Field *field, Accessor *a) {
    Asset *asset = field->asset;
    Field view = field_member(field, "bufferView"), offset = field_member(field, "byteOffset"),
          count = field_member(field, "count"), component = field_member(field, "componentType"),
          type = field_member(field, "type"), normalized = field_member(field, "normalized"),
          sparse = field_member(field, "sparse");
    *a = (Accessor){.index_view = -1, .value_view = -1};
    a->view = field_index(&view, asset->view_count);
    a->offset = field_size(&offset, 0, 0, SIZE_MAX);
    if (!count.json) field_fail(&count, WEFT_MESSAGE_GLTF_SCHEMA, "missing an integer");
    /* Vertices and indices are counted in 32 bits. */
    a->count = field_size(&count, 1, 1, UINT32_MAX);
    a->component = component_read(&component);
    a->normalized = field_bool(&normalized, false);
    shape_read(&type, a);
    size_t size = element_size(a);
    check_bounds(field, a->view, a->offset, a->count, size, stride_of(asset, a->view, size));
    if (sparse.json) sparse_read(&sparse, a);
}

void accessors_read(Asset *asset) {
    Field root = field_root(asset), list = field_member(&root, "accessors");
    asset->accessor_count = field_count(&list);
    asset->accessors = asset_array(asset, &asset->arena, asset->accessor_count, sizeof *asset->accessors);
    for (size_t i = 0; i < asset->accessor_count && asset->result == WEFT_OK; i++) {
        Field field = field_element(&list, i);
        accessor_read(&field, &asset->accessors[i]);
    }
}

/* Returns the array with room for one more item: itself, or a copy of twice the size. */
static void *grown(Asset *asset, void *items, size_t count, size_t size, size_t *room) {
    if (count < *room) return items;
    const size_t more = 2 * count + 16;
    void *copy = asset_array(asset, &asset->arena, more, size);
    if (copy && count) memcpy(copy, items, count * size);
    if (copy) *room = more;
    return copy;
}

int accessor_add(Asset *asset, Accessor accessor, Span bytes) {
    BufferView *views = grown(asset, asset->views, asset->view_count, sizeof *views, &asset->view_room);
    Accessor *accessors =
        grown(asset, asset->accessors, asset->accessor_count, sizeof *accessors, &asset->accessor_room);
    if (!views || !accessors) return 0;
    asset->views = views;
    asset->accessors = accessors;
    accessor.view = (int)asset->view_count;
    accessor.offset = accessor.sparse_count = 0;
    views[asset->view_count++] = (BufferView){.span = bytes};
    accessors[asset->accessor_count] = accessor;
    return (int)asset->accessor_count++;
}

static uint32_t load_integer(const unsigned char *p, Component component) {
    return (uint32_t)little_endian(p, component_size(component));
}

static float load_float(const unsigned char *p, Component component, bool normalized) {
    uint32_t bits = load_integer(p, component);
    float value = 0.0f, unit = 1.0f;
    switch (component) {
    case COMPONENT_I8:
        value = (float)(int8_t)bits;
        unit = 127.0f;
        break;
    case COMPONENT_U8:
        value = (float)bits;
        unit = 255.0f;
        break;
    case COMPONENT_I16:
        value = (float)(int16_t)bits;
        unit = 32767.0f;
        break;
    case COMPONENT_U16:
        value = (float)bits;
        unit = 65535.0f;
        break;
    case COMPONENT_U32:
        value = (float)bits;
        unit = 4294967295.0f;
        break;
    case COMPONENT_F32: memcpy(&value, &bits, sizeof value); return value;
    }
    return normalized ? fmaxf(value / unit, -1.0f) : value;
}

/* Writes 4 bytes to out for each component of an element: a float, or, with integers, the number itself. */
static void element_load(const Accessor *a, const unsigned char *p, bool integers, void *out) {
    size_t size = component_size(a->component), column = column_size(a);
    unsigned char *to = out;
    for (size_t c = 0; c < a->columns; c++)
        for (size_t r = 0; r < a->rows; r++, to += 4) {
            const unsigned char *from = p + c * column + r * size;
            if (integers) {
                uint32_t value = load_integer(from, a->component);
                memcpy(to, &value, 4);
            } else {
                float value = load_float(from, a->component, a->normalized);
                memcpy(to, &value, 4);
            }
        }
}

static void *decode(Asset *asset, Arena *arena, int index, bool integers) {
    const Accessor *a = &asset->accessors[index];
    size_t size = element_size(a), wide = (size_t)4 * a->columns * a->rows;
    unsigned char *out = asset_array(asset, arena, a->count, wide);
    if (out && a->view >= 0) {
        Span base = view_bytes(asset, a->view);
        size_t stride = stride_of(asset, a->view, size);
        for (size_t i = 0; base.data && i < a->count; i++)
            element_load(a, base.data + a->offset + i * stride, integers, out + i * wide);
    }
    if (out && a->sparse_count) {
        Span places = view_bytes(asset, a->index_view), values = view_bytes(asset, a->value_view);
        size_t step = component_size(a->index_component);
        for (size_t i = 0; places.data && values.data && i < a->sparse_count; i++) {
            size_t place = load_integer(places.data + a->index_offset + i * step, a->index_component);
            if (place >= a->count) {
                asset_fail(asset, WEFT_MESSAGE_GLTF_BOUNDS, "accessors[%d].sparse: index %zu of %zu", index, place,
                           a->count);
                break;
            }
            element_load(a, values.data + a->value_offset + i * size, integers, out + place * wide);
        }
    }
    return asset->result == WEFT_OK ? out : NULL;
}

float *accessor_floats(Asset *asset, Arena *arena, int accessor) { return decode(asset, arena, accessor, false); }

uint32_t *accessor_integers(Asset *asset, Arena *arena, int accessor) { return decode(asset, arena, accessor, true); }

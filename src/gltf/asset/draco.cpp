#include "gltf/asset/draco.h"

#include <memory>
#include <new>

/* The library's headers convert without saying so. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wundef"
#pragma GCC diagnostic ignored "-Wpedantic"
#include <draco/compression/decode.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#pragma GCC diagnostic pop

struct DracoMesh {
    draco::Mesh mesh;
};

namespace {

/* Upper bounds of what the library holds for a triangle, and for a triangle and an attribute with seams. */
constexpr size_t TRIANGLE = 64, SEAMS = 32;

/* A decoder may still take so many bytes. */
struct Allowance {
    size_t left;
    bool exceeded;
};

bool take(Allowance *allowance, size_t count, size_t size) {
    allowance->exceeded = allowance->exceeded || (size > 0 && count > allowance->left / size);
    if (!allowance->exceeded) allowance->left -= count * size;
    return !allowance->exceeded;
}

/* A decoder of the library's that looks at the numbers of a stream before memory is allocated for them. */
template <class Decoder> class Careful : public Decoder {
  public:
    explicit Careful(Allowance *allowance) : allowance_(allowance) {}

  protected:
    bool DecodeConnectivity() override { return connectivity_fits() && Decoder::DecodeConnectivity(); }

    bool DecodeAllAttributes() override {
        const draco::PointCloud *cloud = this->point_cloud();
        for (int32_t k = 0; k < cloud->num_attributes(); k++) {
            /* The values, and integers of 4 bytes from which they are made, twice. */
            const draco::PointAttribute *attribute = cloud->attribute(k);
            const int32_t width = draco::DataTypeLength(attribute->data_type());
            const size_t bytes = width > 0 ? static_cast<size_t>(width) : 8;
            if (!take(allowance_, cloud->num_points(), (bytes + 8) * attribute->num_components() + 8)) return false;
        }
        return Decoder::DecodeAllAttributes();
    }

  private:
    bool connectivity_fits();

    Allowance *allowance_;
};

template <> bool Careful<draco::MeshEdgebreakerDecoder>::connectivity_fits() {
    draco::DecoderBuffer ahead = *this->buffer();
    uint32_t vertices = 0, triangles = 0;
    uint8_t attributes = 0;
    return draco::DecodeVarint(&vertices, &ahead) && draco::DecodeVarint(&triangles, &ahead) &&
           ahead.Decode(&attributes) && take(allowance_, triangles, TRIANGLE + SEAMS * attributes) &&
           take(allowance_, vertices, TRIANGLE);
}

template <> bool Careful<draco::MeshSequentialDecoder>::connectivity_fits() {
    draco::DecoderBuffer ahead = *this->buffer();
    uint32_t points = 0, triangles = 0;
    return draco::DecodeVarint(&triangles, &ahead) && draco::DecodeVarint(&points, &ahead) &&
           take(allowance_, triangles, TRIANGLE) && take(allowance_, points, TRIANGLE);
}

template <class Decoder> bool decode(draco::DecoderBuffer *buffer, Allowance *allowance, draco::Mesh *mesh) {
    const draco::DecoderOptions options;
    Careful<Decoder> decoder(allowance);
    return decoder.Decode(options, buffer, mesh).ok();
}

DracoResult open(const unsigned char *data, size_t size, size_t limit, draco::Mesh *mesh) {
    draco::DecoderBuffer buffer;
    draco::DracoHeader header;
    Allowance allowance = {limit, false};
    buffer.Init(reinterpret_cast<const char *>(data), size);
    draco::DecoderBuffer ahead = buffer;
    if (!draco::PointCloudDecoder::DecodeHeader(&ahead, &header).ok()) return DRACO_DAMAGED;
    if (header.version_major != 2 || header.version_minor != 2) return DRACO_VERSION;
    if (header.encoder_type != draco::TRIANGULAR_MESH) return DRACO_DAMAGED;
    const bool good = header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING
                          ? decode<draco::MeshEdgebreakerDecoder>(&buffer, &allowance, mesh)
                      : header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING
                          ? decode<draco::MeshSequentialDecoder>(&buffer, &allowance, mesh)
                          : false;
    return allowance.exceeded ? DRACO_LARGE : good ? DRACO_READ : DRACO_DAMAGED;
}

template <class Number> bool copy(const draco::Mesh &mesh, const draco::PointAttribute &from, int rows, void *out) {
    Number *to = static_cast<Number *>(out);
    for (uint32_t k = 0; k < mesh.num_points(); k++, to += rows) {
        const draco::AttributeValueIndex value = from.mapped_index(draco::PointIndex(k));
        if (value.value() >= from.size()) return false;
        if (!from.ConvertValue<Number>(value, static_cast<int8_t>(rows), to)) return false;
    }
    return true;
}

} // namespace

extern "C" DracoResult draco_open(const unsigned char *data, size_t size, size_t limit, DracoMesh **out) {
    *out = nullptr;
    try {
        std::unique_ptr<DracoMesh> mesh(new DracoMesh);
        const DracoResult result = open(data, size, limit, &mesh->mesh);
        if (result == DRACO_READ) *out = mesh.release();
        return result;
    } catch (const std::bad_alloc &) {
        return DRACO_MEMORY;
    } catch (...) {
        return DRACO_DAMAGED;
    }
}

extern "C" void draco_close(DracoMesh *mesh) { delete mesh; }

extern "C" size_t draco_point_count(const DracoMesh *mesh) { return mesh->mesh.num_points(); }

extern "C" size_t draco_triangle_count(const DracoMesh *mesh) { return mesh->mesh.num_faces(); }

extern "C" bool draco_attribute(const DracoMesh *mesh, uint32_t id, DracoType type, int rows, void *out) try {
    const draco::PointAttribute *from = mesh->mesh.GetAttributeByUniqueId(id);
    if (!from || from->num_components() < rows || from->data_type() == draco::DT_BOOL) return false;
    if (type.is_float) return copy<float>(mesh->mesh, *from, rows, out);
    switch (type.size) {
    case 1: return (type.is_signed ? copy<int8_t> : copy<uint8_t>)(mesh->mesh, *from, rows, out);
    case 2: return (type.is_signed ? copy<int16_t> : copy<uint16_t>)(mesh->mesh, *from, rows, out);
    default: return copy<uint32_t>(mesh->mesh, *from, rows, out);
    }
} catch (...) {
    return false;
}

extern "C" bool draco_indices(const DracoMesh *mesh, uint32_t *out) {
    for (uint32_t k = 0; k < mesh->mesh.num_faces(); k++)
        for (size_t c = 0; c < 3; c++) {
            const uint32_t point = mesh->mesh.face(draco::FaceIndex(k))[c].value();
            if (point >= mesh->mesh.num_points()) return false;
            *out++ = point;
        }
    return true;
}

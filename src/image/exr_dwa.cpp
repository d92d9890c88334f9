#include "image/exr_dwa.h"

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>

/* The library's headers convert without saying so. */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <Iex.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#pragma GCC diagnostic pop

namespace {

/* A whole file in memory. */
class MemoryStream : public Imf::IStream {
  public:
    MemoryStream(const unsigned char *data, size_t size) : IStream("memory"), data_(data), size_(size), at_(0) {}

    bool read(char to[], int count) override {
        if (count < 0 || static_cast<size_t>(count) > size_ - at_) throw Iex::InputExc("it ends early");
        std::memcpy(to, data_ + at_, static_cast<size_t>(count));
        at_ += static_cast<size_t>(count);
        return at_ < size_;
    }
    uint64_t tellg() override { return at_; }
    void seekg(uint64_t to) override {
        if (to > size_) throw Iex::InputExc("it ends early");
        at_ = static_cast<size_t>(to);
    }

  private:
    const unsigned char *data_;
    size_t size_, at_;
};

size_t long_at(const unsigned char *at) {
    return static_cast<size_t>(at[0]) | static_cast<size_t>(at[1]) << 8 | static_cast<size_t>(at[2]) << 16 |
           static_cast<size_t>(at[3]) << 24;
}

/* Returns true if a list of channels, of a name and 16 bytes each, ends where its attribute does. */
bool channels_fit(const unsigned char *at, size_t size) {
    enum { CHANNEL = 16 };
    for (size_t k = 0; k < size;) {
        const size_t start = k;
        while (k < size && at[k]) k++;
        if (k == size) return false;
        if (k++ == start) return k == size;
        if (size - k < CHANNEL) return false;
        k += CHANNEL;
    }
    return false;
}

/* Returns true if the library reads as many bytes of an attribute of this type as it has. */
bool attribute_fits(const char *type, const unsigned char *at, size_t size) {
    static const struct {
        const char *type;
        size_t size;
    } fixed[] = {{"box2i", 16},
                 {"box2f", 16},
                 {"chromaticities", 32},
                 {"compression", 1},
                 {"deepImageState", 1},
                 {"double", 8},
                 {"envmap", 1},
                 {"float", 4},
                 {"int", 4},
                 {"keycode", 28},
                 {"lineOrder", 1},
                 {"m33f", 36},
                 {"m33d", 72},
                 {"m44f", 64},
                 {"m44d", 128},
                 {"rational", 8},
                 {"tiledesc", 9},
                 {"timecode", 8},
                 {"v2f", 8},
                 {"v2i", 8},
                 {"v2d", 16},
                 {"v3f", 12},
                 {"v3i", 12},
                 {"v3d", 24}};
    for (const auto &row : fixed)
        if (std::strcmp(type, row.type) == 0) return size == row.size;
    if (std::strcmp(type, "chlist") == 0) return channels_fit(at, size);
    if (std::strcmp(type, "floatvector") == 0) return size % 4 == 0;
    if (std::strcmp(type, "preview") == 0)
        return size >= 8 && long_at(at) < 1 << 14 && long_at(at + 4) < 1 << 14 &&
               long_at(at) * long_at(at + 4) * 4 == size - 8;
    return std::strcmp(type, "idmanifest") != 0;
}

/* Returns true if every attribute of the headers lies within the file and is read as a whole: the library allocates
 * what they claim. */
bool headers_fit(const unsigned char *data, size_t size) {
    const bool parts = size > 8 && data[5] & 0x10; /* several headers, and an empty one behind them */
    size_t at = 8;
    for (bool ended = false; at < size;) {
        const char *type = "";
        for (int text = 0; text < 2; text++) { /* name and type */
            type = reinterpret_cast<const char *>(data + at);
            const void *zero = std::memchr(data + at, 0, size - at);
            if (!zero) return false;
            const size_t length = static_cast<size_t>(static_cast<const unsigned char *>(zero) - (data + at));
            at += length + 1;
            if (text == 0 && length == 0 && (ended || !parts)) return true;
            ended = text == 0 && length == 0;
            if (ended) break;
        }
        if (ended) continue;
        if (size - at < 4) return false;
        const size_t bytes = long_at(data + at);
        at += 4;
        if (bytes > size - at || !attribute_fits(type, data + at, bytes)) return false;
        at += bytes;
    }
    return false;
}

void read(const unsigned char *data, size_t size, int part, const ExrPlanes &planes) {
    if (!headers_fit(data, size)) throw Iex::InputExc("an attribute of its header is cut off");
    MemoryStream stream(data, size);
    Imf::MultiPartInputFile file(stream, 0, false); /* no threads; a table of chunks that is not there is no image */
    Imf::InputPart input(file, part);
    const Imath::Box2i window = input.header().dataWindow();
    const size_t pixel = sizeof(float) * static_cast<size_t>(planes.count);
    const size_t line = pixel * static_cast<size_t>(planes.width);
    /* The library counts from pixel (0, 0), which need not be in the window. */
    const intptr_t origin = reinterpret_cast<intptr_t>(planes.values) - static_cast<intptr_t>(pixel) * planes.left -
                            static_cast<intptr_t>(line) * planes.top;
    Imf::FrameBuffer buffer;
    for (int c = 0; c < planes.count; c++)
        if (planes.names[c])
            buffer.insert(planes.names[c],
                          Imf::Slice(Imf::FLOAT,
                                     reinterpret_cast<char *>(origin + c * static_cast<intptr_t>(sizeof(float))), pixel,
                                     line));
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
}

} // namespace

ExrDwa exr_dwa_read(const unsigned char *data, size_t size, int part, const ExrPlanes *planes, char *reason,
                    size_t reason_size) {
    try {
        read(data, size, part, *planes);
        return EXR_DWA_READ;
    } catch (const std::bad_alloc &) {
        return EXR_DWA_MEMORY;
    } catch (const std::exception &thrown) {
        std::snprintf(reason, reason_size, "%s", thrown.what());
    } catch (...) {
        std::snprintf(reason, reason_size, "its pixels cannot be decompressed");
    }
    return EXR_DWA_DAMAGED;
}

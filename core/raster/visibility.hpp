// Which sphere is seen where.
#pragma once

#include <vector>

#include "picture.hpp"

namespace carom::raster {

// The nearest sphere at each sample of some rows, by tracing the ray through it. There are
// `view.samples` squared samples to a pixel.
class Visibility {
public:
    static constexpr int kNone = -1;

    void resize(const View& view);
    // Forgets all and looks at these rows of pixels from now on.
    void begin(Span rows);
    // Whether the sphere is seen there, for now. Fastest from near to far: then most of those that
    // others hide are passed over, and what is seen once stays seen.
    bool add(int index, F3 center, float radius);
    // The samples among which a sphere is looked for, in all of the picture, and rows of pixels.
    Bounds bounds(F3 center, float radius) const;
    Span rows(F3 center, float radius) const {
        const Span y = bounds(center, radius).y;
        return y.first > y.last ? Span{} : Span{y.first / samples_, y.last / samples_};
    }

    // Rows of samples. Depths are distances ahead times 1 + x² + y² of the ray (x, y, 1).
    const int* ids(int row) const { return &ids_[size_t(row - rows_.first) * stride_]; }
    const float* depths(int row) const { return &depths_[size_t(row - rows_.first) * stride_]; }

    // The samples of each pixel of a row in which no sphere is seen, and whether it sees nothing
    // else than one sphere or none.
    void open(int row, uint8_t* open, uint8_t* whole) const;

    // Whether spheres cover all of a pixel.
    bool covered(int i, int j, int samples) const {
        int none = 0;
        for (int row = samples * j; row < samples * (j + 1); ++row)
            for (int k = samples * i; k < samples * (i + 1); ++k) none |= int(ids(row)[k] == kNone);
        return !none;
    }

private:
    bool is_hidden(const Bounds& bounds, float distance) const;
    float drawn_radius(F3 center, float radius) const;

    static constexpr int kLanes = 8;  // samples to a step of the loop; rows are padded to it

    View view_;  // with samples as pixels
    int samples_ = 1;
    int stride_ = 0;
    Span rows_;  // of samples
    std::vector<float> depths_;
    std::vector<int> ids_;
};

}  // namespace carom::raster

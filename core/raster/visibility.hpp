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
    // Forgets all and looks at these pixels from now on.
    void begin(Span columns, Span rows);
    // Whether the sphere is seen there, for now. Fastest from near to far: then most of those that
    // others hide are passed over, and what is seen once stays seen.
    bool add(int index, const Ball& ball);
    // The samples among which a sphere is looked for, in all of the picture.
    Bounds bounds(F3 center, float radius) const;

    // Rows of samples. Depths are distances ahead times 1 + x² + y² of the ray (x, y, 1).
    const int* ids(int row) const { return &ids_[size_t(row - rows_.first) * stride_]; }
    const float* depths(int row) const { return &depths_[size_t(row - rows_.first) * stride_]; }

    // The samples of some pixels of a row in which no sphere is seen, and whether each sees nothing
    // else than one sphere or none.
    void open(int row, Span columns, uint8_t* open, uint8_t* whole) const;

    // Whether spheres cover all of kLanes pixels from the i-th on, of a row.
    bool covered(int i, int row) const {
        int all = 0;  // below 0 if one is
        for (int at = samples_ * row; at < samples_ * (row + 1); ++at) {
            const int* id = ids(at) + samples_ * i;
            for (int part = 0; part < samples_; ++part, id += kLanes)
                for (int k = 0; k < kLanes; ++k) all |= id[k];
        }
        return all >= 0;
    }

private:
    bool is_hidden(const Bounds& bounds, float distance) const;
    float drawn_radius(F3 center, float radius) const;

    View view_;  // with samples as pixels
    int samples_ = 1;
    int stride_ = 0;
    Span rows_;  // of samples
    std::vector<float> depths_;
    std::vector<int> ids_;
};

}  // namespace carom::raster

// Which sphere is seen where.
#pragma once

#include <vector>

#include "picture.hpp"

namespace carom::raster {

// The nearest sphere at each sample, by tracing the ray through it. There are `view.samples`
// squared samples to a pixel.
class Visibility {
public:
    static constexpr int kNone = -1;

    void resize(const View& view);
    void clear();
    // Fastest from near to far: then most of those that others hide are passed over.
    void add(int index, F3 center, float radius);

    // Rows of samples. Depths are distances ahead times 1 + x² + y² of the ray (x, y, 1).
    const int* ids(int row) const { return &ids_[size_t(row) * stride_]; }
    const float* depths(int row) const { return &depths_[size_t(row) * stride_]; }

    // Whether spheres cover all of a pixel.
    bool covered(int i, int j, int samples) const {
        int none = 0;
        for (int row = samples * j; row < samples * (j + 1); ++row)
            for (int k = samples * i; k < samples * (i + 1); ++k) none |= int(ids(row)[k] == kNone);
        return !none;
    }

    // Which of n spheres are seen anywhere.
    std::vector<uint8_t> seen(int n) const {
        std::vector<uint8_t> seen(n + 1);
        for (const int id : ids_) seen[id + 1] = 1;
        seen.erase(seen.begin());
        return seen;
    }

private:
    bool is_hidden(const Bounds& bounds, float distance) const;

    static constexpr int kLanes = 8;  // samples to a step of the loop; rows are padded to it

    View view_;  // with samples as pixels
    int stride_ = 0;
    std::vector<float> depths_;
    std::vector<int> ids_;
};

}  // namespace carom::raster

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
    void add(int index, F3 center, float radius);

    // Rows of samples. Depths are distances ahead times 1 + x² + y² of the ray (x, y, 1).
    const int* ids(int row) const { return &ids_[size_t(row) * stride_]; }
    const float* depths(int row) const { return &depths_[size_t(row) * stride_]; }

private:
    static constexpr int kLanes = 8;  // samples to a step of the loop; rows are padded to it

    View view_;  // with samples as pixels
    int stride_ = 0;
    std::vector<float> depths_;
    std::vector<int> ids_;
};

}  // namespace carom::raster

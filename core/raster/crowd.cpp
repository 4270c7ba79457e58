#include "crowd.hpp"

#include <algorithm>
#include <cmath>

namespace carom::raster {

namespace {

constexpr int kMost = 24;  // cells along an axis
// Shares of the light from the sky, the ground, and the four sides.
constexpr float kAbove = 0.4f, kBelow = 0.08f, kSide = 0.13f;
constexpr float kGentle = 0.7f;  // power of the light, for its many reflections
constexpr float kLeak = 0.55f;   // of what hides light; the rest finds its way round
constexpr double kPi = 3.14159265358979323846;

}  // namespace

Crowd::Crowd(const Vec3& low, const Vec3& high, double cell, const Vec3& up) {
    const double l[3] = {low.x, low.y, low.z}, h[3] = {high.x, high.y, high.z};
    const double u[3] = {up.x, up.y, up.z};
    axis_ = 0;
    for (int k = 0; k < 3; ++k) {
        low_[k] = l[k];
        size_[k] = std::max(h[k] - l[k], 1e-9);
        cells_[k] = int(std::clamp(std::round(size_[k] / cell), 2.0, double(kMost)));
        per_[k] = cells_[k] / size_[k];
        if (std::abs(u[k]) > std::abs(u[axis_])) axis_ = k;
    }
    upwards_ = u[axis_] > 0;
    const size_t all = size_t(cells_[0]) * cells_[1] * cells_[2];
    hidden_.resize(all), light_.resize(all), passed_.resize(all);
}

void Crowd::fill(const std::vector<Vec3>& position, const std::vector<double>& radius, size_t n) {
    spread(position, radius, n);
    std::fill(light_.begin(), light_.end(), 0.0f);
    float before = 0;
    for (int k = 0; k < 3; ++k) {
        const float step = kLeak * float(size_[k]) / float(cells_[k]);
        for (size_t c = 0; c < hidden_.size() && step != before; ++c)
            passed_[c] = std::exp(-0.5f * step * hidden_[c]);  // half a cell
        before = step;
        sweep(k, true, k != axis_ ? kSide : upwards_ ? kBelow : kAbove);
        sweep(k, false, k != axis_ ? kSide : upwards_ ? kAbove : kBelow);
    }
    // The best-lit place counts as fully lit, and what is near it too.
    const float most = std::max(*std::max_element(light_.begin(), light_.end()), 1e-9f);
    for (float& light : light_) light = std::min(1.0f, 1.15f * std::pow(light / most, kGentle));
}

void Crowd::spread(const std::vector<Vec3>& position, const std::vector<double>& radius, size_t n) {
    std::fill(hidden_.begin(), hidden_.end(), 0.0f);
    for (size_t i = 0; i < n; ++i) {
        const double x[3] = {position[i].x, position[i].y, position[i].z};
        const double area = kPi * radius[i] * radius[i] * per_[0] * per_[1] * per_[2];
        int cell[3];
        double far[3];
        for (int k = 0; k < 3; ++k) {
            const double at = std::clamp((x[k] - low_[k]) * per_[k] - 0.5, 0.0, cells_[k] - 1.001);
            cell[k] = int(at);
            far[k] = at - cell[k];
        }
        for (int bits = 0; bits < 8; ++bits) {  // shared out among the eight cells around it
            double part = area;
            size_t at = 0;
            for (int k = 2; k >= 0; --k) {
                const int next = bits >> k & 1;
                part *= next ? far[k] : 1 - far[k];
                at = at * cells_[k] + cell[k] + next;
            }
            hidden_[at] += float(part);
        }
    }
}

void Crowd::sweep(int axis, bool forward, float share) {
    const int stride[3] = {1, cells_[0], cells_[0] * cells_[1]};
    const int a = (axis + 1) % 3, b = (axis + 2) % 3, n = cells_[axis];
    for (int i = 0; i < cells_[a]; ++i) {
        for (int j = 0; j < cells_[b]; ++j) {
            float through = share;
            for (int k = 0; k < n; ++k) {
                const int c =
                    i * stride[a] + j * stride[b] + (forward ? k : n - 1 - k) * stride[axis];
                through *= passed_[c];
                light_[c] += through;
                through *= passed_[c];
            }
        }
    }
}

// Eight places in one go: both ends of each axis, and twice the middle.
CAROM_WIDE Crowd::Light Crowd::about(F3 center, float far, const View& view) const {
    constexpr float side[3][kLanes] = {
        {-1, 1, 0, 0, 0, 0, 0, 0}, {0, 0, -1, 1, 0, 0, 0, 0}, {0, 0, 0, 0, -1, 1, 0, 0}};
    const Vec3 place = view.eye + view.right * double(center.x) + view.up * double(center.y) +
                       view.forward * double(center.z);
    const float x[3] = {float(place.x), float(place.y), float(place.z)};
    const int row = cells_[0], layer = cells_[0] * cells_[1];
    const int stride[3] = {1, row, layer};
    int first[kLanes] = {};
    float beyond[3][kLanes], left[kLanes];
    for (int k = 0; k < 3; ++k) {
        const float per = float(per_[k]), step = far * per;
        const float middle = (x[k] - float(low_[k])) * per - 0.5f;
        const float most = float(cells_[k]) - 1.001f;
        for (int lane = 0; lane < kLanes; ++lane) {
            const float at = clamp(middle + side[k][lane] * step, 0, most);
            const int cell = int(at);
            first[lane] += cell * stride[k];
            beyond[k][lane] = at - float(cell);
        }
    }
    const float* const light = light_.data();
    for (int lane = 0; lane < kLanes; ++lane) {
        const auto along = [&](int at) {
            return light[at] + (light[at + 1] - light[at]) * beyond[0][lane];
        };
        const auto across = [&](int at) {
            const float near_row = along(at);
            return near_row + (along(at + row) - near_row) * beyond[1][lane];
        };
        const float near_layer = across(first[lane]);
        left[lane] = near_layer + (across(first[lane] + layer) - near_layer) * beyond[2][lane];
    }
    return {left[7],
            view.direction({0.5 * double(left[1] - left[0]), 0.5 * double(left[3] - left[2]),
                            0.5 * double(left[5] - left[4])})};
}

}  // namespace carom::raster

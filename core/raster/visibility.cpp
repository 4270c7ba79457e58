#include "visibility.hpp"

#include <algorithm>
#include <limits>

namespace carom::raster {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

// Where the outline of a sphere lies along one axis of the picture: the two rays at distance 1
// that touch it. a: its place along that axis, z: ahead; needs z > radius.
void outline(float a, float z, float radius, float& low, float& high) {
    const float bottom = 1 / ((z - radius) * (z + radius));
    const float root = radius * std::sqrt(std::max(a * a + (z - radius) * (z + radius), 0.0f));
    low = (a * z - root) * bottom;
    high = (a * z + root) * bottom;
}

}  // namespace

Bounds around(const View& view, F3 c, float radius, float more) {
    const Bounds all{{0, view.width - 1}, {0, view.height - 1}};
    if (c.z <= 1.05f * radius) return all;
    float left, right, bottom, top;
    outline(c.x, c.z, radius, left, right);
    outline(c.y, c.z, radius, bottom, top);
    const float per = 1 / float(view.pixel);
    const float x = 0.5f * float(view.width) - 0.5f, y = 0.5f * float(view.height) - 0.5f;
    return {span(left * per + x - more, right * per + x + more, view.width),
            span(y - top * per - more, y - bottom * per + more, view.height)};
}

void Visibility::resize(const View& view) {
    view_ = view;
    samples_ = view.samples;
    view_.width *= view.samples;
    view_.height *= view.samples;
    view_.pixel /= view.samples;
    stride_ = samples_ * (view.width + kLanes);
}

void Visibility::begin(Span columns, Span rows) {
    rows_ = {samples_ * rows.first, samples_ * rows.last + samples_ - 1};
    const size_t all = size_t(stride_) * (rows_.last - rows_.first + 1);
    depths_.resize(all);
    ids_.resize(all);
    const int first = samples_ * columns.first;
    const int count = samples_ * (columns.last + 1 + kLanes) - first;
    for (size_t at = first; at < all; at += stride_) {
        std::fill_n(&depths_[at], count, kFar);
        std::fill_n(&ids_[at], count, kNone);
    }
}

// Whether all samples around something see what is nearer. distance: that of its nearest point.
CAROM_WIDE bool Visibility::is_hidden(const Bounds& bounds, float distance) const {
    const auto least = [](float a, float b) {  // distance of an interval from 0
        return a * b <= 0 ? 0 : std::min(std::abs(a), std::abs(b));
    };
    const float x = least(view_.ray_x(float(bounds.x.first)), view_.ray_x(float(bounds.x.last)));
    const float y = least(view_.ray_y(float(bounds.y.first)), view_.ray_y(float(bounds.y.last)));
    const float nearest = distance * std::sqrt(1 + x * x + y * y);  // a depth: distance times |ray|
    for (int row = bounds.y.first; row <= bounds.y.last; ++row) {
        const float* const depth = depths(row);
        int open = 0;
        for (int k = bounds.x.first; k <= bounds.x.last; ++k) open |= int(depth[k] > nearest);
        if (open) return false;
    }
    return true;
}

// At least a sample large, or small spheres would come and go.
float Visibility::drawn_radius(F3 c, float radius) const {
    return std::max(radius, 0.6f * float(view_.pixel) * c.z);
}

Bounds Visibility::bounds(F3 c, float radius) const {
    return around(view_, c, drawn_radius(c, radius), 0);
}

// With the ray d = (x, y, 1) and its difference e to the ray through the centre c, the ray meets
// the sphere where t d² = d·c - sqrt(d² r² - |e × c|²). That root has no small difference of
// large numbers in it, so single precision will do. All is divided by c.z.
CAROM_WIDE bool Visibility::add(int index, const Ball& ball) {
    const F3 c = ball.center;
    const float radius = ball.radius;
    if (c.z <= 0.02f * radius || dot(c, c) <= 1.02f * radius * radius) return false;
    const float pixel = float(view_.pixel);
    const float r = drawn_radius(c, radius) / c.z, r2 = r * r;
    const float x0 = c.x / c.z, y0 = c.y / c.z;
    const Bounds bounds{ball.samples.x, common(ball.samples.y, rows_)};
    if (is_hidden(bounds, std::sqrt(dot(c, c)) - r * c.z)) return false;
    // A narrow sphere is not worth it, and a large one's outline need not be an ellipse.
    const bool narrowed = bounds.x.last - bounds.x.first >= 4 * kLanes && r < 0.95f;
    const float middle = 0.5f * float(view_.width) - 0.5f;
    const float p2 = r2 - 1 - y0 * y0;
    const float per_root = -1 / (p2 * pixel), at_x0 = x0 / pixel + middle;
    int any[kLanes] = {};
    for (int row = bounds.y.first; row <= bounds.y.last; ++row) {
        const float y = view_.ray_y(float(row)), dy = y - y0;
        const float p1 = r2 * x0 + x0 * y0 * dy;
        const float p0 = r2 * (1 + y * y + x0 * x0) - dy * dy * (1 + x0 * x0);
        Span s = bounds.x;
        if (narrowed) {
            const float inside = p1 * p1 - p2 * p0;
            if (inside < 0) continue;
            const float at = p1 * per_root + at_x0, half = std::sqrt(inside) * per_root;
            s = common(s, span(at - half, at + half, view_.width));
        }
        float* depth = &depths_[size_t(row - rows_.first) * stride_ + s.first];
        int* id = &ids_[size_t(row - rows_.first) * stride_ + s.first];
        const float ahead = 1 + x0 * x0 + y * y0, begin = (float(s.first) - middle) * pixel - x0;
        for (int k = 0; s.first + k <= s.last; k += kLanes, depth += kLanes, id += kLanes) {
            for (int lane = 0; lane < kLanes; ++lane) {
                const float dx = begin + float(k + lane) * pixel;
                const float square = (p2 * dx + 2 * p1) * dx + p0;
                const float t = c.z * (ahead + x0 * dx - std::sqrt(std::abs(square)));
                // Bits and no choices, which would keep compilers from making vectors of the loop.
                const int hit = -(int(square >= 0) & int(t > 0) & int(t < depth[lane]));
                id[lane] = (index & hit) | (id[lane] & ~hit);
                depth[lane] = hit ? t : depth[lane];
                any[lane] |= hit;
            }
        }
    }
    int all = 0;
    for (const int lane : any) all |= lane;
    return all;
}

CAROM_WIDE void Visibility::open(int row, Span columns, uint8_t* __restrict open,
                                 uint8_t* __restrict whole) const {
    const int n = columns.last - columns.first + 1;
    if (samples_ == 1) {
        const int* const id = ids(row) + columns.first;
        for (int i = 0; i < n; ++i) open[i] = id[i] == kNone, whole[i] = 1;
        return;
    }
    const int* const upper = ids(2 * row) + 2 * columns.first;
    const int* const lower = ids(2 * row + 1) + 2 * columns.first;
    for (int i = 0; i < n; ++i) {
        const int a = upper[2 * i], b = upper[2 * i + 1], c = lower[2 * i], d = lower[2 * i + 1];
        open[i] = uint8_t((a == kNone) + (b == kNone) + (c == kNone) + (d == kNone));
        whole[i] = uint8_t(int(a == b) & int(a == c) & int(a == d));
    }
}

}  // namespace carom::raster

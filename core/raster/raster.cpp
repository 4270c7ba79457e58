#include "raster.hpp"

#include <algorithm>

#include "wire.hpp"

namespace carom::raster {

namespace {

// Bytes of the rows that are drawn at once: they stay in the processor's cache then.
constexpr int kBand = 1 << 20;

// Parts from 0 to 1 as levels from 0 to 255.
CAROM_WIDE void levels(const std::vector<float>& rgb, uint8_t* bytes) {
    const float* __restrict const from = rgb.data();
    uint8_t* __restrict const to = bytes;
    const size_t n = rgb.size();
    for (size_t k = 0; k < n; ++k) to[k] = uint8_t(int(clamp(from[k]) * 255 + 0.5f));
}

}  // namespace

Raster::Raster(const View& view, const Look& look, Room room)
    : view_(view), look_(look), room_(std::move(room)), shading_(view, look) {
    seen_.resize(view);
    const int per_row = view.width * (12 + 8 * view.samples * view.samples);
    band_ = std::clamp(kBand / per_row, 4, view.height > 4 ? view.height : 4);
    still_.resize(view.width, {0, view.height - 1});
    for (size_t k = 0; k < still_.rgb.size(); k += 3) {
        still_.rgb[k] = look.back.x;
        still_.rgb[k + 1] = look.back.y;
        still_.rgb[k + 2] = look.back.z;
    }
    for (const Face& face : room_.faces) {
        walls_.emplace_back(view, look, face);
        walls_.back().paint(still_);
    }
    for (const double radius : room_.shells) draw_shell(view, look, radius, Half::far, still_);
}

void Raster::place(const std::vector<Vec3>& position, const std::vector<double>& radius,
                   const std::vector<uint32_t>& color) {
    const int n = int(position.size());
    order_.resize(n);
    for (int i = 0; i < n; ++i)
        order_[i] = {float(norm2(position[i] - view_.eye) - radius[i] * radius[i]), i};
    if (!look_.wire) std::sort(order_.begin(), order_.end());  // wires keep their own order
    balls_.resize(n);
    for (int k = 0; k < n; ++k) {
        const int i = order_[k].second;
        const auto part = [&](int shift) { return float(color[i] >> shift & 255) / 255; };
        Ball& ball = balls_[k];
        ball = {view_.place(position[i]),    float(radius[i]), {}, 1, {},
                {part(16), part(8), part(0)}};
        ball.skin = ball.color * ball.color;
    }
}

// Spheres by the bands of rows in which they may be seen, from near to far in each.
void Raster::sort_into_bands() {
    const int bands = (view_.height + band_ - 1) / band_;
    starts_.assign(bands + 1, 0);
    const auto each = [&](auto&& use) {
        for (size_t k = 0; k < balls_.size(); ++k) {
            const Span rows = seen_.rows(balls_[k].center, balls_[k].radius);
            if (rows.first > rows.last) continue;
            for (int band = rows.first / band_; band <= rows.last / band_; ++band)
                use(band, int(k));
        }
    };
    each([&](int band, int) { ++starts_[band + 1]; });
    for (int band = 0; band < bands; ++band) starts_[band + 1] += starts_[band];
    inside_.resize(starts_.back());
    std::vector<int> next(starts_.begin(), starts_.end() - 1);
    each([&](int band, int k) { inside_[next[band]++] = k; });
}

// Light left for a sphere, of the lamp and in the crowd; asked once, when it is first seen.
void Raster::shade(int k, const Vec3& x, double radius) {
    if (shaded_[k]) return;
    shaded_[k] = 1;
    if (look_.shadows) casters_.ask(k, balls_, look_);
    if (!crowd_) return;
    // On the surface it is looked up a little outside: in proportion between both ends.
    const double far = 1.8 * radius;
    const auto slope = [&](const Vec3& step) {
        return 0.5 * double(crowd_->left(x + step) - crowd_->left(x - step));
    };
    balls_[k].left = crowd_->left(x);
    balls_[k].left_slope =
        view_.direction({slope({far, 0, 0}), slope({0, far, 0}), slope({0, 0, far})});
}

// Takes away what lies behind spheres, of pixels that are painted part by part.
void Raster::uncover() {
    if (view_.samples == 1) return;
    std::vector<uint8_t> open(view_.width), whole(view_.width);
    for (int row = frame_.rows.first; row <= frame_.rows.last; ++row) {
        seen_.open(row, open.data(), whole.data());
        float* const pixels = frame_.row(row);
        for (int i = 0; i < view_.width; ++i) {
            if (whole[i]) continue;
            for (int c = 0; c < 3; ++c) pixels[3 * i + c] *= 0.25f * float(open[i]);
        }
    }
}

void Raster::paint(int band, const std::vector<Vec3>& position, const std::vector<double>& radius) {
    const Span rows{band * band_, std::min((band + 1) * band_, view_.height) - 1};
    frame_.resize(view_.width, rows);
    std::copy_n(still_.row(rows.first), frame_.rgb.size(), frame_.rgb.data());
    seen_.begin(rows);
    if (!look_.wire && !balls_.empty()) {
        visible_.clear();
        for (int at = starts_[band]; at < starts_[band + 1]; ++at) {
            const int k = inside_[at];
            if (!seen_.add(k, balls_[k].center, balls_[k].radius)) continue;
            visible_.push_back(k);
            shade(k, position[order_[k].second], radius[order_[k].second]);
        }
        for (const Wall& wall : walls_) wall.darken(seen_, frame_);
        uncover();
        shading_.paint(seen_, visible_, balls_, casters_, frame_);
    }
    for (const Edge& edge : room_.edges) carom::raster::draw(view_, look_, edge, seen_, frame_);
    if (look_.wire)
        for (const Ball& ball : balls_) draw_wires(view_, look_, ball, frame_);
    for (const double shell : room_.shells) draw_shell(view_, look_, shell, Half::near, frame_);
}

void Raster::draw(const std::vector<Vec3>& position, const std::vector<double>& radius,
                  const std::vector<uint32_t>& color, size_t own, uint8_t* bytes) {
    const std::lock_guard lock(busy_);
    place(position, radius, color);
    sort_into_bands();
    shaded_.assign(balls_.size(), 0);
    crowd_.reset();
    casters_.clear();
    if (!look_.wire && !balls_.empty()) {
        if (look_.crowd_cell > 0)
            crowd_.emplace(look_.low, look_.high, look_.crowd_cell, look_.up)
                .fill(position, radius, own);
        if (look_.shadows) casters_.begin(balls_, look_, view_.direction(look_.lamp));
        for (Wall& wall : walls_) wall.light(balls_);
    }
    for (int band = 0; band * band_ < view_.height; ++band) {
        paint(band, position, radius);
        levels(frame_.rgb, bytes + size_t(3) * view_.width * frame_.rows.first);
    }
}

}  // namespace carom::raster

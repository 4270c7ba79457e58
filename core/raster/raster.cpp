#include "raster.hpp"

#include <algorithm>

#include "wire.hpp"

namespace carom::raster {

namespace {

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
    still_.resize(view.width, view.height);
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
                   const std::vector<uint32_t>& color, size_t own) {
    const int n = int(position.size());
    order_.resize(n);
    for (int i = 0; i < n; ++i)
        order_[i] = {float(norm2(position[i] - view_.eye) - radius[i] * radius[i]), i};
    if (!look_.wire) std::sort(order_.begin(), order_.end());  // wires keep their own order
    const bool crowded = look_.crowd_cell > 0 && n > 0;
    Crowd crowd(look_.low, look_.high, crowded ? look_.crowd_cell : 1, look_.up);
    if (crowded) crowd.fill(position, radius, own);
    balls_.resize(n);
    for (int k = 0; k < n; ++k) {
        const int i = order_[k].second;
        const Vec3& x = position[i];
        const auto part = [&](int shift) { return float(color[i] >> shift & 255) / 255; };
        Ball& ball = balls_[k];
        ball = {view_.place(x), float(radius[i]), {}, 1, {}, {part(16), part(8), part(0)}};
        ball.skin = ball.color * ball.color;
        if (!crowded) continue;
        // On the surface it is looked up a little outside: in proportion between both ends.
        const double far = 1.8 * radius[i];
        const auto slope = [&](const Vec3& step) {
            return 0.5 * double(crowd.left(x + step) - crowd.left(x - step));
        };
        ball.left = crowd.left(x);
        ball.left_slope =
            view_.direction({slope({far, 0, 0}), slope({0, far, 0}), slope({0, 0, far})});
    }
}

void Raster::draw(const std::vector<Vec3>& position, const std::vector<double>& radius,
                  const std::vector<uint32_t>& color, size_t own, uint8_t* bytes) {
    const std::lock_guard lock(busy_);
    place(position, radius, color, own);
    frame_ = still_;
    seen_.clear();
    if (!look_.wire && !balls_.empty()) {
        for (size_t i = 0; i < balls_.size(); ++i)
            seen_.add(int(i), balls_[i].center, balls_[i].radius);
        for (Wall& wall : walls_) wall.darken(balls_, seen_, frame_);
        casters_.clear();
        if (look_.shadows)
            casters_.find(balls_, seen_.seen(int(balls_.size())), look_,
                          view_.direction(look_.lamp));
        shading_.paint(seen_, balls_, casters_, frame_);
    }
    for (const Edge& edge : room_.edges) carom::raster::draw(view_, look_, edge, seen_, frame_);
    if (look_.wire)
        for (const Ball& ball : balls_) draw_wires(view_, look_, ball, frame_);
    for (const double radius_ : room_.shells) draw_shell(view_, look_, radius_, Half::near, frame_);
    levels(frame_.rgb, bytes);
}

}  // namespace carom::raster

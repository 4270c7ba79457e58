#include "raster.hpp"

#include <algorithm>

#include "wire.hpp"

namespace carom::raster {

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
                   const std::vector<uint32_t>& color) {
    balls_.resize(position.size());
    for (size_t i = 0; i < balls_.size(); ++i) {
        const auto part = [&](int shift) { return float(color[i] >> shift & 255) / 255; };
        Ball& ball = balls_[i];
        ball = {view_.place(position[i]),    float(radius[i]), {}, 1, {},
                {part(16), part(8), part(0)}};
        ball.skin = ball.color * ball.color;
    }
    if (look_.crowd_cell <= 0) return;
    Crowd crowd(look_.low, look_.high, look_.crowd_cell, look_.up);
    crowd.fill(position, radius);
    for (size_t i = 0; i < balls_.size(); ++i) {
        // On the surface it is looked up a little outside: in proportion between both ends.
        const double far = 1.8 * radius[i];
        const Vec3& x = position[i];
        const auto slope = [&](const Vec3& step) {
            return 0.5 * double(crowd.left(x + step) - crowd.left(x - step));
        };
        balls_[i].left = crowd.left(x);
        balls_[i].left_slope =
            view_.direction({slope({far, 0, 0}), slope({0, far, 0}), slope({0, 0, far})});
    }
}

void Raster::draw(const std::vector<Vec3>& position, const std::vector<double>& radius,
                  const std::vector<uint32_t>& color, uint8_t* bytes) {
    const std::lock_guard lock(busy_);
    place(position, radius, color);
    frame_ = still_;
    seen_.clear();
    if (!look_.wire && !balls_.empty()) {
        for (Wall& wall : walls_) wall.darken(balls_, frame_);
        for (size_t i = 0; i < balls_.size(); ++i)
            seen_.add(int(i), balls_[i].center, balls_[i].radius);
        casters_.clear();
        if (look_.shadows) casters_.find(balls_, look_, view_.direction(look_.lamp));
        shading_.paint(seen_, balls_, casters_, frame_);
    }
    for (const Edge& edge : room_.edges) carom::raster::draw(view_, look_, edge, seen_, frame_);
    if (look_.wire)
        for (const Ball& ball : balls_) draw_wires(view_, look_, ball, frame_);
    for (const double radius_ : room_.shells) draw_shell(view_, look_, radius_, Half::near, frame_);
    const float* const parts = frame_.rgb.data();
    for (size_t k = 0; k < frame_.rgb.size(); ++k)
        bytes[k] = uint8_t(int(clamp(parts[k]) * 255 + 0.5f));
}

}  // namespace carom::raster

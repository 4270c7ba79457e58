#include "raster.hpp"

#include <algorithm>

#include "../memory.hpp"
#include "wire.hpp"

namespace carom::raster {

namespace {

// Bytes of the rows that are drawn at once: they stay in the processor's cache then.
constexpr int kBand = 1 << 20;
// Spheres ahead of the one that is drawn, whose lines of memory are asked for.
constexpr int kAhead = 6;

// Parts from 0 to 1 as levels from 0 to 255.
CAROM_WIDE void levels(const float* __restrict from, int n, uint8_t* __restrict to) {
    for (int k = 0; k < n; ++k) to[k] = uint8_t(int(clamp(from[k]) * 255 + 0.5f));
}

}  // namespace

Raster::Raster(const View& view, const Look& look, Room room)
    : view_(view), look_(look), room_(std::move(room)), shading_(view, look) {
    seen_.resize(view);
    const int per_row = view.width * (12 + 8 * view.samples * view.samples);
    band_ = std::clamp(kBand / per_row, 4, view.height > 4 ? view.height : 4);
    still_.resize(view.width, {0, view.height - 1});
    frame_.resize(view.width, {0, band_ - 1});
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
    if (!room_.shells.empty()) {  // white over black: how much they hide
        veil_.resize(view.width, still_.rows);
        Look white = look;
        white.shell = {1, 1, 1};
        for (const double radius : room_.shells) draw_shell(view, white, radius, Half::near, veil_);
    }
    std::vector<uint8_t> bytes(size_t(3) * view.width * view.height);
    for (int band = 0; band * band_ < view.height; ++band) paint(band, bytes.data());
    empty_ = std::move(bytes);
}

// From near to far, but for those that share one of about n places: nearly is good enough, because
// it only saves work. Wires keep their own order.
void Raster::order(const std::vector<Vec3>& position, const std::vector<double>& radius) {
    const int n = int(position.size());
    order_.resize(n);
    if (look_.wire || n == 0) {
        for (int i = 0; i < n; ++i) order_[i] = i;
        return;
    }
    distance_.resize(n);
    for (int i = 0; i < n; ++i)
        distance_[i] = float(norm2(position[i] - view_.eye) - radius[i] * radius[i]);
    const auto [near, far] = std::minmax_element(distance_.begin(), distance_.end());
    const float low = *near, per = float(n) / std::max(*far - low, 1e-30f);
    const auto place = [&](int i) {
        return int(clamp((distance_[i] - low) * per, 0, float(n - 1)));
    };
    starts_.assign(n + 1, 0);
    for (int i = 0; i < n; ++i) ++starts_[place(i) + 1];
    for (int k = 0; k < n; ++k) starts_[k + 1] += starts_[k];
    for (int i = 0; i < n; ++i) order_[starts_[place(i)]++] = i;
}

void Raster::place(const std::vector<Vec3>& position, const std::vector<double>& radius,
                   const std::vector<uint32_t>& color) {
    const int n = int(position.size());
    order(position, radius);
    balls_.resize(n), skins_.resize(n);
    for (int k = 0; k < n; ++k) {
        const int i = order_[k];
        const auto part = [&](int shift) { return float(color[i] >> shift & 255) / 255; };
        Ball& ball = balls_[k];
        ball.center = view_.place(position[i]);
        ball.radius = float(radius[i]);
        ball.samples = seen_.bounds(ball.center, ball.radius);
        skins_[k] = {};
        skins_[k].color = {part(16), part(8), part(0)};
    }
}

Span Raster::rows_of(int band) const {
    return {band * band_, std::min((band + 1) * band_, view_.height) - 1};
}

// Spheres by the bands of rows in which they may be seen, from near to far in each.
void Raster::sort_into_bands() {
    const int bands = (view_.height + band_ - 1) / band_;
    starts_.assign(bands + 1, 0);
    columns_.assign(bands, {});
    const auto each = [&](auto&& use) {
        for (size_t k = 0; k < balls_.size(); ++k) {
            const Span rows = balls_[k].samples.y;
            if (rows.empty()) continue;
            const int per = view_.samples * band_;
            for (int band = rows.first / per; band <= rows.last / per; ++band) use(band, int(k));
        }
    };
    each([&](int band, int k) {
        ++starts_[band + 1];
        columns_[band] = together(columns_[band], balls_[k].samples.x);
    });
    for (int band = 0; band < bands; ++band) {
        starts_[band + 1] += starts_[band];
        columns_[band] = columns_[band].empty() ? Span{}
                                                : Span{columns_[band].first / view_.samples,
                                                       columns_[band].last / view_.samples};
    }
    inside_.resize(starts_.back());
    std::vector<int> next(starts_.begin(), starts_.end() - 1);
    each([&](int band, int k) { inside_[next[band]++] = k; });
}

// Light left for a sphere in the crowd; asked once, when it is first seen.
void Raster::shade(int k) {
    Skin& skin = skins_[k];
    if (!crowd_ || skin.asked) return;
    skin.asked = true;
    // On the surface it is looked up a little outside: in proportion between both ends.
    const Crowd::Light light = crowd_->about(balls_[k].center, 1.8f * balls_[k].radius, view_);
    skin.left = light.left, skin.slope = light.slope;
}

// Takes away what lies behind spheres, of pixels that are painted part by part.
void Raster::uncover() {
    if (view_.samples == 1) return;
    const Span columns = frame_.columns;
    const int n = columns.last - columns.first + 1;
    std::vector<uint8_t> open(n), whole(n);
    for (int row = frame_.rows.first; row <= frame_.rows.last; ++row) {
        seen_.open(row, columns, open.data(), whole.data());
        float* const pixels = frame_.row(row) + 3 * columns.first;
        for (int i = 0; i < n; ++i) {
            if (whole[i]) continue;
            for (int c = 0; c < 3; ++c) pixels[3 * i + c] *= 0.25f * float(open[i]);
        }
    }
}

// The near halves of spherical walls.
void Raster::draw_veil() {
    if (room_.shells.empty()) return;
    for (int row = frame_.rows.first; row <= frame_.rows.last; ++row) {
        const float* const alpha = veil_.row(row);
        float* const pixels = frame_.row(row);
        for (int i = frame_.columns.first; i <= frame_.columns.last; ++i)
            blend(pixels + 3 * i, look_.shell, alpha[3 * i]);
    }
}

// The columns of a band that differ from the picture without spheres.
Span Raster::columns_of(int band) const {
    if (look_.wire || empty_.empty()) return {0, view_.width - 1};
    Span columns = columns_[band];
    for (const Wall& wall : walls_)
        if (!common(wall.darkened().y, rows_of(band)).empty())
            columns = together(columns, wall.darkened().x);
    return columns;
}

// What is the same in the picture without spheres.
void Raster::copy_beside(uint8_t* bytes) const {
    if (empty_.empty()) return;
    const int from = 3 * frame_.columns.first, to = 3 * (frame_.columns.last + 1);
    const int all = 3 * view_.width;
    for (int row = frame_.rows.first; row <= frame_.rows.last; ++row) {
        const size_t at = size_t(all) * row;
        std::copy_n(&empty_[at], from, bytes + at);
        std::copy_n(empty_.data() + at + to, all - to, bytes + at + to);
    }
}

void Raster::paint(int band, uint8_t* bytes) {
    frame_.rows = rows_of(band);
    frame_.columns = columns_of(band);
    copy_beside(bytes);
    if (frame_.columns.empty()) return;
    const int from = 3 * frame_.columns.first, count = 3 * (frame_.columns.last + 1) - from;
    for (int row = frame_.rows.first; row <= frame_.rows.last; ++row)
        std::copy_n(still_.row(row) + from, count, frame_.row(row) + from);
    seen_.begin(frame_.columns, frame_.rows);
    if (!look_.wire && !balls_.empty()) {
        visible_.clear();
        const int end = starts_[band + 1];
        for (int at = starts_[band]; at < end; ++at) {
            const int k = inside_[at];
            const int ahead = inside_[std::min(at + kAhead, end - 1)];
            fetch(&balls_[ahead]), fetch(&skins_[ahead]);
            if (!seen_.add(k, balls_[k])) continue;
            visible_.push_back(k);
            shade(k);
        }
        for (const Wall& wall : walls_) wall.darken(seen_, frame_);
        uncover();
        shading_.paint(seen_, visible_, balls_, skins_, casters_, frame_);
    }
    for (const Edge& edge : room_.edges) carom::raster::draw(view_, look_, edge, seen_, frame_);
    if (look_.wire)
        for (size_t k = 0; k < balls_.size(); ++k)
            draw_wires(view_, look_, balls_[k], skins_[k].color, frame_);
    draw_veil();
    for (int row = frame_.rows.first; row <= frame_.rows.last; ++row)
        levels(frame_.row(row) + from, count, bytes + size_t(3) * view_.width * row + from);
}

void Raster::draw(const std::vector<Vec3>& position, const std::vector<double>& radius,
                  const std::vector<uint32_t>& color, size_t own, uint8_t* bytes) {
    const std::lock_guard lock(busy_);
    place(position, radius, color);
    sort_into_bands();
    crowd_.reset();
    casters_.clear();
    if (!look_.wire && !balls_.empty()) {
        if (look_.crowd_cell > 0)
            crowd_.emplace(look_.low, look_.high, look_.crowd_cell, look_.up)
                .fill(position, radius, own);
        if (look_.shadows) casters_.find(balls_, look_, view_.direction(look_.lamp));
        for (Wall& wall : walls_) wall.light(balls_, shadows_, spots_);
    }
    for (int band = 0; band * band_ < view_.height; ++band) paint(band, bytes);
}

}  // namespace carom::raster

#include "walls.hpp"

#include <algorithm>
#include <limits>

namespace carom::raster {

namespace {

constexpr float kNearWall = 3.5f;  // radii from the wall at which a spot has faded away

// How much of an endless plane has not faded.
float rim(float u, float v) {
    const float mu = 2 * u - 1, mv = 2 * v - 1;
    return smoothstep(0, 1, 1 - std::sqrt(mu * mu + mv * mv));
}

// The pixels around points; everything if one is not before the eye.
template <class Points>
Bounds around_points(const View& view, const Points& points) {
    float x[2] = {std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
    float y[2] = {x[0], x[1]};
    for (const F3& p : points) {
        if (p.z <= 1e-3f * (std::abs(p.x) + std::abs(p.y)))
            return {{0, view.width - 1}, {0, view.height - 1}};
        const float per = 1 / (p.z * float(view.pixel));
        const float i = 0.5f * float(view.width) - 0.5f + p.x * per;
        const float j = 0.5f * float(view.height) - 0.5f - p.y * per;
        x[0] = std::min(x[0], i), x[1] = std::max(x[1], i);
        y[0] = std::min(y[0], j), y[1] = std::max(y[1], j);
    }
    return {span(x[0] - 1, x[1] + 1, view.width), span(y[0] - 1, y[1] + 1, view.height)};
}

}  // namespace

Wall::Wall(const View& view, const Look& look, const Face& face)
    : view_(view),
      look_(look),
      face_(face),
      corner_(view.place(face.corner)),
      u_(view.direction(face.u)),
      v_(view.direction(face.v)),
      normal_(view.direction(face.normal)),
      level_(dot(normal_, corner_)) {
    along_u_ = (u_ * level_ - normal_ * dot(u_, corner_)) * float(1 / face.side_u);
    along_v_ = (v_ * level_ - normal_ * dot(v_, corner_)) * float(1 / face.side_v);
    const F3 a = u_ * float(face.side_u), b = v_ * float(face.side_v);
    bounds_ =
        around_points(view, std::vector<F3>{corner_, corner_ + a, corner_ + b, corner_ + a + b});
}

inline Wall::Point Wall::at(float x, float y) const {
    const F3 ray{x, y, 1};
    const float per = 1 / dot(normal_, ray), pixel = float(view_.pixel) * per;
    Point p;
    p.u = dot(along_u_, ray) * per;
    p.v = dot(along_v_, ray) * per;
    const float ux = (along_u_.x - p.u * normal_.x) * pixel;
    const float uy = (along_u_.y - p.u * normal_.y) * pixel;
    const float vx = (along_v_.x - p.v * normal_.x) * pixel;
    const float vy = (along_v_.y - p.v * normal_.y) * pixel;
    p.slope_u = std::abs(ux) + std::abs(uy);
    p.slope_v = std::abs(vx) + std::abs(vy);
    const float mu = 2 * p.u - 1, mv = 2 * p.v - 1;
    const float in_u = (1 - std::abs(mu)) / (2 * std::sqrt(ux * ux + uy * uy)) + 0.5f;
    const float in_v = (1 - std::abs(mv)) / (2 * std::sqrt(vx * vx + vy * vy)) + 0.5f;
    p.cover = level_ * per > 0 ? clamp(in_u) * clamp(in_v) : 0;
    p.rim = face_.fade > 0 ? rim(p.u, p.v) : 1;
    return p;
}

void Wall::paint(Frame& frame) {
    columns_.assign(frame.rows.last + 1, {});
    const auto line = [](double begin, double steps, float at, float slope) {
        const float step = float(std::abs(steps)) * slope;
        const float place = float(begin) + float(steps) * at;
        const float off = std::abs(place - std::floor(place + 0.5f)) / std::max(step, 1e-6f);
        return clamp(1 - off) * (1 - smoothstep(0.2f, 0.6f, step));
    };
    for (int j = bounds_.y.first; j <= bounds_.y.last; ++j) {
        float* const pixels = frame.row(j);
        for (int i = bounds_.x.first; i <= bounds_.x.last; ++i) {
            const Point p = at(view_.ray_x(float(i)), view_.ray_y(float(j)));
            if (!(p.cover * p.rim > 0)) continue;
            if (columns_[j].first > columns_[j].last) columns_[j].first = i;
            columns_[j].last = i;
            const float grid = float(face_.grid_line) *
                               std::max(line(face_.grid_u[0], face_.grid_u[1], p.u, p.slope_u),
                                        line(face_.grid_v[0], face_.grid_v[1], p.v, p.slope_v));
            const float mu = 2 * p.u - 1, mv = 2 * p.v - 1;
            const float pool = 1 - 0.42f * std::min(1.0f, 0.5f * (mu * mu + mv * mv));
            const float fill = float(face_.fill) * pool, share = p.cover * p.rim;
            const F3 color = mix(look_.surface * fill, look_.line, grid) * share;
            const float behind = 1 - (fill + (1 - fill) * grid) * share;
            float* const pixel = pixels + 3 * i;
            pixel[0] = color.x + pixel[0] * behind;
            pixel[1] = color.y + pixel[1] * behind;
            pixel[2] = color.z + pixel[2] * behind;
        }
    }
}

// With the line to the lamp l, places that a ball's shadow reaches are those at a distance s from
// that line through the ball: s² = d² - (d·l)², an ellipse on the wall.
CAROM_WIDE void Wall::shadow(const std::vector<Ball>& balls, F3 lamp, LightMap& map) const {
    const float slant = dot(lamp, normal_), per = 1 / slant;
    const float lu = dot(lamp, u_), lv = dot(lamp, v_);
    const float stretch_u = std::sqrt(1 + lu * lu * per * per);
    const float stretch_v = std::sqrt(1 + lv * lv * per * per);
    const float side_u = float(face_.side_u), side_v = float(face_.side_v);
    for (const Ball& ball : balls) {
        const F3 c = ball.center - corner_;
        const float gap = dot(normal_, c) * per;
        const float r = ball.radius, wide = half_shadow(look_, gap);
        const float u = dot(c, u_) - gap * lu, reach_u = (r + wide) * stretch_u;
        const float v = dot(c, v_) - gap * lv, reach_v = (r + wide) * stretch_v;
        const bool beside =
            (u < -reach_u) | (u > side_u + reach_u) | (v < -reach_v) | (v > side_v + reach_v);
        if (beside | (gap <= 0) | (r * r < kFaintest * wide * wide)) continue;
        const HalfShadow half(r, wide);
        map.splat(u, v, reach_u, reach_v, wide, [=](float du, float dv) {
            const float along = du * lu + dv * lv;
            const float s2 = du * du + dv * dv - along * along;
            return half.dark(std::sqrt(positive(s2)));
        });
    }
}

// How much of the sky a ball hides from a place on a wall: r² h/(ρ² + h²)^(3/2).
CAROM_WIDE void Wall::spot(const std::vector<Ball>& balls, LightMap& map) const {
    for (const Ball& ball : balls) {
        const F3 c = ball.center - corner_;
        const float height = dot(normal_, c), r = ball.radius;
        if (height < 0 || height > kNearWall * r) continue;
        const float high = std::max(height / r, 1.0f), reach = (0.8f + high) * r;
        const float fade = clamp((kNearWall - high) / (kNearWall - 1));
        const float most = float(face_.contact) * fade, per = 1 / r,
                    per_reach = 1 / (reach * reach);
        map.splat(dot(c, u_), dot(c, v_), reach, reach, 0.3f * r, [=](float du, float dv) {
            const float away2 = du * du + dv * dv, d2 = away2 * per * per + high * high;
            return most * high / (d2 * std::sqrt(d2)) * clamp(1 - away2 * per_reach);
        });
    }
}

void Wall::light(const std::vector<Ball>& balls, LightMap& shadows, LightMap& spots) {
    const F3 lamp = view_.direction(look_.lamp);
    const bool shaded = look_.shadows && face_.shade > 0 && dot(lamp, normal_) > 0.05f;
    dark_ = shaded || face_.contact > 0;
    if (!dark_) return;
    for (LightMap* const map : {&shadows, &spots})
        map->begin(float(face_.side_u), float(face_.side_v), look_.soft);
    if (shaded) shadow(balls, lamp, shadows);
    if (face_.contact > 0) spot(balls, spots);
    shadows.merge();
    spots.merge();
    light_.set(shadows, spots, float(face_.shade) * look_.shadowed);
}

// Steps of kLanes pixels, and only those where it is seen: what spheres cover may be darkened, too,
// because it is painted over.
void Wall::darken(const Visibility& seen, Frame& frame) const {
    if (!dark_) return;
    const Span rows = common(bounds_.y, frame.rows);
    std::vector<int> first(view_.width / kLanes + 2);
    for (int j = rows.first; j <= rows.last; ++j) {
        int n = 0;
        for (int i = columns_[j].first; i <= columns_[j].last; i += kLanes) {
            first[n] = i;
            n += !seen.covered(i, j);
        }
        darken_row(first.data(), n, view_.ray_y(float(j)), frame.row(j));
    }
}

// What is left of the light; 1 beside the wall.
template <bool fades>
CAROM_INLINE void Wall::darken(const int* first, int n, float y, float* __restrict pixels) const {
    for (int at = 0; at < n; ++at) {
        float factor[kLanes];
        for (int k = 0; k < kLanes; ++k) {
            const float x = view_.ray_x(float(first[at] + k));
            const float per = 1 / (normal_.x * x + normal_.y * y + normal_.z);
            const float u = (along_u_.x * x + along_u_.y * y + along_u_.z) * per;
            const float v = (along_v_.x * x + along_v_.y * y + along_v_.z) * per;
            const bool there = (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1) & (level_ * per > 0);
            float some = light_.at(u, v);
            if constexpr (fades) some = 1 - rim(u, v) * (1 - some);
            factor[k] = there ? some : 1;
        }
        float* const pixel = pixels + 3 * first[at];
        for (int k = 0; k < 3 * kLanes; ++k) pixel[k] *= factor[k / 3];
    }
}

CAROM_WIDE void Wall::darken_row(const int* first, int n, float y, float* pixels) const {
    if (face_.fade > 0)
        darken<true>(first, n, y, pixels);
    else
        darken<false>(first, n, y, pixels);
}

void draw(const View& view, const Look& look, const Edge& edge, const Visibility& seen,
          Frame& frame) {
    F3 a = view.place(edge.from), b = view.place(edge.to);
    const F3 whole = b - a;
    const float size = std::sqrt(dot(whole, whole));
    float begin = 0, end = 1;  // cut at the eye's plane: what lies behind cannot be projected
    const float near = 1e-3f * (std::abs(a.z) + std::abs(b.z) + 1e-9f);
    if (a.z < near && b.z < near) return;
    if (a.z < near) begin = (near - a.z) / whole.z;
    if (b.z < near) end = (near - a.z) / whole.z;
    b = a + whole * end;
    a = a + whole * begin;
    const double per = 1 / view.pixel, x0 = 0.5 * view.width - 0.5, y0 = 0.5 * view.height - 0.5;
    const double ax = x0 + a.x / a.z * per, ay = y0 - a.y / a.z * per;
    const double bx = x0 + b.x / b.z * per, by = y0 - b.y / b.z * per;
    const double length = std::hypot(bx - ax, by - ay);
    if (!(length > 1e-6)) return;
    const double ux = (bx - ax) / length, uy = (by - ay) / length;
    const double reach = 0.5 * look.line_width + 1;
    const Span rows =
        common(span(std::min(ay, by) - reach, std::max(ay, by) + reach, view.height), frame.rows);
    const Span columns =
        common(span(std::min(ax, bx) - reach, std::max(ax, bx) + reach, view.width), frame.columns);
    const int samples = view.samples;
    for (int j = rows.first; j <= rows.last; ++j) {
        // The pixels of this row that the line comes near: |uy (i - ax) - ux (j - ay)| < reach.
        Span part = columns;
        if (std::abs(uy) > 1e-6) {
            const double middle = ax + ux * (j - ay) / uy, half = reach / std::abs(uy);
            part = span(middle - half, middle + half, view.width);
            part = {std::max(part.first, columns.first), std::min(part.last, columns.last)};
        }
        for (int i = part.first; i <= part.last; ++i) {
            const double across = std::abs(uy * (i - ax) - ux * (j - ay));
            const float s = float((ux * (i - ax) + uy * (j - ay)) / length);
            float alpha = float(edge.alpha) * clamp(0.5f * look.line_width + 0.5f - float(across));
            if (!(alpha > 0) || s < 0 || s > 1) continue;
            const float z = 1 / ((1 - s) / a.z + s / b.z);
            if (edge.dash > 0) {
                const float along = (begin + (end - begin) * s * z / b.z) * size;
                const float step = (end - begin) * size * z * z / (a.z * b.z) *
                                   float((std::abs(ux) + std::abs(uy)) / length);
                const float beats = along / float(edge.dash);
                const float beat = std::abs(beats - std::floor(beats) - 0.5f);
                alpha *= clamp((0.28f - beat) * float(edge.dash) / std::max(step, 1e-6f) + 0.5f);
            }
            const float x = view.ray_x(float(i)), y = view.ray_y(float(j));
            const float depth = z * (1 + x * x + y * y);
            int before = 0;
            for (int row = samples * j; row < samples * (j + 1); ++row)
                for (int k = samples * i; k < samples * (i + 1); ++k)
                    before += depth < seen.depths(row)[k];
            blend(frame.row(j) + 3 * i, look.line,
                  alpha * float(before) / float(samples * samples));
        }
    }
}

}  // namespace carom::raster

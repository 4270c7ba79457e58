// Where the neighbour shells are: cells on several levels, each twice as wide as the one below.
//
// A shell of reach s (radius + margin) lives on the lowest level whose cells are at least 2 s wide,
// so that whatever it can touch on its own or a higher level lies within the 27 cells around it.
// Each level is a torus of cells: along an open axis, cell c is kept in slot c mod n. Far places may
// share a slot; the distance test tells them apart. So the cells need no borders, and follow the
// spheres wherever they fly.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "vec3.hpp"

namespace carom {

struct Shell {
    Vec3 centre;
    double reach = 0;  // radius of the sphere + margin it may move before the shell is remade
};

class Cells {
public:
    // `width`: of the lowest level's cells. `period`: 0 on axes that are not periodic. `count` is
    // how many shells to expect.
    void reset(double width, const Vec3& period, size_t count) {
        width_ = width;
        period_ = period;
        count_ = count;
        levels_.clear();
        lines_.clear();
        free_ = -1;
    }

    void add(int i, const Shell& s) {
        Level& level = levels_[size_t(level_of(s.reach))];
        ++level.population;
        push(slot_of(level, s.centre), i);
    }

    void remove(int i, const Shell& s) {
        Level& level = levels_[size_t(level_of(s.reach))];
        --level.population;
        take(slot_of(level, s.centre), i);
    }

    // Appends to `out` every j with |centre - centre_j| < reach + reach_j (nearest image), i itself
    // and j its own image excluded by not being in the cells while it searches.
    void search(const Shell& s, const std::vector<Shell>& shells, std::vector<int32_t>& out) const {
        for (const Level& level : levels_)
            if (level.population > 0) search(level, s, shells, out);
    }

    double distance2(const Vec3& a, const Vec3& b) const {
        Vec3 d = a - b;
        d -= nearest(d * inverse(period_)) * period_;
        return norm2(d);
    }

    size_t bytes() const { return lines_.capacity() * sizeof(Line); }

private:
    struct alignas(32) Line {  // half a cache line: six ids, then a chain
        int32_t n = 0;
        int32_t next = -1;
        int32_t id[6];
    };
    struct Level {
        Vec3 inverse_width;
        int64_t n[3];      // cells per axis
        int64_t first;     // index of its first line
        int64_t population = 0;
    };

    static Vec3 inverse(const Vec3& p) {
        return {p.x > 0 ? 1 / p.x : 0, p.y > 0 ? 1 / p.y : 0, p.z > 0 ? 1 / p.z : 0};
    }

    int level_of(double reach) {
        int k = 0;
        for (double w = width_; w < 2 * reach; w *= 2) ++k;
        while (int(levels_.size()) <= k) levels_.push_back(make_level(int(levels_.size())));
        return k;
    }

    Level make_level(int k) {
        const double w = std::ldexp(width_, k);
        const double want = std::cbrt(double(count_) / std::ldexp(1.0, std::min(3 * k, 60)));
        const auto open = int64_t(std::clamp(std::ceil(want), 4.0, 1024.0));
        Level level;
        const double p[3] = {period_.x, period_.y, period_.z};
        double inverse_width[3];
        for (int a = 0; a < 3; ++a) {
            level.n[a] = open;
            inverse_width[a] = 1 / w;
            if (p[a] > 0) {  // whole cells per period, never narrower than w
                const double whole = std::floor(p[a] / w);
                level.n[a] = int64_t(std::clamp(whole, 1.0, std::max(4.0, 4.0 * double(open))));
                inverse_width[a] = double(level.n[a]) / p[a];
            }
        }
        level.inverse_width = {inverse_width[0], inverse_width[1], inverse_width[2]};
        level.first = int64_t(lines_.size());
        lines_.resize(lines_.size() + size_t(level.n[0] * level.n[1] * level.n[2]));
        return level;
    }

    // Cell coordinate along an axis. Clamped so that no distance overflows an integer; clamping
    // keeps near cells near.
    static int64_t coordinate(double x, double inverse_width) {
        return int64_t(std::clamp(std::floor(x * inverse_width), -1e15, 1e15));
    }
    static int64_t wrap(int64_t c, int64_t n) {
        if (c >= 0 && c < n) return c;
        const int64_t r = c % n;
        return r < 0 ? r + n : r;
    }
    int64_t slot_of(const Level& l, const Vec3& x) const {
        const int64_t a = wrap(coordinate(x.x, l.inverse_width.x), l.n[0]);
        const int64_t b = wrap(coordinate(x.y, l.inverse_width.y), l.n[1]);
        const int64_t c = wrap(coordinate(x.z, l.inverse_width.z), l.n[2]);
        return l.first + (c * l.n[1] + b) * l.n[0] + a;
    }

    struct Range {  // slots along one axis: `count` of them from `begin`, wrapping at n
        int64_t begin, count;
    };
    static Range range(double x, double radius, double inverse_width, int64_t n) {
        const int64_t lo = coordinate(x - radius, inverse_width);
        const int64_t hi = coordinate(x + radius, inverse_width);
        const int64_t count = hi - lo + 1;
        if (count >= n) return {0, n};
        return {wrap(lo, n), count};
    }

    void search(const Level& l, const Shell& s, const std::vector<Shell>& shells,
                std::vector<int32_t>& out) const {
        // Shells on this level reach at most half a cell.
        const double rx = s.reach + 0.5 / l.inverse_width.x, ry = s.reach + 0.5 / l.inverse_width.y,
                     rz = s.reach + 0.5 / l.inverse_width.z;
        const Range ax = range(s.centre.x, rx, l.inverse_width.x, l.n[0]);
        const Range ay = range(s.centre.y, ry, l.inverse_width.y, l.n[1]);
        const Range az = range(s.centre.z, rz, l.inverse_width.z, l.n[2]);
        const Vec3 inv = inverse(period_);
        int64_t z = az.begin;
        for (int64_t kz = 0; kz < az.count; ++kz, z = z + 1 == l.n[2] ? 0 : z + 1) {
            int64_t y = ay.begin;
            for (int64_t ky = 0; ky < ay.count; ++ky, y = y + 1 == l.n[1] ? 0 : y + 1) {
                const int64_t row = l.first + (z * l.n[1] + y) * l.n[0];
                int64_t x = ax.begin;
                for (int64_t kx = 0; kx < ax.count; ++kx, x = x + 1 == l.n[0] ? 0 : x + 1) {
                    for (int64_t c = row + x; c >= 0; c = lines_[size_t(c)].next) {
                        const Line& line = lines_[size_t(c)];
                        for (int k = 0; k < line.n; ++k) {
                            const Shell& o = shells[size_t(line.id[k])];
                            Vec3 d = s.centre - o.centre;
                            d -= nearest(d * inv) * period_;
                            const double near = s.reach + o.reach;
                            if (norm2(d) < near * near) out.push_back(line.id[k]);
                        }
                    }
                }
            }
        }
    }

    void push(int64_t slot, int i) {
        Line& head = lines_[size_t(slot)];
        if (head.n < 6) {
            head.id[head.n++] = i;
            return;
        }
        // Full: its content moves to a spare line behind it.
        int32_t spare = free_;
        if (spare >= 0) {
            free_ = lines_[size_t(spare)].next;
        } else {
            spare = int32_t(lines_.size());
            lines_.push_back({});
        }
        Line& first = lines_[size_t(slot)];
        lines_[size_t(spare)] = first;
        first.next = spare;
        first.n = 1;
        first.id[0] = i;
    }

    void take(int64_t slot, int i) {
        Line& head = lines_[size_t(slot)];
        for (int64_t c = slot; c >= 0; c = lines_[size_t(c)].next) {
            Line& line = lines_[size_t(c)];
            for (int k = 0; k < line.n; ++k) {
                if (line.id[k] != i) continue;
                line.id[k] = head.id[--head.n];
                if (head.n == 0 && head.next >= 0) {  // the line behind becomes the head
                    const int32_t behind = head.next;
                    head = lines_[size_t(behind)];
                    lines_[size_t(behind)].next = free_;
                    free_ = behind;
                }
                return;
            }
        }
    }

    double width_ = 1;
    Vec3 period_;
    size_t count_ = 0;
    std::vector<Level> levels_;
    std::vector<Line> lines_;
    int32_t free_ = -1;  // chain of spare lines
};

}  // namespace carom

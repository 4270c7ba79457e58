// Where the neighbour shells are: cells on several levels, each twice as wide as the one below.
//
// A shell of reach s (radius + margin) lives on the lowest level whose cells are at least 2 s wide,
// so that whatever it can touch on its own or a higher level lies within the 27 cells around it.
// Each level is a torus of cells: along an open axis, cell c is kept in slot c mod n. Far places
// may share a slot; the distance test tells them apart. So the cells need no borders, and follow
// the spheres wherever they fly.
//
// A cell is one cache line: seven shells with their place in the cell to 1/256 of its width. Most
// candidates are turned away by integer arithmetic on that line alone.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "memory.hpp"
#include "vec3.hpp"

namespace carom {

struct Shell {
    Vec3 centre;
    double reach = 0;  // radius of the sphere + margin it may move before the shell is remade
};

class Cells {
public:
    // `width`: of the lowest level's cells. `period`: 0 on axes that are not periodic. `extent`: of
    // the spheres at the start, along each axis.
    void reset(double width, const Vec3& period, const Vec3& extent, size_t count) {
        width_ = width;
        period_ = period;
        extent_ = extent;
        count_ = count;
        inverse_period_ = inverse(period);
        levels_.clear();
        lines_.clear();
        free_ = -1;
    }

    void add(int i, const Shell& s) {
        Level& level = levels_[size_t(level_of(s.reach))];
        ++level.population;
        push(level, i, s);
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
        d -= nearest(d * inverse_period_) * period_;
        return norm2(d);
    }

    size_t bytes() const { return lines_.capacity() * sizeof(Line); }

private:
    static constexpr int kSlots = 7;
    struct alignas(64) Line {
        int32_t n = 0;
        int32_t next = -1;  // the line behind, when seven are not enough
        int32_t id[kSlots];
        uint8_t x[kSlots], y[kSlots], z[kSlots];  // in 1/256 of the cell, rounded down
        uint8_t reach[kSlots];                    // in the same unit, rounded up
    };
    static_assert(sizeof(Line) == 64);
    struct Level {
        Vec3 inverse_width;
        int64_t n[3];   // cells per axis
        int64_t first;  // index of its first line
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

    // As many cells as the spheres' extent holds, but no more than some for each shell expected:
    // an axis that would have more is folded, on an open axis a slot serving several places, on a
    // periodic one with wider cells.
    Level make_level(int k) {
        const double w = std::ldexp(width_, k);
        double n[3] = {cells_along(extent_.x, w), cells_along(extent_.y, w),
                       cells_along(extent_.z, w)};
        const double most = std::max(64.0, std::ldexp(double(count_), -std::min(3 * k, 60)));
        while (n[0] * n[1] * n[2] > most) {
            double& longest = *std::max_element(n, n + 3);
            longest = std::max(1.0, std::floor(longest / 2));
        }
        const double p[3] = {period_.x, period_.y, period_.z};
        double inverse_width[3];
        Level level;
        for (int a = 0; a < 3; ++a) {
            if (p[a] > 0) n[a] = std::min(n[a], std::max(1.0, std::floor(p[a] / w)));
            level.n[a] = int64_t(n[a]);
            inverse_width[a] = p[a] > 0 ? n[a] / p[a] : 1 / w;
        }
        level.inverse_width = {inverse_width[0], inverse_width[1], inverse_width[2]};
        level.first = int64_t(lines_.size());
        lines_.resize(lines_.size() + size_t(level.n[0] * level.n[1] * level.n[2]));
        return level;
    }
    // At least four: with fewer, every search would visit the same cells again and again.
    static double cells_along(double extent, double w) {
        return std::clamp(std::ceil(extent / w), 4.0, 1e7);
    }

    // Cell coordinate along an axis. Clamped so that no distance overflows an integer; clamping
    // keeps near cells near.
    static double coordinate(double x, double inverse_width) {
        return std::clamp(std::floor(x * inverse_width), -1e15, 1e15);
    }
    static int64_t wrap(double coordinate, int64_t n) {
        const auto c = int64_t(coordinate);
        if (c >= 0 && c < n) return c;
        const int64_t r = c % n;
        return r < 0 ? r + n : r;
    }
    // 0 ... 255 within the cell.
    static int fine(double x, double inverse_width) {
        const double u = x * inverse_width;
        return int(std::clamp(std::floor((u - std::floor(u)) * 256), 0.0, 255.0));
    }
    static int fine_reach(double reach, const Level& l) {
        const double finest =
            std::max(l.inverse_width.x, std::max(l.inverse_width.y, l.inverse_width.z));
        return int(std::min(std::ceil(reach * finest * 256), 1e6));
    }
    int64_t slot_of(const Level& l, const Vec3& x) const {
        const int64_t a = wrap(coordinate(x.x, l.inverse_width.x), l.n[0]);
        const int64_t b = wrap(coordinate(x.y, l.inverse_width.y), l.n[1]);
        const int64_t c = wrap(coordinate(x.z, l.inverse_width.z), l.n[2]);
        return l.first + (c * l.n[1] + b) * l.n[0] + a;
    }

    // The slots that a search visits along one axis.
    struct Axis {
        int64_t slot, count, n;  // first slot, how many, wrapping at n
        int near;                // fine coordinate of the searcher, seen from the first cell
        bool exact;              // no cell is met twice and none is far: fine coordinates tell
    };
    static Axis axis(double x, double radius, double inverse_width, int64_t n) {
        const double lo = coordinate(x - radius, inverse_width),
                     hi = coordinate(x + radius, inverse_width);
        const double count = hi - lo + 1;
        if (!(count < double(n))) return {0, n, n, 0, false};
        const double cells = coordinate(x, inverse_width) - lo;
        const bool exact = count < 64;
        return {wrap(lo, n), int64_t(count), n,
                exact ? int(cells) * 256 + fine(x, inverse_width) : 0, exact};
    }

    void search(const Level& l, const Shell& s, const std::vector<Shell>& shells,
                std::vector<int32_t>& out) const {
        // Shells on this level reach at most half a cell.
        const Vec3& iw = l.inverse_width;
        const Axis ax = axis(s.centre.x, s.reach + 0.5 / iw.x, iw.x, l.n[0]);
        const Axis ay = axis(s.centre.y, s.reach + 0.5 / iw.y, iw.y, l.n[1]);
        const Axis az = axis(s.centre.z, s.reach + 0.5 / iw.z, iw.z, l.n[2]);
        const bool exact = ax.exact && ay.exact && az.exact && iw.x == iw.y && iw.y == iw.z;
        const int reach = fine_reach(s.reach, l) + 2;  // 2 > sqrt(3): both places are rounded
        const auto each = [&](auto visit) {
            int64_t z = az.slot;
            for (int64_t kz = 0; kz < az.count; ++kz, z = z + 1 == az.n ? 0 : z + 1) {
                int64_t y = ay.slot;
                for (int64_t ky = 0; ky < ay.count; ++ky, y = y + 1 == ay.n ? 0 : y + 1) {
                    const Line* row = &lines_[size_t(l.first + (z * ay.n + y) * ax.n)];
                    int64_t x = ax.slot;
                    for (int64_t kx = 0; kx < ax.count; ++kx, x = x + 1 == ax.n ? 0 : x + 1)
                        visit(row[x], int(kx), int(ky), int(kz));
                }
            }
        };
        each([](const Line& line, int, int, int) { fetch(&line); });
        if (!exact)
            return each([&](const Line& line, int, int, int) { all(line, s, shells, out); });
        each([&](const Line& line, int x, int y, int z) {
            filter(line, ax.near - 256 * x, ay.near - 256 * y, az.near - 256 * z, reach, s, shells,
                   out);
        });
    }

    void filter(const Line& head, int dx, int dy, int dz, int reach, const Shell& s,
                const std::vector<Shell>& shells, std::vector<int32_t>& out) const {
        for (const Line* line = &head;; line = &lines_[size_t(line->next)]) {
            for (int k = 0; k < line->n; ++k) {
                const int x = dx - line->x[k], y = dy - line->y[k], z = dz - line->z[k],
                          r = reach + line->reach[k];
                if (x * x + y * y + z * z < r * r) accept(line->id[k], s, shells, out);
            }
            if (line->next < 0) return;
        }
    }

    void all(const Line& head, const Shell& s, const std::vector<Shell>& shells,
             std::vector<int32_t>& out) const {
        for (const Line* line = &head;; line = &lines_[size_t(line->next)]) {
            for (int k = 0; k < line->n; ++k) accept(line->id[k], s, shells, out);
            if (line->next < 0) return;
        }
    }

    void accept(int32_t j, const Shell& s, const std::vector<Shell>& shells,
                std::vector<int32_t>& out) const {
        const Shell& o = shells[size_t(j)];
        const double near = s.reach + o.reach;
        if (distance2(s.centre, o.centre) < near * near) out.push_back(j);
    }

    static void move(const Line& from, int k, Line& to, int at) {
        to.id[at] = from.id[k];
        to.x[at] = from.x[k];
        to.y[at] = from.y[k];
        to.z[at] = from.z[k];
        to.reach[at] = from.reach[k];
    }

    void push(const Level& l, int i, const Shell& s) {
        const int64_t slot = slot_of(l, s.centre);
        if (lines_[size_t(slot)].n == kSlots) {  // full: its content moves to a line behind it
            int32_t spare = free_;
            if (spare >= 0) {
                free_ = lines_[size_t(spare)].next;
            } else {
                spare = int32_t(lines_.size());
                grow(lines_);
            }
            lines_[size_t(spare)] = lines_[size_t(slot)];
            lines_[size_t(slot)].next = spare;
            lines_[size_t(slot)].n = 0;
        }
        Line& head = lines_[size_t(slot)];
        const int k = head.n++;
        head.id[k] = i;
        head.x[k] = uint8_t(fine(s.centre.x, l.inverse_width.x));
        head.y[k] = uint8_t(fine(s.centre.y, l.inverse_width.y));
        head.z[k] = uint8_t(fine(s.centre.z, l.inverse_width.z));
        head.reach[k] = uint8_t(std::min(fine_reach(s.reach, l), 255));
    }

    void take(int64_t slot, int i) {
        Line& head = lines_[size_t(slot)];
        for (int64_t c = slot; c >= 0; c = lines_[size_t(c)].next) {
            Line& line = lines_[size_t(c)];
            for (int k = 0; k < line.n; ++k) {
                if (line.id[k] != i) continue;
                move(head, --head.n, line, k);
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
    Vec3 period_, inverse_period_, extent_;
    size_t count_ = 0;
    std::vector<Level> levels_;
    std::vector<Line> lines_;
    int32_t free_ = -1;  // chain of spare lines
};

}  // namespace carom

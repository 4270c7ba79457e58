// Where the neighbour shells are: cells on several levels, each twice as wide as the one below.
//
// A shell of reach s (radius + margin) lives on the lowest level whose cells are at least 2 s wide,
// so that whatever it can touch on its own or a higher level lies within the 27 cells around it.
// Each level is a torus of cells: along an open axis, cell c is kept in slot c mod n. Far places
// may share a slot; the distance test tells them apart. So the cells need no borders, and follow
// the spheres wherever they fly.
//
// A cell is one cache line: seven shells with their place in the cell to 1/256 of its width. Who is
// near is decided by integer arithmetic on that line alone.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "memory.hpp"
#include "simd/kernels.hpp"
#include "vec3.hpp"

namespace carom {

struct Shell {
    Vec3 centre;
    double reach = 0;  // radius of the sphere + margin it may move before the shell is remade
};

// Numbers of spheres.
struct Found {
    std::vector<int32_t> id = std::vector<int32_t>(64);
    size_t n = 0;

    void add(int32_t j) {
        if (n == id.size()) id.resize(2 * n);
        id[n++] = j;
    }
    std::span<const int32_t> ids() const { return {id.data(), n}; }
};

class Cells {
public:
    // `width`: of the lowest level's cells. `period`: 0 on axes that are not periodic. `extent`: of
    // the spheres at the start, along each axis.
    void reset(double width, const Vec3& period, const Vec3& extent, size_t count,
               const Kernels& kernels) {
        width_ = width;
        period_ = period;
        extent_ = extent;
        count_ = count;
        kernels_ = &kernels;
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
        take(slot_of(level, in_cells(s.centre, level)), i);
    }

    // Every j with |centre - centre_j| < reach + reach_j (nearest image) or a hair more, none
    // twice: i itself only if it is in the cells while it searches. The answer is the same from
    // both sides. `shell_of` is asked only where cells are few or met twice.
    template <class ShellOf>
    void search(const Shell& s, const ShellOf& shell_of, Found& out) const {
        out.n = 0;
        for (const Level& level : levels_)
            if (level.population > 0) search(level, s, shell_of, out);
    }

    // Asks for the lines that a search around x will look into.
    void fetch_around(const Vec3& x) const {
        const Level& l = levels_.front();
        const Vec3 u = in_cells(x, l);
        const auto three = [](double v, int64_t n, int64_t out[3]) {
            for (int k = 0; k < 3; ++k) out[k] = wrap(floored(v) + k - 1, n);
        };
        int64_t a[3], b[3], c[3];
        three(u.x, l.n[0], a);
        three(u.y, l.n[1], b);
        three(u.z, l.n[2], c);
        for (const int64_t z : c)
            for (const int64_t y : b)
                for (const int64_t xs : a)
                    fetch(&lines_[size_t(l.first + (z * l.n[1] + y) * l.n[0] + xs)]);
    }

    double distance2(const Vec3& a, const Vec3& b) const {
        Vec3 d = a - b;
        d -= nearest(d * inverse_period_) * period_;
        return norm2(d);
    }

    size_t bytes() const { return lines_.capacity() * sizeof(Line); }

private:
    using Line = CellLine;
    struct Level {
        Vec3 inverse_width;
        double steps[3];  // of a cell's width: 255 along the widest axis
        double steps_per_length;
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
        level.steps_per_length = 255 * *std::min_element(inverse_width, inverse_width + 3);
        for (int a = 0; a < 3; ++a) level.steps[a] = level.steps_per_length / inverse_width[a];
        level.first = int64_t(lines_.size());
        lines_.resize(lines_.size() + size_t(level.n[0] * level.n[1] * level.n[2]));
        return level;
    }
    // At least four: with fewer, every search would visit the same cells again and again.
    static double cells_along(double extent, double w) {
        return std::clamp(std::ceil(extent / w), 4.0, 1e7);
    }

    // In units of the level's cells. Clamped so that no distance overflows an integer; clamping
    // keeps near places near.
    static Vec3 in_cells(const Vec3& x, const Level& l) {
        const auto clamped = [](double u) { return std::clamp(u, -1e15, 1e15); };
        const Vec3 u = x * l.inverse_width;
        return {clamped(u.x), clamped(u.y), clamped(u.z)};
    }
    static int64_t wrap(double cell, int64_t n) {
        auto c = int64_t(cell);
        c += n & (c >> 63);  // no branch: half of all are negative
        if (c >= 0 && c < n) return c;
        const int64_t r = c % n;
        return r < 0 ? r + n : r;
    }
    static int32_t slot_of(const Level& l, const Vec3& u) {
        const int64_t a = wrap(floored(u.x), l.n[0]), b = wrap(floored(u.y), l.n[1]),
                      c = wrap(floored(u.z), l.n[2]);
        return int32_t(l.first + (c * l.n[1] + b) * l.n[0] + a);
    }
    // Place within the cell, in steps of which `steps` make a cell.
    static int fine(double u, double steps) { return int((u - floored(u)) * steps); }
    static int fine_reach(double reach, const Level& l) {
        return int(std::min(floored(reach * l.steps_per_length) + 1, 1e6));
    }

    // The cells within `radius`, a number of cells, of a place along one axis.
    struct Range {
        int64_t first, count, n;  // wrapping at n
        double before;            // from the first cell to the searcher's
        bool exact;               // none is met twice and none is far: places tell distances
    };
    static Range range(double u, double radius, int64_t n) {
        const double own = floored(u), part = u - own;
        const double lo = floored(part - radius), count = floored(part + radius) - lo + 1;
        if (!(count < double(n))) return {0, n, n, 0, false};
        return {wrap(own + lo, n), int64_t(count), n, -lo, count <= CellBlock::kMost};
    }
    static void fill(CellBlock::Axis& a, const Range& r, double u, double steps, int64_t stride,
                     int64_t first) {
        a.n = int32_t(r.count);
        const int place = fine(u, steps);
        int64_t slot = r.first;
        for (int k = 0; k < a.n; ++k) {
            a.line[k] = int32_t(first + slot * stride);
            a.seen[k] = int16_t(place + int(nearest((r.before - k) * steps)));
            slot = slot + 1 == r.n ? 0 : slot + 1;
        }
    }

    template <class ShellOf>
    void search(const Level& l, const Shell& s, const ShellOf& shell_of, Found& out) const {
        // Shells on this level reach at most half a cell.
        const Vec3 u = in_cells(s.centre, l), radius = l.inverse_width * s.reach;
        const Range x = range(u.x, radius.x + 0.5, l.n[0]), y = range(u.y, radius.y + 0.5, l.n[1]),
                    z = range(u.z, radius.z + 0.5, l.n[2]);
        // Two places and a step between cells are rounded: 3 > sqrt(3) (1 + 1/2).
        const int reach = fine_reach(s.reach, l) + 3;
        if (!x.exact || !y.exact || !z.exact || reach >= (1 << 14))
            return all(l, x, y, z, s, shell_of, out);
        CellBlock block;
        block.minus_reach = int16_t(-reach);
        fill(block.x, x, u.x, l.steps[0], 1, 0);
        fill(block.y, y, u.y, l.steps[1], x.n, 0);
        fill(block.z, z, u.z, l.steps[2], x.n * y.n, l.first);
        near(block, out);
    }

    void near(const CellBlock& block, Found& out) const {
        for (;;) {
            const int32_t more = kernels_->near(lines_.data(), block, &out.id[out.n],
                                                int32_t(out.id.size() - out.n));
            if (more >= 0) {
                out.n += size_t(more);
                return;
            }
            out.id.resize(2 * out.id.size());
        }
    }

    template <class ShellOf>
    void all(const Level& l, const Range& rx, const Range& ry, const Range& rz, const Shell& s,
             const ShellOf& shell_of, Found& out) const {
        const auto each = [](const Range& r, auto visit) {
            int64_t slot = r.first;
            for (int64_t k = 0; k < r.count; ++k, slot = slot + 1 == r.n ? 0 : slot + 1)
                visit(slot);
        };
        const auto look = [&](int64_t slot) {
            for (auto at = int32_t(slot); at >= 0; at = lines_[size_t(at)].next) {
                for (const int32_t j : lines_[size_t(at)].id) {
                    if (j < 0) break;
                    const Shell o = shell_of(j);
                    const double near = s.reach + o.reach;
                    if (distance2(s.centre, o.centre) < near * near) out.add(j);
                }
            }
        };
        each(rz, [&](int64_t z) {
            each(ry, [&](int64_t y) {
                each(rx, [&](int64_t x) { look(l.first + (z * ry.n + y) * rx.n + x); });
            });
        });
    }

    static void move(const Line& from, int k, Line& to, int at) {
        to.id[at] = from.id[k];
        to.xy[at] = from.xy[k];
        to.zr[at] = from.zr[k];
    }

    void push(const Level& l, int i, const Shell& s) {
        const Vec3 u = in_cells(s.centre, l);
        const auto slot = size_t(slot_of(l, u));
        if (lines_[slot].full()) {  // its content moves to a line behind it
            int32_t spare = free_;
            if (spare >= 0) {
                free_ = lines_[size_t(spare)].next;
            } else {
                spare = int32_t(lines_.size());
                grow(lines_);
            }
            lines_[size_t(spare)] = lines_[slot];
            lines_[slot] = Line{};
            lines_[slot].next = spare;
        }
        Line& head = lines_[slot];
        const int k = head.size();
        head.id[k] = i;
        head.xy[k] = {uint8_t(fine(u.x, l.steps[0])), uint8_t(fine(u.y, l.steps[1]))};
        head.zr[k] = {uint8_t(fine(u.z, l.steps[2])),
                      uint8_t(std::min(fine_reach(s.reach, l), 255))};
    }

    void take(int32_t slot, int i) {
        Line& head = lines_[size_t(slot)];
        for (int32_t c = slot; c >= 0; c = lines_[size_t(c)].next) {
            Line& line = lines_[size_t(c)];
            const int k = line.find(i);
            if (k < 0) continue;
            const int last = head.size() - 1;
            move(head, last, line, k);
            head.id[last] = -1;
            if (last == 0 && head.next >= 0) {  // the line behind becomes the head
                const int32_t behind = head.next;
                head = lines_[size_t(behind)];
                lines_[size_t(behind)].next = free_;
                free_ = behind;
            }
            return;
        }
    }

    double width_ = 1;
    Vec3 period_, inverse_period_, extent_;
    size_t count_ = 0;
    std::vector<Level> levels_;
    const Kernels* kernels_ = nullptr;
    Array<Line> lines_;
    int32_t free_ = -1;  // chain of spare lines
};

}  // namespace carom

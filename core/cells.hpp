// Where the neighbour shells are: cells on several levels, each twice as wide as the one below.
//
// A shell of reach s (radius + margin) lives on the lowest level whose cells are at least 2 s wide,
// so that whatever it can touch on its own or a higher level lies within the 27 cells around it.
// Each level is a torus of cells: along an open axis, cell c is kept in slot c mod n. Far places
// may share a slot; the distance test tells them apart. So the cells need no borders, and follow
// the spheres wherever they fly. A level has about as many slots as shells: it is laid out anew
// when these have become many more, or many fewer, as in a cloud whose spheres need ever wider
// shells.
//
// A cell is one cache line: seven shells with their place in the cell to 1/256 of its width. Who is
// near is decided by integer arithmetic on that line alone.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
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
    // the spheres at the start, along each axis. `room`: which they never leave, endless in open
    // space.
    void reset(double width, const Vec3& period, const Vec3& extent, const Vec3& room, size_t count,
               const Kernels& kernels) {
        width_ = width;
        period_ = period;
        extent_ = extent;
        room_ = room;
        count_ = count;
        kernels_ = &kernels;
        inverse_period_ = inverse(period);
        for (size_t k = 1; k < levels_.size(); ++k) levels_[k].lines = {};
        levels_.resize(1);
        levels_[0].population = 0;
        levels_[0].n[0] = 0;
        lay_out(levels_[0], width_, int64_t(count));
        clear(levels_[0]);
    }

    // `shell_of` those that are in the cells is asked when a level is laid out anew.
    template <class ShellOf>
    void add(int i, const Shell& s, const ShellOf& shell_of) {
        const int k = level_of(s.reach);
        Level& level = levels_[size_t(k)];
        if (++level.population > level.most) fit(k, shell_of);
        push(level, i, s);
    }

    template <class ShellOf>
    void remove(int i, const Shell& s, const ShellOf& shell_of) {
        const int k = level_of(s.reach);
        Level& level = levels_[size_t(k)];
        take(level, slot_of(level, in_cells(s.centre, level)), i);
        if (--level.population < level.least) fit(k, shell_of);
    }

    // Every j with |centre - centre_j| < reach + reach_j (nearest image) or a hair more, none
    // twice: i itself only if it is in the cells while it searches. The answer is the same from
    // both sides, but for that hair. `shell_of` is asked only where far places share a cell, or
    // cells are much wider than the shell.
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
                for (const int64_t xs : a) fetch(&l.lines[size_t((z * l.n[1] + y) * l.n[0] + xs)]);
    }

    double distance2(const Vec3& a, const Vec3& b) const {
        Vec3 d = a - b;
        d -= nearest(d * inverse_period_) * period_;
        return norm2(d);
    }

    size_t bytes() const {
        size_t all = 0;
        for (const Level& level : levels_) all += level.lines.capacity() * sizeof(Line);
        return all;
    }

private:
    using Line = CellLine;
    struct Level {
        Vec3 inverse_width;
        double steps[3];  // of a cell's width: 255 along the widest axis
        double steps_per_length;
        int64_t n[3] = {0, 0, 0};  // cells per axis
        bool folded = false;       // far places may share a cell
        int64_t population = 0;
        int64_t most = 0, least = 0;  // for which it is laid out
        Array<Line> lines;            // of each cell, and those behind
        int32_t free = -1;            // chain of spare lines
    };

    static Vec3 inverse(const Vec3& p) {
        return {p.x > 0 ? 1 / p.x : 0, p.y > 0 ? 1 / p.y : 0, p.z > 0 ? 1 / p.z : 0};
    }

    int level_of(double reach) {
        int k = 0;
        for (double w = width_; w < 2 * reach; w *= 2) ++k;
        if (int(levels_.size()) <= k) levels_.resize(size_t(k) + 1);
        return k;
    }

    // As many cells as the spheres' extent holds, but no more than shells expected: an axis that
    // would have more is folded, on an open axis a slot serving several places, on a periodic one
    // with wider cells. False if it is so already.
    bool lay_out(Level& level, double w, int64_t expected) const {
        const double p[3] = {period_.x, period_.y, period_.z};
        const double side[3] = {extent_.x, extent_.y, extent_.z};
        // The extent of the start says nothing of how far the wider shells are spread, but their
        // number does.
        double n[3];
        for (int a = 0; a < 3; ++a) n[a] = cells_along(side[a], p[a] > 0 ? w : width_);
        while (n[0] * n[1] * n[2] > std::max(64.0, double(expected))) {
            double& longest = *std::max_element(n, n + 3);
            longest = std::max(1.0, std::floor(longest / 2));
        }
        bool changed = false;
        double inverse_width[3];
        for (int a = 0; a < 3; ++a) {
            if (p[a] > 0) n[a] = std::min(n[a], std::max(1.0, std::floor(p[a] / w)));
            inverse_width[a] = p[a] > 0 ? n[a] / p[a] : 1 / w;
            changed |= level.n[a] != int64_t(n[a]);
            level.n[a] = int64_t(n[a]);
        }
        level.folded = false;
        const double room[3] = {room_.x, room_.y, room_.z};
        for (int a = 0; a < 3; ++a) level.folded |= p[a] == 0 && n[a] * w < room[a];
        const int64_t slots = level.n[0] * level.n[1] * level.n[2];
        level.most = 2 * std::max(slots, expected);
        level.least = slots > 64 ? slots / 16 : 0;
        if (!changed) return false;
        level.inverse_width = {inverse_width[0], inverse_width[1], inverse_width[2]};
        level.steps_per_length = 255 * *std::min_element(inverse_width, inverse_width + 3);
        for (int a = 0; a < 3; ++a) level.steps[a] = level.steps_per_length / inverse_width[a];
        return true;
    }

    template <class ShellOf>
    void fit(int k, const ShellOf& shell_of) {
        Level& level = levels_[size_t(k)];
        if (!lay_out(level, std::ldexp(width_, k), level.population)) return;
        const Array<Line> old = std::exchange(level.lines, {});
        clear(level);
        for (const Line& line : old)
            for (const int32_t i : line.id)
                if (i >= 0) push(level, i, shell_of(i));
    }
    static void clear(Level& level) {
        level.lines.assign(size_t(level.n[0] * level.n[1] * level.n[2]), Line{});
        level.free = -1;
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
        return int32_t((c * l.n[1] + b) * l.n[0] + a);
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
        bool around;              // all there are: what is far may be nearer the other way round
    };
    static Range range(double u, double radius, int64_t n) {
        const double own = floored(u), part = u - own;
        const double lo = floored(part - radius), count = floored(part + radius) - lo + 1;
        if (count < double(n)) return {wrap(own + lo, n), int64_t(count), n, -lo, false};
        const auto before = double((n - 1) / 2);
        return {wrap(own - before, n), n, n, before, true};
    }
    static void fill(CellBlock::Axis& a, const Range& r, double u, double steps, int64_t stride) {
        a.n = int32_t(r.count);
        const int place = fine(u, steps);
        int64_t slot = r.first;
        for (int k = 0; k < a.n; ++k) {
            a.line[k] = int32_t(slot * stride);
            a.seen[k] = int16_t(place + int(nearest((r.before - k) * steps)));
            slot = slot + 1 == r.n ? 0 : slot + 1;
        }
    }
    static int16_t way_round(const Range& r, double steps) {
        return int16_t(r.around ? nearest(double(r.n) * steps) : INT16_MAX);
    }

    template <class ShellOf>
    void search(const Level& l, const Shell& s, const ShellOf& shell_of, Found& out) const {
        // Shells on this level reach at most half a cell.
        const Vec3 u = in_cells(s.centre, l), radius = l.inverse_width * s.reach;
        const Range x = range(u.x, radius.x + 0.5, l.n[0]), y = range(u.y, radius.y + 0.5, l.n[1]),
                    z = range(u.z, radius.z + 0.5, l.n[2]);
        const bool around = x.around || y.around || z.around;
        // Two places and a step between cells are rounded, and the way round: 3 > sqrt(3) (1 + 1/2)
        // and 4 > sqrt(3) 2.
        const int reach = fine_reach(s.reach, l) + (around ? 4 : 3);
        if (std::max({x.count, y.count, z.count}) > CellBlock::kMost || reach >= (1 << 13))
            return all(l, x, y, z, s, shell_of, out);
        CellBlock block;
        block.minus_reach = int16_t(-reach);
        block.around = around;
        block.way_round[0] = way_round(x, l.steps[0]);
        block.way_round[1] = way_round(y, l.steps[1]);
        block.way_round[2] = way_round(z, l.steps[2]);
        fill(block.x, x, u.x, l.steps[0], 1);
        fill(block.y, y, u.y, l.steps[1], x.n);
        fill(block.z, z, u.z, l.steps[2], x.n * y.n);
        const size_t before = out.n;
        near(l, block, out);
        // On a level of much larger spheres steps are coarse, and those who are there are few.
        if (!l.folded && reach > 32) return;
        size_t kept = before;
        for (size_t k = before; k < out.n; ++k) {
            const int32_t j = out.id[k];
            const Shell o = shell_of(j);
            const double most = (s.reach + o.reach) * (1 + 1e-9);
            out.id[kept] = j;
            kept += distance2(s.centre, o.centre) < most * most;
        }
        out.n = kept;
    }

    void near(const Level& l, const CellBlock& block, Found& out) const {
        for (;;) {
            const int32_t more = kernels_->near(l.lines.data(), block, &out.id[out.n],
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
            for (auto at = int32_t(slot); at >= 0; at = l.lines[size_t(at)].next) {
                for (const int32_t j : l.lines[size_t(at)].id) {
                    if (j < 0) break;
                    const Shell o = shell_of(j);
                    const double near = s.reach + o.reach;
                    if (distance2(s.centre, o.centre) < near * near) out.add(j);
                }
            }
        };
        each(rz, [&](int64_t z) {
            each(ry,
                 [&](int64_t y) { each(rx, [&](int64_t x) { look((z * ry.n + y) * rx.n + x); }); });
        });
    }

    static void move(const Line& from, int k, Line& to, int at) {
        to.id[at] = from.id[k];
        to.xy[at] = from.xy[k];
        to.zr[at] = from.zr[k];
    }

    static void push(Level& l, int i, const Shell& s) {
        const Vec3 u = in_cells(s.centre, l);
        const auto slot = size_t(slot_of(l, u));
        if (l.lines[slot].full()) {  // its content moves to a line behind it
            int32_t spare = l.free;
            if (spare >= 0) {
                l.free = l.lines[size_t(spare)].next;
            } else {
                spare = int32_t(l.lines.size());
                grow(l.lines);
            }
            l.lines[size_t(spare)] = l.lines[slot];
            l.lines[slot] = Line{};
            l.lines[slot].next = spare;
        }
        Line& head = l.lines[slot];
        const int k = head.size();
        head.id[k] = i;
        head.xy[k] = {uint8_t(fine(u.x, l.steps[0])), uint8_t(fine(u.y, l.steps[1]))};
        head.zr[k] = {uint8_t(fine(u.z, l.steps[2])),
                      uint8_t(std::min(fine_reach(s.reach, l), 255))};
    }

    static void take(Level& l, int32_t slot, int i) {
        Line& head = l.lines[size_t(slot)];
        for (int32_t c = slot; c >= 0; c = l.lines[size_t(c)].next) {
            Line& line = l.lines[size_t(c)];
            const int k = line.find(i);
            if (k < 0) continue;
            const int last = head.size() - 1;
            move(head, last, line, k);
            head.id[last] = -1;
            if (last == 0 && head.next >= 0) {  // the line behind becomes the head
                const int32_t behind = head.next;
                head = l.lines[size_t(behind)];
                l.lines[size_t(behind)] = Line{};
                l.lines[size_t(behind)].next = l.free;
                l.free = behind;
            }
            return;
        }
    }

    double width_ = 1;
    Vec3 period_, inverse_period_, extent_, room_;
    size_t count_ = 0;
    std::vector<Level> levels_;
    const Kernels* kernels_ = nullptr;
};

}  // namespace carom

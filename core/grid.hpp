// Who is near in a dilute gas of like spheres: cells as wide as a sphere or a little more, and no
// lists. Whoever may touch a sphere is in one of the 27 cells around it; when it crosses into the
// next cell, nine new ones are looked into. That costs a quarter of making a list, and a quarter of
// the memory.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "contact.hpp"
#include "memory.hpp"
#include "simd/kernels.hpp"
#include "vec3.hpp"

namespace carom {

class Grid {
public:
    // Coordinates of a cell, ten bits each; above them the axis along which a sphere will leave it.
    static constexpr int kBits = 10, kMost = (1 << kBits) - 1;
    struct Cell {
        int32_t c[3];
    };
    static uint32_t pack(Cell a, int axis) {
        return uint32_t(a.c[0] | a.c[1] << kBits | a.c[2] << (2 * kBits)) | uint32_t(axis)
                                                                                << (3 * kBits);
    }
    static Cell unpack(uint32_t p) {
        return {
            {int32_t(p & kMost), int32_t(p >> kBits & kMost), int32_t(p >> (2 * kBits) & kMost)}};
    }
    static int axis(uint32_t p) { return int(p >> (3 * kBits)); }

    // Cells at least `width` wide in a room of `size` around `centre`. Along an axis with walls the
    // cells of the border go on for ever. False if that makes too few cells, or too many.
    bool reset(double width, const Vec3& centre, const Vec3& size, const bool periodic[3],
               size_t spheres) {
        const double side[3] = {size.x, size.y, size.z}, mid[3] = {centre.x, centre.y, centre.z};
        double all = 1;
        for (int a = 0; a < 3; ++a) {
            const double n = std::floor(side[a] / width);
            // Within fewer, two in cells side by side may be nearer the other way round.
            if (!(n >= 5 && n <= kMost)) return false;
            n_[a] = int32_t(n);
            width_[a] = side[a] / n;
            low_[a] = mid[a] - 0.5 * side[a];
            period_[a] = periodic[a] ? side[a] : 0;
            all *= n;
        }
        if (all > 4 * double(spheres) + 64) return false;
        bordered_ = !(periodic[0] && periodic[1] && periodic[2]);
        widths_ = {width_[0], width_[1], width_[2], 0};
        halves_ = widths_ * 0.5;
        lows_ = {low_[0], low_[1], low_[2], 0};
        periods_ = {period_[0], period_[1], period_[2], 0};
        const auto inverse = [&](int a) { return periodic[a] ? 1 / side[a] : 0; };
        inverses_ = {inverse(0), inverse(1), inverse(2), 0};
        fill(0, 1);
        fill(1, n_[0]);
        fill(2, n_[0] * n_[1]);
        clear();
        return true;
    }
    void clear() {
        const size_t n = size_t(n_[0]) * size_t(n_[1]) * size_t(n_[2]);
        cells_.reserve(n + n / 16);  // room that is not used is not taken
        cells_.assign(n, GridCell{});
        free_ = -1;
    }

    Cell cell_of(const Vec3& x) const {
        const double p[3] = {x.x, x.y, x.z};
        Cell out;
        for (int a = 0; a < 3; ++a) {
            const auto c = int64_t(std::clamp((p[a] - low_[a]) / width_[a], 0.0, n_[a] - 1.0));
            out.c[a] = int32_t(c);
        }
        return out;
    }

    void add(int32_t i, Cell at) {
        const int32_t number = number_of(at);
        GridCell* cell = &cells_[size_t(number)];
        if (const uint32_t free = places_of(-1, *cell); free != 0) {
            cell->id[std::countr_zero(free)] = i;
            return;
        }
        // Full: the last gives way to a link, to a cell behind that holds it and what was linked.
        int32_t spare = free_;
        if (spare >= 0) {
            free_ = cells_[size_t(spare)].id[0];
        } else {
            spare = int32_t(cells_.size());
            grow(cells_);
            cell = &cells_[size_t(number)];
        }
        GridCell& behind = cells_[size_t(spare)];
        behind = GridCell{};
        behind.id[0] = i;
        behind.id[GridCell::kPlaces - 1] = cell->id[GridCell::kPlaces - 1];
        cell->id[GridCell::kPlaces - 1] = GridCell::link(spare);
    }

    void remove(int32_t i, Cell at) {  // it must be there
        int32_t number = number_of(at), before = -1;
        for (;;) {
            GridCell& cell = cells_[size_t(number)];
            if (const uint32_t place = places_of(i, cell); place != 0) {
                cell.id[std::countr_zero(place)] = -1;
                if (before >= 0) tidy(before, number);
                return;
            }
            before = number;
            number = GridCell::link(cell.id[GridCell::kPlaces - 1]);
        }
    }

    bool has(int32_t i, Cell at) const {
        for (int32_t number = number_of(at);;) {
            const GridCell& cell = cells_[size_t(number)];
            for (const int32_t id : cell.id)
                if (id == i) return true;
            if (cell.id[GridCell::kPlaces - 1] >= -1) return false;
            number = GridCell::link(cell.id[GridCell::kPlaces - 1]);
        }
    }

    // From the middle of the cell to x, nearest image. (Of the fourth number, nothing.)
    Four from_middle(const Four& x, Cell at) const {
        const Four middle{at.c[0] + 0.5, at.c[1] + 0.5, at.c[2] + 0.5, 0};
        const Four d = x - (lows_ + middle * widths_);
        return d - nearest(d * inverses_) * periods_;
    }

    // Up to rounding.
    bool holds(const Vec3& x, Cell at) const {
        const Four from = from_middle(Four(x), at);
        const double d[3] = {from.x(), from.y(), from.z()};
        for (int a = 0; a < 3; ++a) {
            const double most = width_[a] * (0.5 + 1e-9);
            const bool border_low = period_[a] == 0 && at.c[a] == 0,
                       border_high = period_[a] == 0 && at.c[a] == n_[a] - 1;
            if ((d[a] < -most && !border_low) || (d[a] > most && !border_high)) return false;
        }
        return true;
    }

    // When and through which face a sphere at d from the middle leaves its cell.
    struct Crossing {
        double wait;
        int axis;
    };
    Crossing crossing(const Four& d, const Four& v, Cell at) const {
        const auto until = [](Two from, Two speed, Two half) {
            const Two wait = ((speed < 0 ? -half : half) - from) / speed;
            return speed != 0 ? wait : Two{} + kNever;
        };
        const Four waits{until(d.xy, v.xy, halves_.xy), until(d.zw, v.zw, halves_.zw)};
        double wait[3] = {waits.x(), waits.y(), waits.z()};
        if (bordered_) {
            const double speed[3] = {v.x(), v.y(), v.z()};
            for (int a = 0; a < 3; ++a)
                if (period_[a] == 0 && at.c[a] == (speed[a] > 0 ? n_[a] - 1 : 0)) wait[a] = kNever;
        }
        Crossing out{kNever, 0};       // of a sphere at rest
        for (int a = 0; a < 3; ++a) {  // no branches: nothing here can be foreseen
            out.axis = wait[a] < out.wait ? a : out.axis;
            out.wait = wait[a] < out.wait ? wait[a] : out.wait;
        }
        out.wait = std::max(out.wait, 0.0);
        return out;
    }
    Cell next(Cell at, int axis, bool up) const {
        int32_t& c = at.c[axis];
        c += up ? 1 : -1;
        if (c < 0) c = n_[axis] - 1;
        if (c == n_[axis]) c = 0;
        return at;
    }

    static bool upwards(const Vec3& v, int axis) {
        return (axis == 0 ? v.x : axis == 1 ? v.y : v.z) > 0;
    }

    GridBlock around(Cell at) const {
        return {part(0, at, kAround), part(1, at, kAround), part(2, at, kAround)};
    }
    // The nine cells that come into sight through the face just crossed; none behind a border, for
    // that goes on for ever.
    GridBlock face(Cell at, int axis, bool up) const {
        const int face = up ? kAbove : kBelow;
        return {part(0, at, axis == 0 ? face : kAround), part(1, at, axis == 1 ? face : kAround),
                part(2, at, axis == 2 ? face : kAround)};
    }
    // All cells around either of two, of which none is further along any axis than the next: false
    // if one is.
    bool around_both(Cell p, Cell q, GridBlock& out) const {
        GridBlock::Axis* axes[3] = {&out.x, &out.y, &out.z};
        bool beside = true;
        for (int a = 0; a < 3; ++a) {
            // The lower of the two, and the next, which may be the first.
            const int32_t d = q.c[a] - p.c[a], round = period_[a] > 0 ? n_[a] - 1 : n_[a];
            const bool up = (d == 1) | (d == -round), down = (d == -1) | (d == round);
            beside &= (d == 0) | up | down;
            *axes[a] = part(a, down ? q : p, d != 0 ? kAroundTwo : kAround);
        }
        return beside;
    }

    void fetch_cell(Cell at) const { fetch(&cells_[size_t(number_of(at))]); }
    void fetch_block(const GridBlock& b) const {
        if (b.x.cell[0] < 0) return;
        const auto& x = b.x.cell;
        const int32_t first = x[0], last = x[3] >= 0 ? x[3] : x[2] >= 0 ? x[2] : first;
        for (int kz = 0; kz < 4 && b.z.cell[kz] >= 0; ++kz)
            for (int ky = 0; ky < 4 && b.y.cell[ky] >= 0; ++ky) {
                const int32_t row = b.z.cell[kz] + b.y.cell[ky];
                fetch(&cells_[size_t(row + first)]);
                fetch(&cells_[size_t(row + last)]);
            }
    }

    // Cells behind others.
    size_t links() const { return cells_.size() - size_t(n_[0]) * size_t(n_[1]) * size_t(n_[2]); }

    const GridCell* cells() const { return cells_.data(); }
    size_t bytes() const { return cells_.capacity() * sizeof(GridCell); }

private:
    // Bit k: place k holds i. No branch, for which it is cannot be foreseen (a gas 1.04 times
    // faster).
    static uint32_t places_of(int32_t i, const GridCell& cell) {
#if defined(__SSE2__)
        const __m128i id = _mm_load_si128(reinterpret_cast<const __m128i*>(cell.id));
        return uint32_t(_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpeq_epi32(id, _mm_set1_epi32(i)))));
#else
        uint32_t places = 0;
        for (int k = 0; k < GridCell::kPlaces; ++k) places |= uint32_t(cell.id[k] == i) << k;
        return places;
#endif
    }
    int32_t number_of(Cell a) const { return (a.c[2] * n_[1] + a.c[1]) * n_[0] + a.c[0]; }

    // Which cells of an axis, seen from one: from the one before to the one after, to the second
    // after, only the one before, only the one after. Kept for every coordinate, in whole pieces
    // that can be read as they were written.
    enum Part { kAround, kAroundTwo, kBelow, kAbove, kParts };
    const GridBlock::Axis& part(int axis, Cell at, int which) const {
        return parts_[axis][size_t(kParts * at.c[axis] + which)];
    }
    void fill(int axis, int32_t stride) {
        constexpr int32_t first[kParts] = {-1, -1, -1, 1}, last[kParts] = {1, 2, -1, 1};
        const int32_t n = n_[axis];
        parts_[axis].clear();
        for (int32_t c = 0; c < n; ++c)
            for (int which = 0; which < kParts; ++which) {
                constexpr int32_t end = GridBlock::Axis::kEnd;
                GridBlock::Axis& out =
                    parts_[axis].emplace_back(GridBlock::Axis{{end, end, end, end}});
                int m = 0;
                for (int32_t k = c + first[which]; k <= c + last[which]; ++k)
                    if (period_[axis] > 0 || (k >= 0 && k < n))
                        out.cell[m++] = (k + n) % n * stride;
            }
    }

    // Drops the cell behind `before` once it is empty.
    void tidy(int32_t before, int32_t number) {
        constexpr int last = GridCell::kPlaces - 1;
        GridCell& cell = cells_[size_t(number)];
        for (const int32_t id : cell.id)
            if (id >= 0) return;
        cells_[size_t(before)].id[last] = cell.id[last];
        cell.id[0] = free_;
        free_ = number;
    }

    int32_t n_[3] = {0, 0, 0};
    bool bordered_ = false;  // an axis has walls
    double width_[3], low_[3], period_[3];
    Four widths_, halves_, lows_, periods_, inverses_;
    std::vector<GridBlock::Axis> parts_[3];
    Array<GridCell> cells_;
    int32_t free_ = -1;  // chain of spare cells
};

}  // namespace carom

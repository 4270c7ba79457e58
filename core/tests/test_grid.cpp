// The grid holds what a map holds.
#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "../grid.hpp"
#include "check.hpp"

using namespace carom;

namespace {

std::mt19937_64 bits(3);
int whole(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(bits); }
double uniform(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(bits);
}

}  // namespace

TEST(the_grid_holds_what_a_map_holds) {
    const bool periodic[3] = {true, false, true};
    constexpr int n[3] = {5, 6, 7};
    Grid grid;
    CHECK(!grid.reset(1, {}, {3, 9, 9}, periodic, 1000));       // too few cells
    CHECK(!grid.reset(1, {}, {2000, 9, 9}, periodic, 100000));  // too many along an axis
    CHECK(!grid.reset(1, {}, {100, 100, 100}, periodic, 100));  // too many
    CHECK(grid.reset(1, {}, {5.5, 6.5, 7.5}, periodic, 100));
    std::map<uint32_t, std::set<int32_t>> map;  // of packed cells
    std::map<int32_t, uint32_t> where;
    size_t most = 0;
    for (int step = 0; step < 30000; ++step) {
        // Now and then all into a few cells, and out again.
        const bool crowd = step / 3000 % 2 == 0;
        const int32_t i = whole(0, 150);
        const auto at = where.find(i);
        if (at != where.end()) {
            grid.remove(i, Grid::unpack(at->second));
            map[at->second].erase(i);
            where.erase(at);
        } else {
            const Grid::Cell c = crowd ? Grid::Cell{{whole(0, 1), 0, 0}}
                                       : Grid::Cell{{whole(0, 4), whole(0, 5), whole(0, 6)}};
            for (const int a : {0, 1, 2}) {
                CHECK(Grid::pack(Grid::unpack(Grid::pack(c, a)), a) == Grid::pack(c, a));
                CHECK(Grid::axis(Grid::pack(c, a)) == a);
            }
            grid.add(i, c);
            map[Grid::pack(c, 0)].insert(i);
            where[i] = Grid::pack(c, 0);
        }
        if (step == 15000) most = grid.bytes();
        if (step % 50 != 0) continue;
        const Grid::Cell c{{whole(0, 4), whole(0, 5), whole(0, 6)}};
        const int axis = whole(0, 2);
        const bool up = whole(0, 1) == 1;
        for (const bool all : {true, false}) {
            std::vector<int32_t> expected;
            for (int dx = -1; dx <= 1; ++dx)
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dz = -1; dz <= 1; ++dz) {
                        const int d[3] = {dx, dy, dz};
                        if (!all && d[axis] != (up ? 1 : -1)) continue;
                        Grid::Cell near{};
                        bool there = true;
                        for (int a = 0; a < 3; ++a) {
                            near.c[a] = c.c[a] + d[a];
                            if (periodic[a]) near.c[a] = (near.c[a] + n[a]) % n[a];
                            there = there && near.c[a] >= 0 && near.c[a] < n[a];
                        }
                        if (!there) continue;
                        const std::set<int32_t>& ids = map[Grid::pack(near, 0)];
                        expected.insert(expected.end(), ids.begin(), ids.end());
                        for (const int32_t j : ids) CHECK(grid.has(j, near));
                    }
            std::sort(expected.begin(), expected.end());
            // Behind a border there is nothing new: whatever is found does no harm.
            const bool border = !all && !periodic[axis] && c.c[axis] == (up ? n[axis] - 1 : 0);
            const GridBlock block = all ? grid.around(c) : grid.face(c, axis, up);
            for (const std::string& level : simd_levels()) {
                std::vector<int32_t> out(200);
                const int32_t found = kernels(level).collect(grid.cells(), block, out.data(), 200);
                CHECK(found >= 0);
                out.resize(size_t(std::max(found, 0)));
                std::sort(out.begin(), out.end());
                CHECK(border ? out.empty() : out == expected);
                if (out.size() > 5)
                    CHECK(kernels(level).collect(grid.cells(), block, out.data(), 4) == -1);
            }
        }
    }
    CHECK(grid.bytes() <= most * 2);  // spare cells are used again
}

TEST(grid_around_both) {
    const bool periodic[3] = {true, false, true};
    const int32_t n[3] = {5, 6, 7};
    Grid grid;
    CHECK(grid.reset(1, {}, {5.5, 6.5, 7.5}, periodic, 300));
    for (int32_t i = 0; i < 300; ++i)
        grid.add(i, Grid::Cell{{whole(0, 4), whole(0, 5), whole(0, 6)}});
    const auto all_in = [&](const GridBlock& block, const std::string& level) {
        std::vector<int32_t> ids(400);
        ids.resize(size_t(kernels(level).collect(grid.cells(), block, ids.data(), 400)));
        std::sort(ids.begin(), ids.end());
        return ids;
    };
    for (int k = 0; k < 3000; ++k) {
        Grid::Cell p{}, q{};
        bool beside = true;
        for (int a = 0; a < 3; ++a) {
            p.c[a] = whole(0, n[a] - 1);
            q.c[a] =
                k % 2 == 0 ? whole(0, n[a] - 1) : std::clamp(p.c[a] + whole(-1, 1), 0, n[a] - 1);
            const int32_t d = std::abs(p.c[a] - q.c[a]);
            beside = beside && (d <= 1 || (periodic[a] && d == n[a] - 1));
        }
        GridBlock both;
        CHECK(grid.around_both(p, q, both) == beside);
        if (!beside) continue;
        for (const std::string& level : simd_levels()) {
            const std::vector<int32_t> found = all_in(both, level);
            CHECK(std::adjacent_find(found.begin(), found.end()) == found.end());
            for (const Grid::Cell& c : {p, q}) {
                const std::vector<int32_t> one = all_in(grid.around(c), level);
                CHECK(std::includes(found.begin(), found.end(), one.begin(), one.end()));
            }
        }
    }
}

TEST(grid_crossings) {
    const bool periodic[3] = {true, false, true};
    Grid grid;
    CHECK(grid.reset(1, {0.5, 1, -3}, {5.5, 6.5, 7.5}, periodic, 100));
    const double low[3] = {0.5 - 2.75, 1 - 3.25, -3 - 3.75}, width[3] = {1.1, 6.5 / 6, 7.5 / 7},
                 period[3] = {5.5, 0, 7.5};
    for (int n = 0; n < 20000; ++n) {
        double x[3], v[3];
        for (int a = 0; a < 3; ++a) {
            x[a] = uniform(low[a], low[a] + (a == 0 ? 5.5 : a == 1 ? 6.5 : 7.5));
            v[a] = whole(0, 4) == 0 ? 0 : uniform(-1, 1);
        }
        const Vec3 at{x[0], x[1], x[2]}, by{v[0], v[1], v[2]};
        const Grid::Cell cell = grid.cell_of(at);
        CHECK(grid.holds(at, cell));
        double wait = kNever;
        int axis = 0;
        for (int a = 0; a < 3; ++a) {
            CHECK(cell.c[a] == int((x[a] - low[a]) / width[a]));
            const int behind = cell.c[a] + (v[a] > 0 ? 1 : 0);
            if (period[a] == 0 && (v[a] > 0 ? cell.c[a] == 5 : cell.c[a] == 0)) continue;
            const double t = v[a] == 0 ? kNever : (low[a] + behind * width[a] - x[a]) / v[a];
            if (t < wait) wait = t, axis = a;
        }
        const auto c = grid.crossing(grid.from_middle(Four(at), cell), Four(by), cell);
        if (wait == kNever) {
            CHECK(c.wait == kNever);
            continue;
        }
        CHECK(std::abs(c.wait - wait) <= 1e-12 * (1 + wait));
        if (c.axis != axis) continue;  // through an edge, by rounding
        const Grid::Cell next = grid.next(cell, axis, v[axis] > 0);
        CHECK(grid.holds(at + by * c.wait, cell) && grid.holds(at + by * c.wait, next));
        CHECK(grid.crossing(grid.from_middle(Four(at + by * c.wait), next), Four(by), next).wait >=
              0);
    }
    // Along an axis with walls the cells of the border go on for ever.
    for (const double far : {1e9, 1e300}) {
        CHECK(grid.cell_of({0, far, 0}).c[1] == 5 && grid.cell_of({0, -far, 0}).c[1] == 0);
        CHECK(grid.holds({0, far, 0}, grid.cell_of({0, far, 0})));
    }
}

// Rows, cells, the grid and the calendar lose nothing, however much they hold.
#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "../calendar.hpp"
#include "../cells.hpp"
#include "../clock.hpp"
#include "../grid.hpp"
#include "../neighbours.hpp"
#include "check.hpp"

using namespace carom;

namespace {

std::mt19937_64 bits(3);
int whole(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(bits); }
double uniform(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(bits);
}

std::multiset<int32_t> row_of(const Rows& rows, int i) {
    std::multiset<int32_t> ids;
    for (const Row& row : rows.of(i)) ids.insert(row.id, row.id + row.n);
    return ids;
}

// What is not a neighbour is the sphere itself.
bool padded(const Rows& rows, int i) {
    for (const Row& row : rows.of(i))
        for (int k = row.n; k < Row::kPlaces; ++k)
            if (row.id[k] != i) return false;
    return true;
}

}  // namespace

TEST(rows_grow_and_shrink) {
    Rows rows;
    rows.reset(3);
    rows.line(1).margin = 7;
    for (int j = 0; j < 500; ++j) rows.add(1, j);
    CHECK(rows.size(1) == 500 && rows.size(0) == 0);
    CHECK(rows.of(1).size() > 1 && rows.line(1).margin == 7);
    for (int j = 0; j < 490; ++j) rows.remove(1, j);
    CHECK(row_of(rows, 1).size() == 10 && *row_of(rows, 1).begin() == 490);
    CHECK(rows.of(1).size() == 1 && rows.line(1).margin == 7);
    for (int j = 0; j < 100; ++j) rows.add(2, j);  // takes over the long list row 1 gave back
    CHECK(rows.size(2) == 100 && rows.size(1) == 10);
}

TEST(rows_hold_what_sets_hold) {
    constexpr int n = 5;
    Rows rows;
    rows.reset(n);
    std::set<int32_t> sets[n];
    for (int step = 0; step < 20000; ++step) {
        const int i = whole(0, n - 1), most = i * 25;
        std::set<int32_t>& set = sets[i];
        if (whole(0, 99) == 0) {
            std::vector<int32_t> ids;
            for (int k = whole(0, most); k > 0; --k) ids.push_back(100 + k);
            rows.assign(i, ids);
            set = {ids.begin(), ids.end()};
        } else if (int(set.size()) < whole(0, most)) {
            const int32_t j = whole(100, 1000);
            if (set.insert(j).second) rows.add(i, j);
        } else if (!set.empty()) {
            const int32_t j = *std::next(set.begin(), whole(0, int(set.size()) - 1));
            set.erase(j);
            rows.remove(i, j);
        }
        CHECK(rows.size(i) == set.size() && padded(rows, i));
        CHECK(row_of(rows, i) == std::multiset<int32_t>(set.begin(), set.end()));
    }
}

namespace {

// Adds shells of very different reach, moves some, and compares every search with all pairs: with
// every instruction set the same, nobody missed, nobody found twice, hardly any too many.
void search_everything(const Vec3& period, double spread) {
    std::vector<std::vector<int32_t>> first;
    for (const std::string& level : simd_levels()) {
        std::mt19937_64 same(3);
        std::uniform_real_distribution<double> u(-0.5, 0.5);
        Cells cells;
        cells.reset(1.0, period, Vec3{1, 1, 1} * spread, {kNever, kNever, kNever}, 300,
                    kernels(level));
        std::vector<Shell> shells(300);
        const auto shell_of = [&](int32_t j) { return shells[size_t(j)]; };
        const auto place = [&](Shell& s, double reach) {
            s = {{u(same) * spread, u(same) * spread, u(same) * spread}, reach};
        };
        for (size_t i = 0; i < shells.size(); ++i) {
            place(shells[i], i % 50 == 0 ? 3.0 : 0.1 + 0.4 * std::abs(u(same)));
            cells.add(int(i), shells[i], shell_of);
        }
        for (size_t i = 0; i < shells.size(); i += 2) {
            cells.remove(int(i), shells[i], shell_of);
            place(shells[i], shells[i].reach);
            cells.add(int(i), shells[i], shell_of);
        }
        std::vector<std::vector<int32_t>> answers;
        size_t extra = 0, real = 0;
        for (size_t i = 0; i < shells.size(); ++i) {
            Found found;
            cells.remove(int(i), shells[i], shell_of);
            cells.search(shells[i], shell_of, found);
            cells.add(int(i), shells[i], shell_of);
            std::vector<int32_t> ids(found.ids().begin(), found.ids().end());
            std::sort(ids.begin(), ids.end());
            CHECK(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
            for (size_t j = 0; j < shells.size(); ++j) {
                if (j == i) continue;
                const double near = shells[i].reach + shells[j].reach,
                             d2 = cells.distance2(shells[i].centre, shells[j].centre);
                const bool known = std::binary_search(ids.begin(), ids.end(), int32_t(j));
                if (d2 < near * near) CHECK(known);
                extra += known && d2 >= near * near;
                real += d2 < near * near;
            }
            answers.push_back(ids);
        }
        if (first.empty()) first = answers;
        CHECK(answers == first);
        CHECK(spread > 100 || 10 * extra < 2 * real + 100);
    }
}

}  // namespace

TEST(cells_find_every_neighbour) {
    search_everything({8, 8, 8}, 8);
    search_everything({8, 5.5, 11}, 30);  // unequal cells, places many boxes away
    search_everything({1.5, 1.5, 1.5}, 1.5);
    search_everything({0, 0, 0}, 8);
    search_everything({0, 0, 0}, 300);
    search_everything({0, 9, 0}, 1e9);
    search_everything({0, 0, 0}, 1e15);
    search_everything({0, 0, 0}, 1e200);
    search_everything({0, 0, 0}, 1e300);
    search_everything({0, 0, 0}, 0.01);  // all in one cell
}

TEST(lines_are_searched_as_they_are_defined) {
    for (int n = 0; n < 300; ++n) {
        constexpr int kHeads = 27;
        Array<CellLine> lines(kHeads);
        int32_t id = 0;
        for (int at = 0; at < int(lines.size()); ++at) {
            const int full = whole(0, 9) == 0 && lines.size() < 60 ? 7 : whole(0, 7);
            for (int k = 0; k < full; ++k) {
                lines[size_t(at)].id[k] = id++;
                lines[size_t(at)].xy[k] = {uint8_t(whole(0, 255)), uint8_t(whole(0, 255))};
                lines[size_t(at)].zr[k] = {uint8_t(whole(0, 255)), uint8_t(whole(0, 255))};
            }
            lines[size_t(at)].xy[7] = lines[size_t(at)].zr[7] = {uint8_t(whole(0, 255)), 255};
            if (full < 7 || lines.size() >= 60) continue;
            lines[size_t(at)].next = int32_t(lines.size());
            lines.emplace_back();
        }
        CellBlock block;
        const int scale = n % 3 == 0 ? 16000 : 400;
        int stride = 1;
        for (CellBlock::Axis* a : {&block.x, &block.y, &block.z}) {
            a->n = whole(1, 3);
            for (int k = 0; k < a->n; ++k) {
                a->line[k] = k * stride;
                a->seen[k] = int16_t(whole(-scale, scale));
            }
            stride *= 3;
        }
        block.minus_reach = int16_t(-whole(1, scale));
        std::vector<int32_t> expected;
        for (int z = 0; z < block.z.n; ++z)
            for (int y = 0; y < block.y.n; ++y)
                for (int x = 0; x < block.x.n; ++x)
                    for (int at = block.z.line[z] + block.y.line[y] + block.x.line[x]; at >= 0;
                         at = lines[size_t(at)].next) {
                        const CellLine& line = lines[size_t(at)];
                        for (int k = 0; k < line.size(); ++k) {
                            const int64_t dx = block.x.seen[x] - line.xy[k].first,
                                          dy = block.y.seen[y] - line.xy[k].second,
                                          dz = block.z.seen[z] - line.zr[k].first,
                                          r = block.minus_reach - line.zr[k].second;
                            if (dx * dx + dy * dy + dz * dz < r * r) expected.push_back(line.id[k]);
                        }
                    }
        for (const std::string& level : simd_levels()) {
            std::vector<int32_t> out(expected.size() + 8);
            const int32_t found =
                kernels(level).near(lines.data(), block, out.data(), int32_t(out.size()));
            CHECK(found == int32_t(expected.size()));
            out.resize(expected.size());
            CHECK(out == expected);
            if (expected.size() < 4) continue;
            std::vector<int32_t> narrow(expected.size() - 1);
            CHECK(kernels(level).near(lines.data(), block, narrow.data(), int32_t(narrow.size())) ==
                  -1);
        }
    }
}

TEST(differences_of_rows) {
    for (int n = 0; n < 2000; ++n) {
        Row row;
        row.n = int16_t(whole(0, Row::kPlaces));
        row.margin = int16_t(whole(-5, 60));
        const int from = whole(0, 1) * 1000000;
        std::vector<int32_t> pool(60);
        for (size_t k = 0; k < pool.size(); ++k) pool[k] = from + int32_t(k);
        std::shuffle(pool.begin(), pool.end(), bits);
        for (int k = 0; k < Row::kPlaces; ++k) row.id[k] = k < row.n ? pool[size_t(k)] : 77777;
        std::shuffle(pool.begin(), pool.end(), bits);
        const std::vector<int32_t> now(pool.begin(), pool.begin() + whole(0, Row::kPlaces));
        uint32_t gone = 0, fresh = 0;
        for (int k = 0; k < row.n; ++k)
            gone |= uint32_t(std::count(now.begin(), now.end(), row.id[k]) == 0) << k;
        for (size_t k = 0; k < now.size(); ++k)
            fresh |= uint32_t(std::count(row.id, row.id + row.n, now[k]) == 0) << k;
        for (const std::string& level : simd_levels()) {
            const Difference d = kernels(level).difference(reinterpret_cast<const int32_t*>(&row),
                                                           row.n, now.data(), int(now.size()));
            CHECK(d.gone == gone && d.fresh == fresh);
        }
    }
}

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
        const auto c = grid.crossing(grid.from_middle(at, cell), by, cell);
        if (wait == kNever) {
            CHECK(c.wait == kNever);
            continue;
        }
        CHECK(std::abs(c.wait - wait) <= 1e-12 * (1 + wait));
        if (c.axis != axis) continue;  // through an edge, by rounding
        const Grid::Cell next = grid.next(cell, axis, v[axis] > 0);
        CHECK(grid.holds(at + by * c.wait, cell) && grid.holds(at + by * c.wait, next));
        CHECK(grid.crossing(grid.from_middle(at + by * c.wait, next), by, next).wait >= 0);
    }
    // Along an axis with walls the cells of the border go on for ever.
    for (const double far : {1e9, 1e300}) {
        CHECK(grid.cell_of({0, far, 0}).c[1] == 5 && grid.cell_of({0, -far, 0}).c[1] == 0);
        CHECK(grid.holds({0, far, 0}, grid.cell_of({0, far, 0})));
    }
}

namespace {

struct Queue {
    std::vector<Event> events;
    std::vector<int32_t> labels;
    Calendar calendar;
    bool gridded = false;

    explicit Queue(int n) : events(size_t(n)), labels(size_t(n)) {
        for (int i = 0; i < n; ++i) {
            labels[size_t(i)] = i;
            events[size_t(i)].partner = wall_code(0);
            events[size_t(i)].t = kNever;
        }
    }
    Pending pending() const { return {events.data(), labels.data(), events.size(), gridded}; }
    void set(int i, double t, int32_t partner) {
        events[size_t(i)].t = t;
        events[size_t(i)].partner = partner;
    }
    // The order of simultaneous events: bookkeeping, then by the labels of the pair.
    struct Key {
        double t;
        int32_t a, b, id;
        auto operator<=>(const Key&) const = default;
    };
    Key key(int i) const {
        const Event& e = events[size_t(i)];
        const int32_t partner = pending().partner(e), own = labels[size_t(i)];
        if (partner == kEscape) return {e.t, -1, own, i};
        if (partner < 0) return {e.t, own, partner, i};
        const int32_t other = labels[size_t(partner)];
        return {e.t, std::min(own, other), std::max(own, other), i};
    }
    bool next(double limit, Calendar::Due& due) {
        return calendar.next(pending(), limit, due, [] {});
    }
};

}  // namespace

TEST(the_calendar_returns_events_in_order) {
    for (const int crowd : {1000000, 3, 1}) {  // every third at one time: a heap of thousands
        for (const bool gridded : {false, true}) {
            constexpr int n = 3000;
            std::exponential_distribution<double> wait(1);
            Queue q(n);
            q.gridded = gridded;
            std::shuffle(q.labels.begin(), q.labels.end(), bits);
            const auto draw = [&](int i, double after) {
                // Times in eighths coincide; some are years away.
                double t = after + std::floor(8 * wait(bits)) / 8;
                if (whole(0, 1) == 0) t = after + wait(bits);
                if (whole(0, 50) == 0) t = after + 1e4 * wait(bits);
                const int kind = whole(0, 3);
                q.set(i, t,
                      kind == 0               ? wall_code(whole(0, 5))
                      : kind == 1 && !gridded ? kEscape
                                              : whole(0, n - 1));
                if (q.events[size_t(i)].partner == i) q.events[size_t(i)].partner = wall_code(1);
                if (gridded) q.events[size_t(i)].contact = kind == 1 ? t + 1 : t;
            };
            for (int i = 0; i < n; ++i) {
                draw(i, 0);
                if (i % crowd == 1) q.events[size_t(i)].t = 0.5;
                if (i % crowd == 1 && gridded) q.events[size_t(i)].contact = 0.5;
            }
            q.set(7, kNever, kNone);
            std::set<Queue::Key> truth;
            for (int i = 0; i < n; ++i)
                if (q.events[size_t(i)].t < kNever) truth.insert(q.key(i));
            q.calendar.reset(q.pending(), 0);
            int seen = 0;
            Calendar::Due due;
            while (q.next(kNever, due)) {
                CHECK(!truth.empty() && q.key(due.id) == *truth.begin() &&
                      due.t == truth.begin()->t);
                if (truth.empty() || !(q.key(due.id) == *truth.begin())) break;
                q.calendar.pop();
                truth.erase(truth.begin());
                ++seen;
                const auto again = [&](int i) {  // gets another event, and maybe none
                    truth.erase(q.key(i));
                    if (seen > 20000)
                        q.set(i, kNever, kNone);
                    else
                        draw(i, due.t);
                    if (q.events[size_t(i)].t == kNever) return;
                    truth.insert(q.key(i));
                    q.calendar.schedule(i, q.pending());
                };
                again(due.id);
                if (whole(0, 2) == 0) again(whole(0, n - 1));
            }
            CHECK(truth.empty() && seen > 20000);
        }
    }
}

TEST(the_calendar_stops_at_the_limit) {
    Queue q(1);
    Calendar::Due due;
    q.set(0, 10, wall_code(0));
    q.calendar.reset(q.pending(), 0);
    CHECK(!q.next(9.9, due));
    CHECK(q.next(10, due) && due.t == 10 && due.id == 0);
}

TEST(the_calendar_crosses_years_of_nothing) {
    Queue q(100);
    Calendar::Due due;
    for (int i = 0; i < 100; ++i) q.set(i, 1e-3 * i, wall_code(0));
    const double far[] = {1e3, 1e9, 1e9, 1e17, 1e18, 1e19, 1e30, 1e300, 1.7e308};
    for (int k = 0; k < 9; ++k) q.set(10 * (k + 1), far[k], wall_code(0));
    q.calendar.reset(q.pending(), 0);
    double last = 0;
    int seen = 0;
    for (; q.next(kNever, due); ++seen) {
        CHECK(due.t >= last);
        last = due.t;
        q.calendar.pop();
        if (due.t == 1e9 && due.id == 20) {  // one that is soon again, after all the years
            q.set(5, 1e9, wall_code(0));
            q.set(6, std::nextafter(1e9, 2e9), wall_code(0));
            q.calendar.schedule(5, q.pending());
            q.calendar.schedule(6, q.pending());
        }
        q.events[size_t(due.id)].t = kNever;
    }
    CHECK(seen == 102 && last == 1.7e308);
    CHECK(!q.next(kNever, due) && !q.next(1e300, due));
}

TEST(the_clock_is_exact) {
    Clock clock;
    clock.start(1e6 + 0.1, 3.0);
    CHECK(clock.epoch == 4);
    double offset = clock.offset(1e6 + 0.1);
    CHECK(clock.time(offset) == 1e6 + 0.1);
    for (int k = 0; k < 1000; ++k) offset = offset + 5.3 - clock.advance(offset + 5.3);
    CHECK(offset >= 0 && offset < clock.epoch);
    CHECK(clock.time(clock.offset(2e6 + 0.3)) == 2e6 + 0.3);
    CHECK(std::abs(clock.time(offset) - (1e6 + 0.1 + 5300)) < 1e-8);
}

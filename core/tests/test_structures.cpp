// Rows, cells and the calendar grow without losing anything.
#include <algorithm>
#include <random>
#include <set>

#include "../calendar.hpp"
#include "../cells.hpp"
#include "../clock.hpp"
#include "../neighbours.hpp"
#include "check.hpp"

using namespace carom;

TEST(rows_grow_and_shrink) {
    Rows rows;
    rows.reset(3);
    for (int j = 0; j < 500; ++j) rows.add(1, j);
    CHECK(rows.size(1) == 500 && rows.size(0) == 0);
    for (int j = 0; j < 490; ++j) rows.remove(1, j);
    const auto left = rows.of(1);
    std::set<int> ids(left.begin(), left.end());
    CHECK(ids.size() == 10 && *ids.begin() == 490);
    for (int j = 0; j < 100; ++j) rows.add(2, j);  // takes over the long list row 1 gave back
    CHECK(rows.size(2) == 100 && rows.size(1) == 10);
}

namespace {

// Adds shells of very different reach, moves some, and compares every search with all pairs.
void search_everything(const Vec3& period, double spread) {
    std::mt19937_64 bits(3);
    std::uniform_real_distribution<double> u(-0.5, 0.5);
    Cells cells;
    const double never = kNever;
    cells.reset(1.0, period, Vec3{1, 1, 1} * spread, {never, never, never}, 300, kernels());
    std::vector<Shell> shells(300);
    const auto shell_of = [&](int32_t j) { return shells[size_t(j)]; };
    const auto place = [&](Shell& s, double reach) {
        s = {{u(bits) * spread, u(bits) * spread, u(bits) * spread}, reach};
    };
    for (size_t i = 0; i < shells.size(); ++i) {
        place(shells[i], i % 50 == 0 ? 3.0 : 0.1 + 0.4 * std::abs(u(bits)));
        cells.add(int(i), shells[i], shell_of);
    }
    for (size_t i = 0; i < shells.size(); i += 2) {
        cells.remove(int(i), shells[i], shell_of);
        place(shells[i], shells[i].reach);
        cells.add(int(i), shells[i], shell_of);
    }
    for (size_t i = 0; i < shells.size(); ++i) {
        Found near;
        std::vector<int32_t> all;
        cells.remove(int(i), shells[i], shell_of);
        cells.search(shells[i], shell_of, near);
        cells.add(int(i), shells[i], shell_of);
        for (size_t j = 0; j < shells.size(); ++j) {
            const double near = shells[i].reach + shells[j].reach;
            if (j != i && cells.distance2(shells[i].centre, shells[j].centre) < near * near)
                all.push_back(int32_t(j));
        }
        // A hair more may be found; in open space far places share a cell and are told apart.
        std::vector<int32_t> found;
        for (const int32_t j : near.ids()) {
            const double most = shells[i].reach + shells[size_t(j)].reach;
            if (cells.distance2(shells[i].centre, shells[size_t(j)].centre) < most * most)
                found.push_back(j);
        }
        std::sort(found.begin(), found.end());
        CHECK(found == all);
        CHECK(near.n <= all.size() + 30);
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
    search_everything({0, 0, 0}, 1e200);
    search_everything({0, 0, 0}, 0.01);  // all in one cell
}

TEST(the_calendar_returns_events_in_order) {
    std::mt19937_64 bits(5);
    std::exponential_distribution<double> wait(1);
    std::vector<Event> events(1000);
    for (size_t i = 0; i < events.size(); ++i) {
        events[i].t = i % 100 == 0 ? 1e6 * wait(bits) : wait(bits);
        if (i % 3 == 0) events[i].t = 0.5;  // hundreds at once
        events[i].partner = wall_code(0);
    }
    events[7].t = kNever;
    Calendar calendar;
    calendar.reset(events, 0);
    double last = 0;
    int last_id = -1, seen = 0;
    while (const Entry* top = calendar.top(events, kNever)) {
        const Entry e = *top;
        calendar.pop();
        if (e.t != events[size_t(e.id)].t) continue;
        CHECK(e.t > last || (e.t == last && e.id > last_id));
        last = e.t, last_id = e.id;
        // Every second event is followed by another of the same sphere.
        Event& next = events[size_t(e.id)];
        next.t = ++seen % 2 ? e.t + wait(bits) : kNever;
        if (seen > 20000) next.t = kNever;
        calendar.schedule(e.id, next);
    }
    for (const Event& e : events) CHECK(e.t == kNever);
    CHECK(seen > 999);
}

TEST(the_calendar_stops_at_the_limit) {
    std::vector<Event> events(1);
    events[0].t = 10;
    events[0].partner = wall_code(0);
    Calendar calendar;
    calendar.reset(events, 0);
    CHECK(calendar.top(events, 9.9) == nullptr);
    CHECK(calendar.top(events, 10) != nullptr);
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

// The calendar returns every event, in order.
#include <algorithm>
#include <random>
#include <set>
#include <vector>

#include "../calendar.hpp"
#include "check.hpp"

using namespace carom;

namespace {

std::mt19937_64 bits(3);
int whole(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(bits); }

}  // namespace

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

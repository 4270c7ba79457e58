// The event queue: a calendar of buckets, each one cache line of sphere numbers.
//
// Every sphere has one pending event, at `time[i]`. An entry is never deleted: it is dead when its
// sphere's event has moved to another bucket, or is no longer the one the entry was made for. The
// bucket in hand is a small heap, ordered by (time, i, j), so that simultaneous events come in an
// order that nobody's bookkeeping can change.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact.hpp"
#include "memory.hpp"
#include "spheres.hpp"

namespace carom {

struct Entry {
    double t;
    int32_t a, b;  // the event's order among simultaneous ones
    int32_t id;    // whose event it is
};
inline bool later(const Entry& p, const Entry& q) {
    if (p.t != q.t) return p.t > q.t;
    if (p.a != q.a) return p.a > q.a;
    if (p.b != q.b) return p.b > q.b;
    return p.id > q.id;
}

class Calendar {
public:
    // Empties it and chooses buckets for the events now pending, a few to each.
    void reset(const std::vector<Event>& events, double now) {
        std::vector<double> waits;
        for (const Event& e : events)
            if (e.t < kNever) waits.push_back(e.t - now);
        inverse_width_ = 1;
        if (!waits.empty()) {
            // The median wait, blind to the few far away, stands for the mean.
            const auto middle = waits.begin() + std::ptrdiff_t(waits.size() / 2);
            std::nth_element(waits.begin(), middle, waits.end());
            const double width = kPerBucket * *middle / double(waits.size());
            if (width > 1e-250) inverse_width_ = 1 / width;
        }
        size_t buckets = 64;
        while (buckets * 2 < events.size()) buckets *= 2;
        lines_.assign(buckets, Line{});
        mask_ = int64_t(buckets) - 1;
        spare_ = -1;
        heap_.clear();
        current_ = bucket_of(now);
        for (size_t i = 0; i < events.size(); ++i) schedule(int(i), events[i]);
    }

    void schedule(int i, const Event& e) {
        if (e.t == kNever) return;
        const int64_t k = bucket_of(e.t);
        if (k <= current_) {
            heap_.push_back(entry(i, e));
            std::push_heap(heap_.begin(), heap_.end(), later);
        } else {
            push(k & mask_, i);
        }
    }

    // The next entry that may be due, or null if none is at or before `limit`. It may be stale.
    const Entry* top(const std::vector<Event>& events, double limit) {
        int64_t walked = 0;
        while (heap_.empty()) {
            if (limit < kNever && bucket_of(limit) <= current_) return nullptr;
            if (walked++ > mask_) {  // a whole year of nothing: jump to the next event there is
                double next = kNever;
                for (const Event& e : events) next = std::min(next, e.t);
                if (next > limit || next == kNever) return nullptr;
                current_ = std::max(current_ + 1, bucket_of(next)) - 1;
                walked = 0;
            }
            ++current_;
            open(events);
        }
        return heap_.front().t <= limit ? &heap_.front() : nullptr;
    }

    // Is this still what its sphere does next? A sphere may have got another event since, even one
    // of the same time: that has an entry, and a place in the order, of its own.
    static bool live(const Entry& e, const Event& event) {
        if (event.t != e.t) return false;
        const Entry now = entry(e.id, event);
        return now.a == e.a && now.b == e.b;
    }

    void pop() {
        std::pop_heap(heap_.begin(), heap_.end(), later);
        heap_.pop_back();
    }

    size_t bytes() const { return lines_.capacity() * sizeof(Line); }

private:
    static constexpr double kPerBucket = 4;
    static constexpr int kIds = 14;
    struct alignas(64) Line {
        int32_t n = 0;
        int32_t next = -1;
        int32_t id[kIds];
    };

    int64_t bucket_of(double t) const {
        const double k = t * inverse_width_;
        return k < 4e18 ? int64_t(k) : int64_t(4e18);
    }

    // Bookkeeping comes before collisions of the same time: whatever is due then must be known
    // before the first of them happens.
    static Entry entry(int i, const Event& e) {
        if (e.partner == kEscape) return {e.t, -1, i, i};
        if (e.partner < 0) return {e.t, i, e.partner, i};
        return {e.t, std::min(i, e.partner), std::max(i, e.partner), i};
    }

    void push(int64_t slot, int i) {
        Line& head = lines_[size_t(slot)];
        if (head.n < kIds) {
            head.id[head.n++] = i;
            return;
        }
        int32_t spare = spare_;
        if (spare >= 0) {
            spare_ = lines_[size_t(spare)].next;
        } else {
            spare = int32_t(lines_.size());
            grow(lines_);
        }
        Line& first = lines_[size_t(slot)];
        lines_[size_t(spare)] = first;
        first.next = spare;
        first.n = 1;
        first.id[0] = i;
    }

    // Takes the current bucket into the heap; what belongs to a later year goes back.
    void open(const std::vector<Event>& events) {
        const int64_t slot = current_ & mask_;
        if (lines_[size_t(slot)].n == 0) return;
        again_.clear();
        for (int64_t c = slot; c >= 0;) {
            Line& line = lines_[size_t(c)];
            for (int k = 0; k < line.n; ++k) {
                const int i = line.id[k];
                const Event& e = events[size_t(i)];
                const int64_t b = bucket_of(e.t);
                if (b == current_)
                    heap_.push_back(entry(i, e));
                else if (b > current_ && (b & mask_) == slot && e.t < kNever)
                    again_.push_back(i);
            }
            const int32_t next = line.next;
            line.n = 0;
            line.next = -1;
            if (c != slot) {
                line.next = spare_;
                spare_ = int32_t(c);
            }
            c = next;
        }
        std::make_heap(heap_.begin(), heap_.end(), later);
        for (const int32_t i : again_) push(slot, i);
    }

    double inverse_width_ = 1;
    int64_t mask_ = 63, current_ = 0;
    std::vector<Line> lines_;
    int32_t spare_ = -1;  // chain of spare lines
    std::vector<Entry> heap_;
    std::vector<int32_t> again_;
};

}  // namespace carom

// The event queue: a calendar of buckets, each one cache line of sphere numbers.
//
// Every sphere has one pending event, at `time[i]`. An entry is never deleted: it is dead when its
// sphere's event has moved to another time. The bucket in hand is a short list, searched anew for
// each event; simultaneous events come in the order of the spheres' labels, which nobody's
// bookkeeping can change. A bucket that holds a crowd (a lattice start: thousands of collisions in
// one moment) is a heap instead.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contact.hpp"
#include "memory.hpp"
#include "spheres.hpp"

namespace carom {

// What the queue sees of the engine: pending events, and the names by which equals are ordered.
struct Pending {
    const Event* events;
    const int32_t* labels;
    size_t n;
    bool gridded;

    int32_t partner(const Event& e) const {
        return gridded && e.t < e.contact ? kEscape : e.partner;
    }
};

class Calendar {
public:
    struct Due {
        double t;
        int32_t id;  // whose event it is
    };

    // Empties it and chooses buckets for the events now pending, a few to each.
    void reset(const Pending& p, double now) {
        std::vector<double> waits;
        const size_t each = p.n / kAsked + 1;  // some tell of all
        size_t pending = 0;
        for (size_t i = 0; i < p.n; ++i) pending += p.events[i].t < kNever;
        for (size_t i = 0; i < p.n; i += each)
            if (p.events[i].t < kNever) waits.push_back(p.events[i].t - now);
        inverse_width_ = 1;
        if (!waits.empty()) {
            // The median wait, blind to the few far away, stands for the mean.
            const auto middle = waits.begin() + std::ptrdiff_t(waits.size() / 2);
            std::nth_element(waits.begin(), middle, waits.end());
            const double width = kPerBucket * *middle / double(pending);
            if (width > 1e-250) inverse_width_ = 1 / width;
        }
        size_t buckets = 64;
        while (buckets * (p.n < kMany ? 2 : 4) < p.n) buckets *= 2;
        lines_.reserve(buckets + buckets / 16);  // room that is not used is not taken
        lines_.assign(buckets, Line{});
        mask_ = int64_t(buckets) - 1;
        spare_ = -1;
        few_ = 0;
        heap_.clear();
        for (Post& post : posts_) post.slot = -1;
        current_ = bucket_of(now);
        for (size_t i = 0; i < p.n; ++i) schedule(int(i), p);
    }

    void schedule(int i, const Pending& p) {
        const double t = p.events[i].t;
        if (t == kNever) return;
        const int64_t k = bucket_of(t);
        if (k <= current_)
            insert(i, p);
        else
            post(k & mask_, i);
    }

    // The next event, if one is at or before `limit`. Each time a bucket is taken in hand, `opened`
    // is told.
    template <class Opened>
    bool next(const Pending& p, double limit, Due& due, const Opened& opened) {
        int64_t walked = 0;
        for (;;) {
            if (first(p, due)) return due.t <= limit;
            if (limit < kNever && bucket_of(limit) <= current_) return false;
            if (walked++ > mask_) {  // a whole year of nothing: jump to the next event there is
                double soonest = kNever;
                for (size_t i = 0; i < p.n; ++i) soonest = std::min(soonest, p.events[i].t);
                if (soonest > limit || soonest == kNever) return false;
                current_ = std::max(current_ + 1, bucket_of(soonest)) - 1;
                walked = 0;
            }
            ++current_;
            open(p);
            opened();
        }
    }

    // Whose events are, or were, in the bucket `later` after the one in hand; and whether it is the
    // bucket of that event still. For asking memory in time.
    template <class Visit>
    void each(int later, const Visit& visit) const {
        if (later == 0) {
            for (int k = 0; k < few_; ++k) visit(ids_[k]);
            return;
        }
        for (int64_t at = (current_ + later) & mask_; at >= 0; at = lines_[size_t(at)].next) {
            const Line& line = lines_[size_t(at)];
            for (int k = 0; k < line.n; ++k) visit(line.id[k]);
        }
    }
    bool due_in(int later, double t) const { return bucket_of(t) == current_ + later; }
    const void* line(int later) const { return &lines_[size_t((current_ + later) & mask_)]; }

    bool in_hand(double t) const { return bucket_of(t) <= current_; }

    // Shows the events in hand to `moved`, which may give them a later time and then says so.
    template <class Moved>
    void review(const Pending& p, const Moved& moved) {
        for (int k = 0; k < few_;) {
            const int i = ids_[k];
            if (p.events[i].t != times_[k] || !moved(i)) {
                ++k;
            } else if (in_hand(p.events[i].t)) {
                times_[k++] = p.events[i].t;
            } else {
                times_[k] = times_[--few_];
                ids_[k] = ids_[few_];
                schedule(i, p);
            }
        }
    }

    // Takes the event that `next` has shown off the list.
    void pop() {
        if (heap_.empty()) {
            --few_;
            times_[at_] = times_[few_];
            ids_[at_] = ids_[few_];
        } else {
            std::pop_heap(heap_.begin(), heap_.end(), later);
            heap_.pop_back();
        }
    }

    size_t bytes() const { return lines_.capacity() * sizeof(Line); }

private:
    static constexpr double kPerBucket = 6;
    static constexpr size_t kAsked = 10000;
    static constexpr size_t kMany = size_t(1) << 22;  // where memory is dear
    static constexpr int kIds = 14, kFew = 48;
    struct alignas(64) Line {
        int32_t n = 0;
        int32_t next = -1;
        int32_t id[kIds] = {};
    };
    struct Entry {
        double t;
        int32_t a, b;  // the event's order among simultaneous ones
        int32_t id;
    };
    static bool later(const Entry& p, const Entry& q) {
        if (p.t != q.t) return p.t > q.t;
        if (p.a != q.a) return p.a > q.a;
        if (p.b != q.b) return p.b > q.b;
        return p.id > q.id;
    }

    int64_t bucket_of(double t) const {
        const double k = t * inverse_width_;
        return k < 4e18 ? int64_t(k) : int64_t(4e18);
    }

    // Bookkeeping comes before collisions of the same time: whatever is due then must be known
    // before the first of them happens.
    static Entry entry(int i, const Pending& p) {
        const Event& e = p.events[i];
        const int32_t own = p.labels[i];
        const int32_t partner = p.partner(e);
        if (is_bookkeeping(partner)) return {e.t, -1, own, i};
        if (partner < 0) return {e.t, own, partner, i};
        const int32_t other = p.labels[partner];
        return {e.t, std::min(own, other), std::max(own, other), i};
    }

    void insert(int i, const Pending& p) {
        if (!heap_.empty()) {
            heap_.push_back(entry(i, p));
            std::push_heap(heap_.begin(), heap_.end(), later);
            return;
        }
        if (few_ < kFew) {
            times_[few_] = p.events[i].t;
            ids_[few_++] = i;
            return;
        }
        for (; few_ > 0; --few_) {  // a crowd
            const int32_t k = ids_[few_ - 1];
            if (p.events[k].t == times_[few_ - 1]) heap_.push_back(entry(k, p));
        }
        heap_.push_back(entry(i, p));
        std::make_heap(heap_.begin(), heap_.end(), later);
    }

    // First of the bucket in hand whose event still stands.
    bool first(const Pending& p, Due& due) {
        while (few_ > 0) {
            double t = times_[0];
            int at = 0;
            for (int k = 1; k < few_; ++k) {
                const bool sooner = times_[k] < t;
                t = sooner ? times_[k] : t;
                at = sooner ? k : at;
            }
            at_ = at;
            if (p.events[ids_[at]].t != t) {
                pop();
                continue;
            }
            for (int k = at + 1; k < few_; ++k) {  // equals
                if (times_[k] != t || p.events[ids_[k]].t != t) continue;
                if (later(entry(ids_[at_], p), entry(ids_[k], p))) at_ = k;
            }
            due = {t, ids_[at_]};
            return true;
        }
        while (!heap_.empty()) {
            // A sphere may have got another event since, even one of the same time: that has an
            // entry, and a place in the order, of its own.
            const Entry& top = heap_.front();
            if (p.events[top.id].t == top.t) {
                const Entry now = entry(top.id, p);
                if (now.a == top.a && now.b == top.b) {
                    due = {top.t, top.id};
                    return true;
                }
            }
            pop();
        }
        return false;
    }

    // Asks for the bucket's line and pushes a little later, when it has come.
    void post(int64_t slot, int i) {
        fetch(&lines_[size_t(slot)]);
        Post& p = posts_[++posted_ % kPosts];
        if (p.slot >= 0) push(p.slot, p.id);
        p = {slot, i};
    }
    void deliver(int64_t slot) {
        for (Post& p : posts_) {
            if (p.slot != slot) continue;
            push(slot, p.id);
            p.slot = -1;
        }
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

    // Takes the current bucket in hand; what belongs to a later year goes back.
    void open(const Pending& p) {
        const int64_t slot = current_ & mask_;
        deliver(slot);
        if (lines_[size_t(slot)].n == 0) return;
        again_.clear();
        for (int64_t c = slot; c >= 0;) {
            Line& line = lines_[size_t(c)];
            for (int k = 0; k < line.n; ++k) {
                const int i = line.id[k];
                const int64_t b = bucket_of(p.events[i].t);
                if (b == current_)
                    insert(i, p);
                else if (b > current_ && (b & mask_) == slot && p.events[i].t < kNever)
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
        for (const int32_t i : again_) push(slot, i);
    }

    double inverse_width_ = 1;
    int64_t mask_ = 63, current_ = 0;
    Array<Line> lines_;
    int32_t spare_ = -1;  // chain of spare lines
    struct Post {
        int64_t slot = -1;
        int32_t id = 0;
    };
    static constexpr size_t kPosts = 16;
    Post posts_[kPosts];
    size_t posted_ = 0;
    int few_ = 0, at_ = 0;
    double times_[kFew];
    int32_t ids_[kFew];
    std::vector<Entry> heap_;  // instead, while not empty
    std::vector<int32_t> again_;
};

}  // namespace carom

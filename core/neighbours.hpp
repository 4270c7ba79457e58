// Who is near: one row of neighbours per sphere, 128 bytes, growing when a row needs more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

class Rows {
public:
    void reset(size_t n) {
        rows_.assign(n, Row{});
        large_.clear();
        free_.clear();
    }
    std::span<const int32_t> of(int i) const {
        const Row& r = rows_[i];
        return {r.large < 0 ? r.id : large_[r.large].data(), size_t(r.n)};
    }
    const void* line(int i) const { return &rows_[i]; }
    size_t size(int i) const { return size_t(rows_[i].n); }

    size_t bytes() const {
        size_t b = rows_.capacity() * sizeof(Row);
        for (const auto& list : large_) b += list.capacity() * sizeof(int32_t);
        return b;
    }

    void add(int i, int32_t j) {
        Row& r = rows_[i];
        if (r.large < 0 && r.n == kInline) spill(r);
        if (r.large < 0)
            r.id[r.n] = j;
        else
            large_[r.large].push_back(j);
        ++r.n;
    }

    void remove(int i, int32_t j) {  // j must be there
        Row& r = rows_[i];
        int32_t* id = r.large < 0 ? r.id : large_[r.large].data();
        int at = 0;  // no early exit: the plain loop compiles to vector compares
        for (int k = 0; k < r.n; ++k) at = id[k] == j ? k : at;
        id[at] = id[--r.n];
        if (r.large >= 0) large_[r.large].pop_back();
        if (r.large >= 0 && r.n <= kInline / 2) unspill(r);
    }

private:
    static constexpr int kInline = 30;
    struct alignas(64) Row {
        int32_t n = 0;
        int32_t large = -1;  // index of the long list, once there are more than 30
        int32_t id[kInline];
    };
    static_assert(sizeof(Row) == 128);

    void spill(Row& r) {
        if (free_.empty()) {
            free_.push_back(int32_t(large_.size()));
            large_.emplace_back();
        }
        r.large = free_.back();
        free_.pop_back();
        large_[r.large].assign(r.id, r.id + r.n);
    }
    void unspill(Row& r) {
        std::vector<int32_t>& list = large_[r.large];
        for (int k = 0; k < r.n; ++k) r.id[k] = list[k];
        list.clear();
        free_.push_back(r.large);
        r.large = -1;
    }

    std::vector<Row> rows_;
    std::vector<std::vector<int32_t>> large_;
    std::vector<int32_t> free_;  // long lists not in use
};

}  // namespace carom

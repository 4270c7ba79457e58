// Who is near: one row of neighbours per sphere, 128 bytes, growing when a row needs more.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "memory.hpp"

namespace carom {

// Unused places hold the sphere itself, which nobody can meet: whoever looks at several neighbours
// at a time need not know where the row ends.
struct alignas(64) Row {
    static constexpr int kPlaces = 31;
    int16_t n = 0;       // kLong: the row is long, and kept elsewhere
    int16_t margin = 0;  // of the sphere's shell: the common one, doubled so many times
    int32_t id[kPlaces];

    static constexpr int16_t kLong = -1;
    std::span<const int32_t> ids() const { return {id, size_t(n)}; }
    std::span<const int32_t> near_ids() const { return {id, size_t(n < 0 ? 0 : n)}; }
};
static_assert(sizeof(Row) == 128);

class Rows {
public:
    void reset(size_t n) {
        rows_.resize(n);
        for (size_t i = 0; i < n; ++i) clear(rows_[i], int32_t(i));
        long_.clear();
        free_.clear();
    }

    // All its neighbours, in one piece or more.
    std::span<const Row> of(int i) const {
        const Row& r = rows_[size_t(i)];
        return r.n >= 0 ? std::span(&r, 1) : std::span<const Row>(long_[size_t(r.id[0])]);
    }
    Row& line(int i) { return rows_[size_t(i)]; }
    const Row& line(int i) const { return rows_[size_t(i)]; }
    size_t size(int i) const {
        const Row& r = rows_[size_t(i)];
        if (r.n >= 0) return size_t(r.n);
        const std::vector<Row>& pieces = long_[size_t(r.id[0])];
        return (pieces.size() - 1) * Row::kPlaces + size_t(pieces.back().n);
    }

    void add(int i, int32_t j) {
        Row& r = rows_[size_t(i)];
        if (r.n >= 0 && r.n < Row::kPlaces) {
            r.id[r.n++] = j;
            return;
        }
        if (r.n >= 0) lengthen(r, i);
        std::vector<Row>& pieces = long_[size_t(r.id[0])];
        if (pieces.back().n == Row::kPlaces) clear(pieces.emplace_back(), i);
        Row& last = pieces.back();
        last.id[last.n++] = j;
    }

    void remove(int i, int32_t j) {  // j must be there
        Row& r = rows_[size_t(i)];
        if (r.n >= 0) {
            int at = 0;  // no early exit: the plain loop compiles to vector compares
            for (int k = 0; k < Row::kPlaces; ++k) at = r.id[k] == j ? k : at;
            r.id[at] = r.id[--r.n];
            r.id[r.n] = i;
            return;
        }
        std::vector<Row>& pieces = long_[size_t(r.id[0])];
        Row& last = pieces.back();
        const int32_t moved = last.id[--last.n];
        last.id[last.n] = i;
        if (moved != j) replace(pieces, j, moved);
        if (last.n == 0) pieces.pop_back();
        if (pieces.size() == 1 && pieces[0].n <= Row::kPlaces / 2) shorten(r);
    }

    void assign(int i, std::span<const int32_t> ids) {
        Row& r = rows_[size_t(i)];
        if (r.n == Row::kLong) shorten(r);
        const size_t n = std::min(ids.size(), size_t(Row::kPlaces));
        std::copy_n(ids.begin(), n, r.id);
        std::fill(r.id + n, r.id + Row::kPlaces, i);
        r.n = int16_t(n);
        for (const int32_t j : ids.subspan(n)) add(i, j);
    }

    size_t bytes() const {
        size_t b = rows_.capacity() * sizeof(Row);
        for (const auto& pieces : long_) b += pieces.capacity() * sizeof(Row);
        return b;
    }

private:
    static void clear(Row& r, int32_t self) {
        r.n = 0;
        for (int32_t& id : r.id) id = self;
    }
    static void replace(std::vector<Row>& pieces, int32_t j, int32_t by) {
        for (Row& piece : pieces)
            for (int32_t& id : piece.id)
                if (id == j) {
                    id = by;
                    return;
                }
    }
    void lengthen(Row& r, int32_t self) {
        if (free_.empty()) {
            free_.push_back(int32_t(long_.size()));
            long_.emplace_back();
        }
        const int32_t at = free_.back();
        free_.pop_back();
        long_[size_t(at)].assign(1, r);
        clear(r, self);
        r.n = Row::kLong;
        r.id[0] = at;
    }
    void shorten(Row& r) {
        const int32_t at = r.id[0];
        const int16_t margin = r.margin;
        r = long_[size_t(at)][0];
        r.margin = margin;
        long_[size_t(at)].clear();
        free_.push_back(at);
    }

    Array<Row> rows_;
    std::vector<std::vector<Row>> long_;
    std::vector<int32_t> free_;  // long rows not in use
};

}  // namespace carom

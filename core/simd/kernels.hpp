// The few loops that look at many things at once, built for several instruction sets.
//
// None of them touches a number of a trajectory: they find who may be near, or may be next.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "../glance.hpp"

namespace carom {

// Seven shells that share a cell, in one cache line.
struct alignas(64) CellLine {
    static constexpr int kSlots = 7;
    int32_t id[kSlots] = {-1, -1, -1, -1, -1, -1, -1};  // -1 from the first that is free
    int32_t next = -1;                                  // the line behind, when seven are too few
    struct Place {
        uint8_t first, second;
    };
    Place xy[8];  // places in steps of a cell, rounded down
    Place zr[8];  // z, and the reach, rounded up

    bool full() const { return id[kSlots - 1] >= 0; }
    int size() const {
        int n = 0;
        for (const int32_t j : id) n += j >= 0;
        return n;
    }
    int find(int32_t i) const {
        int at = -1;
        for (int k = 0; k < kSlots; ++k) at = id[k] == i ? k : at;
        return at;
    }
};
static_assert(sizeof(CellLine) == 64);

// A block of cells to look into, and where the searcher is, seen from each, in steps of a cell.
// Where the block goes all the way round, what is far one way may be near the other.
struct CellBlock {
    static constexpr int kMost = 64;  // cells along an axis
    struct Axis {
        int32_t n;
        int32_t line[kMost];  // what the cell adds to the number of its line
        int16_t seen[kMost];
    } x, y, z;
    int16_t minus_reach;
    bool around = false;
    int16_t way_round[3];  // along each axis, in steps: far more than any distance if not all of it
};

// Four spheres that share a cell of the grid, as a quarter of a cache line.
struct alignas(16) GridCell {
    static constexpr int kPlaces = 4;
    int32_t id[kPlaces] = {-1, -1, -1, -1};  // -1: free. The last, below -1: more are behind,
    static int32_t link(int32_t cell) { return -2 - cell; }  // in the cell of this number
};

// A block of grid cells: what each coordinate adds to the number of the cell, up to the first that
// is negative. In the order of space, so that the cells along x lie side by side in memory, but
// where the period ends.
struct GridBlock {
    struct alignas(16) Axis {
        int32_t cell[4];
        static constexpr int32_t kEnd = -1;
    } x, y, z;
};

// Who leaves a row of neighbours and who joins it: bit k stands for place k of either list.
struct Difference {
    uint32_t gone, fresh;
};

struct Kernels {
    const char* name;
    // See pair_search.hpp.
    Guess (*first_met)(const Lens&, const Glance* all, const Glance& me, int32_t self,
                       const int32_t* row, int n);
    // The same for two who share their neighbours.
    void (*first_met_by_two)(const Lens&, const Glance* all, const Glance* const me[2],
                             const int32_t* row, int n, Guess out[2]);
    // See cell_search.hpp.
    int32_t (*near)(const CellLine* lines, const CellBlock&, int32_t* out, int32_t room);
    // See cell_search.hpp.
    int32_t (*collect)(const GridCell* cells, const GridBlock&, int32_t* out, int32_t room);
    // See cell_search.hpp.
    Difference (*difference)(const int32_t* row, int n, const int32_t* now, int n_now);
};

// The instruction sets that this machine can run, slowest first.
std::vector<std::string> simd_levels();

// The loops built for one of them; the best for "" (or what CAROM_SIMD says). Throws
// std::invalid_argument for one that this machine does not have.
const Kernels& kernels(const std::string& level = "");

}  // namespace carom

// Memory: what limits the speed and the size of a large run.
#pragma once

#include <cstddef>
#include <vector>

namespace carom {

// Asks for a cache line that will be needed in a moment. A row's spheres, the cells around a shell
// and the rows of new neighbours are asked for all at once, instead of waiting for each in turn:
// 1.2 times faster at 256 000 spheres, the same at 4 000.
inline void fetch(const void* line) {
#if defined(__GNUC__)
    __builtin_prefetch(line);
#else
    (void)line;
#endif
}

// Grows a large array by an eighth instead of doubling it.
template <class T>
void grow(std::vector<T>& v) {
    if (v.size() == v.capacity()) v.reserve(v.size() + v.size() / 8 + 64);
    v.emplace_back();
}

}  // namespace carom

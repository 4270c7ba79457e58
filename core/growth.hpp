// Growing a large array by an eighth instead of doubling it: memory is what limits N.
#pragma once

#include <cstddef>
#include <vector>

namespace carom {

template <class T>
void grow(std::vector<T>& v) {
    if (v.size() == v.capacity()) v.reserve(v.size() + v.size() / 8 + 64);
    v.emplace_back();
}

}  // namespace carom

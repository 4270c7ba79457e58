#include <exception>

#include "check.hpp"

int main() {
    int failed = 0;
    for (const testing::Test& test : testing::tests()) {
        const int before = testing::failures;
        try {
            test.run();
        } catch (const std::exception& error) {
            ++testing::failures;
            std::printf("threw: %s\n", error.what());
        }
        if (testing::failures > before) {
            ++failed;
            std::printf("FAILED %s\n", test.name);
        }
    }
    std::printf("%d core tests passed, %d failed\n", int(testing::tests().size()) - failed, failed);
    return failed > 0;
}

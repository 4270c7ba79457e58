// The arithmetic that a trajectory needs: round to nearest, no flush to zero.
#pragma once

#include <cfenv>

namespace carom {

// While it lives, whatever the caller (or a library it loaded) has set.
class PlainArithmetic {
public:
    PlainArithmetic() {
        std::fegetenv(&saved_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~PlainArithmetic() { std::fesetenv(&saved_); }
    PlainArithmetic(const PlainArithmetic&) = delete;
    PlainArithmetic& operator=(const PlainArithmetic&) = delete;

private:
    std::fenv_t saved_;
};

}  // namespace carom

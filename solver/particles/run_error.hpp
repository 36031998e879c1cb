#pragma once
#include <stdexcept>

namespace slurry {

// A run that went wrong; what() is one line: when, which particle, where, what, and what to try.
class RunError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// A run that was told to end, and can be resumed; what() is one line that says how.
class RunInterrupted : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

} // namespace slurry

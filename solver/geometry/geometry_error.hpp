#pragma once
#include <stdexcept>

namespace slurry {

// A scene whose geometry cannot be simulated; what() is one line for a person.
class GeometryError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

} // namespace slurry

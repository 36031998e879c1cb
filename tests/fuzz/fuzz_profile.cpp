// libFuzzer on the readers of CSV files: profiles and radii.
#include "tests/fuzz/targets.hpp"

#include <cstdint>

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    slurry::fuzz::try_profile({reinterpret_cast<const char*>(data), size});
    return 0;
}

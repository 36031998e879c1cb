// libFuzzer on the reader of checkpoints.
#include "tests/fuzz/checkpoint_target.hpp"

#include <cstdint>

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static slurry::fuzz::CheckpointTarget target;
    target({reinterpret_cast<const char*>(data), size});
    return 0;
}

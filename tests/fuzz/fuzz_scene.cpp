// libFuzzer on the reader of scenes, with changes made by bytes and by the grammar.
#include "tests/fuzz/scene_grammar.hpp"
#include "tests/fuzz/targets.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

// Names and signatures are libFuzzer's.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    slurry::fuzz::try_scene({reinterpret_cast<const char*>(data), size});
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
    slurry::fuzz::RandomSource random(seed);
    if (random.chance(0.3)) {
        return LLVMFuzzerMutate(data, size, most);
    }
    const std::string text =
        slurry::fuzz::changed_scene({reinterpret_cast<const char*>(data), size}, random).substr(0, most);
    std::ranges::copy(text, data);
    return text.size();
}
// NOLINTEND(readability-identifier-naming)

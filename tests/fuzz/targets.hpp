#pragma once
// What the fuzzers try, and what has to hold for any input whatever. Each throws std::logic_error, or lets
// through what should never be thrown, when it does not hold; the fuzzers turn both into a crash.
//
// A further reader of files is tried the same way: a function here, a file fuzz_<what>.cpp with
// LLVMFuzzerTestOneInput, a folder corpus/<what>, and its name in FUZZERS of tests/fuzz/CMakeLists.txt and in
// corpus_test.cpp; the reader of checkpoints, which wants a file, is in checkpoint_target.hpp.
#include <string>
#include <string_view>

namespace slurry::fuzz {

// A refusal has to be one line `file:line[:column]: found ..., allowed ...` about a file of the corpus.
void demand_reason(const std::string& message);

// The scene is accepted, and its resolved text reads back as the same, or refused in one line that names the
// file and a line of it.
void try_scene(std::string_view text);

// The profile is finite and ascends, the radii are finite and positive, or they are refused as above.
void try_profile(std::string_view text);

} // namespace slurry::fuzz

#include "solver/kernels/compact_gaussian.hpp"
#include "solver/loop/pair_interactions.hpp"

namespace slurry {

template std::unique_ptr<Interactions> make_pair_interactions<CompactGaussian>(const Scene&, LoopWidth);

} // namespace slurry

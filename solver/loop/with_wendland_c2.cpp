#include "solver/kernels/wendland.hpp"
#include "solver/loop/pair_interactions.hpp"

namespace slurry {

template std::unique_ptr<Interactions> make_pair_interactions<WendlandC2>(const Scene&, LoopWidth);

} // namespace slurry

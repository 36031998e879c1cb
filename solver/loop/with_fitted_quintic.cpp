#include "solver/kernels/fitted_quintic.hpp"
#include "solver/loop/pair_interactions.hpp"

namespace slurry {

template std::unique_ptr<Interactions> make_pair_interactions<FittedQuintic>(const Scene&, LoopWidth);

} // namespace slurry

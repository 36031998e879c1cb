#include "solver/kernels/quintic_spline.hpp"
#include "solver/loop/pair_interactions.hpp"

namespace slurry {

template std::unique_ptr<Interactions> make_pair_interactions<QuinticSpline>(const Scene&, LoopWidth);

} // namespace slurry

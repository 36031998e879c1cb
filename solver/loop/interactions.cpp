#include "solver/loop/interactions.hpp"

#include "solver/kernels/fitted_quintic.hpp"
#include "solver/kernels/quintic_spline.hpp"
#include "solver/kernels/wendland.hpp"
#include "solver/loop/pair_interactions.hpp"

namespace slurry {

std::unique_ptr<Interactions> make_interactions(const Scene& scene, LoopWidth width) {
    switch (scene.numerics.kernel) {
    case KernelShape::quintic:
        return make_pair_interactions<QuinticSpline>(scene, width);
    case KernelShape::wendland_c2:
        return make_pair_interactions<WendlandC2>(scene, width);
    case KernelShape::wendland_c4:
        return make_pair_interactions<WendlandC4>(scene, width);
    case KernelShape::fitted_quintic:
        break;
    }
    return make_pair_interactions<FittedQuintic>(scene, width);
}

} // namespace slurry

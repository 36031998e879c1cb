#include "solver/loop/interactions.hpp"

#include "solver/kernels/fitted_quintic.hpp"
#include "solver/kernels/quintic_spline.hpp"
#include "solver/kernels/wendland.hpp"
#include "solver/loop/pair_interactions.hpp"
#include "solver/particles/run_error.hpp"

namespace slurry {
namespace {

template <KernelShape shape, class Kernel>
std::unique_ptr<Interactions> made_with(const Scene& scene, LoopWidth width) {
    if constexpr (is_built(shape)) {
        return make_pair_interactions<Kernel>(scene, width);
    } else {
        throw RunError("numerics.kernel: this build has another one only (SLURRY_ONLY_KERNEL)");
    }
}

} // namespace

std::unique_ptr<Interactions> make_interactions(const Scene& scene, LoopWidth width) {
    switch (scene.numerics.kernel) {
    case KernelShape::quintic:
        return made_with<KernelShape::quintic, QuinticSpline>(scene, width);
    case KernelShape::wendland_c2:
        return made_with<KernelShape::wendland_c2, WendlandC2>(scene, width);
    case KernelShape::wendland_c4:
        return made_with<KernelShape::wendland_c4, WendlandC4>(scene, width);
    case KernelShape::fitted_quintic:
        break;
    }
    return made_with<KernelShape::fitted_quintic, FittedQuintic>(scene, width);
}

} // namespace slurry

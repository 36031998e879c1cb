#include "solver/terms/steady_frame.hpp"

namespace slurry {

std::optional<Vector> steady_frame(const Scene& scene) {
    std::optional<Vector> frame;
    for (const WallScene& wall : scene.walls) {
        if (std::holds_alternative<LineShape>(wall.shape)) {
            continue; // looks the same from every frame that slides along it
        }
        if (frame && *frame != wall.velocity) {
            return std::nullopt;
        }
        frame = wall.velocity;
    }
    if (!frame && scene.discs.empty()) {
        return Vector::Zero();
    }
    return frame;
}

} // namespace slurry

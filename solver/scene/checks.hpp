#pragma once
// What must hold between the values of a scene.
#include "solver/scene/scene.hpp"

#include <map>
#include <string>

namespace slurry {

// Where the keys of a scene were written: "fluid.density", "walls.pad.from"; tables ("walls.pad") and "" for
// all.
class Places {
  public:
    void add(const std::string& address, const std::string& place) {
        places_.insert_or_assign(address, place);
    }
    // The place of the key, or of the nearest enclosing table when the key was left to its default.
    [[nodiscard]] const std::string& of(std::string address) const;

  private:
    std::map<std::string, std::string> places_;
};

// Throws SceneError: names used twice, probes of unknown walls or outside the domain, a domain turned inside
// out, lines that are points, sides that do not fit the shape, times beyond the end, sizes that no machine
// should try, gravity along a periodic axis, no fluid where there has to be some, and what check_discs
// and check_stability refuse.
void check_scene(const Scene& scene, const Places& places);

} // namespace slurry

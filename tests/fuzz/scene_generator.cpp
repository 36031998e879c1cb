#include "tests/fuzz/scene_generator.hpp"

#include "tests/fuzz/scene_grammar.hpp"

#include <array>
#include <fmt/format.h>

namespace slurry::fuzz {
namespace {

// Lengths in spacings, speeds in speeds of sound.
class Flow {
  public:
    Flow(RandomSource& random, NumericsRange numerics) : random_(random), numerics_(numerics) {}

    [[nodiscard]] std::string text() {
        std::string text = fmt::format("[domain]\nlower = [{}, {}]\nupper = [{}, {}]\nperiodic = \"{}\"\n",
                                       x(0), y(0), x(width_), y(height_), periodic_);
        text += fluid() + discretisation() + start() + walls() + discs() + probes();
        return text + fmt::format("[output]\nend_time = {}\n", spacing_ / sound_speed_);
    }

  private:
    [[nodiscard]] double x(double spacings) const { return origin_x_ + spacings * spacing_; }
    [[nodiscard]] double y(double spacings) const { return origin_y_ + spacings * spacing_; }
    [[nodiscard]] bool closed_above() const { return periodic_ == "x" || periodic_ == "none"; }
    [[nodiscard]] double slow() { return random_.uniform(-0.1, 0.1) * sound_speed_; }

    std::string fluid() {
        const double cell_reynolds = random_.logarithmic(0.1, 100); // of the speed of sound
        const double force = random_.chance(0.3) && periodic_ != "none"
                                 ? random_.uniform(-1e-3, 1e-3) * sound_speed_ * sound_speed_ / spacing_
                                 : 0;
        return fmt::format("[fluid]\ndensity = {}\ndynamic_viscosity = {}\nbody_force = [{}, 0.0]\n",
                           density_, density_ * sound_speed_ * spacing_ / cell_reynolds,
                           periodic_ == "y" ? 0 : force);
    }

    // Choices freely, numbers as far as wanted.
    std::string discretisation() {
        std::string text =
            fmt::format("[numerics]\nparticle_spacing = {}\nsound_speed = {}\n", spacing_, sound_speed_);
        for (const Parameter* parameter : parameters_of("numerics")) {
            const bool number = parameter->binding.kind == Kind::number;
            if (parameter->fallback.standard && random_.chance(0.2) &&
                (!number || numerics_ == NumericsRange::allowed)) {
                text += fmt::format("{} = {}\n", parameter->key, allowed_value(*parameter, random_));
            }
        }
        return text;
    }

    std::string start() {
        constexpr std::array<const char*, 3> arrangements{"lattice", "jittered", "relaxed"};
        std::string text = fmt::format("[start]\narrangement = \"{}\"\nseed = {}\n",
                                       arrangements[random_.below(arrangements.size())], random_.below(1000));
        if (numerics_ == NumericsRange::allowed) {
            text += fmt::format("jitter = {}\n", random_.uniform(0, 0.5));
        }
        if (width_ == height_ && random_.chance(0.7)) {
            text += fmt::format("velocity = \"taylor_green\"\nspeed = {}\n", slow());
        }
        return text;
    }

    std::string line(const char* name, const char* side, const std::array<double, 4>& ends, double speed) {
        const bool upright = ends[0] == ends[2];
        return fmt::format(
            "[[walls]]\nname = \"{}\"\nshape = \"line\"\nfluid_side = \"{}\"\nfrom = [{}, {}]\n"
            "to = [{}, {}]\nvelocity = [{}, {}]\n",
            name, side, x(ends[0]), y(ends[1]), x(ends[2]), y(ends[3]), upright ? 0 : speed,
            upright ? speed : 0);
    }

    // A pad of any shape below; it moves only where the domain is periodic.
    std::string pad() {
        const double amplitude = random_.uniform(-2, 2);
        const double speed = periodic_ == "x" ? slow() : 0;
        const std::string head =
            fmt::format("[[walls]]\nname = \"pad\"\nfluid_side = \"above\"\nvelocity = [{}, 0.0]\n", speed);
        switch (random_.below(5)) {
        case 0:
            return head +
                   fmt::format("shape = \"cosine\"\nmean_height = {}\namplitude = {}\nwavelength = {}\n",
                               y(2), amplitude * spacing_, width_ * spacing_);
        case 1:
            return head + fmt::format("shape = \"gaussian\"\nbase_height = {}\namplitude = {}\ncentre = {}\n"
                                      "width = {}\n",
                                      y(2), amplitude * spacing_, x(width_ / 2),
                                      random_.uniform(1, 3) * spacing_);
        case 2:
            return head + fmt::format("shape = \"sine\"\nbase_height = {}\namplitude = {}\ncentre = {}\n"
                                      "length = {}\n",
                                      y(2), amplitude * spacing_, x(width_ / 2),
                                      random_.uniform(6, 12) * spacing_);
        case 3:
            return head +
                   fmt::format("shape = \"arc\"\nbase_height = {}\ncentre = {}\nradius = {}\nangle = {}\n"
                               "upward = {}\n",
                               y(2), x(width_ / 2), random_.uniform(4, 8) * spacing_,
                               random_.uniform(0.5, 1.5), random_.chance(0.5));
        default:
            return line("pad", "above", {0, 0, width_, 0}, speed);
        }
    }

    std::string walls() {
        std::string text;
        if (closed_above()) {
            text +=
                pad() + line("wafer", "below", {0, height_, width_, height_}, periodic_ == "x" ? slow() : 0);
        }
        if (periodic_ == "y" || periodic_ == "none") {
            text += line("left", "right", {0, 0, 0, height_}, periodic_ == "y" ? slow() : 0);
            text += line("right", "left", {width_, 0, width_, height_}, 0);
        }
        return text;
    }

    std::string discs() {
        if (!discs_) {
            return "";
        }
        const double radius = random_.uniform(1.6, 3);
        std::string text = fmt::format("[[discs]]\nname = \"grain\"\ndensity = {}\n",
                                       density_ * random_.logarithmic(0.3, 5));
        if (random_.chance(0.5)) {
            const double least_distance =
                numerics_ == NumericsRange::recommended ? 0 : random_.uniform(0, 2) * spacing_;
            return text + fmt::format("placement = \"random\"\ncount = {}\nradius = {}\nseed = {}\n"
                                      "least_distance = {}\n",
                                      1 + random_.below(3), radius * spacing_, random_.below(1000),
                                      least_distance);
        }
        return text +
               fmt::format("placement = \"single\"\nradius = {}\nposition = [{}, {}]\nvelocity = [{}, {}]\n"
                           "spin = {}\n",
                           radius * spacing_, x(width_ / 2), y(0.6 * height_), slow(), slow(),
                           slow() / (radius * spacing_));
    }

    std::string probes() {
        return fmt::format("[[probes]]\nname = \"middle\"\nkind = \"point\"\nposition = [{}, {}]\n",
                           x(width_ / 2), y(height_ / 2)) +
               (closed_above()
                    ? "[[probes]]\nname = \"wafer\"\nkind = \"wall\"\nwall = \"wafer\"\npoints = 5\n"
                    : "[[probes]]\nname = \"grid\"\nkind = \"grid\"\npoints = [3, 3]\n");
    }

    RandomSource& random_;
    NumericsRange numerics_;
    bool discs_ = random_.chance(0.5);
    std::string periodic_ = std::array{"none", "x", "y", "xy"}[random_.below(4)];
    double spacing_ = random_.logarithmic(1e-7, 1e-2);
    double origin_x_ = random_.uniform(-20, 20) * spacing_, origin_y_ = random_.uniform(-20, 20) * spacing_;
    double width_ = random_.uniform(14, 24);
    double height_ = periodic_ == "xy" ? width_ : random_.uniform(12, 18); // vortices fit into a square
    double density_ = random_.logarithmic(100, 1e4), sound_speed_ = random_.logarithmic(0.01, 100);
};

} // namespace

std::string random_flow(RandomSource& random, NumericsRange numerics) {
    return Flow(random, numerics).text();
}

} // namespace slurry::fuzz

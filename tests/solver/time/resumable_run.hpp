#pragma once
// A run in small steps that a test can take to a checkpoint and on from it.
#include "solver/time/checkpoint_folder.hpp"
#include "solver/time/time_step.hpp"
#include "solver/time/velocity_verlet.hpp"
#include "tests/solver/scenes_for_tests.hpp"

#include <unistd.h>

namespace slurry::testing {

// A folder of its own that goes when the test ends.
class OwnFolder {
  public:
    OwnFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "slurry-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) {
            throw std::runtime_error("no folder for the test");
        }
        path_ = name;
    }
    ~OwnFolder() { std::filesystem::remove_all(path_); }
    OwnFolder(const OwnFolder&) = delete;
    OwnFolder& operator=(const OwnFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

struct ResumableRun {
    Scene scene;
    Region region{scene};
    Particles particles = arrange_particles(scene, region);
    std::unique_ptr<Interactions> sums = make_interactions(scene);
    DiscContacts contacts{scene, region};
    PhaseClock clock;
    ResultFile result;
    Forces forces{*sums, contacts, scene.fluid, scene.numerics.sound_speed};
    long step = 0;
    RunState state{step, particles, *sums, contacts, result, clock};

    ResumableRun(const Scene& from, const std::filesystem::path& folder)
        : scene(from), result(folder, from, "test", true) {}

    void go_to(long last) {
        if (step == 0) {
            prepare_first_step(particles, forces, 0.5 * largest_time_step(scene), clock);
        }
        for (; step < last; ++step) {
            advance(particles, forces, 0.5 * largest_time_step(scene), clock);
            result.begin_sample(particles.time);
            result.add_sample("kinetic_energy", "J/m", particles.fluid.size() > 0 ? particles.fluid.x[0] : 0);
        }
    }

    // All numbers of the state.
    [[nodiscard]] std::vector<double> numbers() {
        std::vector<double> all{particles.time, contacts.least_gap(), contacts.first_contact_time()};
        const auto add = [&](const auto& array) { all.insert(all.end(), array.begin(), array.end()); };
        particles.fluid.each_array(add);
        add(particles.fluid.identity);
        particles.dummies.each_array(add);
        for (const Disc& disc : particles.discs) {
            add(std::array{disc.position.x(), disc.position.y(), disc.angle, disc.velocity.x(),
                           disc.velocity.y(), disc.spin, disc.force.x(), disc.force.y(), disc.torque,
                           disc.contact_force.x(), disc.contact_force.y()});
        }
        const ListOrigin lists = sums->list_origin();
        add(lists.x);
        add(lists.y);
        add(lists.normal_x);
        all.push_back(lists.time);
        all.push_back(static_cast<double>(lists.rebuilds));
        return all;
    }
};

// Fluid in a channel whose lid slides, with two discs that will touch.
inline Scene channel_with_discs() {
    Scene scene = flat_channel(16, 1);
    jitter(scene, 0.2);
    scene.numerics.density_diffusion = 0.1;
    scene.numerics.pair_arithmetic = PairArithmetic::single_precision;
    DiscScene left = middle_disc(1500);
    left.name = "left";
    left.placement = SingleDisc{0.13, {0.0, 0.7}};
    left.velocity = {1, 0};
    DiscScene right = left;
    right.name = "right";
    right.placement = SingleDisc{0.13, {0.4, 0.72}};
    right.velocity = {-1, 0};
    scene.discs = {left, right};
    scene.output.end_time = 1;
    scene.resolved_text =
        "[numerics]\nsound_speed = 10.0\n\n[[walls]]\nname = \"lid\"\nvelocity = [1.0, 0.0]\n"
        "\n[output]\ncheckpoint_interval = 600.0\n";
    return scene;
}

} // namespace slurry::testing

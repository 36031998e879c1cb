#pragma once
// A scene as the solver sees it: plain values in SI units, already validated by read_scene.
#include "solver/scene/limits.hpp"
#include "solver/vector.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace slurry {

// wang2014 is the paper's scheme as written; standard (spelled "default" in a scene file) adds what section
// "Schemes" of the README lists. A scheme only sets the defaults of the keys of `numerics`.
enum class Scheme : std::uint8_t { standard, wang2014 };
enum class DummyLayout : std::uint8_t { curve, lattice };
// Which velocity of a wall's dummies the continuity equation sees: the wall's own, the extrapolated one
// (2.16), or the extrapolated one along the wall with, across it, what keeps the volume (as far as the
// dummy's boundary layer is resolved).
enum class WallContinuity : std::uint8_t { wall_velocity, extrapolated, solenoidal };
// What a change of pressure does to the volume of the fluid. acoustic: Eq. 2.14, a particle is compressed on
// its way to higher pressure, which the real fluid is not. steady_frame: a pressure that is steady as seen
// from the rough walls does not compress (solver/terms/pressure_advection.hpp).
enum class Compressibility : std::uint8_t { acoustic, steady_frame };
// Particle volume in the forces: m / rho, 1 / sum W (below Eq. 2.8), or m / rho0.
enum class ParticleVolume : std::uint8_t { mass_over_density, number_density, constant };
// How the fluid is continued to the dummies of a wall: kernel means (2.16, 2.17) or least-squares fits.
enum class WallExtrapolation : std::uint8_t { mean, fit };
// Of the sums over pairs. The state, its integration and the output are in double precision always.
enum class PairArithmetic : std::uint8_t { single_precision, double_precision };
enum class KernelShape : std::uint8_t { quintic, wendland_c2, wendland_c4, fitted_quintic };
// Pressure between two particles: weighted with their densities (Eq. 2.15), or (p_i + p_j) / 2.
enum class PressureMean : std::uint8_t { density_weighted, plain };
// How neighbours are found; the lists do not depend on it.
enum class NeighbourSearch : std::uint8_t { strips, cells, plane_sweep };
// empty: no fluid at all, discs alone.
enum class Arrangement : std::uint8_t { lattice, jittered, relaxed, empty };
enum class InitialVelocity : std::uint8_t { rest, shear, taylor_green };
enum class FluidSide : std::uint8_t { above, below, left, right };
// What gravity does to the fluid: nothing, so that pressure is what exceeds the hydrostatic one and discs
// feel their buoyant weight; or all it does, and discs feel their weight and the fluid's pressure.
enum class Hydrostatics : std::uint8_t { buoyancy, full };
enum class SizeDistribution : std::uint8_t { constant, uniform, lognormal, file };
enum class DiscMotion : std::uint8_t { free, fixed, prescribed };
// Where the particles of a disc lie: on rings beneath its rim, or on a square lattice (the paper's).
enum class DiscDummies : std::uint8_t { rings, lattice, adapted };

struct Domain {
    Vector lower = Vector::Zero();
    Vector upper = Vector::Zero();
    std::array<bool, 2> periodic{false, false};

    [[nodiscard]] Vector size() const { return upper - lower; }
};

struct Fluid {
    double density = 0;                 // kg/m3
    double dynamic_viscosity = 0;       // Pa s
    Vector body_force = Vector::Zero(); // m/s2, per mass; on the fluid alone
    Vector gravity = Vector::Zero();    // m/s2; on discs, and on the fluid as hydrostatics says
    Hydrostatics hydrostatics = Hydrostatics::buoyancy;

    // What the momentum equation of the fluid has for f, m/s2.
    [[nodiscard]] Vector acceleration() const {
        return hydrostatics == Hydrostatics::full ? Vector(body_force + gravity) : body_force;
    }
    [[nodiscard]] double kinematic_viscosity() const { return dynamic_viscosity / density; }
};

struct Numerics {
    double particle_spacing = 0; // m
    PairArithmetic pair_arithmetic = PairArithmetic::single_precision;
    KernelShape kernel = KernelShape::fitted_quintic;
    double smoothing_ratio = 1;             // smoothing length / particle spacing
    double sound_speed = 0;                 // m/s
    double background_pressure_ratio = 1.2; // p_b / (rho0 c^2); 0 = no transport velocity
    double acoustic_cfl = 0.75;             // the three factors of Eq. 2.35, 0.25 there
    double viscous_cfl = 0.4;
    double force_cfl = 0.25;
    double density_diffusion = 0;            // delta of delta-SPH; 0 = off
    double fourth_order_diffusion_share = 0; // of the density diffusion
    bool gradient_correction = true;
    bool advection_tensor = true;
    bool keep_mean_density = true;
    PressureMean pressure_mean = PressureMean::density_weighted;
    DummyLayout wall_dummies = DummyLayout::curve;
    DiscDummies disc_dummies = DiscDummies::adapted;
    WallExtrapolation wall_extrapolation = WallExtrapolation::fit;
    WallContinuity wall_continuity = WallContinuity::solenoidal;
    Compressibility compressibility = Compressibility::steady_frame;
    ParticleVolume particle_volume = ParticleVolume::constant;
    NeighbourSearch neighbour_search = NeighbourSearch::strips;

    [[nodiscard]] double smoothing_length() const { return smoothing_ratio * particle_spacing; }
};

struct Start {
    Arrangement arrangement = Arrangement::lattice;
    double jitter = 0.2; // largest displacement per axis / particle spacing, for `jittered`
    std::uint64_t seed = 1;
    InitialVelocity velocity = InitialVelocity::rest;
    double speed = 0;    // m/s: of the shear at the domain's top, or Taylor-Green's peak
    bool impulse = true; // what walls that start at once across their surface do to the fluid: WallImpulse
};

// Shapes. All but Line are graphs y(x) over the whole width of the domain.
struct LineShape {
    Vector from = Vector::Zero();
    Vector to = Vector::Zero();
};
struct CosineShape { // y = mean_height + amplitude cos(2 pi (x - crest) / wavelength)
    double mean_height, amplitude, wavelength, crest;
};
struct GaussianShape { // y = base_height + amplitude exp(-(x - centre)^2 / (2 width^2))
    double base_height, amplitude, centre, width;
};
struct ArcShape { // the line y = base_height with an arc of the given radius and central angle; height > 0
                  // bulges up
    double base_height, centre, radius, angle;
    bool upward;
};
struct SineShape { // the line y = base_height with one period of a sine of the given length about the centre
    double base_height, amplitude, centre, length;
};
struct ProfileShape {           // y(x) through the two columns of a CSV file
    std::filesystem::path file; // absolute, or relative to the scene file's folder (already resolved)
    double base_height;         // added to the file's heights
    std::vector<Vector> points; // as read, x ascending
};
struct RandomShape { // a rough profile about y = mean_height; solver/geometry/random_profile.hpp
    double mean_height, rms_height, correlation_length;
    std::uint64_t seed;
};
using Shape =
    std::variant<LineShape, CosineShape, GaussianShape, ArcShape, SineShape, ProfileShape, RandomShape>;

struct WallScene {
    std::string name;
    Shape shape;
    FluidSide fluid_side = FluidSide::above;
    Vector velocity = Vector::Zero(); // m/s, translation
};

struct SingleDisc {
    double radius = 0;                // m
    Vector position = Vector::Zero(); // m, of the centre
};
struct RandomDiscs {
    int count = 0;              // one of these three is not 0
    double area_fraction = 0;   // of the fluid's area without discs
    double weight_fraction = 0; // mass of discs over mass of discs and fluid
    SizeDistribution sizes = SizeDistribution::constant;
    double radius = 0;          // m: of all, the mean (uniform) or the median (lognormal)
    double spread = 0;          // half width over radius (uniform), or deviation of ln(radius) (lognormal)
    std::filesystem::path file; // CSV of one column of radii, m, to draw from (file)
    std::vector<double> radii;  // as read
    double least_distance = 0;  // m, between the rims of two discs, and of a disc and a wall
    std::uint64_t seed = 1;
};
struct DiscScene {
    std::string name; // those placed at random are name_1, name_2, ...
    std::variant<SingleDisc, RandomDiscs> placement;
    double density = 0; // kg/m3
    DiscMotion motion = DiscMotion::free;
    Vector velocity = Vector::Zero(); // m/s, at the start, or always when prescribed
    double spin = 0;                  // rad/s, anticlockwise, likewise
};

// Repulsion of discs by discs and walls (Eqs. 2.27, 2.28).
struct Contact {
    double distance = 0;    // m, between rims, where it begins; 0: two particle spacings
    double force_scale = 0; // N/m, c of Eq. 2.27; 0: what stops a disc at a fifth of the sound speed
    double stiffness = 1;   // epsilon of Eq. 2.27: the force at touch is force_scale / stiffness
};

struct WallProbe { // pressure and shear at evenly spaced points along a wall (they move with the wall)
    std::string wall;
    int points = 100;
};
struct PointProbe { // pressure and velocity at a fixed point
    Vector position = Vector::Zero();
};
struct GridProbe { // pressure and velocity on a regular grid over the domain; NaN outside the fluid
    std::array<int, 2> points{0, 0};
};
struct ProbeScene {
    std::string name;
    std::variant<WallProbe, PointProbe, GridProbe> kind;
};

struct Output {
    double end_time = 0;
    int series_samples =
        200;                // energies, momenta and point probes: evenly spaced times, start and end included
    int probe_samples = 10; // wall and grid probes: evenly spaced times up to the end
    std::vector<double> snapshot_times; // all particles; the end is always added
    double checkpoint_interval = 600;   // s of wall time; 0: only when the run is interrupted
};

struct Scene {
    std::string title;
    Scheme scheme = Scheme::standard;
    Domain domain;
    Fluid fluid;
    Numerics numerics;
    Start start;
    std::vector<WallScene> walls;
    std::vector<DiscScene> discs;
    Contact contact;
    std::vector<ProbeScene> probes;
    Output output;
    Limits limits;              // not from the scene file: what whoever runs it allows
    std::filesystem::path path; // the scene file
    std::string resolved_text;  // the scene as TOML with every key, defaults and --set values filled in
    std::vector<std::string> warnings; // one line each: what is allowed, but unlikely to be meant
};

} // namespace slurry

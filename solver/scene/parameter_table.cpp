// The one table of what a scene file can say.
#include "solver/scene/binding.hpp"
#include "solver/scene/parameters.hpp"

#include <numbers>

namespace slurry {
namespace {

const Default required{};
const Default origin{std::vector<double>{0, 0}};

Default word(const char* text) {
    return {std::string(text)};
}

Allowed anything() {
    return {};
}
Allowed positive() {
    return {.lower = 0, .lower_excluded = true};
}
Allowed positive_up_to(double upper) {
    return {.lower = 0, .upper = upper, .lower_excluded = true};
}
Allowed at_least(double lower) {
    return {.lower = lower};
}
Allowed between(double lower, double upper) {
    return {.lower = lower, .upper = upper};
}
Allowed identifier() {
    return {.identifier = true};
}
Allowed one_of(std::vector<std::string_view> choices) {
    return {.choices = std::move(choices)};
}

template <auto Tables> std::size_t count_of(const Scene& scene) {
    return (scene.*Tables).size();
}
template <auto Tables> void append_to(Scene& scene) {
    (scene.*Tables).emplace_back();
}
std::size_t one(const Scene& /*scene*/) {
    return 1;
}

// name, selector, number of tables, adding one, meaning
const std::vector<Section> section_table{
    {"scene", "", one, nullptr,
     "what this is, and the scheme that sets the defaults of [numerics] and start.impulse"},
    {"domain", "", one, nullptr, "the rectangle that holds the fluid"},
    {"fluid", "", one, nullptr, "the liquid"},
    {"numerics", "", one, nullptr, "the discretisation"},
    {"start", "", one, nullptr, "particles and velocities at time 0"},
    {"walls", "shape", count_of<&Scene::walls>, append_to<&Scene::walls>,
     "solid walls, at rest or translating"},
    {"discs", "placement", count_of<&Scene::discs>, append_to<&Scene::discs>,
     "rigid discs in the fluid, one by one or in groups at random places"},
    {"contact", "", one, nullptr, "repulsion of discs by discs and walls (Eqs. 2.27, 2.28)"},
    {"probes", "kind", count_of<&Scene::probes>, append_to<&Scene::probes>, "what is measured"},
    {"output", "", one, nullptr, "when it ends and what is written"},
};

// section, shape, placement or kind, key, member, unit, default, allowed, meaning
const std::vector<Parameter> parameter_table{
    {"scene", "", "title", member(&Scene::title), "", word(""), anything(), "one line for reports"},
    {"scene", "", "scheme", member(&Scene::scheme), "", word("default"), one_of({"default", "wang2014"}),
     "sets defaults: wang2014 is the paper's scheme, default what README's section Schemes lists"},

    {"domain", "", "lower", member(&Domain::lower), "m", required, anything(), "lower left corner [x, y]"},
    {"domain", "", "upper", member(&Domain::upper), "m", required, anything(), "upper right corner [x, y]"},
    {"domain", "", "periodic", member(&Domain::periodic), "", word("none"), one_of({"none", "x", "y", "xy"}),
     "directions in which the flow repeats"},

    {"fluid", "", "density", member(&Fluid::density), "kg/m3", required, positive(), "at rest"},
    {"fluid", "", "dynamic_viscosity", member(&Fluid::dynamic_viscosity), "Pa s", required, positive(),
     "Newtonian, constant"},
    {"fluid", "", "body_force", member(&Fluid::body_force), "m/s2", origin, anything(),
     "force per mass [x, y], on the fluid alone"},
    {"fluid", "", "gravity", member(&Fluid::gravity), "m/s2", origin, anything(),
     "[x, y], on discs, and on the fluid as hydrostatics says; not along a periodic axis"},
    {"fluid", "", "hydrostatics", member(&Fluid::hydrostatics), "", word("buoyancy"),
     one_of({"buoyancy", "full"}),
     "buoyancy: the fluid feels no gravity, its pressure is what exceeds the hydrostatic one, and discs feel "
     "their weight less buoyancy; full: gravity on the fluid, too"},

    {"numerics", "", "particle_spacing", member(&Numerics::particle_spacing), "m", required, positive(),
     "distance between neighbouring particles at the start"},
    {"numerics", "", "smoothing_ratio", member(&Numerics::smoothing_ratio), "", 1.0, between(0.8, 2),
     "smoothing length over particle spacing; the kernel reaches 3 smoothing lengths"},
    {"numerics", "", "kernel", member(&Numerics::kernel), "",
     Default::by_scheme<std::string>("fitted_quintic", "quintic"),
     one_of({"quintic", "wendland_c2", "wendland_c4", "fitted_quintic"}),
     "smoothing kernel (Eq. 2.4: quintic); fitted_quintic is its fast stand-in, a polynomial without a root"},
    {"numerics", "", "pair_arithmetic", member(&Numerics::pair_arithmetic), "",
     Default::by_scheme<std::string>("float", "double"), one_of({"float", "double"}),
     "precision of the sums over pairs; positions, velocities and densities are double always"},
    {"numerics", "", "sound_speed", member(&Numerics::sound_speed), "m/s", required, positive(),
     "artificial; the density stays within 1 % at 10 times the largest flow speed and, in films, at 10 times "
     "sqrt(largest pressure / density)"},
    {"numerics", "", "background_pressure_ratio", member(&Numerics::background_pressure_ratio), "",
     Default::by_scheme(1.2, 1.0), between(0, 10),
     "background pressure over density * sound_speed^2, at most 0.85 / (sound_speed * time step / "
     "smoothing_length)^2; 0 turns the transport velocity off"},
    {"numerics", "", "acoustic_cfl", member(&Numerics::acoustic_cfl), "", Default::by_scheme(0.75, 0.25),
     positive_up_to(10), "time step over smoothing_length / sound_speed"},
    {"numerics", "", "viscous_cfl", member(&Numerics::viscous_cfl), "", Default::by_scheme(0.4, 0.25),
     positive_up_to(10), "time step over smoothing_length^2 / kinematic viscosity"},
    {"numerics", "", "force_cfl", member(&Numerics::force_cfl), "", 0.25, positive_up_to(10),
     "time step over sqrt(smoothing_length / acceleration)"},
    {"numerics", "", "density_diffusion", member(&Numerics::density_diffusion), "",
     Default::by_scheme(0.2, 0.0), between(0, 1),
     "delta of the density diffusion, in full where sound_speed * smoothing_length is at least 2.5 times the "
     "kinematic viscosity, and proportionally less below; 0 turns it off"},
    {"numerics", "", "fourth_order_diffusion_share", member(&Numerics::fourth_order_diffusion_share), "",
     Default::by_scheme(0.8, 0.0), between(0, 0.9),
     "share of the density diffusion that leaves smooth fields alone; 0 is that of Molteni and Colagrossi"},
    {"numerics", "", "gradient_correction", member(&Numerics::gradient_correction), "", true, anything(),
     "corrected kernel gradient in the continuity equation"},
    {"numerics", "", "keep_mean_density", member(&Numerics::keep_mean_density), "",
     Default::by_scheme(true, false), anything(),
     "the mean of the density is the start's, as mass and volume are"},
    {"numerics", "", "advection_tensor", member(&Numerics::advection_tensor), "", true, anything(),
     "momentum carried by the transport velocity"},
    {"numerics", "", "pressure_mean", member(&Numerics::pressure_mean), "", word("density_weighted"),
     one_of({"density_weighted", "plain"}),
     "pressure between two particles: weighted with their densities (Eq. 2.15), or the plain mean"},
    {"numerics", "", "wall_dummies", member(&Numerics::wall_dummies), "",
     Default::by_scheme<std::string>("curve", "lattice"), one_of({"curve", "lattice"}),
     "wall particles in layers along the wall, or on the lattice of the fluid"},
    {"numerics", "", "disc_dummies", member(&Numerics::disc_dummies), "",
     Default::by_scheme<std::string>("adapted", "lattice"), one_of({"rings", "lattice", "adapted"}),
     "particles of a disc on rings beneath its rim, on a square lattice, or, adapted, on rings where the "
     "squares of the lattice have an area more than 10 % off the disc's"},
    {"numerics", "", "wall_extrapolation", member(&Numerics::wall_extrapolation), "",
     Default::by_scheme<std::string>("fit", "mean"), one_of({"mean", "fit"}),
     "fluid continued to wall particles by kernel means (Eqs. 2.16, 2.17) or by least-squares fits"},
    {"numerics", "", "wall_continuity", member(&Numerics::wall_continuity), "",
     Default::by_scheme<std::string>("solenoidal", "wall_velocity"),
     one_of({"wall_velocity", "extrapolated", "solenoidal"}),
     "velocity of wall particles in the continuity equation; solenoidal: extrapolated, but for the normal "
     "part that keeps volumes"},
    {"numerics", "", "compressibility", member(&Numerics::compressibility), "",
     Default::by_scheme<std::string>("steady_frame", "acoustic"), one_of({"acoustic", "steady_frame"}),
     "what the artificial sound speed leaves in the flow; steady_frame: none where the flow is steady as "
     "seen "
     "from the rough walls"},
    {"numerics", "", "particle_volume", member(&Numerics::particle_volume), "",
     Default::by_scheme<std::string>("constant", "number_density"),
     one_of({"mass_over_density", "number_density", "constant"}), "particle volume in the forces"},
    {"numerics", "", "neighbour_search", member(&Numerics::neighbour_search), "", word("strips"),
     one_of({"strips", "cells", "plane_sweep"}),
     "how neighbours are found; the answer is the same, plane_sweep is the paper's"},

    {"start", "", "arrangement", member(&Start::arrangement), "", word("lattice"),
     one_of({"lattice", "jittered", "relaxed", "empty"}),
     "of the fluid's particles; empty: no fluid, discs alone"},
    {"start", "", "jitter", member(&Start::jitter), "", 0.2, between(0, 0.5),
     "largest displacement per axis over particle spacing, when jittered"},
    {"start", "", "seed", member(&Start::seed), "", std::int64_t{1}, at_least(0),
     "of the random displacements"},
    {"start", "", "velocity", member(&Start::velocity), "", word("rest"),
     one_of({"rest", "shear", "taylor_green"}), "of the fluid"},
    {"start", "", "speed", member(&Start::speed), "m/s", 0.0, anything(),
     "of the shear at the domain's top, or Taylor-Green's peak; 0 at rest, and only then"},
    {"start", "", "impulse", member(&Start::impulse), "", Default::by_scheme(true, false), anything(),
     "rough walls that start at once push the fluid as if it were incompressible: a potential flow is added "
     "to its velocity, and to that of free discs; false: sound has to set them in motion"},

    {"walls", "", "name", member(&WallScene::name), "", required, identifier(), "unique"},
    {"walls", "", "shape", member(&WallScene::shape), "", required,
     one_of({"line", "cosine", "gaussian", "arc", "sine", "profile", "random"}), "of the curve"},
    {"walls", "", "fluid_side", member(&WallScene::fluid_side), "", required,
     one_of({"above", "below", "left", "right"}), "of the curve; left and right for vertical lines only"},
    {"walls", "", "velocity", member(&WallScene::velocity), "m/s", origin, anything(), "translation [x, y]"},
    {"walls", "line", "from", member(&LineShape::from), "m", required, anything(), "one end [x, y]"},
    {"walls", "line", "to", member(&LineShape::to), "m", required, anything(), "the other end [x, y]"},
    {"walls", "cosine", "mean_height", member(&CosineShape::mean_height), "m", required, anything(),
     "y = mean_height + amplitude cos(2 pi (x - crest) / wavelength)"},
    {"walls", "cosine", "amplitude", member(&CosineShape::amplitude), "m", required, anything(),
     "of the cosine, of either sign"},
    {"walls", "cosine", "wavelength", member(&CosineShape::wavelength), "m", required, positive(),
     "from crest to crest"},
    {"walls", "cosine", "crest", member(&CosineShape::crest), "m", 0.0, anything(), "x of a crest"},
    {"walls", "gaussian", "base_height", member(&GaussianShape::base_height), "m", required, anything(),
     "y = base_height + amplitude exp(-(x - centre)^2 / (2 width^2))"},
    {"walls", "gaussian", "amplitude", member(&GaussianShape::amplitude), "m", required, anything(),
     "height of the asperity, or depth if negative"},
    {"walls", "gaussian", "centre", member(&GaussianShape::centre), "m", required, anything(),
     "x of the peak"},
    {"walls", "gaussian", "width", member(&GaussianShape::width), "m", required, positive(),
     "standard deviation"},
    {"walls", "arc", "base_height", member(&ArcShape::base_height), "m", required, anything(),
     "y of the line that the arc stands on"},
    {"walls", "arc", "centre", member(&ArcShape::centre), "m", required, anything(), "x of the arc's middle"},
    {"walls", "arc", "radius", member(&ArcShape::radius), "m", required, positive(), "of the circle"},
    {"walls", "arc", "angle", member(&ArcShape::angle), "rad", required, positive_up_to(std::numbers::pi),
     "central angle of the arc"},
    {"walls", "arc", "upward", member(&ArcShape::upward), "", required, anything(), "bulges towards +y"},
    {"walls", "sine", "base_height", member(&SineShape::base_height), "m", required, anything(),
     "y of the line that the sine interrupts"},
    {"walls", "sine", "amplitude", member(&SineShape::amplitude), "m", required, anything(),
     "of the sine, of either sign"},
    {"walls", "sine", "centre", member(&SineShape::centre), "m", required, anything(), "x of its middle"},
    {"walls", "sine", "length", member(&SineShape::length), "m", required, positive(), "of its one period"},
    {"walls", "profile", "file", member(&ProfileShape::file), "", required, anything(),
     "CSV of two columns x, y in m, x ascending, # before a comment; relative to the scene's folder"},
    {"walls", "profile", "base_height", member(&ProfileShape::base_height), "m", 0.0, anything(),
     "added to the file's heights"},
    {"walls", "random", "mean_height", member(&RandomShape::mean_height), "m", required, anything(),
     "of the rough profile, which repeats with the domain's width"},
    {"walls", "random", "rms_height", member(&RandomShape::rms_height), "m", required, positive(),
     "root mean square of the heights about their mean"},
    {"walls", "random", "correlation_length", member(&RandomShape::correlation_length), "m", required,
     positive(), "where the correlation of the heights, exp(-(r / correlation_length)^2), has fallen to 1/e"},
    {"walls", "random", "seed", member(&RandomShape::seed), "", std::int64_t{1}, at_least(0),
     "of the random phases; the same profile on every machine"},

    {"discs", "", "name", member(&DiscScene::name), "", required, identifier(),
     "unique; discs at random places are name_1, name_2, ..."},
    {"discs", "", "placement", member(&DiscScene::placement), "", required, one_of({"single", "random"}),
     "one disc at a given place, or a group at random places without overlap"},
    {"discs", "", "density", member(&DiscScene::density), "kg/m3", required, positive(), "of the discs"},
    {"discs", "", "motion", member(&DiscScene::motion), "", word("free"),
     one_of({"free", "fixed", "prescribed"}),
     "moved by the fluid, contact and gravity, at rest always, or with velocity and spin always"},
    {"discs", "", "velocity", member(&DiscScene::velocity), "m/s", origin, anything(),
     "at the start, or always when prescribed [x, y]"},
    {"discs", "", "spin", member(&DiscScene::spin), "rad/s", 0.0, anything(),
     "anticlockwise, at the start, or always when prescribed"},
    {"discs", "single", "radius", member(&SingleDisc::radius), "m", required, positive(), "of the disc"},
    {"discs", "single", "position", member(&SingleDisc::position), "m", required, anything(),
     "of the centre at the start [x, y]"},
    {"discs", "random", "count", member(&RandomDiscs::count), "", std::int64_t{0}, between(0, 1e8),
     "of discs; one of count, area_fraction and weight_fraction is not 0"},
    {"discs", "random", "area_fraction", member(&RandomDiscs::area_fraction), "", 0.0, between(0, 1),
     "area of the discs over the area between the walls"},
    {"discs", "random", "weight_fraction", member(&RandomDiscs::weight_fraction), "", 0.0, between(0, 1),
     "mass of the discs over the mass of them and the fluid around all discs"},
    {"discs", "random", "sizes", member(&RandomDiscs::sizes), "", word("constant"),
     one_of({"constant", "uniform", "lognormal", "file"}), "distribution of the radii"},
    {"discs", "random", "radius", member(&RandomDiscs::radius), "m", 0.0, at_least(0),
     "of all, the mean (uniform) or the median (lognormal); 0 with sizes = \"file\", and only then"},
    {"discs", "random", "spread", member(&RandomDiscs::spread), "", 0.0, between(0, 2),
     "half width over radius (uniform, less than 1), or deviation of ln(radius) (lognormal)"},
    {"discs", "random", "file", member(&RandomDiscs::file), "", word(""), anything(),
     "CSV of one column of radii in m to draw from, # before a comment; relative to the scene's folder"},
    {"discs", "random", "least_distance", member(&RandomDiscs::least_distance), "m", 0.0, at_least(0),
     "at the start, between the rim of a disc and those of others and walls; 0: contact.distance for free "
     "discs, none for others"},
    {"discs", "random", "seed", member(&RandomDiscs::seed), "", std::int64_t{1}, at_least(0),
     "of the random places and radii"},

    {"contact", "", "distance", member(&Contact::distance), "m", 0.0, at_least(0),
     "between rims, or a rim and a wall, where repulsion begins; 0: two particle spacings"},
    {"contact", "", "force_scale", member(&Contact::force_scale), "N/m", 0.0, at_least(0),
     "c of Eq. 2.27; 0: what stops a disc at a fifth of the sound speed"},
    {"contact", "", "stiffness", member(&Contact::stiffness), "", 1.0, positive(),
     "epsilon of Eq. 2.27: the force at touch is force_scale / stiffness"},

    {"probes", "", "name", member(&ProbeScene::name), "", required, identifier(), "unique"},
    {"probes", "", "kind", member(&ProbeScene::kind), "", required, one_of({"wall", "point", "grid"}),
     "pressure and shear along a wall, or pressure and velocity at a point or on a grid over the domain"},
    {"probes", "wall", "wall", member(&WallProbe::wall), "", required, identifier(), "name of the wall"},
    {"probes", "wall", "points", member(&WallProbe::points), "", std::int64_t{100}, between(1, 100'000),
     "evenly spaced along the wall"},
    {"probes", "point", "position", member(&PointProbe::position), "m", required, anything(),
     "[x, y], in the domain"},
    {"probes", "grid", "points", member(&GridProbe::points), "", required, between(1, 10'000),
     "numbers of points [x, y]"},

    {"output", "", "end_time", member(&Output::end_time), "s", required, positive(), "of the simulation"},
    {"output", "", "series_samples", member(&Output::series_samples), "", std::int64_t{200},
     between(2, 1'000'000),
     "of energies, momenta and point probes: evenly spaced times, start and end included"},
    {"output", "", "probe_samples", member(&Output::probe_samples), "", std::int64_t{10}, between(1, 100'000),
     "of wall and grid probes: evenly spaced times up to the end"},
    {"output", "", "snapshot_times", member(&Output::snapshot_times), "s", std::vector<double>{}, at_least(0),
     "ascending, at which all particles are written; the end is always added"},
    {"output", "", "checkpoint_interval", member(&Output::checkpoint_interval), "s", 600.0, at_least(0),
     "wall time between checkpoints, from which a run that was ended can be resumed; 0: only when it is "
     "interrupted"},
};

} // namespace

const std::vector<Section>& sections() {
    return section_table;
}

const std::vector<Parameter>& parameters() {
    return parameter_table;
}

} // namespace slurry

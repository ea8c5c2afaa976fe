//! The command line of the lab: one file per measurement.

mod cluster;
mod costs;
mod engine;
mod fleet;
mod flights;
mod flights_stages;
mod flights_steps;
mod geometry;
mod ground;
mod lidar;
mod look;
mod outcome;
mod people;
mod planner;
mod plugins;
mod process;
mod render;
mod simplify;
mod small;
mod steady;
mod town_of_recipe;
mod vehicles;

use clap::{Parser, Subcommand};
use outcome::Outcome;

/// Measurements of cosfly and of other libraries
#[derive(Debug, Parser)]
#[command(name = "cosfly-lab", version, about, max_term_width = 100)]
pub struct Arguments {
    /// The measurement
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// The engine on a running HyperQueue server: cheap items as commands on workers
    Cluster(cluster::ClusterArguments),
    /// Core-seconds, bytes and money of a thousand frames by look and size, as a table in Markdown
    #[command(after_help = costs::EXAMPLES)]
    Costs(costs::CostsArguments),
    /// The engine with cheap items: cold overhead, everything cached, one parameter changed and changed back
    Engine(engine::EngineArguments),
    /// Publishing many flights and reading them: toy films, then the real engine and commands; time, memory and disk
    #[command(after_help = flights::EXAMPLES)]
    Flights(flights::FlightsArguments),
    /// Many trajectories on many workers, simulated: operations of the store, waiting, crashes
    Fleet(fleet::FleetArguments),
    /// Box queries per second on one core: cosfly's tree, the trees of parry and obvhs, and a brute-force loop
    #[command(after_help = geometry::EXAMPLES)]
    Geometry(geometry::GeometryArguments),
    /// Lidars: beams a second of a core by device, over a town
    #[command(after_help = lidar::EXAMPLES)]
    Lidar(lidar::LidarArguments),
    /// Statistics of pictures beside those of real ones: spectral slope, flat pixels, edges, spread of colours
    #[command(after_help = look::EXAMPLES)]
    Look(look::LookArguments),
    /// Simulated people beside recorded ones: speeds, stops, turns, groups, distances; speed by density
    #[command(after_help = people::EXAMPLES)]
    People(people::PeopleArguments),
    /// Planners compared on the same paths: visibility, distance, length, time, nodes, clearance, limits
    #[command(after_help = planner::EXAMPLES)]
    Planner(planner::PlannerArguments),
    /// Plugins against the same cost terms in native code: calls, strict mode, whole flights, start
    Plugins,
    /// The renderer: CPU time of a frame by stage, frames per second as finished logs, comparison with memory bandwidth
    #[command(after_help = render::EXAMPLES)]
    Render(render::RenderArguments),
    /// Boxes for planning by tolerance: how few, volume gained and lost, CPU time; 65,000 boxes or those of a map
    #[command(after_help = simplify::EXAMPLES)]
    Simplify(simplify::SimplifyArguments),
    /// Small pictures: depth, labels and ids in the large renderer and in the batch renderer, in turns
    #[command(after_help = small::EXAMPLES)]
    Small(small::SmallArguments),
    /// Steadiness of pictures: pixels that pop in clips of a slowly moving camera, by what they show
    #[command(after_help = steady::EXAMPLES)]
    Steady(steady::SteadyArguments),
    /// Simulated vehicles: speeds, accelerations along and across their ways by kind
    #[command(after_help = vehicles::EXAMPLES)]
    Vehicles(vehicles::VehiclesArguments),
    /// A command of `cluster`
    #[command(hide = true)]
    Task(cluster::TaskArguments),
}

impl Arguments {
    /// Runs the measurement and prints its table.
    pub fn run(&self) -> Outcome {
        match &self.command {
            Command::Cluster(arguments) => cluster::cluster(arguments),
            Command::Costs(arguments) => costs::costs(arguments),
            Command::Engine(arguments) => engine::engine(arguments),
            Command::Flights(arguments) => flights::flights(arguments),
            Command::Fleet(arguments) => fleet::fleet(arguments),
            Command::Geometry(arguments) => geometry::geometry(arguments),
            Command::Lidar(arguments) => lidar::lidar(arguments),
            Command::Look(arguments) => look::look(arguments),
            Command::People(arguments) => people::people(arguments),
            Command::Planner(arguments) => planner::planner(arguments),
            Command::Plugins => plugins::plugins(),
            Command::Render(arguments) => render::render(arguments),
            Command::Simplify(arguments) => simplify::simplify(arguments),
            Command::Small(arguments) => small::small(arguments),
            Command::Steady(arguments) => steady::steady(arguments),
            Command::Vehicles(arguments) => vehicles::vehicles(arguments),
            Command::Task(arguments) => cluster::task(arguments),
        }
    }
}

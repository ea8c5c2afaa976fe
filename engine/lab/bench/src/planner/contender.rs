//! Contenders: cosfly's planner, the paper's, and the baselines, behind one interface.

use super::plain_bvh::PlainBvh;
use super::scene::Ground;
use cosfly_domain::{OrientedBox, PlanOutcome};
use cosfly_frames::{DVec3, TargetTrack};
use cosfly_planner::baselines::grid::VoxelOptions;
use cosfly_planner::baselines::{Baseline, BaselineInput, BaselinePath, plan_astar, plan_baseline, plan_baseline_with};
use cosfly_planner::config::Foresight;
use cosfly_planner::paper::plan_paper;
use cosfly_planner::problem::Problem;
use cosfly_planner::terms::built_in_terms;
use cosfly_planner::{MucoConfig, PlanError, PlanRequest, Preset, Walk, plan_request};
use cosfly_surroundings::ground::GroundGrid;
use cosfly_surroundings::local::LocalObstacles;

/// A planner of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Contender {
    /// Cosfly's planner with its default preset.
    Cosfly,
    /// Planner of cosfly that knows only the past of target and movers.
    Causal,
    /// Cosfly's planner with another of its presets.
    Preset(Preset),
    /// The paper's pipeline alone: neither certified nor rejected.
    Paper,
    /// The paper's pipeline as recipes use it: made flyable and certified, or rejected.
    PaperFlyable,
    /// The paper's A*, with rays through a textbook BVH: the reference of the column "faster".
    Astar,
    /// A baseline that recipes offer, too.
    Baseline(Baseline),
    /// A* with other settings; an index into [`SETTINGS`].
    Setting(usize),
}

/// A* with non-default settings, for a fair comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// Name in the table and on the command line.
    pub name: &'static str,
    /// Whether the path is made flyable.
    pub smoothed: bool,
    /// Voxels and the weight of motion.
    pub options: VoxelOptions,
    /// Weight of visibility, where it differs from the recipe's.
    pub visibility: Option<f64>,
    /// Weight of the soft safety term, where it differs from the recipe's; the hard constraint stays.
    pub safety: Option<f64>,
}

const fn setting(name: &'static str, smoothed: bool, voxel_m: f64, motion_per_m: f64) -> Setting {
    Setting { name, smoothed, options: VoxelOptions { voxel_m, motion_per_m }, visibility: None, safety: None }
}

/// Settings, in the table only on request.
pub const SETTINGS: [Setting; 8] = [
    setting("astar_move_0.1", false, 2.0, 0.1),
    setting("astar_move_4", false, 2.0, 4.0),
    Setting { safety: Some(0.0), ..setting("astar_bold", false, 2.0, 1.0) },
    Setting { safety: Some(0.0), ..setting("astar_bold_smoothed", true, 2.0, 1.0) },
    Setting { visibility: Some(300.0), ..setting("astar_vis_300", false, 2.0, 1.0) },
    Setting { visibility: Some(300.0), ..setting("astar_vis_300_smoothed", true, 2.0, 1.0) },
    Setting { visibility: Some(300.0), safety: Some(0.0), ..setting("astar_best_smoothed", true, 2.0, 0.1) },
    setting("astar_1m", false, 1.0, 1.0),
];

/// Presets beside the default one, with their names.
const PRESETS: [(Preset, &str); 3] = [(Preset::Agile, "agile"), (Preset::Rear, "rear"), (Preset::Short, "short")];

/// A planned path, before evaluation.
pub struct Planned {
    /// Positions, one per frame, metres.
    pub waypoints: Vec<DVec3>,
    /// Nodes expanded by the search; 0 for planners without a search.
    pub nodes: u64,
    /// Mean visibility of the lattice's cheapest path, from which the flight was refined.
    pub lattice_visibility: Option<f64>,
}

impl Contender {
    /// All contenders of the default table, in order.
    pub fn all() -> Vec<Self> {
        let first = [Self::Cosfly, Self::Paper, Self::PaperFlyable, Self::Astar];
        first.into_iter().chain(Baseline::ALL.into_iter().map(Self::Baseline)).collect()
    }

    /// The contenders of the table of visibility against learnability, in order.
    pub fn of_front() -> Vec<Self> {
        let presets = PRESETS.map(|(preset, _)| Self::Preset(preset));
        let rivals = [Self::Baseline(Baseline::AstarFast), Self::Baseline(Baseline::AstarSmoothed)];
        let paper = [Self::Paper, Self::PaperFlyable];
        [Self::Cosfly].into_iter().chain(presets).chain(rivals).chain(paper).collect()
    }

    /// [`Self::all`], the other presets, and the [`SETTINGS`].
    pub fn nameable() -> Vec<Self> {
        let presets = PRESETS.map(|(preset, _)| Self::Preset(preset));
        Self::all()
            .into_iter()
            .chain([Self::Causal])
            .chain(presets)
            .chain((0..SETTINGS.len()).map(Self::Setting))
            .collect()
    }

    /// Name in the table and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Setting(index) => SETTINGS[index].name,
            Self::Cosfly => "cosfly",
            Self::Causal => "causal",
            Self::Preset(preset) => PRESETS.iter().find(|(known, _)| *known == preset).map_or("preset", |it| it.1),
            Self::Paper => "paper",
            Self::PaperFlyable => "paper_flyable",
            Self::Astar => "astar",
            Self::Baseline(baseline) => baseline.name(),
        }
    }

    /// Plans one path; the error is the reason for a missing flight.
    pub fn plan(self, ground: &Ground, track: &TargetTrack, config: &MucoConfig) -> Result<Planned, String> {
        self.plan_among(&[], ground, track, config)
    }

    /// Plan of one path among boxes that move, of which the paper's pipeline alone does not know.
    pub fn plan_among(
        self,
        movers: &[Vec<OrientedBox>],
        ground: &Ground,
        track: &TargetTrack,
        config: &MucoConfig,
    ) -> Result<Planned, String> {
        let way = &Way { ground, track, movers };
        match self {
            Self::Cosfly => flight(way, &MucoConfig { preset: Preset::Cosfly, ..config.clone() }),
            Self::Causal => flight(way, &MucoConfig { foresight: Foresight::Causal, ..config.clone() }),
            Self::Preset(preset) => flight(way, &MucoConfig { preset, ..config.clone() }),
            Self::Paper => Ok(paper_flight(ground, track, &MucoConfig { preset: Preset::Paper, ..config.clone() })),
            Self::PaperFlyable => flight(way, &MucoConfig { preset: Preset::Paper, ..config.clone() }),
            Self::Astar => baseline_path(way, config, &|input| {
                plan_astar(input, VoxelOptions::default(), |boxes| PlainBvh::build(&boxes))
            }),
            Self::Baseline(baseline) => baseline_path(way, config, &|input| plan_baseline(baseline, input)),
            Self::Setting(index) => setting_path(&SETTINGS[index], way, config),
        }
    }
}

/// Ground, walk and boxes that one flight is planned on.
struct Way<'a> {
    ground: &'a Ground,
    track: &'a TargetTrack,
    movers: &'a [Vec<OrientedBox>],
}

fn flight(&Way { ground, track, movers }: &Way<'_>, config: &MucoConfig) -> Result<Planned, String> {
    let height = |x: f64, y: f64| (ground.height)(x, y);
    let mut request = PlanRequest::new(track, ground.exact.as_ref(), &ground.planning_boxes, &height, config);
    request.movers = movers;
    match plan_request(request) {
        PlanOutcome::Planned(flight) => Ok(Planned {
            waypoints: flight.poses_in_world.iter().map(|pose| pose.position_in_world).collect(),
            nodes: 0,
            lattice_visibility: Some(flight.certificate.lattice_visibility).filter(|seen| *seen > 0.0),
        }),
        PlanOutcome::Rejected { reason, .. } => Err(reason),
    }
}

/// Flight of the paper's pipeline alone, neither certified nor rejected.
fn paper_flight(ground: &Ground, track: &TargetTrack, config: &MucoConfig) -> Planned {
    let terms = built_in_terms(&config.resolved_weights());
    let walk = Walk::of(track);
    let problem =
        Problem { track, view: &config.view, walk: &walk, terms: &terms, built_in: terms.len(), first_frame: 0 };
    let (radius_m, influence_m) = (config.search.filter_radius_m, config.view.safety_influence_m);
    let grid = GroundGrid::sample(track, &*ground.height, radius_m + 10.0);
    let mut obstacles = LocalObstacles::filter(track, &ground.planning_boxes, &grid, radius_m, influence_m);
    let flight = plan_paper(&problem, &mut obstacles, config);
    Planned { waypoints: flight.waypoints, nodes: 0, lattice_visibility: None }
}

fn setting_path(setting: &Setting, way: &Way<'_>, config: &MucoConfig) -> Result<Planned, String> {
    let mut own = config.clone();
    own.weights.visibility = setting.visibility.or(own.weights.visibility);
    own.weights.safety = setting.safety.or(own.weights.safety);
    let kind = if setting.smoothed { Baseline::AstarSmoothed } else { Baseline::AstarFast };
    baseline_path(way, &own, &|input| plan_baseline_with(kind, input, setting.options))
}

fn baseline_path(
    &Way { ground, track, movers }: &Way<'_>,
    config: &MucoConfig,
    find: &dyn Fn(&BaselineInput<'_>) -> Result<BaselinePath, PlanError>,
) -> Result<Planned, String> {
    let terms = built_in_terms(&config.resolved_weights());
    let walk = Walk::of(track);
    let problem =
        Problem { track, view: &config.view, walk: &walk, terms: &terms, built_in: terms.len(), first_frame: 0 };
    let grid = GroundGrid::sample(track, &*ground.height, config.search.filter_radius_m + 10.0);
    let input = BaselineInput {
        problem: &problem,
        planning_boxes: &ground.planning_boxes,
        exact: ground.exact.as_ref(),
        movers,
        ground: &grid,
        config,
    };
    let found = find(&input).map_err(|reason| reason.to_string())?;
    let (waypoints, nodes) = (found.waypoints, found.nodes_expanded);
    Ok(Planned { waypoints, nodes, lattice_visibility: None })
}

//! Kinds of things that boxes with a label of CARLA's `CityObjectLabel` become.

use cosfly_domain::{ObstacleKind, OrientedBox};
use cosfly_frames::DVec3;
use cosfly_town::crown::crown_boxes;
use serde::Deserialize;

/// Plants up to this height are bushes, metres; higher ones are trees.
const BUSH_M: f64 = 3.0;
/// Height at which the crown of a tree begins, as a share of the whole.
const CROWN_SHARE: f64 = 0.35;

/// A name of `carla.CityObjectLabel`.
#[derive(Clone, Copy, Debug, Deserialize)]
pub(super) enum Label {
    Any,
    Bicycle,
    Bridge,
    Buildings,
    Bus,
    Car,
    Dynamic,
    Fences,
    Ground,
    GuardRail,
    Motorcycle,
    #[serde(rename = "NONE")]
    Nothing,
    Other,
    Pedestrians,
    Poles,
    RailTrack,
    Rider,
    RoadLines,
    Roads,
    Sidewalks,
    Sky,
    Static,
    Terrain,
    TrafficLight,
    TrafficSigns,
    Train,
    Truck,
    Vegetation,
    Walls,
    Water,
}

/// Part of the town that a box becomes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// Itself.
    Solid(ObstacleKind),
    /// A tree or a bush, by its height.
    Plant,
    /// Ground, sky and what moves: nothing.
    Nothing,
}

/// How many boxes became what no map says.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    plants: usize,
    left_out: usize,
}

impl Label {
    pub(super) fn part(self) -> Part {
        match self {
            Self::Buildings => Part::Solid(ObstacleKind::Building),
            Self::Walls => Part::Solid(ObstacleKind::Wall),
            Self::Fences => Part::Solid(ObstacleKind::Fence),
            Self::Poles => Part::Solid(ObstacleKind::Pole),
            Self::TrafficLight => Part::Solid(ObstacleKind::TrafficLight),
            Self::TrafficSigns => Part::Solid(ObstacleKind::TrafficSign),
            Self::GuardRail => Part::Solid(ObstacleKind::GuardRail),
            Self::Bridge => Part::Solid(ObstacleKind::Bridge),
            Self::Car | Self::Truck | Self::Bus | Self::Train => Part::Solid(ObstacleKind::Car),
            Self::Bicycle | Self::Motorcycle | Self::Static | Self::Dynamic | Self::Other => {
                Part::Solid(ObstacleKind::Static)
            }
            Self::Vegetation => Part::Plant,
            Self::Any
            | Self::Nothing
            | Self::Ground
            | Self::Pedestrians
            | Self::RailTrack
            | Self::Rider
            | Self::RoadLines
            | Self::Roads
            | Self::Sidewalks
            | Self::Sky
            | Self::Terrain
            | Self::Water => Part::Nothing,
        }
    }
}

impl Part {
    /// The solid boxes of a box of the file.
    pub(super) fn boxes(self, shape: OrientedBox, object_id: u32) -> Vec<(ObstacleKind, OrientedBox)> {
        match self {
            Self::Nothing => Vec::new(),
            Self::Solid(kind) => vec![(kind, shape)],
            Self::Plant if 2.0 * shape.half_extents_m.z <= BUSH_M => vec![(ObstacleKind::Bush, shape)],
            Self::Plant => {
                let height_m = 2.0 * shape.half_extents_m.z;
                let foot = shape.center_in_world - shape.half_extents_m.z * DVec3::Z;
                let part = |from: f64, to: f64, half_m: [f64; 2]| OrientedBox {
                    center_in_world: foot + 0.5 * (from + to) * height_m * DVec3::Z,
                    half_extents_m: DVec3::new(half_m[0], half_m[1], 0.5 * (to - from) * height_m),
                    yaw_rad: shape.yaw_rad,
                };
                let trunk_m = (0.015 * height_m).clamp(0.08, 0.4);
                let crown = part(CROWN_SHARE, 1.0, [shape.half_extents_m.x, shape.half_extents_m.y]);
                let crowns = crown_boxes(&crown, object_id).map(|one| (ObstacleKind::TreeCrown, one));
                let trunk = (ObstacleKind::TreeTrunk, part(0.0, CROWN_SHARE, [trunk_m; 2]));
                core::iter::once(trunk).chain(crowns).collect()
            }
        }
    }
}

impl Tally {
    pub(super) fn note(&mut self, part: Part) {
        self.plants += usize::from(part == Part::Plant);
        self.left_out += usize::from(part == Part::Nothing);
    }

    pub(super) fn notes(self) -> Vec<String> {
        let note = format!(
            "{} boxes of vegetation are trees above {BUSH_M} m, with an assumed trunk and a crown from {CROWN_SHARE} of the \
             height up, else bushes",
            self.plants
        );
        if self.plants > 0 { vec![note] } else { Vec::new() }
    }

    pub(super) fn warnings(self) -> Vec<String> {
        let warning = format!("{} boxes of ground, sky or people are left out", self.left_out);
        if self.left_out > 0 { vec![warning] } else { Vec::new() }
    }
}

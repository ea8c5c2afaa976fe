//! The road network as the file states it: typed, checked, nothing derived; map frame, metres, radians.

use super::plan_view::PlanElement;
use super::polynomial::CubicProfile;
use core::ops::Range;
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_town::solids::Roof;

/// Everything the reader takes from an OpenDRIVE file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RoadNetwork {
    /// `name` of the header.
    pub name: Option<String>,
    /// Projection text of the header.
    pub geo_reference: Option<String>,
    /// `<offset>` of the header: the projection's coordinates are those of the file and this, metres.
    pub offset_m: DVec3,
    /// `userData` of the header: land without a surface is lawn, also between houses.
    pub has_lawn: bool,
    /// Roads in file order.
    pub roads: Vec<Road>,
}

impl RoadNetwork {
    /// All lanes of all roads.
    pub fn lanes(&self) -> impl Iterator<Item = &RoadLane> {
        let sections = self.roads.iter().flat_map(|road| &road.sections);
        sections.flat_map(|section| section.left.iter().chain(&section.right))
    }

    /// Turns all roads about the origin of the file, counter-clockwise.
    pub(super) fn turn(&mut self, turn_rad: f64) {
        if turn_rad == 0.0 {
            return;
        }
        let (sin, cos) = real::sin_cos(turn_rad);
        for element in self.roads.iter_mut().flat_map(|road| &mut road.plan) {
            let DVec2 { x, y } = element.start.position_in_map;
            element.start.position_in_map = DVec2::new(cos * x - sin * y, sin * x + cos * y);
            element.start.heading_rad += turn_rad;
        }
    }

    /// First points of all pieces of all reference lines, map frame, metres.
    pub fn plan_points(&self) -> impl Iterator<Item = DVec2> {
        self.roads.iter().flat_map(|road| &road.plan).map(|element| element.start.position_in_map)
    }
}

/// A road: a reference line with lanes and things beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Road {
    /// `id` in the file.
    pub id: String,
    /// Junction that it crosses, `None` outside junctions.
    pub junction: Option<String>,
    /// Whether traffic keeps to the left.
    pub left_hand: bool,
    /// Speed limits, m/s, by the place along the road where they begin, metres; sorted.
    pub speed_limits: Vec<(f64, f64)>,
    /// Length of the reference line, metres.
    pub length_m: f64,
    /// Whether its start and its end meet a junction.
    pub meets_junction: [bool; 2],
    /// The reference line, sorted by s, never empty.
    pub plan: Vec<PlanElement>,
    /// Height of the reference line.
    pub elevation: CubicProfile,
    /// Roll of the surface, radians, positive = left side up.
    pub superelevation: CubicProfile,
    /// Fall of the left and the right side away from the reference line, radians (OpenDRIVE 1.4).
    pub crossfall: [CubicProfile; 2],
    /// Cross-sections of free shape, sorted by s.
    pub shapes: Vec<ShapeSection>,
    /// Sideways shift of the centre lane.
    pub lane_offset: CubicProfile,
    /// Lane sections, sorted by s, never empty.
    pub sections: Vec<LaneSection>,
    /// Things beside and on the road.
    pub objects: Vec<RoadObject>,
    /// Signs and lights.
    pub signals: Vec<RoadSignal>,
    /// Bytes of the start tag in the text.
    pub byte_span: Range<usize>,
}

/// Heights across the road at one s.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeSection {
    /// Place along the road, metres.
    pub s_m: f64,
    /// Height over t; the starts of the records are values of t.
    pub over_t: CubicProfile,
}

/// A stretch of road with a fixed set of lanes.
#[derive(Clone, Debug, PartialEq)]
pub struct LaneSection {
    /// Start, metres along the road.
    pub start_s_m: f64,
    /// End, metres along the road: the start of the next section or the end of the road.
    pub end_s_m: f64,
    /// Lanes 1, 2, ... from the centre outwards.
    pub left: Vec<RoadLane>,
    /// Marks of the centre line.
    pub center_marks: Vec<RoadMark>,
    /// Lanes -1, -2, ... from the centre outwards.
    pub right: Vec<RoadLane>,
}

impl LaneSection {
    /// Both sides, each with its sign: +1 for the left (growing t), -1 for the right.
    pub fn sides(&self) -> [(f64, &[RoadLane]); 2] {
        [(1.0, &self.left), (-1.0, &self.right)]
    }
}

/// One lane of a section. Stations are along the road, not within the section.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadLane {
    /// `id`: positive to the left, negative to the right.
    pub id: i32,
    /// Use of the lane.
    pub kind: RoadLaneKind,
    /// Vehicles that drive on it in its direction, if any.
    pub traffic: Option<cosfly_domain::LaneKind>,
    /// Its own speed limit, m/s.
    pub speed_limit_mps: Option<f64>,
    /// Kept level: the road's roll does not apply.
    pub level: bool,
    /// Course of the outer edge.
    pub edge: LaneEdge,
    /// Heights above the road surface, sorted by s; between records they change linearly.
    pub heights: Vec<LaneHeight>,
    /// Marks on its outer edge, sorted by s.
    pub marks: Vec<RoadMark>,
}

/// Course of the outer edge of a lane, as the file gives it.
#[derive(Clone, Debug, PartialEq)]
pub enum LaneEdge {
    /// Width of the lane.
    Width(CubicProfile),
    /// t of the outer edge, before the lane offset.
    Border(CubicProfile),
}

/// `<height>` of a lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaneHeight {
    /// Place along the road, metres.
    pub s_m: f64,
    /// At the inner edge, metres above the road surface.
    pub inner_m: f64,
    /// At the outer edge.
    pub outer_m: f64,
}

/// Use of a lane, as far as it matters to a town.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoadLaneKind {
    /// Any carriageway: driving, parking, bus, bicycle, ramp and so on.
    Carriageway,
    /// Pavement for pedestrians.
    Sidewalk,
    /// Hard or soft shoulder.
    Shoulder,
    /// Kerb stone or border strip.
    Kerb,
    /// Median.
    Median,
    /// Tram or rail.
    Rail,
    /// `none` and unknown kinds: green beside the road.
    None,
}

/// `<roadMark>`: a painted line on the outer edge of a lane.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadMark {
    /// Start, metres along the road.
    pub s_m: f64,
    /// Paint of the line; `None` for kinds without paint.
    pub paint: Option<Paint>,
    /// Whether the line is a kerb.
    pub is_kerb: bool,
}

/// Paint on a lane edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paint {
    /// Width of one line, metres.
    pub width_m: f64,
    /// Dashes of this length, or one solid line.
    pub dash: Option<Dash>,
    /// Two lines side by side.
    pub double: bool,
}

/// A dashed line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dash {
    /// Painted length, metres.
    pub length_m: f64,
    /// Gap, metres.
    pub space_m: f64,
}

/// `<object>`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RoadObject {
    /// `id` in the file.
    pub id: String,
    /// `type`, lower case.
    pub type_name: String,
    /// `name` and `subtype`, lower case.
    pub name: String,
    /// Place of the object's origin.
    pub at: RoadPosition,
    /// Turn against the road, radians.
    pub heading_rad: f64,
    /// Size along, across and upwards, and radius, metres; 0 when not given.
    pub size: ObjectSize,
    /// Copies along the road.
    pub repeats: Vec<Repeat>,
    /// Outlines of its parts.
    pub outlines: Vec<Outline>,
    /// Our own extension: `<userData code=... value=...>` of a tree's crown.
    pub crown: Crown,
    /// Our own extension: the roof of a building.
    pub roof: Roof,
    /// Our own extension: surface of a patch of ground, and whether people walk on it.
    pub surface: Option<String>,
    /// See `surface`.
    pub is_walkable: bool,
    /// Bytes of the start tag in the text.
    pub byte_span: Range<usize>,
}

/// A point relative to a road.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RoadPosition {
    /// Along the road, metres.
    pub s_m: f64,
    /// To the left of the reference line, metres.
    pub t_m: f64,
    /// Above the road surface, metres.
    pub z_offset_m: f64,
}

/// Sizes of an object, metres, 0 when not given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ObjectSize {
    /// Along its own u axis.
    pub length_m: f64,
    /// Along its own v axis.
    pub width_m: f64,
    /// Upwards.
    pub height_m: f64,
    /// Radius of a round object, metres.
    pub radius_m: f64,
}

/// Crown of a tree, where the file has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Crown {
    /// Radius, metres.
    pub radius_m: Option<f64>,
    /// Height of its lower end above the trunk's foot, metres.
    pub base_m: Option<f64>,
}

/// `<repeat>`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repeat {
    /// Start and end: along the road.
    pub s_m: [f64; 2],
    /// Between copies, metres; 0 for one continuous thing.
    pub distance_m: f64,
    /// t at both ends.
    pub t_m: [f64; 2],
    /// Height above the road at both ends.
    pub z_offset_m: [f64; 2],
    /// Width at both ends.
    pub width_m: [f64; 2],
    /// Height at both ends.
    pub height_m: [f64; 2],
}

/// `<outline>`.
#[derive(Clone, Debug, PartialEq)]
pub struct Outline {
    /// An area, not a line.
    pub closed: bool,
    /// A courtyard in the other outlines.
    pub is_hole: bool,
    /// Corners in order.
    pub corners: Vec<Corner>,
}

/// A corner of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Corner {
    /// Relative to the road.
    Road {
        /// Foot of the corner.
        at: RoadPosition,
        /// Height of the object there, metres.
        height_m: f64,
    },
    /// Relative to the object.
    Local {
        /// Along the object, metres.
        u_m: f64,
        /// Across it, metres.
        v_m: f64,
        /// Above its origin, metres.
        z_m: f64,
        /// Height of the object there, metres.
        height_m: f64,
    },
}

/// `<signal>`.
#[derive(Clone, Debug, PartialEq)]
pub struct RoadSignal {
    /// `id` in the file.
    pub id: String,
    /// Place of the plate.
    pub at: RoadPosition,
    /// Turn of the plate, radians against the road (orientation included).
    pub heading_rad: f64,
    /// Size of the plate, metres; 0 when not given.
    pub width_m: f64,
    /// Height of the plate, metres; 0 when not given.
    pub height_m: f64,
    /// A light, not a plate.
    pub is_light: bool,
}

//! Carriageway on which nobody walks: where cars may be parked beside lanes.

use crate::network::{Drive, Network};
use cosfly_domain::{OrientedBox, SemanticLabel, Town, WalkableKind, WalkablePolygon};
use cosfly_frames::{DVec2, DVec3, real};
use cosfly_town::GroundIndex;
use cosfly_town::polygons::PolygonIndex;

/// Distance from the kerb, metres.
pub(crate) const FROM_KERB_M: f64 = 0.2;
/// Distance between a parked car and the middle of a lane that stays open, metres: at least this, and all of the lane.
const ROOM_M: [f64; 2] = [1.55, 0.05];
/// Width of a car for which a lane must have room, metres.
const CAR_M: f64 = 1.9;
/// The kerb is looked for so far beyond a lane's edge, in steps of so much, metres.
const KERB_M: [f64; 2] = [6.0, 0.1];
/// A street's pavement begins this far beyond a lane's edge at most, metres.
const PAVEMENT_M: f64 = 9.0;
/// Limit of calm streets, m/s: 50 km/h.
const CALM_MPS: f64 = 14.0;
/// Ground that is higher or lower belongs to another street, metres.
const LEVEL_M: f64 = 1.0;
/// Distance between the places of a footprint that are looked up, metres.
const SPACING_M: f64 = 0.6;

/// Carriageway of a town, and where people walk.
pub(crate) struct Paved {
    carriageway: GroundIndex,
    walked: PolygonIndex,
    /// Pavements that nobody invented.
    pavements: PolygonIndex,
}

/// Distance between a parked car and the middle of a lane that stays open, metres.
pub(crate) fn room_m(lane: &Drive) -> f64 {
    let [least_m, beyond_m] = ROOM_M;
    least_m.max(0.5 * lane.width_m + beyond_m)
}

impl Paved {
    pub fn new(town: &Town) -> Self {
        let carriageway = GroundIndex::of_surfaces(&town.surfaces, |mesh| mesh.label == SemanticLabel::Roads);
        let of = |keep: &dyn Fn(&WalkablePolygon) -> bool| {
            PolygonIndex::new(town.walkable.iter().filter(|area| keep(area)).map(WalkablePolygon::plan).collect())
        };
        let pavements = of(&|area| area.kind == WalkableKind::Sidewalk && !area.synthetic);
        Self { carriageway, walked: of(&|_| true), pavements }
    }

    /// Height of carriageway on which nobody walks, near a point.
    fn height_m(&self, point: DVec3) -> Option<f64> {
        let ground = self.carriageway.ground_near(point)?;
        let is_here = (ground.height_m - point.z).abs() < LEVEL_M && self.walked.at(point.truncate()).next().is_none();
        is_here.then_some(ground.height_m)
    }

    /// How far the carriageway reaches from the middle of a lane towards the kerb, metres; at most some metres beyond the
    /// lane's edge.
    pub fn reach_m(&self, network: &Network, lane: &Drive, way_m: f64) -> f64 {
        let (middle, along) = lane.at(way_m);
        let to_kerb = network.kerb * along.perp();
        let [most_m, step_m] = KERB_M;
        let edge_m = 0.5 * lane.width_m;
        let away_m = (1..=(most_m / step_m) as u32).map(|step| edge_m + f64::from(step) * step_m);
        let paved = away_m.take_while(|away_m| self.height_m(middle + (*away_m * to_kerb).extend(0.0)).is_some());
        paved.last().unwrap_or(edge_m)
    }

    /// Whether a lane is of a street of a town: a pavement is beside it, or nobody drives fast there.
    pub fn is_street(&self, network: &Network, lane: &Drive, way_m: f64) -> bool {
        let (middle, along) = lane.at(way_m);
        let to_kerb = network.kerb * along.perp();
        let away_m = |step: u32| 0.5 * lane.width_m + f64::from(step) * SPACING_M;
        let is_pavement = |step: u32| self.pavements.at(middle.truncate() + away_m(step) * to_kerb).next().is_some();
        lane.limit_mps <= CALM_MPS || (0..=(PAVEMENT_M / SPACING_M) as u32).any(is_pavement)
    }

    /// Whether a car stands beside a lane without narrowing it.
    pub fn has_room_beside(&self, network: &Network, lane: &Drive, way_m: f64) -> bool {
        self.reach_m(network, lane, way_m) >= room_m(lane) + CAR_M + FROM_KERB_M
    }

    /// Height of the ground under the middle of a box that stands on carriageway with all of its footprint.
    pub fn under(&self, shape: &OrientedBox) -> Option<f64> {
        let (sin, cos) = real::sin_cos(shape.yaw_rad);
        let (along, across) = (DVec2::new(cos, sin), DVec2::new(-sin, cos));
        let half = shape.half_extents_m;
        let counts = [half.x, half.y].map(|half_m| (half_m / SPACING_M).ceil() as i32);
        let foot = shape.center_in_world - DVec3::Z * half.z;
        let place = |x: i32, y: i32| {
            let [x, y] = [(x, half.x, counts[0]), (y, half.y, counts[1])]
                .map(|(step, half_m, count)| half_m * f64::from(step) / f64::from(count));
            foot + (along * x + across * y).extend(0.0)
        };
        let mut places = (-counts[0]..=counts[0]).flat_map(|x| (-counts[1]..=counts[1]).map(move |y| (x, y)));
        let stands = places.all(|(x, y)| self.height_m(place(x, y)).is_some());
        if stands { self.height_m(foot) } else { None }
    }
}

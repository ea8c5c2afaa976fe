//! `forest_edge`: a country road, a wood with trails on one side of it, fields and a few houses on the other.

use super::around::{Around, fields};
use super::car_park::CarPark;
use super::houses::{Houses, playground};
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::pavements::Furniture;
use crate::geometry::{disc, segment_distance_m};
use crate::lot::Lot;
use crate::net::plan::{Profile, StreetPlan};
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "forest_edge",
    doc: "A country road, a wood with trails and clearings, fields, a few houses",
    keys: &[
        Key { name: "length_m", doc: "Length of the road, metres", range: [260.0, 700.0], default: 400.0 },
        Key {
            name: "depth_m",
            doc: "How far the wood reaches from the road, metres",
            range: [100.0, 300.0],
            default: 190.0,
        },
        Key { name: "spacing_m", doc: "Distance of the trees, metres", range: [6.0, 20.0], default: 8.0 },
    ],
    build,
};

const ROAD: Profile = Profile { lanes: 1, lane_m: 3.0, sidewalk_m: 1.8, corner_m: 3.0 };
/// Width of the trails, metres.
const TRAIL_M: f64 = 2.4;
/// Trees stay so far from the middle of trails, metres.
const CLEAR_M: f64 = 4.2;
const CLEARING_M: f64 = 15.0;

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("road");
    let (sin, cos) = real::sin_cos(stream.uniform(-1.5, 1.5));
    let along = DVec2::new(cos, sin);
    let road_m = settings.get("length_m");
    let mut site = Site::of(&road(road_m, along, &mut stream));
    let wood = Wood { along, length_m: road_m, depth_m: settings.get("depth_m") };
    let mut stream = seed.stream("trails");
    let trails = wood.trails(&site, &mut stream);
    for trail in &trails {
        site.path(trail, TRAIL_M, Surface::Gravel);
    }
    let clearing = wood.clearing(&mut site, &trails, &mut stream);
    houses(&mut site, along, &mut seed.stream("houses"));
    wood.plant(&mut site, (&trails, clearing), settings.get("spacing_m"), &mut seed.stream("trees"));
    fields(&mut site, 3, &mut seed.stream("fields"));
    Furniture { tree_share: 0.0, crown_m: 2.0, lamp_m: 5.0 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 5, trees: 300, rows: 0, eaves_m: [0.0; 2] }.put(&mut site, seed);
    site
}

/// A winding road, from which a lane leads to the houses.
fn road(length_m: f64, along: DVec2, stream: &mut RandomStream) -> StreetPlan {
    let mut plan = StreetPlan::default();
    let aside = along.perp();
    for at in 0..3 {
        plan.node((0.5 * f64::from(at) - 0.5) * length_m * along + stream.uniform(-12.0, 12.0) * aside);
    }
    for at in 0..2 {
        let [from, to] = [plan.nodes[at], plan.nodes[at + 1]];
        let bends = [0.33, 0.67].map(|share| from.lerp(to, share) + stream.uniform(-9.0, 9.0) * aside);
        plan.bent(at, bends.to_vec(), at + 1, ROAD);
    }
    let end = plan.node(plan.nodes[1] - stream.uniform(80.0, 100.0) * aside);
    plan.link(1, end, ROAD);
    plan
}

/// The wood to the left of the road.
struct Wood {
    along: DVec2,
    length_m: f64,
    depth_m: f64,
}

impl Wood {
    /// A point: so far along the road from its middle, and so far into the wood.
    fn at(&self, along_m: f64, deep_m: f64) -> DVec2 {
        along_m * self.along + deep_m * self.along.perp()
    }

    /// A loop from the road through the wood and back, a way across it from a second entrance, and a way along its far side.
    fn trails(&self, site: &Site, stream: &mut RandomStream) -> Vec<Vec<DVec2>> {
        let entrance = |street: usize, share: f64| {
            let (line, profile) = (&site.network.streets[street].line, site.network.streets[street].profile);
            line.pose_at(share * line.length_m()).moved(0.0, profile.half_width_m() - 0.5).at
        };
        let mut winding = |from: DVec2, to: DVec2, steps: usize| -> Vec<DVec2> {
            let side = (to - from).normalize().perp();
            let bend = |step: usize| {
                let aside_m = if step == 0 || step == steps { 0.0 } else { stream.uniform(-9.0, 9.0) };
                from.lerp(to, step as f64 / steps as f64) + aside_m * side
            };
            (0..=steps).map(bend).collect()
        };
        let [west, east] = [-0.36, 0.36].map(|share| self.at(share * self.length_m, 0.72 * self.depth_m));
        let cross = self.at(0.0, 0.4 * self.depth_m);
        vec![
            winding(entrance(0, 0.22), west, 5),
            winding(west, east, 8),
            winding(east, entrance(1, 0.78), 5),
            winding(entrance(0, 0.7), cross, 3),
            winding(cross, east, 5),
            winding(cross, west, 5),
        ]
    }

    /// A clearing with benches and a place to play, where two trails meet.
    fn clearing(&self, site: &mut Site, trails: &[Vec<DVec2>], stream: &mut RandomStream) -> DVec2 {
        let at = trails[3][trails[3].len() - 1];
        for bench in 0..5 {
            let (sin, cos) = real::sin_cos(f64::from(bench) * 1.25 + stream.uniform(0.0, 0.4));
            let lot = Lot {
                center: at + 7.0 * DVec2::new(cos, sin),
                half_m: DVec2::new(0.3, 0.9),
                heading_rad: real::atan2(sin, cos),
            };
            site.stand(ThingKind::Bench, lot, 0.8, 0.3);
        }
        site.walk_on(&disc(at, 5.0, 12), Surface::Gravel);
        at
    }

    /// Trees all over the wood, but for trails and the clearing.
    fn plant(
        &self,
        site: &mut Site,
        (trails, clearing): (&[Vec<DVec2>], DVec2),
        spacing_m: f64,
        stream: &mut RandomStream,
    ) {
        let [columns, rows] = [self.length_m + 60.0, self.depth_m].map(|size_m| (size_m / spacing_m) as usize);
        for row in 0..rows {
            for column in 0..columns {
                let mut place = |number: usize| (number as f64 + stream.uniform(-0.36, 0.36)) * spacing_m;
                let at = self.at(place(column) - 0.5 * (self.length_m + 60.0), 12.0 + place(row));
                let from_trails_m = trails
                    .iter()
                    .flat_map(|trail| trail.windows(2))
                    .map(|pair| segment_distance_m([pair[0], pair[1]], [at, at]))
                    .fold(f64::INFINITY, f64::min);
                let crown_m = stream.uniform(1.8, 3.4);
                let depth_m = self.depth_m * (0.87 + 0.13 * real::sin(at.dot(self.along) / 37.0));
                if at.dot(self.along.perp()) < depth_m && from_trails_m > CLEAR_M && at.distance(clearing) > CLEARING_M
                {
                    site.plant(at, crown_m, stream);
                }
            }
        }
    }
}

/// Houses along the lane and the near side of the road, and a car park for walkers.
fn houses(site: &mut Site, along: DVec2, stream: &mut RandomStream) {
    let homes = Houses {
        in_a_row: [1, 1],
        width_m: [9.0, 13.0],
        depth_m: [8.0, 10.0],
        setback_m: [4.0, 9.0],
        gap_m: [8.0, 30.0],
        eaves_m: [3.2, 5.5],
        garden_m: 16.0,
        density: 0.6,
        hedges: 0.5,
        cars: 0.6,
        drive_onto_m: 0.0,
        trees: 0.9,
    };
    let street = &site.network.streets[1];
    let pose = street.line.pose_at(0.45 * street.line.length_m());
    let front = pose.moved(0.0, -street.profile.half_width_m() - 1.0).at;
    let lot =
        CarPark { front, along: -pose.ahead(), size_m: DVec2::new(36.0, 17.0), filled: 0.5, way_m: Some([1.6, 0.0]) };
    lot.put(site, stream);
    playground(site, front - 34.0 * pose.left() + 8.0 * pose.ahead(), along);
    for face in site.faces.clone() {
        for front in face.fronts.iter().filter(|front| {
            let [from, to] = front.ends();
            front.street == 2
                || (to - from).perp_dot(along).abs() < 0.5 * from.distance(to) && (to - from).dot(along) < 0.0
        }) {
            homes.along(site, front, stream);
        }
    }
}

//! `suburb`: a ring that winds, crescents and culs-de-sac that grew without a plan, superblocks with a school and a green inside.

use super::around::Around;
use super::houses::{Houses, playground, scatter};
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::pavements::Furniture;
use super::sports::sports_field;
use super::winding::{Beside, Winding};
use crate::geometry::{contains, disc, rectangle};
use crate::lot::Lot;
use crate::net::faces::Front;
use crate::net::network::circle_m;
use crate::net::plan::{Profile, StreetPlan};
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, RandomStream, Seed, real};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "suburb",
    doc: "Crescents and culs-de-sac around large blocks with a school and a green inside",
    keys: &[
        Key { name: "size_m", doc: "Width of the place, metres", range: [360.0, 1000.0], default: 620.0 },
        Key {
            name: "order",
            doc: "How far streets keep to two directions, 0 not at all",
            range: [0.0, 1.0],
            default: 0.6,
        },
        Key { name: "density", doc: "Share of the plots with a house", range: [0.0, 1.0], default: 0.96 },
        Key { name: "tree_share", doc: "Trees in the gardens, 1 is many", range: [0.0, 1.0], default: 0.6 },
    ],
    build,
};

const COLLECTOR: Profile = Profile { lanes: 1, lane_m: 3.25, sidewalk_m: 2.8, corner_m: 5.0 };
const STREET: Profile = Profile { lanes: 1, lane_m: 2.9, sidewalk_m: 2.0, corner_m: 4.0 };
/// Streets that are tried for each of the two sorts.
const TRIES: usize = 700;
/// Radius of a green, and from its edge to the middles of streets: gardens and houses lie between, metres.
const GREEN_M: f64 = 44.0;
const GARDENS_M: f64 = 28.0;
/// Radius of the ring as a share of the size, and one crescent for so much of it, metres.
const RING: f64 = 0.3;
const CRESCENT_M: f64 = 35.0;
/// Streets leave others at no more than so much from a right angle, radians.
const LEAN_RAD: f64 = 0.35;
/// Paths end so far on the pavement, metres.
const ONTO_PAVEMENT_M: f64 = 0.5;

/// An open piece of a superblock.
struct Green {
    center: DVec2,
    radius_m: f64,
}

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let (plan, greens) = streets(settings, seed);
    let mut site = Site::of(&plan);
    let blocks = site.blocks();
    for (number, green) in greens.iter().enumerate() {
        let mut stream = seed.child("green", number as u64).stream("ground");
        let edges = blocks.iter().find(|block| contains(&block.outline, green.center)).map(|block| &block.outline);
        if let Some(outline) = edges {
            lay_green(&mut site, green, outline, number == 0, &mut stream);
        }
    }
    let houses = Houses {
        in_a_row: [1, 1],
        width_m: [9.0, 13.5],
        depth_m: [8.5, 11.0],
        setback_m: [5.0, 7.5],
        gap_m: [3.6, 7.0],
        eaves_m: [3.0, 5.8],
        garden_m: 11.0,
        density: settings.get("density"),
        hedges: 0.4,
        cars: 0.8,
        drive_onto_m: 1.0,
        trees: settings.get("tree_share"),
    };
    around_turning_circles(&mut site, &houses, &mut seed.stream("circles"));
    for (number, face) in site.faces.clone().iter().enumerate() {
        let mut stream = seed.child("face", number as u64).stream("gardens");
        for front in &face.fronts {
            houses.along(&mut site, front, &mut stream);
        }
        if face.is_enclosed {
            scatter(&mut site, &face.outline, (150.0 * settings.get("tree_share")) as usize, [1.6, 4.0], &mut stream);
        }
    }
    Furniture { tree_share: 0.7, crown_m: 2.4, lamp_m: 5.0 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 4, trees: 1100, rows: 0, eaves_m: [3.0, 5.8] }.put(&mut site, seed);
    site
}

/// How a suburb is laid out.
struct Layout {
    /// Radius of the ring before it is stretched, metres.
    radius_m: f64,
    /// The longer direction.
    along: DVec2,
    /// Length over width.
    stretch: f64,
    /// How far streets keep to two directions, 0 to 1.
    order: f64,
}

/// The net of streets, and the greens that they leave.
fn streets(settings: &PlaceSettings, seed: Seed) -> (StreetPlan, Vec<Green>) {
    let mut stream = seed.stream("streets");
    let (sin, cos) = real::sin_cos(stream.uniform(0.0, real::PI));
    let layout = Layout {
        radius_m: RING * settings.get("size_m"),
        along: DVec2::new(cos, sin),
        stretch: stream.uniform(1.1, 1.7),
        order: settings.get("order"),
    };
    let mut net = Winding::ring(&layout.ring(&mut stream), COLLECTOR);
    layout.across(&mut net, &mut stream);
    let greens = layout.greens(&net, &mut stream);
    greens.iter().for_each(|green| net.keep_off(green.center, green.radius_m + GARDENS_M));
    layout.ways_out(&mut net, &mut stream);
    layout.crescents(&mut net, &mut stream);
    layout.culs_de_sac(&mut net, &mut stream);
    (net.into_plan(), greens)
}

impl Layout {
    /// The place in the stretched town of one in a round town.
    fn stretched(&self, at: DVec2) -> DVec2 {
        let root = self.stretch.sqrt();
        self.along.rotate(DVec2::new(at.x * root, at.y / root))
    }

    /// Whether the town reaches to a place.
    fn holds(&self, at: DVec2) -> bool {
        let root = self.stretch.sqrt();
        let round = DVec2::new(at.dot(self.along) / root, at.dot(self.along.perp()) * root);
        round.length() < 0.5 / RING * self.radius_m
    }

    /// A number around 0 that is the smaller, the more order there is.
    fn loose(&self, most: f64, stream: &mut RandomStream) -> f64 {
        (1.0 - self.order) * stream.uniform(-most, most)
    }

    /// Turn from a direction towards the nearest of the main ones, radians.
    fn lean_rad(&self, out: DVec2) -> f64 {
        let turn_rad = real::atan2(self.along.perp_dot(out), self.along.dot(out));
        let nearest_rad = (turn_rad / real::FRAC_PI_2).round() * real::FRAC_PI_2;
        (self.order * (nearest_rad - turn_rad)).clamp(-LEAN_RAD, LEAN_RAD)
    }

    /// Points of a ring, counter-clockwise: an oval that winds, or nearly a rectangle with round corners.
    fn ring(&self, stream: &mut RandomStream) -> Vec<DVec2> {
        let [second, third] =
            [0.18, 0.09].map(|share| ((1.0 - self.order) * share * stream.uniform(0.6, 1.1), stream.uniform(0.0, 6.0)));
        let wave = |(share, phase_rad): (f64, f64), angle_rad: f64| share * real::sin(angle_rad + phase_rad);
        let power = 2.0 + 10.0 * self.order * self.order;
        let circle = disc(DVec2::ZERO, self.radius_m, 360);
        let points = circle.iter().enumerate().map(|(at, way)| {
            let angle_rad = 2.0 * real::PI * at as f64 / 360.0;
            let (sin, cos) = real::sin_cos(angle_rad);
            let square = real::powf(real::powf(cos.abs(), power) + real::powf(sin.abs(), power), -1.0 / power);
            self.stretched((square + wave(second, 2.0 * angle_rad) + wave(third, 3.0 * angle_rad)) * *way)
        });
        points.collect()
    }

    /// A collector from one side of the ring to the other.
    fn across(&self, net: &mut Winding, stream: &mut RandomStream) {
        for _ in 0..TRIES {
            let count = net.points(0);
            let from = stream.index(count);
            let to = from + (count as f64 * (0.5 + self.loose(0.1, stream))) as usize;
            let ends = [from, to % count].map(|point| Beside { curve: 0, point, side: 1.0 });
            if net.bow(ends, self.radius_m * stream.uniform(0.6, 1.0), COLLECTOR) {
                return;
            }
        }
    }

    /// The two widest open places within the ring.
    fn greens(&self, net: &Winding, stream: &mut RandomStream) -> Vec<Green> {
        let mut greens: Vec<Green> = Vec::new();
        let side = |stream: &mut RandomStream| self.radius_m * stream.uniform(-1.0, 1.0);
        for _ in 0..2 {
            let room_m = |at: DVec2| {
                greens.iter().map(|green| 0.5 * green.center.distance(at)).fold(net.distance_m(at), f64::min)
            };
            let spots: Vec<DVec2> = (0..300).map(|_| DVec2::new(side(stream), side(stream))).collect();
            let within = spots.into_iter().filter(|at| at.length() < 0.9 * self.radius_m).map(|at| self.stretched(at));
            let Some(center) = within.max_by(|a, b| room_m(*a).total_cmp(&room_m(*b))) else { continue };
            let radius_m = GREEN_M.min(room_m(center) - GARDENS_M);
            if radius_m > 0.5 * GREEN_M {
                greens.push(Green { center, radius_m });
            }
        }
        greens
    }

    /// Two roads that leave the ring.
    fn ways_out(&self, net: &mut Winding, stream: &mut RandomStream) {
        let mut made = 0;
        for _ in 0..TRIES {
            let from = Beside { curve: 0, point: stream.index(net.points(0)), side: -1.0 };
            let lean_rad = self.lean_rad(net.leave(from).1) + self.loose(0.2, stream);
            let way = [stream.uniform(90.0, 130.0), lean_rad, self.loose(0.6, stream)];
            made += usize::from(made < 2 && net.dead_end(from, way, COLLECTOR));
        }
    }

    /// Streets that leave a street and come back to it.
    fn crescents(&self, net: &mut Winding, stream: &mut RandomStream) {
        let wanted = ((1.0 - 0.5 * self.order) * self.radius_m / CRESCENT_M).ceil() as usize;
        let mut made = 0;
        for _ in 0..TRIES {
            let from = beside(net, stream);
            let steps = (0.5 * stream.uniform(110.0, 210.0)) as usize;
            let to = Beside { point: (from.point + steps) % net.points(from.curve), ..from };
            let reach_m = stream.uniform(80.0, 130.0);
            let is_within = [from, to].iter().all(|end| {
                let (at, out) = net.leave(*end);
                self.holds(at + 0.75 * reach_m * out)
            });
            made += usize::from(made < wanted && is_within && net.bow([from, to], reach_m, STREET));
        }
    }

    /// Dead ends wherever there is room.
    fn culs_de_sac(&self, net: &mut Winding, stream: &mut RandomStream) {
        for _ in 0..6 * TRIES {
            let from = beside(net, stream);
            let (at, out) = net.leave(from);
            let lean_rad = self.lean_rad(out) + self.loose(0.3, stream);
            let way = [stream.uniform(55.0, 140.0), lean_rad, self.loose(1.5, stream)];
            if self.holds(at + way[0] * out) {
                net.dead_end(from, way, STREET);
            }
        }
    }
}

/// Any place beside any street.
fn beside(net: &Winding, stream: &mut RandomStream) -> Beside {
    let curve = stream.index(net.count());
    Beside { curve, point: stream.index(net.points(curve)), side: if stream.chance(0.5) { 1.0 } else { -1.0 } }
}

/// Houses around the turning circles, their fronts to the middle.
fn around_turning_circles(site: &mut Site, houses: &Houses, stream: &mut RandomStream) {
    let ends: Vec<_> = site.network.junctions.iter().filter(|arms| arms.len() == 1).map(|arms| arms[0]).collect();
    for arm in ends {
        let (mouth, profile) = (site.network.mouth(arm), site.network.profile(arm));
        let circle_m = circle_m(&profile);
        let center = mouth.at - 2.0 * circle_m * real::sin(real::PI / 3.0) * mouth.ahead();
        let edge_m = circle_m + profile.half_width_m();
        for turn in -2..=2 {
            let (sin, cos) = real::sin_cos(0.82 * f64::from(turn));
            let out = -DVec2::new(cos, sin).rotate(mouth.ahead());
            let half = 8.0 * out.perp();
            let points = vec![center + edge_m * out + half, center + edge_m * out - half];
            houses.along(site, &Front { points, street: arm.street }, stream);
        }
    }
}

/// A path from the pavement, and at its end a school with its ground or a green.
fn lay_green(site: &mut Site, green: &Green, outline: &[DVec2], is_school: bool, stream: &mut RandomStream) {
    let Some(end) = way_in(site, green, outline) else { return };
    let along = (green.center - end).normalize();
    let inner = green.center - 0.5 * green.radius_m * along;
    site.path(&[end, inner], 2.6, Surface::Paving);
    if is_school && green.radius_m > 0.9 * GREEN_M {
        school(site, inner, along, stream);
    } else {
        park(site, green, inner, along, stream);
    }
    scatter(site, &disc(green.center, green.radius_m, 24), 60, [2.0, 4.2], stream);
    site.take(&disc(green.center, green.radius_m, 24));
}

/// The nearest place of a pavement from which a straight path leads in.
fn way_in(site: &Site, green: &Green, outline: &[DVec2]) -> Option<DVec2> {
    let mut ends: Vec<DVec2> = outline.to_vec();
    ends.sort_by(|a, b| a.distance(green.center).total_cmp(&b.distance(green.center)));
    let leads_in = |end: &DVec2| {
        let along = (green.center - *end).normalize();
        let front = *end + 1.0 * along;
        let path = rectangle(
            front.lerp(green.center, 0.5) - 1.6 * along.perp(),
            along,
            DVec2::new(front.distance(green.center), 3.2),
        );
        site.is_free(&path, 0.2, 0.2)
    };
    let end = ends.into_iter().find(leads_in)?;
    Some(end - ONTO_PAVEMENT_M * (green.center - end).normalize())
}

/// A school of two wings around a yard, and a sports field behind it.
fn school(site: &mut Site, inner: DVec2, along: DVec2, stream: &mut RandomStream) {
    let across = along.perp();
    let yard = rectangle(inner - 1.0 * along, -across, DVec2::new(26.0, 17.0));
    site.walk_on(&yard, Surface::Paving);
    let side = if stream.chance(0.5) { 1.0 } else { -1.0 };
    let storeys = 2.0 + stream.index(2) as f64;
    let at = |ahead_m: f64, aside_m: f64| inner + ahead_m * along + side * aside_m * across;
    let mut plan =
        vec![at(-1.0, 14.5), at(-1.0, 27.0), at(30.0, 27.0), at(30.0, -27.0), at(17.5, -27.0), at(17.5, 14.5)];
    if side > 0.0 {
        plan.reverse();
    }
    site.build(&plan, 3.4 * storeys + 0.8, 0.0, 0.5);
    sports_field(site, at(48.0, 0.0), across, DVec2::new(42.0, 22.0), stream.chance(0.5));
    for aside_m in [-9.0, 0.0, 9.0] {
        let lot = Lot {
            center: at(14.0, aside_m),
            half_m: DVec2::new(0.9, 0.25),
            heading_rad: real::atan2(across.y, across.x),
        };
        site.things.push(crate::things::GeneratedThing::on_lot(ThingKind::Bench, lot, 0.8));
    }
}

/// A round place, a pond and a playground.
fn park(site: &mut Site, green: &Green, inner: DVec2, along: DVec2, stream: &mut RandomStream) {
    site.walk_on(&disc(inner, 5.0, 16), Surface::Paving);
    let phase_rad = stream.uniform(0.0, 6.0);
    let pond_m = 0.36 * green.radius_m;
    let middle = green.center + 0.3 * green.radius_m * along;
    let shore = disc(DVec2::ZERO, 1.0, 24);
    let corner = |(at, way): (usize, &DVec2)| {
        middle + pond_m * (1.0 + 0.15 * real::sin(real::PI * at as f64 / 6.0 + phase_rad)) * *way
    };
    let pond: Vec<DVec2> = shore.iter().enumerate().map(corner).collect();
    if site.is_free(&pond, 3.0, 1.5) {
        site.surface(&pond, Surface::Water);
        site.take(&pond);
    }
    let side = if stream.chance(0.5) { 1.0 } else { -1.0 };
    playground(site, inner + side * 0.45 * green.radius_m * along.perp(), along);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::twice_area_m2;
    use crate::net::network::{acute_ends, short_streets};
    use crate::things::{Footprint, GeneratedThing};
    use std::collections::BTreeMap;

    fn settings(order: f64) -> PlaceSettings {
        KIND.settings(&BTreeMap::from([("order".to_owned(), order)])).unwrap()
    }

    #[test]
    fn suburbs_of_all_seeds_have_two_greens_crescents_and_culs_de_sac() {
        for order in [0.0, 0.6, 1.0] {
            for seed in 1..31 {
                let (plan, greens) = streets(&settings(order), Seed([seed; 32]));
                let arms =
                    |node: usize| plan.links.iter().flat_map(|link| link.ends).filter(|end| *end == node).count();
                let dead_ends = (0..plan.nodes.len()).filter(|node| arms(*node) == 1).count();
                let blocks = plan.links.len() + 1 - plan.nodes.len();
                assert!(greens.len() == 2 && dead_ends >= 8 && blocks >= 3, "{seed}: {dead_ends}, {blocks}");
                assert!(acute_ends(&plan).is_empty() && short_streets(&plan).is_empty(), "{order}, {seed}");
            }
        }
    }

    #[test]
    fn a_suburb_has_one_school_and_many_houses() {
        let area_m2 = |thing: &GeneratedThing| match &thing.footprint {
            Footprint::Polygon(corners) => 0.5 * twice_area_m2(corners),
            _ => 0.0,
        };
        for seed in 1..13 {
            let things = build(&settings(0.6), Seed([seed; 32])).things;
            let buildings: Vec<f64> =
                things.iter().filter(|thing| thing.kind == ThingKind::Building).map(area_m2).collect();
            let schools = buildings.iter().filter(|area_m2| **area_m2 > 800.0).count();
            assert!(schools == 1 && buildings.len() > 120, "{seed}: {schools} of {}", buildings.len());
        }
    }
}

//! `shopping`: a shopping centre behind a car park with marked bays, retail halls, a sports ground, houses around.

use super::around::Around;
use super::car_park::CarPark;
use super::houses::{Houses, playground, scatter};
use super::kind::{Key, PlaceKind, PlaceSettings};
use super::mesh::Mesh;
use super::pavements::Furniture;
use super::sports::sports_field;
use crate::geometry::{convex_core, inset, long_axis, middle, reach_m, rectangle};
use crate::net::plan::Profile;
use crate::site::{Site, Surface};
use crate::things::ThingKind;
use cosfly_frames::{DVec2, RandomStream, Seed};

/// The kind.
pub const KIND: PlaceKind = PlaceKind {
    name: "shopping",
    doc: "A shopping centre and retail halls behind car parks with marked bays",
    keys: &[
        Key { name: "size_m", doc: "Width of the place, metres", range: [300.0, 800.0], default: 420.0 },
        Key { name: "filled", doc: "Share of the bays with a car", range: [0.0, 1.0], default: 0.6 },
        Key { name: "height_m", doc: "Height of the shopping centre, metres", range: [6.0, 30.0], default: 13.0 },
    ],
    build,
};

const WIDE: Profile = Profile { lanes: 2, lane_m: 3.25, sidewalk_m: 3.4, corner_m: 6.0 };
const SIDE: Profile = Profile { lanes: 1, lane_m: 3.25, sidewalk_m: 2.8, corner_m: 5.0 };

fn build(settings: &PlaceSettings, seed: Seed) -> Site {
    let mut stream = seed.stream("streets");
    let size_m = settings.get("size_m");
    let [x, y] = [stream.uniform(0.56, 0.62), stream.uniform(0.54, 0.6)];
    let mesh = Mesh {
        columns_m: vec![(x * size_m).round(), ((1.0 - x) * size_m).round()],
        rows_m: vec![(y * size_m).round(), (0.9 * (1.0 - y) * size_m).round()],
        heading_rad: stream.uniform(-0.8, 0.8),
        jitter_m: 0.0,
        bend_m: 0.0,
    };
    let is_wide = |is_row: bool, number: usize| is_row && number == 1;
    let profile = |is_row, number| if is_wide(is_row, number) { WIDE } else { SIDE };
    let mut site = Site::of(&mesh.plan(&mut stream, |place| Some(profile(place.is_row, place.number))));
    let center = site.middle();
    for (number, block) in site.blocks().iter().enumerate() {
        let mut stream = seed.child("block", number as u64).stream("halls");
        let core = convex_core(&block.outline);
        let height_m = if number == 0 { settings.get("height_m") } else { stream.uniform(5.5, 8.5).round() };
        let front = Frontage::of(&core, center);
        if number == 3 {
            sports_ground(&mut site, &core, &front);
        } else {
            front.halls(
                &mut site,
                [if number == 0 { 0.9 } else { 0.75 }, height_m],
                settings.get("filled"),
                &mut stream,
            );
        }
        scatter(&mut site, &inset(&core, 1.0), 60, [1.8, 3.4], &mut stream);
    }
    let mut stream = seed.stream("edge");
    for face in site.faces.clone().iter().filter(|face| !face.is_enclosed) {
        for front in &face.fronts {
            homes().along(&mut site, front, &mut stream);
        }
    }
    Furniture { tree_share: 0.5, crown_m: 2.2, lamp_m: 8.0 }.put(&mut site, &mut seed.stream("pavements"));
    Around { fields: 1, trees: 420, rows: 2, eaves_m: [5.2, 8.0] }.put(&mut site, seed);
    site
}

/// Pairs of houses on the far side of the outermost streets.
fn homes() -> Houses {
    Houses {
        in_a_row: [2, 3],
        width_m: [6.5, 8.0],
        depth_m: [9.0, 10.0],
        setback_m: [4.0, 6.0],
        gap_m: [3.6, 8.0],
        eaves_m: [5.2, 8.2],
        garden_m: 10.0,
        density: 0.9,
        hedges: 0.7,
        cars: 0.7,
        drive_onto_m: 0.0,
        trees: 0.6,
    }
}

/// The side of a block that its halls look to.
struct Frontage {
    /// Middle of that side, metres.
    front: DVec2,
    /// Its direction; the block lies to the left.
    along: DVec2,
    /// The block along the front and across it, metres.
    size_m: DVec2,
}

impl Frontage {
    /// The long side of a block that is nearer to the middle of the place.
    fn of(core: &[DVec2], center: DVec2) -> Self {
        let (axis, size_m) = long_axis(core);
        let at = middle(core);
        let along = if (center - at).dot(axis.perp()) < 0.0 { axis } else { -axis };
        Self { front: at - reach_m(core, at, -along.perp()) * along.perp(), along, size_m }
    }

    /// A hall at the back and a car park before it, with ways on foot to its doors.
    fn halls(&self, site: &mut Site, [share, height_m]: [f64; 2], filled: f64, stream: &mut RandomStream) {
        let (along, across) = (self.along, self.along.perp());
        let lot_m = DVec2::new(share * self.size_m.x - 6.0, 0.52 * self.size_m.y);
        let before_m = 3.0;
        let apron_m = 5.0;
        let door_m = before_m + lot_m.y + apron_m;
        let hall_m = DVec2::new(share * self.size_m.x - 14.0, self.size_m.y - door_m - 6.0);
        if hall_m.y < 12.0 {
            return;
        }
        let hall = self.front + door_m * across;
        site.build(&rectangle(hall, along, hall_m), height_m, 0.0, 0.5);
        // Slabs before the doors, which the way through the car park leads to.
        let apron = rectangle(hall - (apron_m - 0.4) * across, along, DVec2::new(hall_m.x, apron_m - 0.8));
        for side in [-0.3, 0.3] {
            let center = hall + side * hall_m.x * along - 1.6 * across;
            let lot = crate::lot::Lot { center, half_m: DVec2::new(2.6, 1.0), heading_rad: heading_rad(along) };
            site.stand(ThingKind::BusStop, lot, 2.4, 0.1);
        }
        let way_m = Some([before_m + 0.5, 1.5]);
        CarPark { front: self.front + before_m * across, along, size_m: lot_m, filled, way_m }.put(site, stream);
        site.walk_on(&apron, Surface::Paving);
    }
}

fn heading_rad(along: DVec2) -> f64 {
    cosfly_frames::real::atan2(along.y, along.x)
}

/// A football field, a hard court and a playground, with a way on foot past them.
fn sports_ground(site: &mut Site, core: &[DVec2], front: &Frontage) {
    let (along, across) = (front.along, front.along.perp());
    let at = middle(core);
    for direction in [across, -across] {
        site.path(&[at, at + (reach_m(core, at, direction) + 0.5) * direction], 2.8, Surface::Gravel);
    }
    let half_m = 0.25 * front.size_m.x;
    let pitch_m = DVec2::new((1.4 * half_m).min(60.0), (0.6 * front.size_m.y).min(38.0));
    sports_field(site, at - half_m * along, along, pitch_m, false);
    sports_field(site, at + half_m * along - 0.22 * front.size_m.y * across, along, DVec2::new(26.0, 14.0), true);
    playground(site, at + half_m * along + 0.24 * front.size_m.y * across, along);
}

//! [`Surroundings`]: those near one person at one moment, in an order that depends on places alone.

use cosfly_frames::{DVec2, real};
use cosfly_world::{Present, Snapshot};
use std::ops::Range;

/// Distance at which people take notice of others, metres.
const SEE_M: f64 = 8.0;

/// Distance at which they take notice of those behind, metres.
const BEHIND_M: f64 = 2.0;

/// Others beyond this number are not noticed; the nearest are.
const MOST: usize = 24;

/// Somebody near.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Neighbour {
    /// From the person to the middle of the other person, or to the nearest point of a vehicle.
    pub away: DVec2,
    /// Length of `away`, metres.
    pub distance_m: f64,
    /// Distance at which the two bodies touch, metres.
    pub touch_m: f64,
    pub velocity_mps: DVec2,
    pub is_person: bool,
    /// Walks in the same company.
    pub is_mate: bool,
    /// Belongs to another population, which may not keep its half of the gap.
    pub is_foreign: bool,
}

impl Neighbour {
    /// Distance between the bodies, metres.
    pub fn gap_m(&self) -> f64 {
        self.distance_m - self.touch_m
    }

    /// Unit vector towards the other.
    pub fn normal(&self) -> DVec2 {
        if self.distance_m > 0.0 { self.away / self.distance_m } else { DVec2::X }
    }
}

/// Those near one person.
#[derive(Debug, Default)]
pub(crate) struct Surroundings {
    /// The nearest first.
    pub neighbours: Vec<Neighbour>,
}

impl Surroundings {
    /// Looks around from the place of body `number`, which walks `ahead`; `own` are the numbers of its population, `mates` those of its company.
    pub fn look(
        &mut self,
        everybody: &Snapshot,
        number: u32,
        (at, radius_m, ahead): (DVec2, f64, DVec2),
        own: &Range<u32>,
        mates: &Range<u32>,
    ) {
        self.neighbours.clear();
        everybody.near(at, SEE_M, |other| {
            if other.number == number {
                return;
            }
            let is_person = other.kind.is_person();
            let away = if is_person { other.state.feet_in_world.truncate() - at } else { to_vehicle(at, other) };
            if is_person && away.dot(ahead) < 0.0 && away.length_squared() > BEHIND_M * BEHIND_M {
                return;
            }
            self.neighbours.push(Neighbour {
                away,
                distance_m: away.length(),
                touch_m: radius_m + if is_person { other.radius_m } else { 0.0 },
                velocity_mps: other.velocity_mps,
                is_person,
                is_mate: mates.contains(&other.number),
                is_foreign: !own.contains(&other.number),
            });
        });
        let order = |a: &Neighbour, b: &Neighbour| {
            (a.gap_m().total_cmp(&b.gap_m())).then(a.away.x.total_cmp(&b.away.x)).then(a.away.y.total_cmp(&b.away.y))
        };
        self.neighbours.sort_unstable_by(order);
        self.neighbours.truncate(MOST);
    }
}

/// From a place to the nearest point of a vehicle's outline seen from above; zero inside.
fn to_vehicle(at: DVec2, vehicle: &Present) -> DVec2 {
    let (sin, cos) = real::sin_cos(vehicle.state.heading_rad);
    let offset = at - vehicle.state.feet_in_world.truncate();
    let own = DVec2::new(cos * offset.x + sin * offset.y, cos * offset.y - sin * offset.x);
    let half = 0.5 * vehicle.size_m.truncate();
    let nearest = own.clamp(-half, half) - own;
    DVec2::new(cos * nearest.x - sin * nearest.y, sin * nearest.x + cos * nearest.y)
}

//! `orbit`: a cinematic circle round a point, with soft beginning and end.

use cosfly_plugin::{Metadata, Objective, Plan, Random, Site, libm, params, town};

params! {
    /// The circle.
    pub struct Params {
        /// Point that is circled, x y in metres; a free place of the town is drawn when left out (an empty list).
        center: Vec<f64> = vec![];
        /// Radius, metres.
        radius_m: f64 = 25.0, [5.0, 200.0];
        /// Height above the ground, metres.
        height_m: f64 = 18.0, [3.0, 150.0];
        /// Height of the point that is looked at, metres above the ground.
        look_m: f64 = 1.5, [0.2, 100.0];
        /// How far round, degrees; below 0 clockwise.
        turn_deg: f64 = 360.0, [-3600.0, 3600.0];
        /// Speed in the middle, m/s.
        speed_mps: f64 = 4.0, [0.5, 10.0];
    }
}

/// Draws of a place before giving up.
const MAX_DRAWS: usize = 500;
/// Places round the circle that are looked at for room.
const PROBES: usize = 24;
/// How much it matters to be on the circle.
const PULL: f64 = 0.2;

/// See the crate.
pub struct Orbit(Params);

impl Objective for Orbit {
    type Params = Params;

    fn describe() -> Metadata {
        Metadata { name: "orbit", version: "0.1.0", summary: "A cinematic circle round a point." }
    }

    fn new(params: Params) -> Result<Self, String> {
        if !matches!(params.center.len(), 0 | 2) {
            return Err(format!("`center` has {} numbers; it must have 2, or none", params.center.len()));
        }
        if params.turn_deg.abs() < 10.0 {
            return Err(format!("`turn_deg` is {}; it must be at least 10 degrees, either way", params.turn_deg));
        }
        Ok(Self(params))
    }

    fn produce(&self, site: &Site) -> Result<Plan, String> {
        let center = match self.0.center[..] {
            [x, y] => [x, y],
            _ => self.drawn(site)?,
        };
        let ground = height(center);
        let way = self.0.turn_deg.abs().to_radians() * self.0.radius_m;
        let speed = self.0.speed_mps.min(0.8 * site.max_speed);
        // An even beginning and end: in the middle twice as fast as on average.
        let steps = ((2.0 * way / speed / site.dt) as usize).max(8);
        if steps + 1 > site.max_steps {
            return Err(format!(
                "the circle takes {} s; at most {} s are flown",
                2.0 * way / speed,
                site.max_steps as f64 * site.dt
            ));
        }
        let start = Random::new(site.seed).uniform(0.0, core::f64::consts::TAU);
        let mut plan = Plan::default();
        for step in 0..=steps {
            let time = step as f64 / steps as f64;
            let share = time - libm::sin(core::f64::consts::TAU * time) / core::f64::consts::TAU;
            let angle = start + share * self.0.turn_deg.to_radians();
            let place = [
                center[0] + self.0.radius_m * libm::cos(angle),
                center[1] + self.0.radius_m * libm::sin(angle),
                ground + self.0.height_m,
            ];
            let mark = step == 0 || step == steps;
            plan.push([center[0], center[1], ground + self.0.look_m], place, if mark { 1.0 } else { PULL });
        }
        plan.note("circled", format!("{:.0}, {:.0}", center[0], center[1]));
        Ok(plan)
    }
}

impl Orbit {
    /// A place in the open with room for the circle.
    fn drawn(&self, site: &Site) -> Result<[f64; 2], String> {
        let mut random = Random::new(site.seed ^ 0x006f_7262_6974);
        let [low_x, low_y, high_x, high_y] = site.bounds;
        let mut best: Option<(usize, [f64; 2])> = None;
        for _ in 0..MAX_DRAWS {
            let center = [random.uniform(low_x, high_x), random.uniform(low_y, high_y)];
            let ground = height(center);
            let look = [center[0], center[1], ground + self.0.look_m];
            let ring: Vec<_> = (0..PROBES)
                .map(|k| {
                    let angle = core::f64::consts::TAU * k as f64 / PROBES as f64;
                    [
                        center[0] + self.0.radius_m * libm::cos(angle),
                        center[1] + self.0.radius_m * libm::sin(angle),
                        ground + self.0.height_m,
                    ]
                })
                .collect();
            let keep = site.clearance + 1.0;
            if town::distances(&[look], keep)[0] < site.clearance
                || town::distances(&ring, keep).iter().any(|d| *d < keep)
            {
                continue;
            }
            let seen = town::rays(&ring, &vec![look; PROBES]).iter().filter(|share| share.is_infinite()).count();
            if best.is_none_or(|(most, _)| seen > most) {
                best = Some((seen, center));
            }
            if seen == PROBES {
                break;
            }
        }
        let wanted = "a smaller `radius_m` or another `height_m` helps";
        best.map(|(_, center)| center)
            .ok_or_else(|| format!("no place with room for the circle in {MAX_DRAWS} draws: {wanted}"))
    }
}

fn height(place: [f64; 2]) -> f64 {
    let ground = town::ground(&[place])[0];
    if ground.is_finite() { ground } else { 0.0 }
}

cosfly_plugin::objective!(Orbit);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_circle_begins_and_ends_slowly_and_closes() {
        let site = Site { dt: 0.5, max_steps: 4000, max_speed: 12.0, clearance: 1.5, ..Site::default() };
        let orbit = Orbit::new(Params { center: vec![3.0, 4.0], ..Params::default() }).unwrap();
        let plan = orbit.produce(&site).unwrap();
        let places = plan.places();
        let gap = |a: usize, b: usize| cosfly_plugin::distance(places[a], places[b]);
        let middle = plan.len() / 2;
        assert!(gap(0, plan.len() - 1) < 1e-6);
        assert!(gap(0, 1) < 0.1 * gap(middle, middle + 1));
        assert!(gap(middle, middle + 1) / site.dt < 4.1);
        assert!(places.iter().all(|place| (cosfly_plugin::distance(*place, [3.0, 4.0, 18.0]) - 25.0).abs() < 1e-9));
    }
}

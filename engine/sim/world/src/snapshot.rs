//! [`Snapshot`]: everybody at one moment, with a grid to find neighbours.

use cosfly_domain::{BodyKind, BodyPlan};
use cosfly_frames::{DVec2, DVec3, TargetState, real};

/// Side of a cell of the grid, metres.
const CELL_M: f64 = 5.0;
/// Largest number of cells a side.
const CELLS: i64 = 1_024;

/// A body at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Present {
    /// Number of the body among all bodies.
    pub number: u32,
    /// Kind of the body.
    pub kind: BodyKind,
    /// Length, width and height, metres.
    pub size_m: DVec3,
    /// Radius of a person; of a vehicle, of the circle around its outline, metres.
    pub radius_m: f64,
    /// Place, heading, speed.
    pub state: TargetState,
    /// Velocity seen from above, m/s.
    pub velocity_mps: DVec2,
}

/// Everybody at one moment.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    present: Vec<Present>,
    low: DVec2,
    columns: usize,
    rows: usize,
    cell_m: f64,
    /// First place in `order` of each cell, and the end.
    starts: Vec<u32>,
    /// Places in `present`, cell by cell, within a cell by number.
    order: Vec<u32>,
    /// Largest radius, metres.
    largest_m: f64,
}

impl Snapshot {
    /// A body in a state.
    pub fn present(number: u32, plan: &BodyPlan, state: TargetState) -> Present {
        let (sin, cos) = real::sin_cos(state.heading_rad);
        let velocity_mps = DVec2::new(cos, sin) * state.speed_mps;
        let (kind, size_m, radius_m) = (plan.kind, plan.size_m, plan.radius_m());
        Present { number, kind, size_m, radius_m, state, velocity_mps }
    }

    /// Bodies with rising numbers. Bodies at places that are not finite cannot be found by [`Self::near`].
    pub fn new(present: Vec<Present>) -> Self {
        let mut snapshot = Self::default();
        snapshot.refill(|list| *list = present);
        snapshot
    }

    /// Replaces all bodies; `fill` gets the emptied list and adds bodies with rising numbers.
    pub fn refill(&mut self, fill: impl FnOnce(&mut Vec<Present>)) {
        self.present.clear();
        fill(&mut self.present);
        let plan = |body: &Present| body.state.feet_in_world.truncate();
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        self.largest_m = 0.0;
        for body in self.present.iter().filter(|body| body.state.feet_in_world.is_finite()) {
            (low, high) = (low.min(plan(body)), high.max(plan(body)));
            self.largest_m = self.largest_m.max(body.radius_m);
        }
        if low.x > high.x {
            (low, high) = (DVec2::ZERO, DVec2::ZERO);
        }
        self.low = low;
        self.cell_m = CELL_M.max((high - low).max_element() / (CELLS - 1) as f64);
        [self.columns, self.rows] = [high.x - low.x, high.y - low.y].map(|size| (size / self.cell_m) as usize + 1);
        self.starts.clear();
        self.starts.resize(self.columns * self.rows + 1, 0);
        let cells: Vec<Option<usize>> = self.present.iter().map(|body| self.cell(body)).collect();
        for cell in cells.iter().flatten() {
            self.starts[cell + 1] += 1;
        }
        for cell in 0..self.columns * self.rows {
            self.starts[cell + 1] += self.starts[cell];
        }
        self.order.clear();
        self.order.resize(*self.starts.last().unwrap_or(&0) as usize, 0);
        let mut next = self.starts.clone();
        for (place, cell) in cells.iter().enumerate().filter_map(|(place, cell)| Some((place, (*cell)?))) {
            self.order[next[cell] as usize] = place as u32;
            next[cell] += 1;
        }
    }

    fn cell(&self, body: &Present) -> Option<usize> {
        let at = body.state.feet_in_world;
        let [column, row] = [at.x - self.low.x, at.y - self.low.y].map(|away| (away / self.cell_m) as usize);
        at.is_finite().then(|| row.min(self.rows - 1) * self.columns + column.min(self.columns - 1))
    }

    /// All bodies, by number.
    pub fn all(&self) -> &[Present] {
        &self.present
    }

    /// The body with a number, where it is present.
    pub fn of(&self, number: u32) -> Option<&Present> {
        let place = self.present.binary_search_by_key(&number, |body| body.number).ok()?;
        Some(&self.present[place])
    }

    /// Calls `each` for every body whose circle is within a distance of a place, seen from above; in an order that depends on
    /// places and numbers alone.
    pub fn near(&self, place: DVec2, within_m: f64, mut each: impl FnMut(&Present)) {
        let reach = within_m + self.largest_m;
        let range = |at: f64, low: f64, cells: usize| {
            let first = (((at - reach - low) / self.cell_m).floor().max(0.0) as usize).min(cells);
            let end = (((at + reach - low) / self.cell_m).floor() + 1.0).clamp(0.0, cells as f64) as usize;
            first..end.max(first)
        };
        for row in range(place.y, self.low.y, self.rows) {
            for column in range(place.x, self.low.x, self.columns) {
                let cell = row * self.columns + column;
                for &at in &self.order[self.starts[cell] as usize..self.starts[cell + 1] as usize] {
                    let body = &self.present[at as usize];
                    let away_m = (body.state.feet_in_world.truncate() - place).length() - body.radius_m;
                    if away_m <= within_m {
                        each(body);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_those_of_a_search_over_all() {
        let mut random = cosfly_frames::Seed([7; 32]).stream("places");
        let body = |number: u32, x: f64, y: f64| Present {
            number,
            kind: BodyKind::Pedestrian,
            size_m: DVec3::splat(0.5),
            radius_m: 0.25 * f64::from(number % 5),
            state: TargetState { feet_in_world: DVec3::new(x, y, 0.0), heading_rad: 0.0, speed_mps: 0.0 },
            velocity_mps: DVec2::ZERO,
        };
        let mut bodies: Vec<Present> =
            (0..300).map(|number| body(number, 90.0 * random.unit(), 40.0 * random.unit())).collect();
        bodies[17].state.feet_in_world.x = f64::NAN;
        let snapshot = Snapshot::new(bodies.clone());
        for (place, within_m) in [(DVec2::new(20.0, 10.0), 4.0), (DVec2::new(-30.0, 90.0), 200.0), (DVec2::ZERO, 0.3)] {
            let mut found = vec![];
            snapshot.near(place, within_m, |body| found.push(body.number));
            found.sort_unstable();
            let is_near =
                |body: &&Present| (body.state.feet_in_world.truncate() - place).length() - body.radius_m <= within_m;
            let expected: Vec<u32> = bodies.iter().filter(is_near).map(|body| body.number).collect();
            assert_eq!(found, expected);
        }
        assert_eq!(snapshot.of(40).map(|body| body.number), Some(40));
        assert!(Snapshot::default().of(0).is_none());
        Snapshot::default().near(DVec2::ZERO, 1e9, |_| panic!("nobody is there"));
    }
}

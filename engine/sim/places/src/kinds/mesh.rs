//! A mesh of streets with columns and rows, loosened: the frame of several kinds.

use crate::net::plan::{Profile, StreetPlan};
use cosfly_frames::{DVec2, RandomStream, real};

/// A mesh of streets.
pub struct Mesh {
    /// Distances between the columns, from west to east, metres.
    pub columns_m: Vec<f64>,
    /// Distances between the rows, from south to north, metres.
    pub rows_m: Vec<f64>,
    /// Direction of the rows, radians from east.
    pub heading_rad: f64,
    /// Points move by up to so much in either direction, metres.
    pub jitter_m: f64,
    /// Bends of streets lie up to so much beside the straight line, metres.
    pub bend_m: f64,
}

/// A street of a mesh: along a row or a column, with its number, and its place along that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Whether it runs along a row.
    pub is_row: bool,
    /// Number of the row or column.
    pub number: usize,
    /// Place along it, from 0.
    pub at: usize,
}

impl Mesh {
    /// The plan around the origin; `profile` gives the cross-section of a street, none where there is no street.
    pub fn plan(&self, stream: &mut RandomStream, profile: impl Fn(Place) -> Option<Profile>) -> StreetPlan {
        let (x_m, y_m) = (positions(&self.columns_m), positions(&self.rows_m));
        let (sin, cos) = real::sin_cos(self.heading_rad);
        let mut plan = StreetPlan::default();
        for y in &y_m {
            for x in &x_m {
                let moved = DVec2::new(*x, *y) + self.aside(stream);
                plan.node(DVec2::new(cos, sin).rotate(moved));
            }
        }
        let columns = x_m.len();
        for row in 0..y_m.len() {
            for column in 0..columns {
                let from = row * columns + column;
                let along_row = (column + 1 < columns).then_some((true, row, column, from + 1));
                let along_column = (row + 1 < y_m.len()).then_some((false, column, row, from + columns));
                for (is_row, number, at, to) in along_row.into_iter().chain(along_column) {
                    let bends = self.bends([plan.nodes[from], plan.nodes[to]], stream);
                    if let Some(profile) = profile(Place { is_row, number, at }) {
                        plan.bent(from, bends, to, profile);
                    }
                }
            }
        }
        plan
    }

    fn aside(&self, stream: &mut RandomStream) -> DVec2 {
        let mut one = || stream.uniform(-self.jitter_m, self.jitter_m);
        DVec2::new(one(), one())
    }

    fn bends(&self, [from, to]: [DVec2; 2], stream: &mut RandomStream) -> Vec<DVec2> {
        if self.bend_m <= 0.0 {
            return Vec::new();
        }
        let side = (to - from).normalize().perp();
        let aside_m = stream.uniform(-self.bend_m, self.bend_m);
        vec![from.lerp(to, 0.5) + aside_m * side]
    }
}

/// Distances drawn so that they add up to about a size, each within a range of it.
pub fn distances_m(size_m: f64, wanted_m: f64, spread: f64, stream: &mut RandomStream) -> Vec<f64> {
    let count = (size_m / wanted_m).round().max(1.0);
    (0..count as usize).map(|_| (size_m / count * stream.uniform(1.0 - spread, 1.0 + spread)).round()).collect()
}

fn positions(distances_m: &[f64]) -> Vec<f64> {
    let all = distances_m.iter().scan(0.0, |at, distance_m| {
        *at += distance_m;
        Some(*at)
    });
    let at: Vec<f64> = [0.0].into_iter().chain(all).collect();
    let middle = 0.5 * at[at.len() - 1];
    at.into_iter().map(|at| at - middle).collect()
}

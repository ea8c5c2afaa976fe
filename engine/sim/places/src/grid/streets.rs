//! The street network of a generated town: a loose grid, curved at its four corners and along two streets.

use super::GenerateConfig;
use crate::alignment::{Alignment, Pose2};
use cosfly_frames::{DVec2, Seed, real};

/// Width of every driving lane, metres.
pub const LANE_WIDTH_M: f64 = 3.5;
/// Length of a junction beyond the pavement of the crossing street, metres.
const CORNER_M: f64 = 2.5;

/// Cross-section of a street, the same on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// Driving lanes per direction.
    pub lanes: u32,
    /// Width of the pavement, metres.
    pub sidewalk_m: f64,
}

impl Profile {
    /// From the middle to the kerb, metres.
    pub fn carriageway_m(&self) -> f64 {
        f64::from(self.lanes) * LANE_WIDTH_M
    }

    /// From the middle to the far edge of the pavement, metres.
    pub fn half_width_m(&self) -> f64 {
        self.carriageway_m() + self.sidewalk_m
    }
}

/// End of a road that meets a junction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoadEnd {
    /// The start of its reference line.
    Start,
    /// The end of its reference line.
    End,
}

/// A street between two junctions.
#[derive(Clone, Debug)]
pub struct Street {
    /// Reference line.
    pub line: Alignment,
    /// Cross-section.
    pub profile: Profile,
    /// Indices of the junctions at its start and end.
    pub junctions: [usize; 2],
    /// Side without any crossing street: +1 left, -1 right, for the streets around the town.
    pub outer_side: Option<f64>,
}

/// A street's end at a junction.
#[derive(Clone, Copy, Debug)]
pub struct Arm {
    /// Index of the street.
    pub street: usize,
    /// End of the street.
    pub contact: RoadEnd,
}

/// A junction; its arms leave east, north, west and south.
#[derive(Clone, Debug, Default)]
pub struct Junction {
    /// The arms, in that order.
    pub arms: [Option<Arm>; 4],
}

/// The network, centred on the origin of the map frame.
#[derive(Clone, Debug)]
pub struct Network {
    /// Streets, in the order of their ids.
    pub streets: Vec<Street>,
    /// Junctions, in the order of their ids.
    pub junctions: Vec<Junction>,
    /// Cross-sections of the streets that run north-south and east-west.
    pub profiles: [Vec<Profile>; 2],
    grid: Grid,
}

/// Crossings of the streets, in columns and rows.
#[derive(Clone, Debug)]
struct Grid {
    columns: usize,
    rows: usize,
    x_m: Vec<f64>,
    y_m: Vec<f64>,
    /// This row moves north by so much from this column on.
    shifted_row: (usize, usize, f64),
    /// This column moves east by so much from this row on.
    shifted_column: (usize, usize, f64),
}

impl Grid {
    fn node(&self, column: usize, row: usize) -> DVec2 {
        let (shifted_row, from_column, north_m) = self.shifted_row;
        let (shifted_column, from_row, east_m) = self.shifted_column;
        let north_m = if row == shifted_row && column >= from_column { north_m } else { 0.0 };
        let east_m = if column == shifted_column && row >= from_row { east_m } else { 0.0 };
        DVec2::new(self.x_m[column] + east_m, self.y_m[row] + north_m)
    }
}

impl Network {
    /// Draws the network.
    pub fn draw(config: &GenerateConfig, seed: Seed) -> Self {
        let (columns, rows) = (config.columns as usize, config.rows as usize);
        let mut stream = seed.stream("streets");
        let mut positions = |count: usize| {
            let mut at = vec![0.0];
            for _ in 1..count {
                at.push(at[at.len() - 1] + stream.uniform(config.min_spacing_m, config.max_spacing_m).round());
            }
            let middle = (0.5 * at[count - 1]).round();
            at.iter().map(|x| x - middle).collect::<Vec<f64>>()
        };
        let (x_m, y_m) = (positions(columns), positions(rows));
        let mut shift = |along: usize, across: usize| {
            let street = 1 + stream.index(across - 2);
            let sign = if stream.chance(0.5) { 1.0 } else { -1.0 };
            (street, 1 + stream.index(along - 1), sign * stream.uniform(8.0, 11.0).round())
        };
        let grid =
            Grid { columns, rows, x_m, y_m, shifted_row: shift(columns, rows), shifted_column: shift(rows, columns) };
        let mut profile = |at: usize, count: usize| {
            let is_edge = at == 0 || at == count - 1;
            let lanes = if at == count / 2 { 2 } else { 1 };
            let sidewalk_m = if is_edge { 4.0 } else { 3.6 + 0.2 * stream.index(5) as f64 };
            Profile { lanes, sidewalk_m }
        };
        let profiles =
            [(0..columns).map(|at| profile(at, columns)).collect(), (0..rows).map(|at| profile(at, rows)).collect()];
        let mut network =
            Self { streets: Vec::new(), junctions: vec![Junction::default(); columns * rows], profiles, grid };
        network.lay_rows();
        network.lay_columns();
        network.lay_corners();
        network
    }

    /// Distance from the middle of a junction to the mouth of an arm that leaves along a row (or a column).
    fn mouth_m(&self, crossing: &Profile) -> f64 {
        crossing.half_width_m() + CORNER_M
    }

    fn lay_rows(&mut self) {
        let (columns, rows) = (self.grid.columns, self.grid.rows);
        for row in 0..rows {
            let is_edge = row == 0 || row == rows - 1;
            let (first, last) = if is_edge { (1, columns - 2) } else { (0, columns - 1) };
            for column in first..last {
                let (from, to) = (self.grid.node(column, row), self.grid.node(column + 1, row));
                let start = Pose2 { at: from + DVec2::X * self.mouth_m(&self.profiles[0][column]), heading_rad: 0.0 };
                let end = to - DVec2::X * self.mouth_m(&self.profiles[0][column + 1]);
                let line = connect(start, end, Alignment::sideways_by_spirals);
                let outer_side = is_edge.then_some(if row == 0 { -1.0 } else { 1.0 });
                self.lay(line, self.profiles[1][row], [(column, row, 0), (column + 1, row, 2)], outer_side);
            }
        }
    }

    fn lay_columns(&mut self) {
        let (columns, rows) = (self.grid.columns, self.grid.rows);
        for column in 0..columns {
            let is_edge = column == 0 || column == columns - 1;
            let (first, last) = if is_edge { (1, rows - 2) } else { (0, rows - 1) };
            for row in first..last {
                let (from, to) = (self.grid.node(column, row), self.grid.node(column, row + 1));
                let start =
                    Pose2 { at: from + DVec2::Y * self.mouth_m(&self.profiles[1][row]), heading_rad: real::FRAC_PI_2 };
                let end = to - DVec2::Y * self.mouth_m(&self.profiles[1][row + 1]);
                let line = connect(start, end, Alignment::sideways_by_arcs);
                let outer_side = is_edge.then_some(if column == 0 { 1.0 } else { -1.0 });
                self.lay(line, self.profiles[0][column], [(column, row, 1), (column, row + 1, 3)], outer_side);
            }
        }
    }

    /// The four corners of the town are curves without a junction, run counter-clockwise.
    fn lay_corners(&mut self) {
        let (east, north) = (self.grid.columns - 1, self.grid.rows - 1);
        let corners = [
            ((0, 1, 3), (1, 0, 2)),
            ((east - 1, 0, 0), (east, 1, 3)),
            ((east, north - 1, 1), (east - 1, north, 0)),
            ((1, north, 2), (0, north - 1, 1)),
        ];
        for (from, to) in corners {
            let outward = |(column, row, side): (usize, usize, usize)| {
                let heading_rad = side as f64 * real::FRAC_PI_2;
                let crossing = if side % 2 == 0 { &self.profiles[0][column] } else { &self.profiles[1][row] };
                Pose2 { at: self.grid.node(column, row), heading_rad }.moved(self.mouth_m(crossing), 0.0)
            };
            let (start, goal) = (outward(from), outward(to));
            let reach = goal.at - start.at;
            let (ahead_m, side_m) = (reach.dot(start.ahead()), reach.dot(start.left()));
            let line = Alignment::quarter_turn(start, ahead_m, side_m, true, 46.0, 0.22);
            self.lay(line, self.profiles[1][0], [from, to], Some(-1.0));
        }
    }

    fn lay(&mut self, line: Alignment, profile: Profile, ends: [(usize, usize, usize); 2], outer_side: Option<f64>) {
        let street = self.streets.len();
        let junctions = ends.map(|(column, row, _)| row * self.grid.columns + column);
        for ((_, _, side), (junction, contact)) in
            ends.into_iter().zip(junctions.into_iter().zip([RoadEnd::Start, RoadEnd::End]))
        {
            self.junctions[junction].arms[side] = Some(Arm { street, contact });
        }
        self.streets.push(Street { line, profile, junctions, outer_side });
    }

    /// The land between four streets, without their pavements: (smallest corner, largest corner), for every block.
    pub fn blocks(&self) -> Vec<(DVec2, DVec2)> {
        let mut blocks = Vec::new();
        for row in 0..self.grid.rows - 1 {
            for column in 0..self.grid.columns - 1 {
                let node = |c: usize, r: usize| self.grid.node(column + c, row + r);
                let half = |c: usize, r: usize| {
                    DVec2::new(self.profiles[0][column + c].half_width_m(), self.profiles[1][row + r].half_width_m())
                };
                let low = DVec2::new(node(0, 0).x.max(node(0, 1).x), node(0, 0).y.max(node(1, 0).y)) + half(0, 0);
                let high = DVec2::new(node(1, 0).x.min(node(1, 1).x), node(0, 1).y.min(node(1, 1).y)) - half(1, 1);
                blocks.push((low, high));
            }
        }
        blocks
    }

    /// Outer edge of the pavement around the town: (smallest corner, largest corner).
    pub fn outline(&self) -> (DVec2, DVec2) {
        let (east, north) = (self.grid.columns - 1, self.grid.rows - 1);
        let half = DVec2::new(self.profiles[0][0].half_width_m(), self.profiles[1][0].half_width_m());
        (self.grid.node(0, 0) - half, self.grid.node(east, north) + half)
    }
}

/// A line on from a start to an end that lies ahead and aside; `aside` takes both distances and the size of a bend, metres.
fn connect(start: Pose2, end: DVec2, aside: fn(Pose2, f64, f64, f64) -> Alignment) -> Alignment {
    let (ahead_m, left_m) = ((end - start.at).dot(start.ahead()), (end - start.at).dot(start.left()));
    if left_m.abs() < 1e-9 { Alignment::straight(start, ahead_m) } else { aside(start, ahead_m, left_m, 4.0) }
}

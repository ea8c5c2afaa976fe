//! Seeded streets, alleys and canyons with walkers in them: for tests, examples and benchmarks.
//!
//! The kinds follow the planner's reference figures: `light` and `leafy` are 16 m streets between houses of 8 to 26 m
//! with trees over the pavement (a third of the places or nearly all; in
//! `tunnel` with crowns that nearly touch), `alley` and `canyon` are gaps of 4.5 to 7 m and
//! 4.2 to 5.2 m between houses of 20 to 45 m and 40 to 60 m. `fine` is `leafy` cut into some 65,000 boxes.

mod movers;

pub use movers::movers_around;

use cosfly_domain::OrientedBox;
use cosfly_frames::{DVec2, DVec3, TargetState, TargetTrack, real};
use cosfly_random::{RandomStream, Seed};

/// Kind of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneKind {
    /// Streets with a third of the trees.
    Light,
    /// Streets with dense trees.
    Leafy,
    /// Streets whose crowns nearly touch.
    Tunnel,
    /// Narrow alleys between houses.
    Alley,
    /// Narrower alleys between taller houses.
    Canyon,
    /// Dense trees, every box cut into many.
    Fine,
}

impl SceneKind {
    /// All kinds, in the order of tables.
    pub const ALL: [Self; 6] = [Self::Light, Self::Leafy, Self::Tunnel, Self::Alley, Self::Canyon, Self::Fine];

    /// Name in tables and on command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Leafy => "leafy",
            Self::Tunnel => "tunnel",
            Self::Alley => "alley",
            Self::Canyon => "canyon",
            Self::Fine => "fine",
        }
    }

    fn is_street(self) -> bool {
        !matches!(self, Self::Alley | Self::Canyon)
    }
}

/// Obstacles and the lines between them.
pub struct Scene {
    /// All obstacles; the ground is at z = 0.
    pub boxes: Vec<OrientedBox>,
    kind: SceneKind,
    columns: Vec<Line>,
    rows: Vec<Line>,
}

/// A street seen from the side: its middle and its width, metres.
#[derive(Clone, Copy)]
struct Line {
    middle: f64,
    width: f64,
}

const EXTENT_M: f64 = 500.0;
const FRAMES: usize = 200;
const DT_S: f64 = 0.5;
/// Distance of the walker from the houses in streets, metres.
const WALL_GAP_M: f64 = 1.5;
/// Distance of trees from the houses, metres.
const TREE_GAP_M: f64 = 2.6;

impl Scene {
    /// The scene of a kind and a seed.
    pub fn generate(kind: SceneKind, seed: u64) -> Self {
        let seed = Seed::of_item(seed, "scene", if kind == SceneKind::Fine { "leafy" } else { kind.name() });
        let columns = lines(kind, &mut seed.stream("columns"));
        let rows = lines(kind, &mut seed.stream("rows"));
        let mut boxes = Vec::new();
        let mut stream = seed.stream("houses");
        for x in columns.windows(2) {
            for y in rows.windows(2) {
                let low = DVec2::new(x[0].middle + 0.5 * x[0].width, y[0].middle + 0.5 * y[0].width);
                let high = DVec2::new(x[1].middle - 0.5 * x[1].width, y[1].middle - 0.5 * y[1].width);
                fill_block(kind, low, high, &mut stream, &mut boxes);
            }
        }
        if kind == SceneKind::Fine {
            boxes = boxes.iter().flat_map(|shape| cut_up(shape, 3.2)).collect();
        }
        Self { boxes, kind, columns, rows }
    }

    /// Walker number `index`: 200 frames at 0.5 s, about 131 m on pavements or in alleys.
    pub fn walker(&self, seed: u64, index: u64) -> TargetTrack {
        let mut stream = Seed::of_item(seed, "walkers", self.kind.name()).child("walker", index).stream("route");
        let length_m = 140.0;
        let mut corners = vec![];
        while way(&corners) < length_m {
            corners = self.route(&mut stream, length_m);
        }
        track_along(&rounded(&rounded(&corners)), &mut stream)
    }

    /// Corners of a random walk over the grid that does not turn back.
    fn route(&self, stream: &mut RandomStream, length_m: f64) -> Vec<DVec2> {
        let inner = |count: usize, stream: &mut RandomStream| 1 + stream.index(count.saturating_sub(2).max(1));
        let mut at = [inner(self.columns.len(), stream), inner(self.rows.len(), stream)];
        let side = if self.kind.is_street() { 0.5 * self.columns[0].width - WALL_GAP_M } else { 0.0 };
        let mut corner =
            DVec2::new(if stream.chance(0.5) { side } else { -side }, if stream.chance(0.5) { side } else { -side });
        let place =
            |at: [usize; 2], corner: DVec2| DVec2::new(self.columns[at[0]].middle, self.rows[at[1]].middle) + corner;
        let mut corners = vec![place(at, corner)];
        let mut last: Option<(usize, bool)> = None;
        for _ in 0..40 {
            let (axis, forward) = (stream.index(2), stream.chance(0.5));
            let size = if axis == 0 { self.columns.len() } else { self.rows.len() };
            let outside = if forward { at[axis] + 1 >= size } else { at[axis] == 0 };
            if outside || last == Some((axis, !forward)) {
                continue;
            }
            let sign = if forward { 1.0 } else { -1.0 };
            corner[axis] = sign * side;
            corners.push(place(at, corner));
            at[axis] = if forward { at[axis] + 1 } else { at[axis] - 1 };
            corner[axis] = -sign * side;
            corners.push(place(at, corner));
            last = Some((axis, forward));
            if way(&corners) > length_m {
                break;
            }
        }
        corners.dedup();
        corners
    }
}

fn lines(kind: SceneKind, stream: &mut RandomStream) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut middle = -0.5 * EXTENT_M;
    while middle < 0.5 * EXTENT_M {
        let width = match kind {
            SceneKind::Alley => stream.uniform(4.5, 7.0),
            SceneKind::Canyon => stream.uniform(4.2, 5.2),
            _ => 16.0,
        };
        lines.push(Line { middle, width });
        middle += if kind.is_street() { stream.uniform(60.0, 95.0) } else { stream.uniform(22.0, 36.0) };
    }
    lines
}

fn fill_block(kind: SceneKind, low: DVec2, high: DVec2, stream: &mut RandomStream, boxes: &mut Vec<OrientedBox>) {
    let mut block = |low: DVec2, high: DVec2, bottom: f64, top: f64| {
        boxes.push(OrientedBox::from_corners(low.extend(bottom), high.extend(top)));
    };
    if !kind.is_street() {
        let (floor, roof) = if kind == SceneKind::Alley { (20.0, 45.0) } else { (40.0, 60.0) };
        return block(low, high, 0.0, stream.uniform(floor, roof));
    }
    let share = match kind {
        SceneKind::Light => 0.25,
        SceneKind::Tunnel => 0.95,
        _ => 0.75,
    };
    let crowns = if kind == SceneKind::Tunnel { (2.0, 3.2) } else { (1.5, 2.4) };
    for axis in 0..2 {
        for far in [false, true] {
            let mut along = low[axis] + 2.0;
            while along + 10.0 < high[axis] {
                let length = stream.uniform(12.0, 26.0).min(high[axis] - along - 1.0);
                let depth = stream.uniform(9.0, 14.0);
                let (mut a, mut b) = (low, high);
                (a[axis], b[axis]) = (along, along + length);
                let across = 1 - axis;
                if far {
                    a[across] = high[across] - depth
                } else {
                    b[across] = low[across] + depth
                }
                block(a, b, 0.0, stream.uniform(8.0, 26.0));
                along += length + if stream.chance(0.4) { stream.uniform(2.0, 7.0) } else { 0.0 };
            }
            let mut tree = low[axis] + 4.0;
            while tree < high[axis] {
                let mut foot = DVec2::ZERO;
                foot[axis] = tree;
                foot[1 - axis] = if far { high[1 - axis] + TREE_GAP_M } else { low[1 - axis] - TREE_GAP_M };
                let (crown, bottom) = (stream.uniform(crowns.0, crowns.1), stream.uniform(2.8, 4.0));
                let top = bottom + stream.uniform(3.0, 5.0);
                if stream.chance(share) {
                    block(foot - DVec2::splat(0.2), foot + DVec2::splat(0.2), 0.0, bottom);
                    block(foot - DVec2::splat(crown), foot + DVec2::splat(crown), bottom, top);
                }
                tree += stream.uniform(9.0, 14.0);
            }
        }
    }
}

/// Cells of at most `cell_m` that fill the box.
fn cut_up(shape: &OrientedBox, cell_m: f64) -> Vec<OrientedBox> {
    let (min, max) = shape.bounds_in_world();
    let count = ((max - min) / cell_m).ceil().max(DVec3::ONE);
    let size = (max - min) / count;
    let mut cells = Vec::new();
    for z in 0..count.z as u32 {
        for y in 0..count.y as u32 {
            for x in 0..count.x as u32 {
                let corner = min + size * DVec3::new(f64::from(x), f64::from(y), f64::from(z));
                cells.push(OrientedBox::from_corners(corner, corner + size));
            }
        }
    }
    cells
}

fn way(corners: &[DVec2]) -> f64 {
    corners.windows(2).map(|w| w[1].distance(w[0])).sum()
}

/// Corners cut by a metre (Chaikin's scheme with a bounded cut).
fn rounded(corners: &[DVec2]) -> Vec<DVec2> {
    let mut out = vec![corners[0]];
    for w in corners.windows(3) {
        let cut = |other: DVec2| w[1] + (other - w[1]).clamp_length_max(1.0_f64.min(0.25 * other.distance(w[1])));
        out.push(cut(w[0]));
        out.push(cut(w[2]));
    }
    out.extend(corners.last());
    out
}

fn track_along(corners: &[DVec2], stream: &mut RandomStream) -> TargetTrack {
    let cruise = stream.uniform(1.15, 1.45);
    let mut states = Vec::with_capacity(FRAMES);
    let (mut leg, mut into, mut speed) = (0, 0.0, cruise);
    let mut stopped_until = 0;
    for frame in 0..FRAMES {
        let (from, to) = (corners[leg], corners[leg + 1]);
        let length = to.distance(from).max(1e-9);
        let direction = (to - from) / length;
        let feet = from + direction * f64::min(into, length);
        let heading_rad = real::atan2(direction.y, direction.x);
        states.push(TargetState { feet_in_world: feet.extend(0.0), heading_rad, speed_mps: speed });
        if stream.chance(0.006) {
            stopped_until = frame + 8;
        }
        speed = if frame < stopped_until { 0.0 } else { cruise * stream.uniform(0.9, 1.1) };
        into += speed * DT_S;
        while into > corners[leg + 1].distance(corners[leg]) && leg + 2 < corners.len() {
            into -= corners[leg + 1].distance(corners[leg]);
            leg += 1;
        }
    }
    TargetTrack { dt_s: DT_S, height_m: 1.75, radius_m: 0.3, states }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_one_scene_and_walkers_stay_out_of_houses() {
        for kind in SceneKind::ALL {
            let scene = Scene::generate(kind, 1);
            assert_eq!(scene.boxes, Scene::generate(kind, 1).boxes);
            for index in 0..5 {
                let track = scene.walker(1, index);
                assert_eq!(track.len(), FRAMES);
                for state in &track.states {
                    let head = state.feet_in_world + DVec3::Z;
                    let inside = scene.boxes.iter().any(|shape| {
                        let (min, max) = shape.bounds_in_world();
                        head.cmpgt(min).all() && head.cmplt(max).all()
                    });
                    assert!(!inside, "{} {index} {}", kind.name(), state.feet_in_world);
                }
            }
        }
        assert!(Scene::generate(SceneKind::Fine, 1).boxes.len() > 20_000);
    }
}

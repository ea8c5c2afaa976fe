//! A view's window into the town's shadow map: tiles around what the camera looks at, fine ones near the target.

use super::seen_places::SeenPlaces;
use super::sun_map::Painter;
use super::sun_tiles::{Sun, TEXEL_M, Tile, TilePlace};
use super::sunlight::{
    GRAINS, Grain, LOWEST_M, Places, SUMMARY_SIDE, SummaryMap, TILE, Texels, TownMap, WINDOW_TILES, WINDOWS,
};
use crate::scene::Scene;
use cosfly_domain::Season;
use cosfly_frames::simd::Level;
use cosfly_frames::{DVec2, DVec3};
use cosfly_materials::pattern::fixed_size;
use cosfly_raster::eye::Eye;
use cosfly_raster::seen_region::{SeenRegion, for_seen_points};
use cosfly_raster::shadow_frame::ShadowFrame;
use cosfly_raster::visibility::{Screen, VisibilityBuffer};
use std::sync::Arc;

/// Where the windows of the coarser texels have their middle, along the camera's axis, metres.
const AHEAD_M: [f64; GRAINS] = [30.0, 60.0, 120.0, 240.0];
/// Places this near what the view shows are drawn, too, metres: shading moves points a little, those of crowns the most.
const MARGIN_M: f64 = 4.0;

/// The tiles that a renderer's kernels read, each at its place modulo the window's size. Cameras that look at one town share
/// them: nothing but their summaries is copied.
pub(super) struct Window {
    pub(super) map: Box<TownMap>,
    pub(super) summary: Box<SummaryMap>,
    /// Scene and sun of the tiles.
    of: Option<(u64, Sun)>,
    held: Vec<Option<TilePlace>>,
    wanted: Vec<TilePlace>,
    seen: SeenPlaces,
    /// A tile where nothing stands.
    nothing: Arc<Texels>,
    /// There once a tile has to be drawn.
    painter: Option<Painter>,
}

/// Part of a window: the texels of one size.
#[derive(Clone, Copy)]
struct Part {
    lattice: ShadowFrame,
    /// Tiles.
    first: [i32; 2],
    end: [i32; 2],
}

impl Part {
    /// Corners of a rectangle of tiles over the sheared ground, metres.
    fn metres(&self, first: [i32; 2], end: [i32; 2]) -> [DVec2; 2] {
        let corner = |tile: [i32; 2]| DVec2::new(tile[0].into(), tile[1].into()) * TILE as f64 * self.lattice.texels_m;
        [corner(first), corner(end)]
    }

    /// Its tiles at and around places between two, metres.
    fn tiles_between(&self, grain: usize, low: DVec2, high: DVec2) -> impl Iterator<Item = TilePlace> {
        let tile_m = TILE as f64 * self.lattice.texels_m;
        let margin_m = MARGIN_M + 2.0 * self.lattice.texels_m;
        let from = ((low - margin_m) / tile_m).floor().as_ivec2().to_array();
        let to = ((high + margin_m) / tile_m).floor().as_ivec2().to_array();
        let [columns, rows] = [0, 1].map(|k| from[k].max(self.first[k])..(to[k].saturating_add(1)).min(self.end[k]));
        rows.flat_map(move |row| columns.clone().map(move |column| (grain, row, column)))
    }

    /// Whether kernels read finer texels instead of a tile and all that lies so near that they would read it.
    fn is_covered(&self, tile: [i32; 2], finer: &Self) -> bool {
        let [low, high] = self.metres(tile, tile.map(|at| at + 1));
        let [from, to] = finer.inside();
        let near = 2.0 * self.lattice.texels_m;
        (low - near).cmpge(from).all() && (high + near).cmple(to).all()
    }

    /// The area in which kernels read it, metres: they need the texels around a place.
    fn inside(&self) -> [DVec2; 2] {
        let [low, high] = self.metres(self.first, self.end);
        [low + self.lattice.texels_m, high - 2.0 * self.lattice.texels_m]
    }
}

impl Window {
    pub(super) fn new() -> Self {
        let nothing = Arc::new(Texels([0; TILE * TILE]));
        Self {
            map: Box::new(core::array::from_fn(|_| Arc::clone(&nothing))),
            summary: fixed_size(vec![]),
            of: None,
            held: vec![None; WINDOWS],
            wanted: Vec::new(),
            seen: SeenPlaces::default(),
            nothing,
            painter: None,
        }
    }

    /// Brings the tiles that a picture needs, whose nearest surfaces are `drawn`, and forgets all others: what a place looks
    /// like follows from its own picture. Says where the tiles are.
    pub(super) fn prepare(
        &mut self,
        level: Level,
        (scene, sun): (&Scene, &Sun),
        (eye, screen): (&Eye, &Screen),
        (target, lowest_m): (Option<DVec3>, f64),
        drawn: &VisibilityBuffer,
    ) -> Places {
        let is_same = self.of == Some((scene.identity, *sun));
        self.of = Some((scene.identity, *sun));
        let parts: [Part; GRAINS] = core::array::from_fn(|grain| {
            let lattice = sun.lattice(grain);
            let focus = match target {
                Some(feet) if grain == 0 => feet,
                _ => on_ground(scene, eye, AHEAD_M[grain]),
            };
            part_seen(&lattice, focus, (eye, screen), lowest_m)
        });
        let mut needed = [None; WINDOWS];
        self.seen.visit(level, &parts[0].lattice, (eye, screen), drawn, |low, high| {
            for (grain, part) in parts.iter().enumerate() {
                for place in part.tiles_between(grain, low, high) {
                    needed[slot(place)] = Some(place);
                }
            }
        });
        for needed in &mut needed {
            let is_covered = |&(grain, row, column): &TilePlace| {
                parts[..grain].iter().any(|finer| parts[grain].is_covered([column, row], finer))
            };
            *needed = needed.filter(|place| !is_covered(place));
        }
        self.wanted.clear();
        for (slot, needed) in needed.iter().enumerate() {
            if self.held[slot].is_some() && (!is_same || self.held[slot] != *needed) {
                self.map[slot] = Arc::clone(&self.nothing);
                put_summary(slot, None, &mut self.summary);
                self.held[slot] = None;
            }
            if self.held[slot].is_none() {
                self.wanted.extend(needed);
            }
        }
        if !self.wanted.is_empty() {
            let Self { map, summary, held, wanted, nothing, painter, .. } = self;
            let mut take = |place: TilePlace, tile: Option<&Tile>| {
                held[slot(place)] = Some(place);
                map[slot(place)] = Arc::clone(tile.map_or(&*nothing, |tile| &tile.texels));
                put_summary(slot(place), tile.map(|tile| tile.summary.as_slice()), summary);
            };
            scene.sun_maps.take_kept(sun, wanted, &mut take);
            if !wanted.is_empty() {
                painter.get_or_insert_with(Painter::new).draw(level, (scene, sun), wanted, &mut take);
            }
        }
        places(&parts, scene.season, sun.steps_per_m)
    }
}

/// Place of a tile among those held.
fn slot((grain, row, column): TilePlace) -> usize {
    let [row, column] = [row, column].map(|at| at.rem_euclid(WINDOW_TILES) as usize);
    (grain * WINDOW_TILES as usize + row) * WINDOW_TILES as usize + column
}

/// The ground under a point on the camera's axis.
fn on_ground(scene: &Scene, eye: &Eye, ahead_m: f64) -> DVec3 {
    let ahead = eye.position_in_world + ahead_m * eye.world_from_body.x_axis;
    ahead.with_z(f64::from(scene.grid.sample(ahead.x as f32, ahead.y as f32).ground_m))
}

/// The part of the lattice that a view may need, within the window around a focus: it depends on the frame alone.
fn part_seen(lattice: &ShadowFrame, focus: DVec3, (eye, screen): (&Eye, &Screen), lowest_m: f64) -> Part {
    let side = WINDOW_TILES as usize * TILE;
    let margin = MARGIN_M / lattice.texels_m;
    let middle = (DVec2::from_array(lattice.place(focus)) / TILE as f64).round();
    let corner = middle - f64::from(WINDOW_TILES / 2);
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for_seen_points(eye, screen, lowest_m, |point| {
        let place = DVec2::from_array(lattice.place(point)) - corner * TILE as f64;
        low = low.min(place - margin);
        high = high.max(place + margin);
    });
    let region = SeenRegion::around(low, high, side, TILE);
    let tiles = |texels: [usize; 2]| [0, 1].map(|k| corner[k] as i32 + (texels[k] / TILE) as i32);
    Part { lattice: *lattice, first: tiles(region.first), end: tiles(region.end) }
}

/// Copies the summary of a tile, or nothing, to its slot among all.
fn put_summary(slot: usize, of_tile: Option<&[u32]>, summary: &mut SummaryMap) {
    let stride = WINDOW_TILES as usize * SUMMARY_SIDE;
    let (row, column) = (slot / WINDOW_TILES as usize, slot % WINDOW_TILES as usize);
    for line in 0..SUMMARY_SIDE {
        let at = (row * SUMMARY_SIDE + line) * stride + column * SUMMARY_SIDE;
        let to = &mut summary[at..at + SUMMARY_SIDE];
        match of_tile {
            Some(squares) => to.copy_from_slice(&squares[line * SUMMARY_SIDE..(line + 1) * SUMMARY_SIDE]),
            None => to.fill(0),
        }
    }
}

/// Places of the windows' parts for the kernels: coordinates of the finest texels from near the view, and from them those of
/// each size, counted from a corner that is a whole number of windows from the lattice's.
fn places(parts: &[Part; GRAINS], season: Season, steps_per_m: f32) -> Places {
    let side = f64::from(WINDOW_TILES) * TILE as f64;
    let finest = parts[0].lattice;
    let seen = parts.iter().find(|part| part.first[0] < part.end[0]).unwrap_or(&parts[0]);
    let near = seen.metres(seen.first, seen.end)[0] / finest.texels_m;
    let corner = (near / side).floor() * side;
    let frame = ShadowFrame { corner, ..finest };
    let grains = parts.map(|part| {
        let first = DVec2::new(part.first[0].into(), part.first[1].into()) * TILE as f64;
        let base = (first / side).floor() * side;
        let scale = finest.texels_m / part.lattice.texels_m;
        let [low, high] = part.inside().map(|at| at / part.lattice.texels_m - base);
        let is_empty = part.first[0] >= part.end[0];
        Grain {
            scale: scale.as_vec2().to_array(),
            shift: (corner * scale - base).as_vec2().to_array(),
            low: if is_empty { [f32::INFINITY; 2] } else { low.as_vec2().to_array() },
            high: if is_empty { [f32::NEG_INFINITY; 2] } else { high.as_vec2().to_array() },
        }
    });
    let used = parts.iter().rposition(|part| part.first[0] < part.end[0]).map_or(0, |last| last + 1);
    Places {
        rows: frame.rows(),
        base_m: (LOWEST_M - finest.reference_m) as f32,
        steps_per_m,
        texel_m: TEXEL_M as f32,
        corner_m: (frame.corner * frame.texels_m).as_vec2().to_array(),
        grains,
        hidden_by: 0,
        gaps: cosfly_materials::season::row(season).gaps,
        used,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cosfly_domain::Camera;
    use cosfly_frames::Pose;
    use cosfly_materials::vector::Vec3;

    #[test]
    fn ground_within_forty_metres_of_the_target_has_the_finest_texels() {
        let camera = Camera { width: 640, height: 640, horizontal_fov_rad: 1.9 };
        let down = |x: f64| Pose {
            position_in_world: DVec3::new(x, 0.0, 150.0),
            pitch_rad: -1.5,
            yaw_rad: 0.3,
            roll_rad: 0.0,
        };
        for (number, height) in [0.25f32, 0.6, 0.95].into_iter().enumerate() {
            let lattice = Sun::new(Vec3::new(0.7, -0.4, height).unit(), [0.0; 2]).lattice(0);
            for step in 0..40 {
                let target = DVec3::new(1.7 * f64::from(step), 3.1 * number as f64, 0.0);
                let eye = Eye::new(&down(target.x));
                let part = part_seen(&lattice, target, (&eye, &Screen::new(&camera)), 0.0);
                let [low, high] = part.inside();
                for away in [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y] {
                    let at = lattice.sheared(target + 40.0 * away);
                    assert!(at.cmpge(low).all() && at.cmplt(high).all(), "{step} {height}: {at} in {low} to {high}");
                }
            }
        }
    }
}

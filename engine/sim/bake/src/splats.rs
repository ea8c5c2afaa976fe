//! Towns as Gaussian splats: a flat one on each pixel of a surface that can be seen.

use crate::bake::BakedTown;
use crate::patch::Patch;
use cosfly_domain::SemanticLabel;
use cosfly_frames::{DMat3, DQuat, DVec3};
use cosfly_geometry::{BoxBvh, SpatialQuery, TriangleBvh};
use cosfly_splats::Splat;
use rayon::prelude::*;

/// Spread along a surface, pixels: neighbours leave no gaps.
const SPREAD: f64 = 0.6;
/// Spread across a surface, metres.
const THIN_M: f32 = 0.01;
const OPACITY: f32 = 0.97;
/// Side of the blocks of pixels of open land, pixels.
const WIDE: usize = 4;
/// Depth in a box from which on nothing is seen, metres.
const INSIDE_M: f64 = 0.02;
/// Layers of ground this near to each other lie in one place, metres.
const LAYERS_M: f64 = 0.03;

impl BakedTown {
    /// Splats of what can be seen, in the frame of the town's map: right-handed, z up.
    pub fn splats(&self) -> Vec<Splat> {
        let hidden = Hidden::of(self);
        self.patches.par_iter().flat_map_iter(|patch| self.of_patch(patch, &hidden)).collect()
    }

    fn of_patch(&self, patch: &Patch, hidden: &Hidden<'_>) -> Vec<Splat> {
        let in_map = |way: DVec3| DVec3::new(way.x, -way.y, way.z);
        let [first, second] = patch.axes.map(in_map);
        let turn = DQuat::from_mat3(&DMat3::from_cols(first, second, first.cross(second))).as_quat();
        let mut seen = vec![false; patch.rgb.len()];
        let pixels = patch.covered().into_iter().filter(|pixel| !hidden.has(patch, patch.pixel_in_world(*pixel)));
        pixels.for_each(|pixel| seen[pixel] = true);
        let mut splats = vec![];
        for Block { place, side } in blocks(patch, &seen) {
            let spread = (SPREAD * side as f64 * patch.texel_m) as f32;
            let middle = patch.in_world(place.map(|at| at as f64 + 0.5 * side as f64));
            let middle = in_map(middle + self.origin_m).as_vec3().to_array();
            let srgb = patch.mean_srgb(place, side);
            splats.push(Splat::plain(
                middle,
                [spread, spread, THIN_M],
                [turn.w, turn.x, turn.y, turn.z],
                OPACITY,
                srgb,
            ));
        }
        splats
    }
}

/// Pixels that one splat stands for, by the first of them.
struct Block {
    place: [usize; 2],
    side: usize,
}

/// Blocks of the pixels that are seen: one pixel each; on open land, where all pixels around are seen, [`WIDE`] a side.
fn blocks(patch: &Patch, seen: &[bool]) -> Vec<Block> {
    let [width, height] = patch.size;
    let is_land = [SemanticLabel::Terrain, SemanticLabel::Ground].iter().any(|label| label.id() == patch.label);
    let is_wide = |column: usize, row: usize| {
        let is_inside = column > 0 && row > 0 && column + WIDE < width && row + WIDE < height;
        is_land
            && is_inside
            && (row - 1..=row + WIDE)
                .all(|row| seen[row * width + column - 1..=row * width + column + WIDE].iter().all(|it| *it))
    };
    let mut blocks = vec![];
    for top in (0..height).step_by(WIDE) {
        for left in (0..width).step_by(WIDE) {
            if is_wide(left, top) {
                blocks.push(Block { place: [left, top], side: WIDE });
                continue;
            }
            let rows = top..(top + WIDE).min(height);
            let pixels = rows.flat_map(|row| (left..(left + WIDE).min(width)).map(move |column| [column, row]));
            let own = pixels.filter(|[column, row]| seen[row * width + column]);
            blocks.extend(own.map(|place| Block { place, side: 1 }));
        }
    }
    blocks
}

/// Boxes that hide parts of surfaces from everywhere.
struct Hidden<'a> {
    boxes: &'a BoxBvh,
    ground: TriangleBvh,
    lifts: Vec<f64>,
}

impl<'a> Hidden<'a> {
    fn of(town: &'a BakedTown) -> Self {
        let (mut points, mut triangles, mut lifts) = (vec![], vec![], vec![]);
        for patch in town.patches.iter().filter(|patch| patch.instance == 0) {
            let first = points.len() as u32;
            points.extend(&patch.corners_in_world);
            triangles.extend((2..patch.corners_in_world.len() as u32).map(|k| [first, first + k - 1, first + k]));
            lifts.resize(triangles.len(), patch.lift);
        }
        Self { boxes: &town.boxes, ground: TriangleBvh::build(&points, &triangles), lifts }
    }

    /// Whether a point of a patch lies in a box, or below a higher layer of ground.
    fn has(&self, patch: &Patch, point: DVec3) -> bool {
        if self.boxes.nearest(point, 0.0).is_some_and(|near| near.distance_m < -INSIDE_M) {
            return true;
        }
        let (mut is_below, reach) = (false, DVec3::splat(LAYERS_M));
        if patch.instance == 0 {
            self.ground.within(point - reach, point + reach, &mut |number| {
                let away = || self.ground.triangles()[number as usize].closest_point(point).distance(point);
                is_below |= self.lifts[number as usize] > patch.lift && away() <= LAYERS_M;
            });
        }
        is_below
    }
}

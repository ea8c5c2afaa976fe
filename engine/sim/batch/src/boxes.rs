//! Boxes of a town in groups of eight neighbours, projected together.

use crate::eye::{Eye, Linear, NEAR_M};
use crate::faces::DrawnFace;
use crate::raster::BoxOnScreen;
use crate::zorder::z_order;
use cosfly_frames::DVec3;
use cosfly_frames::simd_kernel;
use cosfly_render::outside::SceneFace;

/// Boxes of a group.
pub const GROUP: usize = 8;
/// Boxes with a longer side than this are grouped apart and drawn first: they hide much, metres.
const LARGE_M: f64 = 6.0;

/// A box in full precision.
#[derive(Clone, Copy)]
pub struct SolidBox {
    center_in_world: DVec3,
    half_m: DVec3,
    /// Unit vector of its own x axis; its y axis is that turned by a right angle, its z axis the world's.
    axis: [f64; 2],
    lift: f64,
    label: u8,
    instance: u32,
}

/// Neighbouring boxes.
pub struct Group {
    pub center_in_world: DVec3,
    pub half_m: DVec3,
    /// Index of the first box; the others follow.
    pub first: u32,
    pub count: u32,
    lanes: Lanes,
}

/// The boxes of a group side by side, from the group's centre.
struct Lanes {
    center_m: [[f32; GROUP]; 3],
    half_m: [[f32; GROUP]; 3],
    axis: [[f32; GROUP]; 2],
}

/// Eight boxes on the screen: pixels from the image's centre, metres ahead.
#[derive(Clone, Copy, Default)]
pub struct Projected {
    pub low: [[f32; GROUP]; 2],
    pub high: [[f32; GROUP]; 2],
    pub nearest_m: [f32; GROUP],
    pub farthest_m: [f32; GROUP],
}

/// All boxes of a town.
pub struct Boxes {
    all: Vec<SolidBox>,
    /// Groups of large boxes first.
    groups: Vec<Group>,
    large: usize,
}

impl Boxes {
    /// Boxes by their faces, six of each.
    pub fn of(faces: &[SceneFace]) -> Self {
        let mut boxes: Vec<SolidBox> = faces.chunks_exact(6).map(SolidBox::of).collect();
        let low = boxes.iter().map(|b| b.center_in_world).fold(DVec3::INFINITY, DVec3::min);
        let is_large = |b: &SolidBox| b.half_m.truncate().max_element() > 0.5 * LARGE_M;
        boxes.sort_by_cached_key(|b| {
            let cell = (b.center_in_world - low) * 0.5;
            (!is_large(b), z_order(cell.x as u32, cell.y as u32))
        });
        let large = boxes.partition_point(is_large);
        let mut groups = Vec::new();
        for range in [0..large, large..boxes.len()] {
            for start in range.clone().step_by(GROUP) {
                let members = &boxes[start..(start + GROUP).min(range.end)];
                groups.push(Group::of(members, start as u32));
            }
        }
        Self { large: large.div_ceil(GROUP), all: boxes, groups }
    }

    pub fn get(&self, index: u32) -> &SolidBox {
        &self.all[index as usize]
    }

    /// Groups of large boxes.
    pub fn large(&self) -> &[Group] {
        &self.groups[..self.large]
    }

    /// Groups of all other boxes.
    pub fn small(&self) -> &[Group] {
        &self.groups[self.large..]
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.all) + size_of_val(&*self.groups)
    }
}

impl SolidBox {
    fn of(faces: &[SceneFace]) -> Self {
        // Faces 0 and 1 look along the box's x axis, 2 and 3 along y, 4 and 5 along z.
        let (low, high) = (&faces[4].corners_in_world, &faces[5].corners_in_world);
        let axis = faces[1].normal_in_world;
        let half = |from: usize, to: usize| 0.5 * (low[to] - low[from]).length();
        Self {
            center_in_world: 0.5 * (low[0] + high[2]),
            half_m: DVec3::new(half(0, 1), half(1, 2), 0.5 * (high[0].z - low[0].z)),
            axis: [axis.x, axis.y],
            lift: faces[0].lift,
            label: faces[0].label,
            instance: faces[0].instance,
        }
    }

    fn half_bounds_m(&self) -> DVec3 {
        let [cos, sin] = self.axis.map(f64::abs);
        let half = self.half_m;
        DVec3::new(cos * half.x + sin * half.y, sin * half.x + cos * half.y, half.z)
    }

    /// The planes of its faces; the faces that are seen are appended to `faces`. `None` when the camera is inside.
    pub fn on_screen(&self, eye: &Eye, faces: &mut Vec<DrawnFace>) -> Option<BoxOnScreen> {
        let [cos, sin] = self.axis;
        let away = self.center_in_world - eye.position_in_world;
        let center = [cos * away.x + sin * away.y, cos * away.y - sin * away.x, away.z];
        let rays = eye.ray_in_world;
        let mut planes = [[0.0f32; 3]; 6];
        let mut numbers = [0u32; 3];
        let (mut entries, mut exits) = (0, 6);
        for axis in 0..3 {
            let along: Linear = match axis {
                0 => rays.map(|ray| cos * ray.x + sin * ray.y),
                1 => rays.map(|ray| cos * ray.y - sin * ray.x),
                _ => rays.map(|ray| ray.z),
            };
            let (low, high) = (center[axis] - self.half_m[axis], center[axis] + self.half_m[axis]);
            // Ways to the planes by which rays come and go.
            let (entry, exit) = if low > 0.0 {
                (Some(low), high)
            } else if high < 0.0 {
                (Some(high), low)
            } else {
                // Between both: rays only leave, by one or the other.
                exits -= 1;
                planes[exits] = self.lifted(&along.map(|part| part / low.min(-1e-12)));
                (None, high.max(1e-12))
            };
            exits -= 1;
            planes[exits] = self.lifted(&along.map(|part| part / exit));
            if let Some(entry) = entry {
                let plane = along.map(|part| part / entry);
                planes[entries] = self.lifted(&plane);
                numbers[entries] = faces.len() as u32;
                faces.push(DrawnFace { plane, instance: self.instance, label: self.label });
                entries += 1;
            }
        }
        (entries > 0).then_some(BoxOnScreen { planes, entries, faces: numbers })
    }

    /// A plane for the comparison.
    fn lifted(&self, plane: &Linear) -> [f32; 3] {
        plane.map(|part| (part * (1.0 + self.lift)) as f32)
    }
}

impl Group {
    fn of(members: &[SolidBox], first: u32) -> Self {
        let low = members.iter().map(|b| b.center_in_world - b.half_bounds_m()).fold(DVec3::INFINITY, DVec3::min);
        let high = members.iter().map(|b| b.center_in_world + b.half_bounds_m()).fold(DVec3::NEG_INFINITY, DVec3::max);
        let center_in_world = 0.5 * (low + high);
        let lane = |value: &dyn Fn(&SolidBox) -> f64| {
            core::array::from_fn(|k| members.get(k).or(members.last()).map_or(0.0, value) as f32)
        };
        let lanes = Lanes {
            center_m: [0, 1, 2].map(|axis| lane(&|b| (b.center_in_world - center_in_world)[axis])),
            half_m: [0, 1, 2].map(|axis| lane(&|b| b.half_m[axis])),
            axis: [0, 1].map(|axis| lane(&|b| b.axis[axis])),
        };
        Self { center_in_world, half_m: 0.5 * (high - low), first, count: members.len() as u32, lanes }
    }

    /// Where its boxes are on the screen; boxes that reach behind the camera may be everywhere.
    pub fn project(&self, level: cosfly_frames::simd::Level, eye: &Eye) -> Projected {
        let mut projected = Projected::default();
        let focal = eye.focal_px as f32;
        let scale = |at: [f32; 3]| [at[0], focal * at[1], -focal * at[2]];
        let center = scale(eye.see(self.center_in_world).as_vec3().to_array());
        let turn = eye.body_from_world.to_cols_array_2d().map(|column| scale(column.map(|part| part as f32)));
        project(level, &self.lanes, center, &turn, &mut projected);
        projected
    }
}

simd_kernel! {
    /// Bounds of the corners of eight boxes on the screen.
    fn project(lanes: &Lanes, origin: [f32; 3], turn: &[[f32; 3]; 3], projected: &mut Projected) {
        let mut center = [[0.0f32; GROUP]; 3];
        let mut reach = [[[0.0f32; GROUP]; 3]; 3];
        for part in 0..3 {
            for k in 0..GROUP {
                let [x, y, z] = [lanes.center_m[0][k], lanes.center_m[1][k], lanes.center_m[2][k]];
                center[part][k] = origin[part] + (x * turn[0][part] + y * turn[1][part] + z * turn[2][part]);
                let [cos, sin] = [lanes.axis[0][k], lanes.axis[1][k]];
                reach[0][part][k] = lanes.half_m[0][k] * (cos * turn[0][part] + sin * turn[1][part]);
                reach[1][part][k] = lanes.half_m[1][k] * (cos * turn[1][part] - sin * turn[0][part]);
                reach[2][part][k] = lanes.half_m[2][k] * turn[2][part];
            }
        }
        let mut low = [[f32::INFINITY; GROUP]; 2];
        let mut high = [[f32::NEG_INFINITY; GROUP]; 2];
        let mut nearest = [f32::INFINITY; GROUP];
        let mut farthest = [f32::NEG_INFINITY; GROUP];
        for corner in 0..8 {
            let sign = [0, 1, 2].map(|axis| if corner >> axis & 1 == 0 { -1.0f32 } else { 1.0 });
            for k in 0..GROUP {
                let at = |part: usize| {
                    let across = sign[0] * reach[0][part][k] + sign[1] * reach[1][part][k];
                    center[part][k] + across + sign[2] * reach[2][part][k]
                };
                let x = at(0);
                let (u, v) = (at(1) / x, at(2) / x);
                nearest[k] = if x < nearest[k] { x } else { nearest[k] };
                farthest[k] = if x > farthest[k] { x } else { farthest[k] };
                low[0][k] = if u < low[0][k] { u } else { low[0][k] };
                low[1][k] = if v < low[1][k] { v } else { low[1][k] };
                high[0][k] = if u > high[0][k] { u } else { high[0][k] };
                high[1][k] = if v > high[1][k] { v } else { high[1][k] };
            }
        }
        for k in 0..GROUP {
            let ahead = nearest[k] >= NEAR_M as f32;
            for axis in 0..2 {
                low[axis][k] = if ahead { low[axis][k] } else { f32::NEG_INFINITY };
                high[axis][k] = if ahead { high[axis][k] } else { f32::INFINITY };
            }
        }
        *projected = Projected { low, high, nearest_m: nearest, farthest_m: farthest };
    }
}

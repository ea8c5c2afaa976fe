//! Boxes of a town in groups of eight neighbours, projected together.

use crate::eye::{Eye, Linear, in_single, scaled};
use crate::faces::DrawnFace;
use crate::lanes::{Bounds, BoxLanes, LANES};
use crate::raster::BoxOnScreen;
use crate::zorder::z_order;
use cosfly_frames::DVec3;
use cosfly_render::outside::SceneFace;

/// Boxes of a group.
const GROUP: usize = LANES;
/// Boxes with a longer side than this are grouped apart and drawn first: they hide much, metres.
const LARGE_M: f64 = 6.0;

/// A box in full precision.
#[derive(Clone, Copy)]
pub struct SolidBox {
    bounds: Bounds,
    lift: f64,
    label: u8,
    instance: u32,
    /// Number of its first face in the scene.
    first_face: u32,
    /// Place of its planes among those of [`Boxes`], for a step of a pitched roof that is cut to its slopes.
    slopes: Option<u32>,
}

/// The six planes of a box whose sides lean inwards: unit normals outwards, and the component of their points along them.
type Slopes = [(DVec3, f64); 6];

/// Neighbouring boxes.
struct Group {
    /// Index of the first box; the others follow.
    first: u32,
    lanes: BoxLanes,
}

/// Boxes of a kind in groups.
pub struct Grouped {
    groups: Vec<Group>,
    /// Boxes around the groups.
    around: BoxLanes,
}

/// All boxes of a town.
pub struct Boxes {
    all: Vec<SolidBox>,
    slopes: Vec<Slopes>,
    large: Grouped,
    small: Grouped,
}

impl Boxes {
    /// Boxes by their faces, six of each.
    pub fn of(faces: &[SceneFace]) -> Self {
        let mut slopes = vec![];
        let mut boxes: Vec<SolidBox> = (0u32..)
            .step_by(6)
            .zip(faces.chunks_exact(6))
            .map(|(first, faces)| SolidBox::of(first, faces, &mut slopes))
            .collect();
        let low = boxes.iter().map(|b| b.bounds.center_in_world).fold(DVec3::INFINITY, DVec3::min);
        let is_large = |b: &SolidBox| b.bounds.half_m.truncate().max_element() > 0.5 * LARGE_M;
        boxes.sort_by_cached_key(|b| {
            let cell = (b.bounds.center_in_world - low) * 0.5;
            (!is_large(b), z_order(cell.x as u32, cell.y as u32))
        });
        let large = boxes.partition_point(is_large);
        let (large, small) = (Grouped::of(&boxes[..large], 0), Grouped::of(&boxes[large..], large));
        Self { all: boxes, slopes, large, small }
    }

    /// The planes of a box; its faces that are seen are appended to `faces`. `None` when the camera is inside.
    #[inline]
    pub fn on_screen(&self, index: u32, eye: &Eye, faces: &mut Vec<DrawnFace>) -> Option<BoxOnScreen> {
        let own = &self.all[index as usize];
        match own.slopes {
            None => own.on_screen(eye, faces),
            Some(place) => own.slopes_on_screen(&self.slopes[place as usize], eye, faces),
        }
    }

    /// Boxes that hide much.
    pub fn large(&self) -> &Grouped {
        &self.large
    }

    /// All others.
    pub fn small(&self) -> &Grouped {
        &self.small
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&*self.all) + size_of_val(&*self.slopes) + self.large.bytes() + self.small.bytes()
    }
}

/// Bounds of a box by its foot and the height of its top.
fn upright(foot: &[DVec3], top_m: f64, axis: DVec3) -> Bounds {
    let half = |from: usize, to: usize| 0.5 * (foot[to] - foot[from]).length();
    Bounds {
        center_in_world: 0.5 * (foot[0] + foot[2].with_z(top_m)),
        half_m: DVec3::new(half(0, 1), half(1, 2), 0.5 * (top_m - foot[0].z)),
        axis: [axis.x, axis.y],
    }
}

/// Bounds of corners: sides that lean may lean outwards, and those of round crowns are not square.
fn around<'a>(corners: impl Iterator<Item = &'a DVec3>, axis: DVec3) -> Bounds {
    let across = DVec3::new(-axis.y, axis.x, 0.0);
    let own = corners.map(|corner| DVec3::new(corner.dot(axis), corner.dot(across), corner.z));
    let (low, high) = own.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), it| (low.min(it), high.max(it)));
    let middle = 0.5 * (low + high);
    let center_in_world = (middle.x * axis + middle.y * across).with_z(middle.z);
    Bounds { center_in_world, half_m: 0.5 * (high - low), axis: [axis.x, axis.y] }
}

/// Whether faces are those of a box that stands: upright sides at right angles, a level top.
fn is_upright_box(faces: &[SceneFace]) -> bool {
    let normal = |number: usize| faces[number].normal_in_world;
    let is_upright = (0..4).all(|side| normal(side).z == 0.0) && normal(5).z > 1.0 - 1e-12;
    let is_square = normal(0).dot(normal(1)) < -1.0 + 1e-9 && normal(0).dot(normal(2)).abs() < 1e-6;
    is_upright && is_square && normal(2).dot(normal(3)) < -1.0 + 1e-9
}

impl SolidBox {
    fn of(first_face: u32, faces: &[SceneFace], slopes: &mut Vec<Slopes>) -> Self {
        // Faces 0 and 1 look along the box's x axis, 2 and 3 along y, 4 and 5 along z.
        let (low, high) = (&faces[4].corners_in_world, &faces[5].corners_in_world);
        let is_cut = !is_upright_box(faces);
        // Sides of pieces of roofs may have no length, and no normal.
        let mut sides = [1, 0, 2, 3].iter().map(|side| faces[*side].normal_in_world.with_z(0.0));
        let axis = sides.find(|axis| axis.length_squared() > 1e-6).unwrap_or(DVec3::X);
        let axis = if is_cut { axis.normalize() } else { axis };
        let bounds = if is_cut { around(low.iter().chain(high), axis) } else { upright(low, high[0].z, axis) };
        Self {
            bounds,
            lift: faces[0].lift,
            label: faces[0].label,
            instance: faces[0].instance,
            first_face,
            slopes: is_cut.then(|| {
                let plane = |number: usize| {
                    let face = &faces[number];
                    (face.normal_in_world, face.normal_in_world.dot(face.point_in_world))
                };
                slopes.push(std::array::from_fn(plane));
                slopes.len() as u32 - 1
            }),
        }
    }

    /// As [`Self::on_screen`], by planes of any direction: those that the camera is before are entered, the others left.
    fn slopes_on_screen(&self, slopes: &Slopes, eye: &Eye, faces: &mut Vec<DrawnFace>) -> Option<BoxOnScreen> {
        let mut shape = BoxOnScreen { planes: [[0.0; 3]; 6], entries: 0, faces: [0.0; 5] };
        let mut exits = 6;
        let lift = 1.0 + self.lift;
        for ((normal, offset_m), number) in slopes.iter().zip(self.first_face..) {
            let way_m = offset_m - normal.dot(eye.position_in_world);
            if way_m >= 0.0 || shape.entries == shape.faces.len() {
                exits -= 1;
                shape.planes[exits] = in_single(scaled(eye.along(*normal), lift / way_m.max(1e-12)));
                continue;
            }
            let plane = scaled(eye.along(*normal), 1.0 / way_m);
            shape.planes[shape.entries] = in_single(scaled(plane, lift));
            shape.faces[shape.entries] = faces.len() as f32;
            faces.push(DrawnFace { plane, instance: self.instance, number, triangle: 0, label: self.label });
            shape.entries += 1;
        }
        (shape.entries > 0).then_some(shape)
    }

    /// The planes of its faces; the faces that are seen are appended to `faces`. `None` when the camera is inside.
    fn on_screen(&self, eye: &Eye, faces: &mut Vec<DrawnFace>) -> Option<BoxOnScreen> {
        let Bounds { center_in_world, half_m, axis: [cos, sin] } = self.bounds;
        let away = center_in_world - eye.position_in_world;
        let center = [cos * away.x + sin * away.y, cos * away.y - sin * away.x, away.z];
        let rays = eye.ray_in_world;
        let (ahead, across) = (|ray: DVec3| cos * ray.x + sin * ray.y, |ray: DVec3| cos * ray.y - sin * ray.x);
        let along: [Linear; 3] = [
            [ahead(rays[0]), ahead(rays[1]), ahead(rays[2])],
            [across(rays[0]), across(rays[1]), across(rays[2])],
            [rays[0].z, rays[1].z, rays[2].z],
        ];
        let mut planes = [[0.0f32; 3]; 6];
        let mut numbers = [0.0f32; 5];
        let (mut entries, mut exits) = (0, 6);
        let lift = 1.0 + self.lift;
        let mut leave = |axis: usize, way: f64| {
            exits -= 1;
            planes[exits] = in_single(scaled(along[axis], lift / way));
        };
        let mut ways = [0.0; 3];
        for axis in 0..3 {
            let (low, high) = (center[axis] - half_m[axis], center[axis] + half_m[axis]);
            if low > 0.0 {
                ways[axis] = low;
                leave(axis, high);
            } else if high < 0.0 {
                ways[axis] = high;
                leave(axis, low);
            } else {
                // Between both: rays only leave, by one or the other.
                leave(axis, low.min(-1e-12));
                leave(axis, high.max(1e-12));
            }
        }
        for axis in 0..3 {
            if ways[axis] != 0.0 {
                let plane = scaled(along[axis], 1.0 / ways[axis]);
                planes[entries] = in_single(scaled(plane, lift));
                numbers[entries] = faces.len() as f32;
                // Faces 0, 2 and 4 look along the axes' negative directions; a way is positive behind the lower face.
                let number = self.first_face + 2 * axis as u32 + u32::from(ways[axis] < 0.0);
                faces.push(DrawnFace { plane, instance: self.instance, number, triangle: 0, label: self.label });
                entries += 1;
            }
        }
        (entries > 0).then_some(BoxOnScreen { planes, entries, faces: numbers })
    }
}

impl Grouped {
    fn of(boxes: &[SolidBox], first: usize) -> Self {
        let bounds: Vec<Bounds> = boxes.iter().map(|b| b.bounds).collect();
        let group = |(number, members): (usize, &[Bounds])| Group {
            first: (first + GROUP * number) as u32,
            lanes: BoxLanes::of(members),
        };
        let around: Vec<Bounds> = bounds.chunks(GROUP).map(|members| Bounds::around(members.iter().copied())).collect();
        Self { groups: bounds.chunks(GROUP).enumerate().map(group).collect(), around: BoxLanes::of(&around) }
    }

    /// Boxes around all groups.
    pub fn around(&self) -> &BoxLanes {
        &self.around
    }

    /// Index of the first box of a group, and the group's boxes.
    pub fn group(&self, number: u32) -> (u32, &BoxLanes) {
        let group = &self.groups[number as usize];
        (group.first, &group.lanes)
    }

    fn bytes(&self) -> usize {
        let lanes = self.groups.iter().map(|group| group.lanes.bytes());
        self.around.bytes() + lanes.sum::<usize>() + size_of_val(&*self.groups)
    }
}

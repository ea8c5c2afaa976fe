//! [`Plan`]: a box seen along its longer side, and the parts that things are drawn of within it.

use crate::parts::{BOX_FACES, SceneBox};
use crate::pattern::hash;
use crate::thing_form::ThingForm;
use cosfly_domain::ObstacleKind;
use cosfly_frames::{DVec2, DVec3};

/// Half the size of a box may be over or under a measure by this much, metres.
pub(crate) const CLOSE_M: f64 = 0.03;

/// The seed of the shapes of a thing's parts: the same under every seed of looks, because depth and labels have none.
pub(crate) fn shape_seed(b: &SceneBox) -> u32 {
    hash(b.instance, 0x5e1f)
}

fn swapped(at: DVec3) -> DVec3 {
    DVec3::new(at.y, at.x, at.z)
}

/// A box with its longer side first. Places in it are metres from its lowest corner along its length, depth and height.
pub(crate) struct Plan<'a> {
    of: &'a SceneBox,
    /// Length, depth and height, metres.
    pub size_m: DVec3,
    is_across: bool,
    /// Whether lengths are counted from the other end.
    is_turned: bool,
}

impl<'a> Plan<'a> {
    /// The plan of a box.
    pub fn of(of: &'a SceneBox) -> Self {
        let size_m = 2.0 * of.half_extents_m.as_dvec3();
        let is_across = size_m.y > size_m.x;
        Self { of, size_m: if is_across { swapped(size_m) } else { size_m }, is_across, is_turned: false }
    }

    /// The same box, its length counted from the other end where `is_turned`.
    pub fn turned(self, is_turned: bool) -> Self {
        Self { is_turned, ..self }
    }

    /// Whether each measure lies between the least and the greatest.
    pub fn is_within(&self, [least, most]: [[f64; 3]; 2]) -> bool {
        self.size_m.cmpge(least.into()).all() && self.size_m.cmple(most.into()).all()
    }

    /// Whether the box has these measures.
    pub fn is_of(&self, size_m: [f64; 3]) -> bool {
        (self.size_m - DVec3::from(size_m)).abs().max_element() < CLOSE_M
    }

    /// A part between two corners.
    pub fn part(&self, kind: ObstacleKind, low: [f64; 3], high: [f64; 3]) -> SceneBox {
        let outline = |at: [f64; 3], to: [f64; 3]| [[at[0], at[1]], [to[0], at[1]], [at[0], to[1]], [to[0], to[1]]];
        let around = outline(low, high).map(DVec2::from);
        self.boxed(kind, [around, around], [low[2], high[2]])
    }

    /// A part between two corners that is drawn as a form.
    pub fn shaped(&self, form: ThingForm, low: [f64; 3], high: [f64; 3]) -> SceneBox {
        SceneBox { thing: form, ..self.part(ObstacleKind::Static, low, high) }
    }

    /// A part between a lower and an upper face, each by its corners (near, far along the length, then the same on the far side),
    /// at two heights. Its four sides are flat.
    pub fn prism(&self, form: ThingForm, faces: [[DVec2; 4]; 2], heights_m: [f64; 2]) -> SceneBox {
        let mut part = SceneBox { thing: form, ..self.boxed(ObstacleKind::Static, faces, heights_m) };
        for (face, side) in part.sides_in_world.iter_mut().enumerate() {
            let [a, b, c, d] = BOX_FACES[face].2.map(|corner| part.corners_in_world[corner]);
            let normal = (c - a).cross(d - b).normalize_or(*side);
            *side = normal * normal.dot(a - part.center_in_world).signum();
        }
        part
    }

    /// A place on the ground: so far along the box, and so far out of its far (`side` 1) or near (-1) long side.
    pub fn in_plan(&self, along_m: f64, side: f64, away_m: f64) -> DVec2 {
        let across_m = 0.5 * self.size_m.y * (1.0 + side) + side * away_m;
        self.in_world(DVec3::new(along_m, across_m, 0.0)).truncate()
    }

    fn in_world(&self, at: DVec3) -> DVec3 {
        let at = if self.is_turned { DVec3::new(self.size_m.x - at.x, self.size_m.y - at.y, at.z) } else { at };
        let own = at - 0.5 * self.size_m;
        let own = if self.is_across { swapped(own) } else { own };
        let [x, y] = self.of.axes_in_world;
        self.of.center_in_world + own.x * x + own.y * y + own.z * DVec3::Z
    }

    /// The corners, bounds and half size of a part; its sides are those of the box.
    fn boxed(&self, kind: ObstacleKind, faces: [[DVec2; 4]; 2], heights_m: [f64; 2]) -> SceneBox {
        let mut part = self.of.clone();
        for (number, corner) in part.corners_in_world.iter_mut().enumerate() {
            let turned = if self.is_turned { 3 - number % 4 } else { number % 4 };
            let own = if self.is_across { [0, 2, 1, 3][turned] } else { turned };
            *corner = self.in_world(faces[number / 4][own].extend(heights_m[number / 4]));
        }
        let corners = part.corners_in_world;
        let bounds = |axis: DVec3| {
            let along = corners.map(|corner| corner.dot(axis));
            let (low, high) =
                (along.into_iter().fold(f64::INFINITY, f64::min), along.into_iter().fold(f64::NEG_INFINITY, f64::max));
            [0.5 * (low + high), 0.5 * (high - low)]
        };
        let [x, y] = part.axes_in_world.map(bounds);
        let z = bounds(DVec3::Z);
        part.center_in_world = x[0] * part.axes_in_world[0] + y[0] * part.axes_in_world[1] + z[0] * DVec3::Z;
        part.half_extents_m = DVec3::new(x[1], y[1], z[1]).as_vec3a();
        let from_middle = |corner: DVec3| (corner - part.center_in_world).abs();
        part.half_bounds_m = corners.into_iter().map(from_middle).fold(DVec3::ZERO, DVec3::max);
        part.kind = kind;
        part.whole = [part.center_in_world.as_vec3a(), part.half_extents_m];
        part
    }
}

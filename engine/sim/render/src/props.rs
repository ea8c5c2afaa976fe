//! Models in the places of a town's things: triangles in the world with their colours, ready to be drawn.

use cosfly_domain::{ObstacleKind, Town, object_instance};
use cosfly_frames::DVec3;
use cosfly_materials::parts::SceneBox;
use cosfly_materials::pattern::hash;
use cosfly_materials::vector::Vec3;
use cosfly_models::{Model, ModelFit, ModelKind, ModelTriangle, Stand, Texture, place, stands};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// A model for all things of a kind.
pub struct SceneModel {
    /// Kind of the things.
    pub kind: ModelKind,
    /// Size beside the box around a thing.
    pub fit: ModelFit,
    /// Turn about the vertical before it is placed, radians.
    pub turn_rad: f64,
    /// The model.
    pub model: Model,
}

/// All models of a scene, where they stand.
#[derive(Default)]
pub(crate) struct Props {
    pub props: Vec<Prop>,
    pub triangles: Vec<PropTriangle>,
    pub textures: Vec<Texture>,
}

/// A thing drawn by a model.
pub(crate) struct Prop {
    pub center_in_world: DVec3,
    pub half_bounds_m: DVec3,
    pub label: u8,
    pub instance: u32,
    /// Whether light falls through as through leaves.
    pub is_leafy: bool,
    /// Numbers of its triangles.
    pub triangles: Range<usize>,
}

/// A triangle of a model; both sides are seen.
pub(crate) struct PropTriangle {
    pub corners_in_world: [DVec3; 3],
    pub normal_in_world: DVec3,
    pub skin: Skin,
}

/// Colours of a triangle: a texture's place changes evenly over its plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Skin {
    /// Linear; the texture is multiplied by it.
    pub colour: Vec3,
    pub texture: Option<u32>,
    /// A corner, metres, and its place in the texture.
    corner: Vec3,
    origin: [f32; 2],
    /// Change of the place per metre.
    per_m: [Vec3; 2],
    /// Most texels along a metre.
    texels_per_m: f32,
}

impl Skin {
    fn new(triangle: &ModelTriangle, textures: &[Texture], first_texture: u32) -> Self {
        let [a, b, c] = triangle.corners;
        let (along, aside) = (b - a, c - a);
        let normal = along.cross(aside);
        let [dual_along, dual_aside] =
            [aside.cross(normal), normal.cross(along)].map(|it| it / normal.length_squared());
        let [from, to, other] = triangle.texture_places;
        let per_m = [0, 1].map(|k| {
            let change = dual_along * f64::from(to[k] - from[k]) + dual_aside * f64::from(other[k] - from[k]);
            if change.is_finite() { Vec3::from(change) } else { Vec3::ZERO }
        });
        let size = triangle.texture.map_or([1.0; 2], |texture| textures[texture as usize].size());
        let texels = [0, 1].map(|k| per_m[k].dot(per_m[k]).sqrt() * size[k]);
        let [r, g, b] = triangle.colour;
        Self {
            colour: Vec3::new(r, g, b),
            texture: triangle.texture.map(|texture| first_texture + texture),
            corner: Vec3::from(a),
            origin: from,
            per_m,
            texels_per_m: texels[0].max(texels[1]),
        }
    }

    /// Linear colour at a point for a pixel of a size, metres.
    #[inline]
    pub fn colour_at(&self, textures: &[Texture], point: Vec3, footprint_m: f32) -> Vec3 {
        let Some(texture) = self.texture else { return self.colour };
        let away = point - self.corner;
        let at = [0, 1].map(|k| self.origin[k] + self.per_m[k].dot(away));
        let [r, g, b] = textures[texture as usize].sample(at, footprint_m * self.texels_per_m);
        Vec3::new(self.colour.x * r, self.colour.y * g, self.colour.z * b)
    }

    /// Colour where details do not matter.
    pub fn mean(&self, textures: &[Texture]) -> Vec3 {
        self.colour_at(textures, self.corner, f32::INFINITY)
    }
}

impl Props {
    /// Puts models in the places of a town's things; `seed` chooses among several of one kind.
    pub fn new(town: &Town, models: &[SceneModel], seed: u32) -> Self {
        let mut props = Self::default();
        let mut first_textures = vec![];
        for it in models {
            first_textures.push(props.textures.len() as u32);
            props.textures.extend(it.model.textures.iter().cloned());
        }
        let mut by_kind: BTreeMap<ModelKind, Vec<usize>> = BTreeMap::new();
        for (number, it) in models.iter().enumerate() {
            by_kind.entry(it.kind).or_default().push(number);
        }
        let mut placed = BTreeSet::new();
        for (kind, numbers) in by_kind {
            for (object_id, stand) in stands(&town.obstacles, |part| kind.has_part(part)) {
                if placed.insert(object_id) {
                    let number = numbers[hash(object_id, seed) as usize % numbers.len()];
                    props.add(&models[number], first_textures[number], object_id, &stand);
                }
            }
        }
        props
    }

    fn add(&mut self, it: &SceneModel, first_texture: u32, object_id: u32, stand: &Stand) {
        let first = self.triangles.len();
        for triangle in place(&it.model, it.turn_rad, it.fit, stand) {
            let [a, b, c] = triangle.corners;
            let normal_in_world = (b - a).cross(c - a).normalize_or_zero();
            if normal_in_world != DVec3::ZERO {
                let skin = Skin::new(&triangle, &it.model.textures, first_texture);
                self.triangles.push(PropTriangle { corners_in_world: triangle.corners, normal_in_world, skin });
            }
        }
        let corners = || self.triangles[first..].iter().flat_map(|triangle| triangle.corners_in_world);
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
        self.props.push(Prop {
            center_in_world: 0.5 * (low + high),
            half_bounds_m: 0.5 * (high - low),
            label: stand.kind.label().id(),
            instance: object_instance(object_id),
            is_leafy: stand.kind == ObstacleKind::TreeCrown,
            triangles: first..self.triangles.len(),
        });
    }

    /// Leaves out the boxes of things that models draw.
    pub fn replace(&self, boxes: &mut Vec<SceneBox>) {
        let drawn: BTreeSet<u32> = self.props.iter().map(|prop| prop.instance).collect();
        boxes.retain(|b| !drawn.contains(&b.instance));
    }
}

//! From a document's objects to faces in the world: vertices, units, templates, the geometry that is used.

use super::document::{CityObject, Document, Geometry, Templates, Transform};
use super::faces::Face;
use cosfly_diagnose::plausible;
use cosfly_frames::{DVec2, DVec3};
use cosfly_town::MapError;
use cosfly_town::units::{epsg_code, height_code, height_unit_m, unit_m};
use cosfly_town::world::WorldFromMap;

/// Farthest coordinate, metres.
const FARTHEST_M: f64 = 1e8;
/// Maps narrower than this are in degrees: the longest way through a town is a fraction of one.
const NARROWEST: f64 = 2.0;
/// Widest map, metres.
const WIDEST_M: f64 = 100_000.0;
/// Most faces of one object; a building of the finest level has some ten thousand.
pub(super) const MOST_FACES: usize = 500_000;

/// Frame, units and templates that the vertices of all documents share.
pub(super) struct Space {
    transform: Transform,
    /// Length of the units of plan and height, metres.
    pub(super) units_m: [f64; 2],
    /// Whether the file has no `transform`, although its version asks for one.
    pub(super) lacks_transform: bool,
    templates: Option<Templates>,
    pub(super) world: WorldFromMap,
    pub(super) reference_system: Option<String>,
}

/// Faces of one object at its best level of detail, world frame.
#[derive(Debug, Default)]
pub(super) struct Shape {
    pub(super) faces: Vec<Face>,
    /// Meaning of each face: the index of its surface in the geometry, by [`Geometry::surface_of_face`].
    pub(super) sources: Vec<(usize, usize)>,
    pub(super) lod: f64,
    /// Faces left out: too few corners, or a vertex that the file does not have.
    pub(super) broken: usize,
    /// Corners of points and lines.
    pub(super) points: Vec<DVec3>,
}

impl Transform {
    fn check(&self) -> Result<(), MapError> {
        let is_broken = |number: &f64| plausible(*number).is_err();
        if self.scale.iter().any(|scale| is_broken(scale) || *scale == 0.0) || self.translate.iter().any(is_broken) {
            let message =
                format!("`transform` has the scale {:?} and the translation {:?}", self.scale, self.translate);
            return Err(MapError::new(message).hint("each must be a number within 1e9, and no scale 0"));
        }
        Ok(())
    }
}

impl Space {
    /// The head's transform and unit, and the shift that the first vertices of all documents ask for.
    pub(super) fn of(documents: &mut [Document]) -> Result<Self, MapError> {
        check_transforms(documents)?;
        documents.iter().filter_map(|document| document.transform).try_for_each(|transform| transform.check())?;
        let head = &mut documents[0];
        let plain = Transform { scale: [1.0; 3], translate: [0.0; 3] };
        let transform = head.transform.unwrap_or(plain);
        let lacks_transform = head.lacks_transform();
        let reference_system = head.reference_system().map(str::to_owned);
        let code = reference_system.as_deref().and_then(epsg_code);
        let plan_m = code.map_or(1.0, unit_m);
        let height_m = reference_system.as_deref().and_then(height_code).map_or(plan_m, height_unit_m);
        let templates = head.templates.take();
        let (units_m, world) = ([plan_m, height_m], WorldFromMap::default());
        let mut space = Self { transform, lacks_transform, units_m, templates, world, reference_system };
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for document in documents.iter() {
            let own = space.of_document(document);
            for point in used_vertices(document).map(|vertex| own.in_map(vertex)) {
                (low, high) = (low.min(point), high.max(point));
            }
        }
        if !low.is_finite() {
            return Err(MapError::new("no object of the file has a shape"));
        }
        let across_m = (high - low).max_element();
        if low.abs().max(high.abs()).max_element() > FARTHEST_M || across_m > WIDEST_M {
            let error = MapError::new(format!("the map is {across_m:.3e} m across; at most {WIDEST_M} m are read"));
            return Err(error.hint("check `transform` and `vertices`, or cut the map into smaller pieces"));
        }
        let is_geographic = code.is_some_and(|code| (4000..5000).contains(&code));
        let is_tiny = (high - low).truncate().max_element() < NARROWEST;
        let may_be_degrees = low.abs().max(high.abs()).truncate().cmple(DVec2::splat(360.0)).all();
        if (is_geographic || is_tiny) && may_be_degrees {
            let error = MapError::new(if is_geographic {
                "the coordinates are degrees; cosfly needs a projected reference system".to_owned()
            } else {
                format!(
                    "the map is {:.5} m across: its coordinates seem to be degrees",
                    (high - low).truncate().max_element()
                )
            });
            return Err(error.hint("`cjio FILE reproject EPSG save NEW` projects the map"));
        }
        space.world = WorldFromMap::around([low.truncate(), high.truncate()]);
        Ok(space)
    }

    /// From the vertices of one document, which may have a transform of its own.
    fn of_document(&self, document: &Document) -> Vertices {
        Vertices { transform: document.transform.unwrap_or(self.transform), units_m: self.units_m }
    }

    fn in_metres(&self, point: DVec3) -> DVec3 {
        let [plan_m, height_m] = self.units_m;
        point * DVec3::new(plan_m, plan_m, height_m)
    }

    /// A height of the file's attributes, metres.
    pub(super) fn length_m(&self, length: f64) -> f64 {
        self.units_m[1] * length
    }

    /// Faces of an object's geometries at the highest level of detail that has any.
    pub(super) fn shape(&self, object: &CityObject, document: &Document) -> Shape {
        let (own, vertices) = (self.of_document(document), &document.vertices);
        let geometries = object.geometry.as_deref().unwrap_or_default();
        let lods = geometries.iter().filter(|geometry| self.corner_count(geometry) > 0).map(Geometry::lod);
        let Some(lod) = lods.max_by(f64::total_cmp) else { return Shape::default() };
        let mut shape = Shape { lod, ..Shape::default() };
        for (index, geometry) in geometries.iter().enumerate().filter(|(_, geometry)| geometry.lod() == lod) {
            match (geometry.template, &self.templates) {
                (Some(template), Some(templates)) => {
                    let place = geometry.boundaries.corners().first().and_then(|vertex| vertices.get(*vertex as usize));
                    let place = place.map(|place| own.in_map(*place));
                    self.add_instance(&mut shape, geometry, place, templates.templates.get(template), templates)
                }
                _ => shape
                    .add(geometry, index, &|vertex| vertices.get(vertex).map(|it| self.world.point(own.in_map(*it)))),
            }
        }
        shape
    }

    fn corner_count(&self, geometry: &Geometry) -> usize {
        geometry.boundaries.corners().len()
    }

    /// A template turned and scaled by the instance's matrix, at the instance's point.
    fn add_instance(
        &self,
        shape: &mut Shape,
        instance: &Geometry,
        place: Option<DVec3>,
        template: Option<&Geometry>,
        templates: &Templates,
    ) {
        let (Some(place), Some(geometry)) = (place, template) else {
            shape.broken += 1;
            return;
        };
        let rows = instance.matrix.as_deref().filter(|matrix| matrix.len() == 16);
        let turned = |point: DVec3| match rows {
            Some(m) => DVec3::from_array(
                [0, 4, 8].map(|r| m[r] * point.x + m[r + 1] * point.y + m[r + 2] * point.z + m[r + 3]),
            ),
            None => point,
        };
        shape.add(geometry, usize::MAX, &|vertex| {
            let point = DVec3::from_array(*templates.vertices.get(vertex)?);
            Some(self.world.point(place + self.in_metres(turned(point))))
        });
    }
}

/// From the numbers of a document's vertices to coordinates of the map, metres.
struct Vertices {
    transform: Transform,
    units_m: [f64; 2],
}

impl Vertices {
    fn in_map(&self, vertex: [f64; 3]) -> DVec3 {
        let scaled = DVec3::from_array(vertex) * DVec3::from_array(self.transform.scale);
        let [plan_m, height_m] = self.units_m;
        DVec3::new(plan_m, plan_m, height_m) * (scaled + DVec3::from_array(self.transform.translate))
    }
}

/// # Errors
/// A scale that flattens or mirrors the map.
fn check_transforms(documents: &[Document]) -> Result<(), MapError> {
    let scales = documents.iter().filter_map(|document| document.transform).flat_map(|transform| transform.scale);
    match scales.into_iter().find(|scale| !(1e-9..=1e9).contains(scale)) {
        Some(scale) => Err(MapError::new(format!("`transform.scale` has {scale:e}; it must be 1e-9 to 1e9"))
            .hint("write the file again with the program that made it, or `cjio FILE upgrade save NEW`")),
        None => Ok(()),
    }
}

/// Vertices that a shape has; files cut out of larger ones may keep others.
fn used_vertices(document: &Document) -> impl Iterator<Item = [f64; 3]> {
    let geometries = document.objects.values().flat_map(|object| object.geometry.iter().flatten());
    let corners = geometries.flat_map(|geometry| geometry.boundaries.corners());
    corners.filter_map(|vertex| document.vertices.get(*vertex as usize).copied())
}

impl Shape {
    fn add(&mut self, geometry: &Geometry, index: usize, point: &dyn Fn(usize) -> Option<DVec3>) {
        let usable = |point: &DVec3| point.is_finite() && point.abs().max_element() < FARTHEST_M;
        if geometry.boundaries.face_count() == 0 {
            let corners = geometry.boundaries.corners().iter();
            self.points.extend(corners.filter_map(|vertex| point(*vertex as usize)).filter(usable));
        }
        for (number, rings) in geometry.boundaries.faces().enumerate() {
            let rings: Option<Vec<Vec<DVec3>>> =
                rings.map(|ring| ring.iter().map(|vertex| point(*vertex as usize).filter(usable)).collect()).collect();
            match rings {
                Some(rings) if rings.first().is_some_and(|outer| outer.len() > 2) && self.faces.len() < MOST_FACES => {
                    self.faces.push(Face { rings });
                    self.sources.push((index, number));
                }
                _ => self.broken += 1,
            }
        }
    }

    /// Lowest and highest corner; none without any.
    pub(super) fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let corners = || self.faces.iter().flat_map(Face::corners).chain(self.points.iter().copied());
        let low = corners().fold(DVec3::INFINITY, DVec3::min);
        low.is_finite().then(|| (low, corners().fold(DVec3::NEG_INFINITY, DVec3::max)))
    }
}

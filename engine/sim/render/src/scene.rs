//! A town prepared for the renderer: boxes with faces, ground polygons in small bounded clusters, seeds for looks.

use crate::parked::{leave_out, parked_cars};
use crate::props::{Props, SceneModel};
use crate::scene_mesh::SceneMesh;
use crate::scene_splats::SceneSplats;
use crate::shade::material::colour_of;
use crate::shade::outskirts::Outskirts;
use crate::shade::sun_tiles::SunMaps;
use cosfly_domain::{ObstacleKind, Season, Town};
use cosfly_figures::{Clothes, FigureInPicture, add_figure};
use cosfly_frames::{DVec3, Seed};
use cosfly_materials::building_forms::tell_forms;
use cosfly_materials::drawn_shapes::cut_to_drawn;
use cosfly_materials::grid::LightGrid;
use cosfly_materials::ground_kinds::GroundKinds;
use cosfly_materials::ground_polygons::{GroundPolygon, GroundPolygons};
use cosfly_materials::kerb_lines::edges_of_pavements;
use cosfly_materials::kerbs::{KerbLine, tone_of_town};
use cosfly_materials::lane_wear::LaneWear;
use cosfly_materials::leaves::Leaves;
use cosfly_materials::measured::roofs::measured_roofs;
use cosfly_materials::parts::{BOX_FACES, Cluster, ClusterPolygon, SceneBox, boxes_of, join_wholes};
use cosfly_materials::pattern::{NoiseTexture, noise_texture};
use cosfly_materials::roof_edges::roofs_that_go_on;
use cosfly_materials::roof_step::{FaceLook, RoofStep};
use cosfly_materials::roof_steps::roof_steps;
use cosfly_materials::street_walls::tell_street_walls;
use cosfly_materials::vector::Vec3;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Polygons in one cluster of ground.
const CLUSTER_POLYGONS: usize = 48;

/// Everything static, ready to be drawn. Built once per town, shared by all threads.
pub struct Scene {
    pub(crate) boxes: Vec<SceneBox>,
    /// Stone of its kerbs.
    pub(crate) kerb_tone: Vec3,
    /// Season of its trees and lawns.
    pub(crate) season: Season,
    /// Colours of boxes in the simple look.
    pub(crate) colours: Vec<Vec3>,
    /// Crowns of the boxes that have leaves.
    pub(crate) crowns: Vec<Option<Leaves>>,
    pub(crate) clusters: Vec<Cluster>,
    /// Numbers at which the faces of each cluster end, see [`Self::faces`].
    face_ends: Vec<u32>,
    pub(crate) noise: Box<NoiseTexture>,
    pub(crate) grid: LightGrid,
    /// Wear of its carriageways.
    pub(crate) wear: LaneWear,
    pub(crate) outskirts: Outskirts,
    pub(crate) props: Props,
    /// Cars of the town as vehicles.
    pub(crate) parked: Vec<FigureInPicture>,
    /// A scan's triangles, in the place of boxes, models and parked cars; ground shows through its holes.
    pub(crate) mesh: Option<Arc<SceneMesh>>,
    /// A scan's colours, in the place of those of boxes and ground.
    pub(crate) splats: Option<Arc<SceneSplats>>,
    /// Shadows of everything above, drawn as views need them.
    pub(crate) sun_maps: SunMaps,
    /// Tells scenes of one process apart; buffers that outlive a frame remember it.
    pub(crate) identity: u64,
}

/// Tells all boxes their places in pitched roofs.
pub(crate) fn set_roofs(boxes: &mut [SceneBox]) {
    let mut steps = roof_steps(boxes);
    measured_roofs(boxes, &mut steps);
    boxes.iter_mut().zip(steps).for_each(|(b, step)| b.roof = step.map(Box::new));
}

/// A triangle of the static scene as rays see it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneTriangle {
    /// Corners, metres.
    pub corners_in_world: [DVec3; 3],
    /// CARLA label id.
    pub label: u8,
    /// Instance id.
    pub instance: u32,
}

/// A scan of a town's place, which several scenes share.
#[derive(Clone, Default)]
pub struct SceneScan {
    /// Triangles in the place of boxes.
    pub mesh: Option<Arc<SceneMesh>>,
    /// Colours in the place of those of boxes and ground.
    pub splats: Option<Arc<SceneSplats>>,
}

impl SceneScan {
    /// Whether there is nothing of a scan.
    pub fn is_empty(&self) -> bool {
        self.mesh.is_none() && self.splats.is_none()
    }
}

impl Scene {
    /// Prepares a town. Boxes and triangles that are not finite are left out; `seed` draws colours and patterns.
    pub fn new(town: &Town, seed: Seed) -> Self {
        Self::with_models(town, seed, &[])
    }

    /// Prepares a town whose cars are boxes like all other things: the scene of the faces of [`Self::faces_of`].
    pub fn of_boxes(town: &Town, seed: Seed) -> Self {
        Self::of(town, seed, &[], |_| vec![])
    }

    /// Prepares a town some of whose things are drawn by models.
    pub fn with_models(town: &Town, seed: Seed, models: &[SceneModel]) -> Self {
        Self::of(town, seed, models, |props| parked_cars(town, props, seed))
    }

    fn of(town: &Town, seed: Seed, models: &[SceneModel], cars: impl FnOnce(&Props) -> Vec<FigureInPicture>) -> Self {
        let look_seed = (seed.child("looks", 0).as_u64() >> 32) as u32;
        let mut boxes = boxes_of(town, look_seed);
        join_wholes(&mut boxes);
        set_roofs(&mut boxes);
        tell_forms(&mut boxes);
        let ground = GroundKinds::of(town);
        tell_street_walls(&mut boxes, &ground);
        let sides = roofs_that_go_on(&boxes);
        boxes.iter_mut().zip(sides).for_each(|(b, sides)| b.roof_goes_on = sides);
        let clusters = clusters_of(town);
        let noise = noise_texture(look_seed);
        let grid = LightGrid::new(&boxes, &clusters, &ground);
        let season = cosfly_materials::season::of_town(look_seed);
        let outskirts = Outskirts::of(&grid, season);
        cut_to_drawn(&mut boxes, &ground);
        let props = Props::new(town, models, look_seed);
        props.replace(&mut boxes);
        let parked = cars(&props);
        leave_out(&parked, &mut boxes);
        static SCENES: AtomicU64 = AtomicU64::new(0);
        let identity = SCENES.fetch_add(1, Ordering::Relaxed);
        let ends = clusters.iter().scan((BOX_FACES.len() * boxes.len()) as u32, |end, cluster| {
            *end += cluster.polygons.len() as u32;
            Some(*end)
        });
        let face_ends = ends.collect();
        let colours = boxes.iter().map(colour_of).collect();
        let crowns = boxes.iter().map(|b| Leaves::of(b, season)).collect();
        Self {
            boxes,
            kerb_tone: tone_of_town(look_seed),
            season,
            colours,
            crowns,
            clusters,
            face_ends,
            noise,
            grid,
            wear: LaneWear::new(&town.lanes, look_seed),
            outskirts,
            props,
            parked,
            mesh: None,
            splats: None,
            sun_maps: SunMaps::default(),
            identity,
        }
    }

    /// Season of its trees and lawns.
    pub fn season(&self) -> Season {
        self.season
    }

    /// This town in a season of one's choice; without one, in its own.
    pub fn in_season(mut self, season: Option<Season>) -> Self {
        let Some(season) = season else { return self };
        self.season = season;
        self.outskirts = Outskirts::of(&self.grid, season);
        self.crowns = self.boxes.iter().map(|b| Leaves::of(b, season)).collect();
        self
    }

    /// This town drawn as a scan; where that is empty, as it is.
    pub fn with_scan(self, scan: SceneScan) -> Self {
        let SceneScan { mesh, splats } = scan;
        Self { mesh, splats, ..self }
    }

    /// The mesh that the weather of frames lights.
    pub(crate) fn lit_mesh(&self) -> Option<&SceneMesh> {
        self.mesh.as_deref().filter(|mesh| mesh.is_lit)
    }

    /// Whether a scan is drawn with the light in its colours.
    pub(crate) fn has_light_of_its_own(&self) -> bool {
        self.splats.is_some() || self.mesh.as_ref().is_some_and(|mesh| !mesh.is_lit)
    }

    /// The textured mesh that it is drawn as.
    pub fn mesh(&self) -> Option<&SceneMesh> {
        self.mesh.as_deref()
    }

    /// Cars of the town as vehicles, which are drawn in the place of their boxes.
    pub fn parked(&self) -> &[FigureInPicture] {
        &self.parked
    }

    /// Whether a face of a box is the wall of a building, not its roof.
    pub(crate) fn is_wall(&self, index: u32, face: u8) -> bool {
        let (b, face) = (&self.boxes[index as usize], usize::from(face));
        let is_slope = |roof: &RoofStep| matches!(roof.sides.get(face), Some(FaceLook::Slope(_)));
        BOX_FACES[face].0 != 2 && b.kind == ObstacleKind::Building && !b.roof.as_deref().is_some_and(is_slope)
    }

    /// Cluster and polygon of a face of the ground by its number in [`Self::faces`]; the last one for numbers beyond it.
    pub(crate) fn ground_face(&self, number: u32) -> (usize, usize) {
        let cluster = self.face_ends.partition_point(|end| *end <= number).min(self.clusters.len().saturating_sub(1));
        let count = self.clusters[cluster].polygons.len();
        let left = self.face_ends[cluster].saturating_sub(number).clamp(1, count as u32);
        (cluster, count - left as usize)
    }

    /// Every triangle that the renderer draws except the target's, for casting the same rays
    /// (box faces and cars as triangles whose outside alone is drawn; models and ground are seen from both sides).
    pub fn triangles(&self) -> Vec<SceneTriangle> {
        let mut triangles = Vec::new();
        for b in &self.boxes {
            for (_, _, c) in BOX_FACES {
                for [i, j, k] in [[c[0], c[1], c[2]], [c[0], c[2], c[3]]] {
                    let corners_in_world = [b.corners_in_world[i], b.corners_in_world[j], b.corners_in_world[k]];
                    triangles.push(SceneTriangle { corners_in_world, label: b.label, instance: b.instance });
                }
            }
        }
        for prop in &self.props.props {
            triangles.extend(self.props.triangles[prop.triangles.clone()].iter().map(|triangle| SceneTriangle {
                corners_in_world: triangle.corners_in_world,
                label: prop.label,
                instance: prop.instance,
            }));
        }
        let mut figures = vec![];
        for car in &self.parked {
            add_figure(&car.figure, &Clothes::draw(&car.figure.clothes_seed), 0, &mut figures);
            triangles.extend(figures.drain(..).map(|triangle| SceneTriangle {
                corners_in_world: triangle.corners_in_world,
                label: ObstacleKind::Car.label().id(),
                instance: car.instance,
            }));
        }
        for cluster in &self.clusters {
            for polygon in &cluster.polygons {
                let corners = &cluster.corners[polygon.range()];
                let corner = |k: usize| polygon.on_plane(cluster.points_in_world[usize::from(corners[k])]);
                for k in 2..corners.len() {
                    let corners_in_world = [corner(0), corner(k - 1), corner(k)];
                    triangles.push(SceneTriangle { corners_in_world, label: polygon.label.id(), instance: 0 });
                }
            }
        }
        triangles
    }
}

/// Cuts the ground into clusters of neighbouring polygons, ordered along a Z curve over the ground.
pub(crate) fn clusters_of(town: &Town) -> Vec<Cluster> {
    let ground = GroundPolygons::of(town);
    let mut order: Vec<(u64, u32)> = (0u32..)
        .zip(&ground.polygons)
        .map(|(number, polygon)| {
            let cell = (polygon.middle_in_world - town.min_in_world) * 0.25;
            (z_order(cell.x as u32, cell.y as u32), number)
        })
        .collect();
    order.sort_unstable();
    let kerbs = edges_of_pavements(town, &ground);
    order.chunks(CLUSTER_POLYGONS).map(|members| cluster_of(&ground, &kerbs, members)).collect()
}

fn cluster_of(ground: &GroundPolygons, kerbs: &[KerbLine], members: &[(u64, u32)]) -> Cluster {
    let mut numbers = BTreeMap::new();
    let mut points: Vec<DVec3> = Vec::new();
    let (mut polygons, mut all_corners) = (Vec::new(), Vec::new());
    for &(_, number) in members {
        let GroundPolygon { corners, label, normal_in_world, middle_in_world } = &ground.polygons[number as usize];
        let first = all_corners.len() as u32;
        all_corners.extend(corners.iter().map(|corner| {
            *numbers.entry(*corner).or_insert_with(|| {
                points.push(ground.points_in_world[*corner as usize]);
                (points.len() - 1) as u16
            })
        }));
        polygons.push(ClusterPolygon {
            first,
            count: corners.len() as u32,
            label: *label,
            normal_in_world: *normal_in_world,
            middle_in_world: *middle_in_world,
            kerb: kerbs[number as usize],
        });
    }
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    Cluster {
        center_in_world: 0.5 * (low + high),
        half_bounds_m: 0.5 * (high - low),
        points_in_world: points,
        polygons,
        corners: all_corners,
    }
}

/// Interleaves the bits of a cell's two coordinates.
fn z_order(x: u32, y: u32) -> u64 {
    let spread = |value: u32| {
        let mut v = u64::from(value);
        v = (v | (v << 16)) & 0x0000_ffff_0000_ffff;
        v = (v | (v << 8)) & 0x00ff_00ff_00ff_00ff;
        v = (v | (v << 4)) & 0x0f0f_0f0f_0f0f_0f0f;
        v = (v | (v << 2)) & 0x3333_3333_3333_3333;
        (v | (v << 1)) & 0x5555_5555_5555_5555
    };
    spread(x) | (spread(y) << 1)
}

//! Frames whose nearest static faces were found elsewhere, such as on a graphics card: everything after visibility is ours.

use crate::faces::{DrawnFace, FaceSource, box_lift, ground_lift};
use crate::scene::{Scene, clusters_of};
use cosfly_domain::Town;
use cosfly_frames::DVec3;
use cosfly_materials::parts::{BOX_FACES, Cluster, SceneBox, boxes_of};
use cosfly_raster::eye::Eye;
use cosfly_raster::visibility::{PlaneOnScreen, Screen, Visibility};

/// A static face: numbered by its place in [`Scene::faces`].
#[derive(Clone, Debug, PartialEq)]
pub struct SceneFace {
    /// A flat convex polygon, metres. Neighbours share corners exactly.
    pub corners_in_world: Vec<DVec3>,
    /// Set for the faces of boxes, which are seen from outside only.
    pub outward_in_world: Option<DVec3>,
    /// Unit normal; outward for boxes, upward for ground.
    pub normal_in_world: DVec3,
    /// A point of its plane, metres; corners may lie a millimetre off the plane.
    pub point_in_world: DVec3,
    /// Share by which its inverse depth counts as greater where faces are coplanar.
    pub lift: f64,
    /// CARLA label id.
    pub label: u8,
    /// Instance id; 0 for ground.
    pub instance: u32,
}

impl Scene {
    /// Tells the scenes of one process apart.
    pub fn identity(&self) -> u64 {
        self.identity
    }

    /// All faces but the target's: six of each box, then the ground's.
    pub fn faces(&self) -> Vec<SceneFace> {
        faces(&self.boxes, &self.clusters)
    }

    /// The faces of a town's scene, without the scene: what light and looks need is not prepared.
    pub fn faces_of(town: &Town) -> Vec<SceneFace> {
        // Looks alone depend on a seed.
        faces(&boxes_of(town, 0), &clusters_of(town))
    }
}

fn faces(boxes: &[SceneBox], clusters: &[Cluster]) -> Vec<SceneFace> {
    let ground: usize = clusters.iter().map(|cluster| cluster.polygons.len()).sum();
    let mut faces = Vec::with_capacity(BOX_FACES.len() * boxes.len() + ground);
    for (index, b) in (0u32..).zip(boxes) {
        faces.extend(BOX_FACES.iter().enumerate().map(|(face, (_, _, around))| SceneFace {
            corners_in_world: around.map(|corner| b.corners_in_world[corner]).to_vec(),
            outward_in_world: Some(b.normal_in_world(face)),
            normal_in_world: b.normal_in_world(face),
            point_in_world: b.corners_in_world[around[0]],
            lift: box_lift(index),
            label: b.label,
            instance: b.instance,
        }));
    }
    for cluster in clusters {
        faces.extend(cluster.polygons.iter().map(|polygon| {
            let corners = cluster.corners[polygon.range()].iter();
            SceneFace {
                corners_in_world: corners.map(|corner| cluster.points_in_world[usize::from(*corner)]).collect(),
                outward_in_world: None,
                normal_in_world: polygon.normal_in_world,
                point_in_world: polygon.middle_in_world,
                lift: ground_lift(polygon.label),
                label: polygon.label.id(),
                instance: 0,
            }
        }));
    }
    faces
}

/// A scene seen by a camera, whose faces are noted as if they had been drawn here.
pub(crate) struct Found<'a> {
    pub scene: &'a Scene,
    pub eye: &'a Eye,
    pub screen: &'a Screen,
}

impl Found<'_> {
    /// Puts the faces that are `nearest` at each pixel, numbered as in [`Scene::faces`], into an empty frame.
    pub fn adopt(&self, nearest: &[u32], frame: &mut Visibility, faces: &mut Vec<DrawnFace>) {
        let scene = self.scene;
        let mut count = BOX_FACES.len() * scene.boxes.len();
        let mut ends = Vec::with_capacity(scene.clusters.len());
        for cluster in &scene.clusters {
            count += cluster.polygons.len();
            ends.push(count);
        }
        let mut numbers = vec![NO_FACE; count];
        let (width, height) = (self.screen.width, self.screen.height);
        for (row, line) in nearest.chunks_exact(width).take(height).enumerate() {
            let mut start = 0;
            for run in line.chunk_by(|a, b| a == b) {
                let pixels = start..start + run.len();
                start = pixels.end;
                let found = run[0] as usize;
                let Some(number) = numbers.get_mut(found) else { continue };
                if *number == NO_FACE {
                    let Some(face) = self.face(found, &ends) else { continue };
                    *number = faces.len() as u32;
                    faces.push(face);
                }
                let plane = faces[*number as usize].plane;
                frame.adopt_run(row, pixels, &plane, *number);
            }
        }
    }

    /// A face by its number; `ends` are the numbers at which the faces of each cluster end.
    fn face(&self, found: usize, ends: &[usize]) -> Option<DrawnFace> {
        let Self { scene, eye, screen } = self;
        let plane = |normal, point| PlaneOnScreen::new(screen, eye.turn(normal), eye.see(point));
        if let Some(b) = scene.boxes.get(found / BOX_FACES.len()) {
            let (index, face) = ((found / BOX_FACES.len()) as u32, found % BOX_FACES.len());
            let normal = b.normal_in_world(face);
            let plane = plane(normal, b.corners_in_world[BOX_FACES[face].2[0]])?;
            let source = FaceSource::of_box(scene, index, face as u8);
            let normal = normal.as_vec3().to_array();
            return Some(DrawnFace { plane, normal, source, label: b.label, instance: b.instance });
        }
        let index = ends.partition_point(|end| *end <= found);
        let cluster = scene.clusters.get(index)?;
        let number = found - (ends[index] - cluster.polygons.len());
        let polygon = &cluster.polygons[number];
        let plane = plane(polygon.normal_in_world, polygon.middle_in_world)?;
        let source = FaceSource::Ground { cluster: index as u32, polygon: number as u16 };
        let normal = polygon.normal_in_world.as_vec3().to_array();
        Some(DrawnFace { plane, normal, source, label: polygon.label.id(), instance: 0 })
    }
}

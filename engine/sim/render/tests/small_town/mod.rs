//! A small invented town for tests and pictures: blocks of buildings, streets, pavements, trees, lamps, cars.

use cosfly_domain::{
    MapOrigin, Obstacle, ObstacleKind, OrientedBox, SemanticLabel, SimplificationReport, SurfaceMesh, Synthetic, Town,
};
use cosfly_frames::{DVec2, DVec3, RandomStream, Seed};

/// Side of a block with its street, metres.
pub const BLOCK_M: f64 = 60.0;
const ROAD_M: f64 = 12.0;
const PAVEMENT_M: f64 = 4.0;

/// A town of `blocks` x `blocks` blocks around the origin.
pub fn small_town(blocks: i32, seed: u64) -> Town {
    let mut builder =
        Builder { town: empty_town(), random: Seed::of_item(seed, "town", "small").stream("layout"), next_object: 0 };
    for row in 0..blocks {
        for column in 0..blocks {
            let corner =
                DVec2::new(f64::from(column) - 0.5 * f64::from(blocks), f64::from(row) - 0.5 * f64::from(blocks));
            builder.block(corner * BLOCK_M);
        }
    }
    let half = 0.5 * BLOCK_M * f64::from(blocks);
    builder.town.min_in_world = DVec3::new(-half, -half, -1.0);
    builder.town.max_in_world = DVec3::new(half, half, 60.0);
    builder.town
}

/// A town with nothing in it.
pub fn empty_town() -> Town {
    Town {
        name: "small".into(),
        origin: MapOrigin::default(),
        obstacles: vec![],
        planning_boxes: vec![],
        simplification: SimplificationReport::default(),
        lanes: vec![],
        walkable: vec![],
        surfaces: vec![],
        synthetic: Synthetic::default(),
        min_in_world: DVec3::ZERO,
        max_in_world: DVec3::ONE,
    }
}

struct Builder {
    town: Town,
    random: RandomStream,
    next_object: u32,
}

impl Builder {
    fn block(&mut self, corner: DVec2) {
        let (x, y) = (corner.x, corner.y);
        let inner = ROAD_M + PAVEMENT_M;
        self.ground(SemanticLabel::Roads, [x, y], [x + BLOCK_M, y + ROAD_M + 0.5], 0.0, 6);
        self.ground(SemanticLabel::Roads, [x, y + ROAD_M + 0.5], [x + ROAD_M + 0.5, y + BLOCK_M], 0.0, 6);
        for k in 0..8 {
            let start = ROAD_M + 2.0 + 6.0 * f64::from(k);
            let middle = 0.5 * ROAD_M;
            let across = [x + start, y + middle - 0.08];
            self.ground(SemanticLabel::RoadLine, across, [across[0] + 3.0, y + middle + 0.08], 0.01, 1);
            let down = [x + middle - 0.08, y + start];
            self.ground(SemanticLabel::RoadLine, down, [x + middle + 0.08, down[1] + 3.0], 0.01, 1);
        }
        for k in 0..8 {
            let stripe = 0.9 + 1.4 * f64::from(k);
            self.ground(
                SemanticLabel::RoadLine,
                [x + stripe, y + ROAD_M + 0.5],
                [x + stripe + 0.7, y + ROAD_M + 3.5],
                0.01,
                1,
            );
        }
        self.ground(SemanticLabel::SideWalks, [x + ROAD_M, y + ROAD_M], [x + BLOCK_M, y + BLOCK_M], 0.14, 6);
        let green = [x + inner + 12.0, y + inner + 12.0];
        self.ground(SemanticLabel::Terrain, green, [x + BLOCK_M - 16.0, y + BLOCK_M - 16.0], 0.18, 3);
        self.buildings(x + inner, y + inner, BLOCK_M - inner - PAVEMENT_M);
        for k in 0..3 {
            let along = ROAD_M + 6.0 + 14.0 * f64::from(k);
            self.tree(x + along, y + ROAD_M + 1.4);
            self.tree(x + ROAD_M + 1.4, y + along + 5.0);
            self.car(x + along + 4.0, y + ROAD_M - 1.3, 0.0);
            self.lamp(x + along + 8.0, y + ROAD_M + 0.6);
        }
    }

    fn buildings(&mut self, x: f64, y: f64, side: f64) {
        let depth = 12.0;
        let mut start = 0.0;
        while start < side - 6.0 {
            let width = self.random.uniform(9.0, 17.0).min(side - start);
            let height = 3.3 * self.random.uniform(2.0, 9.0).floor();
            self.solid([x + start, y], [x + start + width, y + depth], height);
            let other = 3.3 * self.random.uniform(2.0, 7.0).floor();
            self.solid([x + start, y + side - depth], [x + start + width, y + side], other);
            start += width;
        }
        let height = 3.3 * self.random.uniform(2.0, 5.0).floor();
        self.solid([x, y + depth + 3.0], [x + depth, y + side - depth - 3.0], height);
    }

    fn solid(&mut self, min: [f64; 2], max: [f64; 2], height: f64) {
        let shape = OrientedBox::from_corners(DVec3::new(min[0], min[1], 0.0), DVec3::new(max[0], max[1], height));
        let object = self.object();
        self.add(shape, ObstacleKind::Building, object);
    }

    fn tree(&mut self, x: f64, y: f64) {
        let object = self.object();
        let (radius, height) = (self.random.uniform(1.6, 2.6), self.random.uniform(2.4, 3.2));
        let upright = |half: DVec3, z: f64, yaw_rad: f64| OrientedBox {
            center_in_world: DVec3::new(x, y, z),
            half_extents_m: half,
            yaw_rad,
        };
        self.add(upright(DVec3::new(0.16, 0.16, 0.5 * height), 0.5 * height, 0.3), ObstacleKind::TreeTrunk, object);
        for (share, low, high) in [(0.75, 0.0, 1.0), (1.0, 0.7, 2.6), (0.7, 2.4, 3.6)] {
            let half = DVec3::new(share * radius, share * radius, 0.5 * (high - low));
            let yaw = self.random.uniform(0.0, 1.5);
            self.add(upright(half, height + 0.5 * (low + high), yaw), ObstacleKind::TreeCrown, object);
        }
    }

    fn lamp(&mut self, x: f64, y: f64) {
        let object = self.object();
        let mast = OrientedBox::from_corners(DVec3::new(x - 0.08, y - 0.08, 0.1), DVec3::new(x + 0.08, y + 0.08, 6.0));
        let head = OrientedBox::from_corners(DVec3::new(x - 0.2, y - 1.4, 5.9), DVec3::new(x + 0.2, y + 0.1, 6.1));
        self.add(mast, ObstacleKind::Lamp, object);
        self.add(head, ObstacleKind::Lamp, object);
    }

    fn car(&mut self, x: f64, y: f64, yaw_rad: f64) {
        let object = self.object();
        let shape = OrientedBox {
            center_in_world: DVec3::new(x, y, 0.75),
            half_extents_m: DVec3::new(2.2, 0.9, 0.72),
            yaw_rad: yaw_rad + self.random.uniform(-0.03, 0.03),
        };
        self.add(shape, ObstacleKind::Car, object);
    }

    fn object(&mut self) -> u32 {
        self.next_object += 1;
        self.next_object - 1
    }

    fn add(&mut self, shape: OrientedBox, kind: ObstacleKind, object_id: u32) {
        self.town.obstacles.push(Obstacle { shape, kind, object_id, synthetic: true });
    }

    /// A rectangle of ground cut into `cuts` x `cuts` pieces.
    fn ground(&mut self, label: SemanticLabel, min: [f64; 2], max: [f64; 2], z: f64, cuts: u32) {
        let mut vertices = Vec::new();
        for row in 0..=cuts {
            for column in 0..=cuts {
                let share = [f64::from(column) / f64::from(cuts), f64::from(row) / f64::from(cuts)];
                vertices.push(DVec3::new(
                    min[0] + share[0] * (max[0] - min[0]),
                    min[1] + share[1] * (max[1] - min[1]),
                    z,
                ));
            }
        }
        let mut triangles = Vec::new();
        for row in 0..cuts {
            for column in 0..cuts {
                let at = row * (cuts + 1) + column;
                triangles.push([at, at + 1, at + cuts + 1]);
                triangles.push([at + 1, at + cuts + 2, at + cuts + 1]);
            }
        }
        let along_across_m = vec![DVec2::ZERO; vertices.len()];
        self.town.surfaces.push(SurfaceMesh {
            label,
            vertices_in_world: vertices,
            along_across_m,
            triangles,
            synthetic: true,
        });
    }
}

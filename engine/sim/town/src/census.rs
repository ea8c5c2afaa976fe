//! Figures of a town: things by kind, their heights, walkable ground by kind, seen ground by label.

use crate::polygons::twice_area_m2;
use cosfly_domain::{Obstacle, Town};
use std::collections::BTreeMap;

/// Figures of a town.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Census {
    /// Things by the name of their kind.
    pub kinds: BTreeMap<String, Things>,
    /// Walkable ground by the name of its kind.
    pub walkable: BTreeMap<String, WalkableGround>,
    /// Ground that is seen, by the name of its label.
    pub ground: BTreeMap<&'static str, SeenGround>,
}

/// Things of one kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Things {
    /// Number of things.
    pub objects: usize,
    /// Number of their boxes.
    pub boxes: usize,
    /// Number of things that were invented.
    pub synthetic_objects: usize,
    /// Heights of the things, from the lowest to the highest point of their boxes, metres.
    pub heights_m: Range,
}

/// Spread of a quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Range {
    /// Smallest value.
    pub least: f64,
    /// Middle value; the lower one of two.
    pub median: f64,
    /// Largest value.
    pub most: f64,
}

/// Walkable ground of one kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WalkableGround {
    /// Number of polygons.
    pub polygons: usize,
    /// Sum of their areas in plan, square metres; where polygons overlap, ground counts twice.
    pub area_m2: f64,
    /// The part of the area that was invented, square metres.
    pub synthetic_area_m2: f64,
}

/// Ground that is seen under one label.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeenGround {
    /// Area in plan, square metres; where surfaces lie over each other, ground counts for each.
    pub area_m2: f64,
    /// The part of the area that was invented, square metres.
    pub synthetic_area_m2: f64,
}

impl Town {
    /// Figures of the town.
    pub fn census(&self) -> Census {
        let mut census = Census::default();
        let mut spans: BTreeMap<(String, u32), (f64, f64, bool)> = BTreeMap::new();
        for Obstacle { shape, kind, object_id, synthetic } in &self.obstacles {
            let name = format!("{kind:?}");
            census.kinds.entry(name.clone()).or_default().boxes += 1;
            let (low, high) =
                (shape.center_in_world.z - shape.half_extents_m.z, shape.center_in_world.z + shape.half_extents_m.z);
            let span = spans.entry((name, *object_id)).or_insert((low, high, *synthetic));
            *span = (span.0.min(low), span.1.max(high), span.2 && *synthetic);
        }
        let mut heights: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for ((name, _), (low, high, synthetic)) in spans {
            let things = census.kinds.entry(name.clone()).or_default();
            things.objects += 1;
            things.synthetic_objects += usize::from(synthetic);
            heights.entry(name).or_default().push(high - low);
        }
        for (name, mut heights) in heights {
            heights.sort_by(f64::total_cmp);
            let [least, .., most] = heights[..] else {
                let only = heights.first().copied().unwrap_or_default();
                census.kinds.entry(name).or_default().heights_m = Range { least: only, median: only, most: only };
                continue;
            };
            let median = heights[(heights.len() - 1) / 2];
            census.kinds.entry(name).or_default().heights_m = Range { least, median, most };
        }
        for polygon in &self.walkable {
            let ground = census.walkable.entry(format!("{:?}", polygon.kind)).or_default();
            let area_m2 = 0.5 * twice_area_m2(&polygon.plan()).abs();
            ground.polygons += 1;
            ground.area_m2 += area_m2;
            ground.synthetic_area_m2 += if polygon.synthetic { area_m2 } else { 0.0 };
        }
        for mesh in &self.surfaces {
            let plan = |corner: u32| mesh.vertices_in_world[corner as usize].truncate();
            let area_m2: f64 = mesh.triangles.iter().map(|corners| 0.5 * twice_area_m2(&corners.map(plan)).abs()).sum();
            let ground = census.ground.entry(mesh.label.name()).or_default();
            ground.area_m2 += area_m2;
            ground.synthetic_area_m2 += if mesh.synthetic { area_m2 } else { 0.0 };
        }
        census
    }
}

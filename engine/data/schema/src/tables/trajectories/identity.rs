//! Name, town, split and difficulty of a trajectory.

use super::columns::Trajectories;
use crate::Role;
use crate::tables::DatasetItem;
use crate::tables::column::columns;
use crate::tables::windows::{self, SceneMembership};
use cosfly_domain::{Outfit, Traffic, Traits};
use cosfly_windows::{Difficulty, WindowFeatures};

columns! { Trajectories::IDENTITY of DatasetItem;
    /// Name of the trajectory, unique in the dataset.
    trajectory_id: String = |item, _| item.record.trajectory_id.clone();
    /// Name of the flight: rows with the same name have the same poses, target and ids in different weathers or by
    /// different cameras.
    flight_id: String = |item, _| item.record.flight_id.clone();
    /// Expert or perturbed trajectory.
    role: Role = |item, _| item.record.role;
    /// Expert of a perturbed trajectory; null for experts.
    expert_id: Option<String> = |item, _| item.record.pair.as_ref().map(|pair| pair.expert_id.clone());
    /// Pedestrian who is followed; all trajectories behind one pedestrian are in the same split.
    pedestrian_id: String = |item, _| item.record.pedestrian_id.clone();
    /// Kind of the target, such as `pedestrian`, `push_chair` or `car`: a word of `follow.kinds` of stage `traffic`; null for a
    /// target without a body.
    target_kind: Option<String> = |item, _| item.record.target_kind().map(|kind| kind.name().to_owned());
    /// Id of the target as `bodies.body_id` of other trajectories has it; null outside of stage `traffic`.
    target_body_id: Option<String> = |item, _| item.record.followed.as_ref().filter(|it| !it.traffic.is_empty()).map(|it| Traffic::body_id(&it.traffic, it.number));
    /// Colour of the target's shirt or jacket in words, the same in all flights behind the pedestrian unless the recipe says
    /// otherwise; null for a target without a body.
    target_top_colour: Option<String> = |item, _| outfit(item).map(|it| it.top.name.name().to_owned());
    /// Colour of the target's shirt or jacket: share of light that it reflects, linear red, green, blue.
    target_top_linear_rgb: Option<[f64; 3]> = |item, _| outfit(item).map(|it| it.top.linear_rgb.map(f64::from));
    /// Colour of the target's trousers in words.
    target_trousers_colour: Option<String> = |item, _| outfit(item).map(|it| it.trousers.name.name().to_owned());
    /// Whether the target wears a backpack.
    target_has_backpack: Option<bool> = |item, _| outfit(item).map(|it| it.backpack);
    /// Whether the target holds an open umbrella, a part of the target in pixels and boxes: up to 1.25 times `target_height_m` high.
    target_has_umbrella: Option<bool> = |item, _| outfit(item).map(|it| it.umbrella);
    /// The target's bag: `none`, `backpack` or `shoulder_bag`; null for vehicles and their riders.
    target_bag: Option<String> = |item, _| traits(item).map(|it| it.bag.name().to_owned());
    /// The target's build: `slim`, `medium` or `stout`; null for vehicles and their riders.
    target_build: Option<String> = |item, _| traits(item).map(|it| it.build.name().to_owned());
    /// The target's steps: `short`, `medium` or `long`; null for vehicles and their riders.
    target_gait: Option<String> = |item, _| traits(item).map(|it| it.gait.name().to_owned());
    /// Seed of the item, decimal.
    seed: String = |item, _| item.record.seed.to_string();
    /// Number of frames.
    frames: u32 = |item, _| item.record.len() as u32;
    /// Time between frames.
    dt_s: f64 = |item, _| item.record.dt_s();
    /// Time of the last frame.
    duration_s: f64 = |item, _| item.record.times().s(item.record.len().saturating_sub(1));

    /// Name of the town.
    town: String = |item, _| item.record.town.name.clone();
    /// BLAKE3 of the town's geometry, hexadecimal.
    town_geometry_blake3: String = |item, _| item.record.town.geometry_digest.clone();
    /// Position of the world frame in the map file: x = x_map - x_offset, y = -y_map - y_offset, z = z_map - z_offset.
    town_offset_m: [f64; 3] = |item, _| item.record.town.origin.offset_m.to_array();
    /// Projection text of the map file; null where the file has none.
    town_geo_reference: Option<String> = |item, _| item.record.town.origin.geo_reference.clone();
    /// Whether buildings were generated, not read from the map file.
    synthetic_buildings: bool = |item, _| item.record.town.synthetic.buildings;
    /// Whether trees were generated, not read from the map file.
    synthetic_trees: bool = |item, _| item.record.town.synthetic.trees;
    /// Whether street furniture was generated, not read from the map file.
    synthetic_furniture: bool = |item, _| item.record.town.synthetic.furniture;
    /// List of all generated parts, in words.
    synthetic_notes: Vec<String> = |item, _| item.record.town.synthetic.notes.clone();

    /// BLAKE3 of the ground plan of the walkable surface, the same for copies of a town with other names or buildings.
    town_layout_blake3: String = |item, _| item.layout.digest.clone();
    /// Sketch of the ground plan, 64 numbers; the share of numbers that two towns have in common estimates the
    /// similarity of their plans (MinHash).
    town_layout_sketch: Vec<i64> = |item, _| item.layout.sketch.clone();
    /// Split: `train`, `val` or `test`; that of the file.
    split: String = |item, _| item.membership.split.name().to_owned();
    /// Split group: all trajectories of one group are in one split.
    split_group: String = |item, _| item.membership.split_group.clone();
    /// Rank in nested subsets, 0..1, the same for all trajectories behind a pedestrian: those below 0.25 are a quarter of
    /// all, and part of those below 0.5.
    subset_rank: f64 = |item, _| item.membership.subset_rank;
    /// Seen: split `train` of this dataset has trajectories in the same town, by the town's ground plan.
    scene: SceneMembership = |item, _| windows::scene_of(item);
    /// Median of the difficulties of the trajectory's windows, see table `windows`; null without the expert.
    difficulty: Option<Difficulty> = |item, _| {
        let mut all: Vec<_> = windows::all_features(item).iter().map(WindowFeatures::difficulty).collect();
        all.sort_unstable();
        all.get(all.len() / 2).copied()
    };
    /// Mean of the windows' `turn_deg`; null without the expert.
    mean_turn_deg: Option<f64> = |item, _| mean_of_windows(item, |it| it.turn_deg);
    /// Mean of the windows' `height_change_m`; null without the expert.
    mean_height_change_m: Option<f64> = |item, _| mean_of_windows(item, |it| it.height_change_m);
    /// Mean of the windows' `occluded_share`; null without the expert.
    mean_occluded_share: Option<f64> = |item, _| mean_of_windows(item, |it| it.occluded_share);
    /// Mean of the windows' `speed_mps`; null without the expert.
    mean_speed_mps: Option<f64> = |item, _| mean_of_windows(item, |it| it.speed_mps);
}

fn mean_of_windows(item: &DatasetItem, feature: fn(&WindowFeatures) -> f64) -> Option<f64> {
    let all = windows::all_features(item);
    (!all.is_empty()).then(|| all.iter().map(feature).sum::<f64>() / all.len() as f64)
}

fn traits(item: &DatasetItem) -> Option<Traits> {
    outfit(item)?.traits
}

fn outfit(item: &DatasetItem) -> Option<&Outfit> {
    item.record.outfit.as_ref()
}

//! Writes the training windows of 12,000 synthetic flights of 200 frames (2.4 million time steps) into the Parquet file
//! given as the first argument; prints time and peak memory.

use cosfly_captions::sight::Landmarks;
use cosfly_frames::{DVec3, Pose, Seed};
use cosfly_sample as sample;
use cosfly_schema::tables::{self, DatasetItem, Membership};
use cosfly_schema::{LogRecord, PreviewStrip, RenderedTrajectory, Role, Split, TownLayout};
use cosfly_windows::WindowShape;
use cosfly_write::derive::derive;
use cosfly_write::table_file::TableWriter;
use std::fs::File;
use std::io::BufWriter;
use std::sync::Arc;
use std::time::Instant;

const PAIRS: usize = 6_000;
const FRAMES: usize = 200;

fn main() {
    let path = std::env::args_os().nth(1).expect("usage: windows_of_many_flights FILE");
    let began = Instant::now();
    let table = tables::of_trajectories().into_iter().find(|table| table.name == "windows").expect("it exists");
    let output = BufWriter::new(File::create(path).expect("the file can be written"));
    let mut writer = TableWriter::new(&table, output).expect("a new file can be written");
    let layout = Arc::new(TownLayout::of(&sample::town()));
    let landmarks = Landmarks::of(&sample::town());
    let patterns = [Role::Expert, Role::Perturbed].map(|role| sample::flight(0, role));
    for pair in 0..PAIRS {
        let expert = long_flight(&patterns[0].record, pair, 0.0);
        let twin = long_flight(&patterns[1].record, pair, 2.0);
        for (pattern, record) in patterns.iter().zip([expert.clone(), twin]) {
            let item = DatasetItem {
                derived: derive(&record, &landmarks, &WindowShape::default()),
                captions: pattern.captions.clone(),
                previews: PreviewStrip::default(),
                log: log_of(&record),
                mcap_path: String::new(),
                expert: record.pair.is_some().then(|| Box::new(expert.clone())),
                membership: Membership {
                    split: Split::Train,
                    split_group: String::new(),
                    is_seen: true,
                    subset_rank: 0.5,
                },
                layout: Arc::clone(&layout),
                windows: WindowShape::default(),
                record,
            };
            writer.append(&item).expect("made-up flights are sound");
        }
    }
    let rows = writer.finish().expect("the file can be finished");
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).map_or("unknown", str::trim);
    println!(
        "{rows} windows of {} time steps in {:.1} s, peak memory {peak}",
        2 * PAIRS * FRAMES,
        began.elapsed().as_secs_f64()
    );
}

/// Flight like `pattern` with another number of frames, on its own trajectory; `spread_m` displaces every frame.
fn long_flight(pattern: &RenderedTrajectory, number: usize, spread_m: f64) -> RenderedTrajectory {
    let mut stream = Seed::of_item(number as u64, "windows", pattern.role.name()).stream("way");
    let mut record = pattern.clone();
    record.trajectory_id = format!("{}-p{number:05}", pattern.role.name());
    let (state, view) = (pattern.trajectory.track.states[0], pattern.views[0]);
    let (mut feet, mut heading_rad) = (DVec3::ZERO, stream.uniform(-3.0, 3.0));
    let (mut states, mut poses) = (vec![], vec![]);
    for _ in 0..FRAMES {
        heading_rad += stream.uniform(-0.2, 0.2);
        feet += DVec3::new(0.6, stream.uniform(-0.2, 0.2), 0.0);
        let away = DVec3::from_array([0; 3].map(|_| spread_m * stream.uniform(-1.0, 1.0)));
        poses.push(Pose::looking_at(feet + DVec3::new(-15.0, 3.0, 18.0) + away, feet));
        states.push(cosfly_frames::TargetState { feet_in_world: feet, heading_rad, ..state });
    }
    record.trajectory.track.states = states;
    record.trajectory.poses_in_world = poses;
    record.views = vec![view; FRAMES];
    if let Some(perturbation) = &mut record.trajectory.perturbation {
        let frame = perturbation.frames[0];
        perturbation.frames =
            (0..FRAMES as u32).map(|expert_frame| cosfly_domain::FramePerturbation { expert_frame, ..frame }).collect();
    }
    record
}

fn log_of(record: &RenderedTrajectory) -> LogRecord {
    LogRecord {
        trajectory_id: record.trajectory_id.clone(),
        role: record.role,
        pedestrian_id: record.pedestrian_id.clone(),
        town: record.town.name.clone(),
        frames: FRAMES as u64,
        messages: 0,
        bytes: 0,
        sha256: String::new(),
    }
}

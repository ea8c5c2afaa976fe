//! Perturbed flights against their experts: each frame is the expert's plus the stored displacement.

use super::frames::TOLERANCE;
use super::report::VerifyReport;
use super::rows::PlacedFrame;
use super::tables::SmallTables;
use cosfly_frames::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// The parts of a perturbed frame that are compared with its expert's.
struct TwinFrame {
    row: usize,
    position: DVec3,
    angles_deg: [f64; 3],
    expert_frame: Option<u32>,
    undisturbed: bool,
    offset: DVec3,
}

/// Experts and twins, kept until both have been read.
pub struct Twins<'a> {
    tables: &'a SmallTables,
    wanted: BTreeSet<&'a str>,
    experts: BTreeMap<String, Vec<(DVec3, [f64; 3], DVec3)>>,
    twins: BTreeMap<String, Vec<(TwinFrame, DVec3)>>,
}

impl<'a> Twins<'a> {
    /// Nothing read yet.
    pub fn of(tables: &'a SmallTables) -> Self {
        let wanted = tables.flights.values().filter_map(|flight| flight.expert_id.as_deref());
        Self { tables, wanted: wanted.collect(), experts: BTreeMap::new(), twins: BTreeMap::new() }
    }

    /// Keeps a flight that is an expert of another, or has one.
    pub fn keep(&mut self, frames: &[PlacedFrame]) {
        let id = &frames[0].trajectory_id;
        if self.wanted.contains(id.as_str()) {
            let poses =
                frames.iter().map(|it| (it.pose.position_in_world, it.angles_deg, it.target.feet_in_world)).collect();
            self.experts.insert(id.clone(), poses);
        }
        if self.tables.flights.get(id).is_some_and(|flight| flight.expert_id.is_some()) {
            let twin = |frame: &PlacedFrame| {
                let event = frame.disturbance.as_ref();
                let twin = TwinFrame {
                    row: frame.row,
                    position: frame.pose.position_in_world,
                    angles_deg: frame.angles_deg,
                    expert_frame: event.map(|it| it.expert_frame),
                    undisturbed: event.is_none_or(|it| !it.position && !it.rotation),
                    offset: event.map_or(DVec3::ZERO, |it| it.drone_offset_in_world),
                };
                (twin, frame.target.feet_in_world)
            };
            self.twins.insert(id.clone(), frames.iter().map(twin).collect());
        }
    }

    /// A twin is its expert plus the stored displacement, and exactly its expert where nothing happened.
    pub fn check(&self, tables: &SmallTables, report: &mut VerifyReport) {
        for (id, frames) in &self.twins {
            let flight = &tables.flights[id];
            let file = flight.place.0.replace("data/trajectories/", "data/frames/");
            let Some(expert_id) = &flight.expert_id else { continue };
            let Some(expert) = self.experts.get(expert_id) else { continue };
            for (number, (frame, feet)) in frames.iter().enumerate() {
                let of_expert = frame.expert_frame.and_then(|it| expert.get(it as usize));
                let aligned = of_expert.is_some_and(|(position, angles, expert_feet)| {
                    let turned = angles.iter().zip(frame.angles_deg).any(|(a, b)| (a - b).abs() > TOLERANCE);
                    (*position + frame.offset - frame.position).length() <= TOLERANCE
                        && (*expert_feet - *feet).length() <= TOLERANCE
                        && !(frame.undisturbed && turned)
                });
                if !aligned {
                    let expert_frame = frame.expert_frame.map_or("?".to_owned(), |it| it.to_string());
                    let message =
                        format!("it is not frame {expert_frame} of `{expert_id}` plus its stored displacement");
                    report.find(&file, format!("row {}, `{id}` frame {number}", frame.row), "verify-pair", message);
                }
            }
        }
    }
}

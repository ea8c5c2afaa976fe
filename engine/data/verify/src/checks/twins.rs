//! Perturbed flights against their experts: each frame is the expert's plus the stored displacement.

use crate::flight_rows::FlightRows;
use crate::frames::TOLERANCE;
use crate::report::VerifyReport;
use cosfly_frames::DVec3;

/// A twin is its expert plus the stored displacement, and exactly its expert where nothing happened.
pub fn check(rows: &FlightRows<'_>, report: &mut VerifyReport) {
    let FlightRows { file, flight, frames, expert: Some(expert), .. } = *rows else { return };
    let (id, expert_id) = (&flight.trajectory_id, flight.expert_id.as_deref().unwrap_or_default());
    for (number, frame) in frames.iter().enumerate() {
        let event = frame.disturbance.as_ref();
        let expert_frame = event.map(|it| it.expert_frame);
        let is_undisturbed = event.is_none_or(|it| !it.position && !it.rotation);
        let offset = event.map_or(DVec3::ZERO, |it| it.drone_offset_in_world);
        let aligned = expert_frame.map(|it| it as usize).filter(|at| *at < expert.poses.len()).is_some_and(|at| {
            let pose = &expert.poses[at];
            let angles = [pose.pitch_rad, pose.yaw_rad, pose.roll_rad].map(f64::to_degrees);
            let turned = angles.iter().zip(frame.angles_deg).any(|(a, b)| (a - b).abs() > TOLERANCE);
            (pose.position_in_world + offset - frame.pose.position_in_world).length() <= TOLERANCE
                && (expert.feet[at] - frame.target.feet_in_world).length() <= TOLERANCE
                && !(is_undisturbed && turned)
        });
        if !aligned {
            let expert_frame = expert_frame.map_or("?".to_owned(), |it| it.to_string());
            let message = format!("it is not frame {expert_frame} of `{expert_id}` plus its stored displacement");
            report.find(file, format!("row {}, `{id}` frame {number}", frame.row), "verify-pair", message);
        }
    }
}

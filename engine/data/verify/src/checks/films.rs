//! Films of one flight by several cameras: each has the drone and the target where the others have them at the same time.

use crate::flight_rows::FlightRows;
use crate::frames::TOLERANCE;
use crate::report::VerifyReport;
use cosfly_frames::DVec3;

/// Compares drone and feet with the film that has the most frames. Between its frames both move evenly, but for what a coarse film leaves
/// out: never more than its course bends there. Perturbed flights jump in between.
pub fn check(rows: &FlightRows<'_>, report: &mut VerifyReport) {
    let FlightRows { file, flight, frames, film: Some((other, track)), .. } = *rows else { return };
    if flight.expert_id.is_some() || track.poses.len() < 2 || track.feet.len() != track.poses.len() {
        return;
    }
    let drone: Vec<DVec3> = track.poses.iter().map(|pose| pose.position_in_world).collect();
    for (number, frame) in frames.iter().enumerate() {
        let at = (flight.times().s(number) - other.times().s(0)) / other.dt_s;
        let places = [(&drone, frame.pose.position_in_world), (&track.feet, frame.target.feet_in_world)];
        let Some((off_m, _)) = places.iter().filter_map(|(list, place)| apart(list, at, *place)).find(|it| it.0 > it.1)
        else {
            continue;
        };
        let place = format!("row {}, `{}` frame {number}", frame.row, flight.trajectory_id);
        let (time_s, other) = (frame.time_s, &other.trajectory_id);
        let message =
            format!("at {time_s} s it is {off_m:.4} m from where `{other}` has it: its time stamps are shifted");
        return report.find(file, place, "verify-film", message);
    }
}

/// Distance from a course at a place among its frames, and the distance that is allowed, metres; none beyond its ends.
fn apart(list: &[DVec3], at: f64, place: DVec3) -> Option<(f64, f64)> {
    let nearest = at.round();
    let at = if (at - nearest).abs() < 1e-6 { nearest } else { at };
    let last = list.len() - 1;
    if !(0.0..=last as f64).contains(&at) {
        return None;
    }
    let first = (at as usize).min(last - 1);
    let bend_m = |k: usize| match (k.checked_sub(1), list.get(k + 1)) {
        (Some(before), Some(after)) => (list[before] + *after - 2.0 * list[k]).length(),
        _ => 0.0,
    };
    let between = if at.fract() == 0.0 { 0.0 } else { bend_m(first).max(bend_m(first + 1)) };
    Some((list[first].lerp(list[first + 1], at - first as f64).distance(place), TOLERANCE + between))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_of_another_time_is_off_a_straight_course_and_nothing_is_known_beyond_it() {
        let list: Vec<DVec3> = (0..5).map(|k| DVec3::X * f64::from(k)).collect();
        let off_m = |at: f64| apart(&list, at, DVec3::X * 2.4).map(|(off_m, allowed_m)| off_m > allowed_m);
        assert_eq!((off_m(2.4), off_m(2.3), off_m(2.0)), (Some(false), Some(true), Some(true)));
        assert_eq!((off_m(-0.1), off_m(4.1)), (None, None));
        // A corner lies beside the line between the frames of a coarse film.
        let corner = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::X + 2.0 * DVec3::Y];
        let (off_m, allowed_m) = apart(&corner, 0.5, DVec3::new(0.6, -0.1, 0.0)).expect("it is known");
        assert!(off_m > 0.1 && off_m < allowed_m);
    }
}
